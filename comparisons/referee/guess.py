"""The first guess of the exact equilibrium from the axes, forces and arc positions of an answer."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field

import numpy as np

from comparisons.answer import Array, ContactHistory, Response
from comparisons.frozen import Frozen
from comparisons.referee.grip import Grip
from comparisons.referee.layout import NONE, Layout, Part
from comparisons.referee.rod import value
from comparisons.scene import BeamSpec, ContactSpec, Scene

Rotations = tuple[Array, Array]
"""Arc positions from one end of a beam to the other, and rotations of its sections there, linear in between; in units of `Layout`."""
Seen = Callable[[str, Array], tuple[Array, Array]]
"""Positions (m, 2) in the scene's units and rotations (m,) that are seen at arc positions of a beam in those of `Layout`."""

PULL = 1e-9
"""Largest contact force that is round-off, over EI/L^2 of the touched beam, for the models' contacts at a release."""
SHORTEST = 1e-9
"""Length of a part over the longest beam up to which two stations are at one place."""


class AnswerState(Frozen):
    """An answer at one load parameter, in the scene's units."""

    load_parameter: float  #: Load parameter of the answer.
    axes: dict[str, tuple[Array, Array]]  #: Arc lengths (m,) and deformed positions (m, 2) of every axis.
    arcs: dict[str, float] = field(default_factory=dict)  #: Arc positions of the closed pairs.
    #: Contact forces of the pairs that have one, on their beams.
    forces: Mapping[str, Sequence[float] | Array] = field(default_factory=dict)
    #: Force and moment of every support, by the supported end.
    reactions: Mapping[str, Sequence[float] | Array] = field(default_factory=dict)
    #: How friction holds the closed pairs; pairs without a grip have no friction.
    grips: dict[str, Grip] = field(default_factory=dict)


def answer_state(response: Response, scene: Scene, k: int) -> AnswerState:
    """Return the state at load parameter number k; a contact whose force is round-off is open at an end of its beam, but its force counts."""
    arcs, forces = dict[str, float](), dict[str, Sequence[float]]()
    for spec in scene.contacts:
        item = response.contacts[spec.pair]
        if item.force[k] != 0.0:
            forces[spec.pair] = (math.nan, math.nan) if item.vector is None else item.vector[k].tolist()
            if not idle_at_an_end(item, scene, spec, k):
                arcs[spec.pair] = float(item.arc_position[k])
    return AnswerState(
        load_parameter=float(response.load_parameter[k]),
        arcs=arcs,
        forces=forces,
        axes={beam.name: response.axis_line(beam.name, k) for beam in scene.beams},
        reactions={
            node: (*item.force[k].tolist(), float(item.moment[k])) for node, item in response.supports.items()
        },
    )


def pull_allowed(beam: BeamSpec) -> float:
    """Largest tensile contact force on a beam that is round-off."""
    return PULL * beam.EI / beam.length**2


def idle_at_an_end(contact: ContactHistory, scene: Scene, spec: ContactSpec, k: int) -> bool:
    """Whether a contact is at an end of its beam with a force that is round-off."""
    beam, arc = scene.beam(spec.beam), float(contact.arc_position[k])
    inside = min(arc, beam.length - arc) / max(item.length for item in scene.beams)
    return abs(float(contact.force[k])) <= pull_allowed(beam) and abs(inside) <= SHORTEST


def first_guess(layout: Layout, answer: AnswerState) -> tuple[Array, Seen]:
    """Return the unknowns of the layout, and what an answer shows of its beams."""
    z = np.zeros(layout.unknowns)
    z[layout.arcs] = [answer.arcs[pair] / layout.length for pair in layout.touches]
    for _ in range(2):  # the shear follows from the forces
        turns = _rotations(layout, answer, z)

        def seen(beam: str, s: Array, turns: dict[str, Rotations] = turns) -> tuple[Array, Array]:
            axis, line = answer.axes[beam]
            places = np.transpose([np.interp(s * layout.length, axis, way) for way in line.T])
            return places, np.interp(s, *turns[beam])

        put(layout, z, seen)
        _balance(layout, answer, z)
    return z, seen


def put(layout: Layout, z: Array, seen: Seen) -> None:
    """Set the stations' motions, and the directions of contacts, from what is seen of the beams."""
    for part, arcs in zip(layout.parts, layout.extents(z), strict=True):
        for number, s, place, theta in zip(part.stations, arcs, *seen(part.beam, arcs), strict=True):
            station = layout.stations[number]
            moved = (place - layout.scene.beams[0].start) / layout.length - station.reference
            free = (station.numbers >= 0) & [station.touch is None, station.touch is None, True]
            z[station.numbers[free]] = np.append(moved, theta)[free]
            if station.touch is not None and station.touch.angle != NONE:
                z[station.touch.angle] = part.piece.angle(s)[0] + theta + math.asin(station.touch.face.tilt)


def _rotations(layout: Layout, answer: AnswerState, z: Array) -> dict[str, Rotations]:
    """Rotations of all beams, with multiples of 2 pi, so that beams agree with prescribed rotations and, at joints, with each other."""
    known: dict[int, float] = {
        k: float(layout.given[item.numbers[2]])
        for k, item in enumerate(layout.stations)
        if item.numbers[2] < 0
    }
    own: dict[str, list[tuple[Part, Array]]] = {beam.name: [] for beam in layout.scene.beams}
    for part, extent in zip(layout.parts, layout.extents(z), strict=True):
        own[part.beam].append((part, extent))
    turns = {}
    while own:
        joined = (b for b in own if {own[b][0][0].stations[0], own[b][-1][0].stations[1]} & known.keys())
        beam = next(joined, next(iter(own)))
        parts = own.pop(beam)
        arc, theta = _rotation(layout, answer, parts, z)
        both = [(parts[0][0].stations[0], theta[0]), (parts[-1][0].stations[1], theta[-1])]
        shift = next((known[k] - turn for k, turn in both if k in known), 0.0)
        whole = 2.0 * math.pi * round(shift / (2.0 * math.pi))
        turns[beam] = arc, theta + whole
        for k, turn in both:
            known.setdefault(k, float(turn + whole))
    return turns


def _rotation(layout: Layout, answer: AnswerState, own: list[tuple[Part, Array]], z: Array) -> Rotations:
    """Angles of a beam's chords from the undeformed direction, less the shear of the forces in z, extrapolated to the ends.

    ``r' = d1 + (N/EA) d1 + (Q/GA) d2`` gives ``r' - n/GA = (1 + N/EA - N/GA) d1``. In strong shear the factor of d1 is negative; its
    sign is the one that agrees with N.
    """
    part, length = own[0][0], own[-1][1][1]
    arc, line = answer.axes[part.beam]
    chords, extents = np.diff(line, axis=0) @ (1.0, 1.0j), np.diff(arc)
    long = (np.abs(chords) > 0.0) & (extents > 0.0)
    if not long.any():
        return np.array([0.0, length]), np.zeros(2)
    s = (arc[:-1] + arc[1:])[long] / (2.0 * layout.length)
    way, back = chords[long] / extents[long], np.exp(-1.0j * part.piece.angle(s))
    theta = np.angle(way * back)
    for part, (first, last) in own:
        EA, GA, _, *W = value(part.piece.coefficients, s)
        force = np.array([1.0, 1.0j]) @ (part.constant(z) - W)
        along = way - force / GA
        size = np.abs(along)
        d1 = along / np.where(size > 0.0, size, 1.0)
        factor = (1.0 / EA - 1.0 / GA) * (d1 * force.conjugate()).real
        d1 = np.where(np.abs(1.0 + factor - size) <= np.abs(1.0 - factor + size), d1, -d1)
        theta = np.where((s >= first) & (s <= last) & (size > 0.0), np.angle(d1 * back), theta)
    theta = np.unwrap(theta)
    slope = np.append(np.diff(theta) / np.diff(s), 0.0)[[0, max(len(s) - 2, 0)]]
    ends = theta[[0, -1]] + slope * ([0.0, length] - s[[0, -1]])
    return np.array([0.0, *s, length]), np.array([ends[0], *theta, ends[1]])


def _balance(layout: Layout, answer: AnswerState, z: Array) -> None:
    """Set the forces of the parts by a least-squares balance with the answer's contact forces, reactions and loads."""
    _, loads, stiffness = layout.tables
    acting = loads[:, :2] - (stiffness @ layout.motions(z).ravel()).reshape(loads.shape)[:, :2]
    joined = {end: joint for end, joint, _ in layout.hinges}
    for end, joint in joined.items():
        acting[joint] += acting[end]
    for node, (x, y, _) in answer.reactions.items():
        acting[layout.joints[node]] += np.array([x, y]) / layout.force
    for pair, touch in layout.touches.items():
        force = np.nan_to_num(np.array(answer.forces[pair])) / layout.force
        acting[touch.station] += force
        if touch.spec.node in layout.joints:
            acting[layout.joints[touch.spec.node]] -= force
    known = {layout.joints[node] for node in answer.reactions}
    balance = np.zeros((len(layout.stations), len(layout.parts)))
    for n, part in enumerate(layout.parts):
        for number, sign in zip(part.stations, (-1.0, 1.0), strict=True):
            balance[joined.get(number, number), n] += sign
    for axis, forces in enumerate(layout.forces.reshape(-1, 2).T):
        stated = [
            k not in joined and (k in known or item.touch is not None or item.numbers[axis] >= 0)
            for k, item in enumerate(layout.stations)
        ]
        z[forces] = np.linalg.lstsq(balance[stated], acting[stated, axis], rcond=None)[0]
