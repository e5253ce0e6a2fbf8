"""Differences between an answer and the exact equilibrium near it."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import Array, Response
from comparisons.answer.axis import place_of
from comparisons.answer.round_off import (
    LAST_PLACES,
    RESIDUAL,
    UNRESOLVED,
    force_round_off,
    least_force,
)
from comparisons.frozen import Value
from comparisons.referee.guess import SHORTEST
from comparisons.referee.rod import angle, axis_at_rest, cross, face_of
from comparisons.referee.state import Equilibrium
from comparisons.scene import BeamSpec, ContactSpec

Scales = tuple[float, float, float]
"""Largest force, moment and displacement."""

COMPARED = ("force", "arc_position", "reaction", "tip", "shape", "displacement")
"""The differences that are held against the allowance, by their names."""
ROUGH = ("gap", "sections", "constraint")
"""Differences held against it too, which are interpolated and therefore no measure of an answer's accuracy; `place` has its own limit."""
NONE = 1e-9
"""Difference below which only its bound is told."""
_TIE = 1e-6
"""Relative difference of sizes of which the first is told, so that round-off chooses no name."""
_POINTS = 401
"""Points of an axis between which the feet of a node are sought."""
_HALVINGS = 24
"""Number of times that an interval of arc positions around a foot is halved."""
LOCAL = 1.5
"""Distance from contacts, loads and ends, over the height, within which the section forces of a solid are not compared."""
_SHARPEST = 1.4
"""Largest angle between neighbouring chords in the bound of the chords' error [rad]; beyond it the tangent grows without limit."""


class Distance(Value):
    """Largest differences between an answer and the exact equilibrium.

    The `sizes` are infinite for missing or unknown items, zero where there is nothing to compare:
    `force` of a contact as a vector, over the largest contact force;
    `arc_position`, `tip`, the distance of a beam's free or less restrained end, `shape`, that of an axis, and `gap`, over the beam's length;
    `reaction`, of the force or moment of a support or spring, over the largest force or moment of supports, contacts and loads;
    `sections`, of a section force N, V or M, over the same;
    `displacement`, the largest distance of a tip or an axis over the largest exact displacement;
    `place`, the violation of the constraints by the answer itself: distance of its axis from the touching points of the contacts and
    from the prescribed positions of the supports, over the beam's length, less the error of the chords between the points of the axis;
    `constraint`, the largest of these over the largest exact displacement.
    """

    sizes: Mapping[str, float]  #: By name.
    #: The pair, supported end or beam with the largest difference by name; none where there is nothing to compare.
    where: Mapping[str, str] = field(repr=False)
    scales: Scales  #: Those of the exact equilibrium.

    @property
    def largest(self) -> tuple[str, float]:
        """Name and size of the largest difference that measures the accuracy."""
        return self._largest(COMPARED)

    @property
    def rough(self) -> tuple[str, float]:
        """Name and size of the largest difference that is interpolated."""
        return self._largest(ROUGH)

    def _largest(self, names: Sequence[str]) -> tuple[str, float]:
        most = max(self.sizes[name] for name in names)
        return next(name for name in names if self.sizes[name] * (1.0 + _TIE) >= most), most

    def line(self, of: tuple[str, float] | None = None) -> str:
        """Return a difference, the largest one if none is given, in words, as ``force off by 20 % (pin->strip)``."""
        name, size = of or self.largest
        if size <= NONE:
            return f"off by less than {100.0 * NONE:g} %"
        return f"{name.replace('_', ' ')} off by {100.0 * size:.2g} %{self.at(name)}"

    def at(self, name: str) -> str:
        """Return where a difference is largest in brackets, as `` (pin->strip)``; nothing where there is nothing to compare."""
        return f" ({self.where[name]})" if name in self.where else ""


def _size(value: float) -> float:
    """Return a value, infinite for nan."""
    return math.inf if math.isnan(value) else value


def distance(response: Response, k: int, exact: Equilibrium, largest: Scales) -> Distance:
    """Return the differences at load parameter number k; forces, moments and displacements are relative to those here, or to larger ones."""
    scene = exact.scene
    lines = {beam.name: response.axis_line(beam.name, k) for beam in scene.beams}
    axes = {name: exact.shape(name, arc).position for name, (arc, _) in lines.items()}
    ways = [axes[beam.name] - axis_at_rest(beam, lines[beam.name][0]) for beam in scene.beams]
    scales = (*_forces(exact), max(float(np.hypot(*way.T).max()) for way in ways))
    size, moment, moved = map(max, scales, largest)
    length = max(beam.length for beam in scene.beams)
    last = force_round_off(scene, size)
    last_moment = min(force_round_off(scene, math.inf) * length, UNRESOLVED * moment)
    places = [np.abs(place) for beam in scene.beams for place in (beam.start, beam.end)]
    soft = max(beam.length**3 / beam.EI for beam in scene.beams)
    floor = RESIDUAL * length + LAST_PLACES * float(np.max(places)) + last * soft
    if size <= least_force(scene):
        # nothing acts: what the answer states is its round-off
        last, last_moment = max(last, response.round_off), max(last_moment, response.round_off * length)
    rows = [*_contact_differences(response, k, exact)]
    for end, total, stated in _holds(response, k, exact):
        x, y, turn = total - np.array(stated)
        rows.append(("reaction", f"force of {end}", _beyond(math.hypot(x, y), size, last)))
        rows.append(("reaction", f"moment of {end}", _beyond(abs(float(turn)), moment, last_moment)))
    for beam in scene.beams:
        name, there = beam.name, exact.ends[f"{beam.name}.{scene.tip(beam.name)}"]
        tip = math.hypot(*(there - response.tips[name][k]))
        axis = float(np.hypot(*(axes[name] - lines[name][1]).T).max())
        rows += [("tip", name, tip / beam.length), ("shape", name, axis / beam.length)]
        rows.append(("displacement", name, _beyond(max(_size(tip), _size(axis)), moved, floor)))
        for letter, off in _section_differences(response, k, exact, beam):
            of = (moment, last_moment) if letter == "M" else (size, last)
            rows.append(("sections", f"{letter} of {name}", _beyond(off, *of)))
    for name, off, own in _misplaced(response, k, exact):
        rows += [("place", name, off / own), ("constraint", name, _beyond(off, moved, floor))]
    sizes, where = dict.fromkeys((*COMPARED, *ROUGH, "place"), 0.0), dict[str, str]()
    for name, at, off in rows:
        if name not in where or _size(off) > (1.0 + _TIE) * sizes[name]:
            where[name] = at
        sizes[name] = max(sizes[name], _size(off))
    return Distance(sizes=sizes, where=where, scales=scales)


def _contact_differences(response: Response, k: int, exact: Equilibrium) -> Iterator[tuple[str, str, float]]:
    """Yield names, pairs and differences of forces, arc positions and gaps."""
    largest = largest_force(exact)
    for spec in exact.scene.contacts:
        pair, length = spec.pair, exact.scene.beam(spec.beam).length
        contact, stated = exact.contacts.get(pair), response.contacts[pair]
        if contact is not None:
            # without its direction, a force has the exact one
            size, vector = np.hypot(*contact.force), stated.vector
            off = abs(size - stated.force[k]) if vector is None else np.hypot(*(contact.force - vector[k]))
            yield "force", pair, _beyond(float(off), largest, force_round_off(exact.scene, largest))
            yield "arc_position", pair, abs(contact.arc_position - float(stated.arc_position[k])) / length
        if contact is not None or math.isfinite(stated.gap[k]):
            yield "gap", pair, gap_off(exact, spec, float(stated.gap[k])) / length


def _holds(response: Response, k: int, exact: Equilibrium) -> Iterator[tuple[str, Array, Any]]:
    """Yield the supports and the springs that the answer states, with the exact force and moment and the stated ones."""
    held = [(end, total, response.supports[end]) for end, total in exact.reactions.items()]
    for spring in exact.scene.springs:
        node = spring.node
        if node in response.springs:
            way = np.array(spring.stiffness) * (exact.ends[node] - exact.scene.place(node))
            turn = exact.layout.motions(exact.z)[exact.layout.joints[node], 2]
            total = -np.append(way, spring.rotation * turn)
            held.append((f"the spring at {node}", total, response.springs[node]))
    for name, total, own in held:
        yield name, total, (*own.force[k], own.moment[k])


def feet(exact: Equilibrium, spec: ContactSpec) -> tuple[Array, Array]:
    """Arc positions where a pair's node is nearest to the curve of touching nodes, and its distances from the axis there, positive on its side."""
    face, arcs = face_of(exact.scene, spec), np.linspace(0.0, exact.scene.beam(spec.beam).length, _POINTS)

    def seen(arcs: Array) -> tuple[NDArray[np.bool_], Array]:
        there = exact.shape(spec.beam, arcs)
        away = exact.place(spec.node) - there.position
        far = np.hypot(*away.T)
        sided = np.where(face.left * cross(there.tangent, away) < 0.0, -far, far)
        return np.asarray(np.einsum("mi,mi->m", away, there.tangent) + face.slope * far >= 0.0), sided

    ahead = seen(arcs)[0]
    nearest = np.flatnonzero(ahead[:-1] & ~ahead[1:])
    low, high = arcs[nearest], arcs[nearest + 1]
    for _ in range(_HALVINGS if len(nearest) else 0):
        middle = (low + high) / 2.0
        ahead = seen(middle)[0]
        low, high = np.where(ahead, middle, low), np.where(ahead, high, middle)
    return low, seen(low)[1]


def gap_off(exact: Equilibrium, spec: ContactSpec, gap: float) -> float:
    """Difference of a stated gap from the exact one; an open pair may be stated at any foot of its node, or at none."""
    if spec.pair in exact.contacts:
        return _size(abs(gap))
    arcs, away = feet(exact, spec)
    true = away - face_of(exact.scene, spec).reach(arcs)
    return float(np.min(np.abs(gap - true), initial=math.inf)) if len(arcs) else 0.0


def _section_differences(
    response: Response, k: int, exact: Equilibrium, beam: BeamSpec
) -> Iterator[tuple[str, float]]:
    """Yield the largest differences of the stated section forces, at the stations or in the middles between them, away from jumps."""
    # elements with one direction for all of N and V state them to second order in the middles alone, and others have few stations
    if response.sections is None:
        return
    scene, at, local = exact.scene, response.sections(beam.name, k), LOCAL * response.continuum
    arc, near = at.arc, local * beam.rectangle_height + SHORTEST * beam.length
    loads = [item.load.at for item in scene.load_histories if item.load.beam == beam.name]
    jumps = [(part * beam.length,) * 2 for part in loads if part is not None]
    jumps += [
        (exact.contacts[spec.pair].arc_position, float(response.contacts[spec.pair].arc_position[k]))
        for spec in scene.contacts
        if spec.beam == beam.name and spec.pair in exact.contacts
    ]
    jumps += [(0.0, 0.0), (beam.length, beam.length)] if local else []
    kept = np.diff(arc) > SHORTEST * beam.length
    for jump in jumps:
        kept &= (arc[1:] < min(jump) - near) | (arc[:-1] > max(jump) + near)
    begins, station = np.flatnonzero(kept), exact.shape(beam.name, arc)
    middle = exact.shape(beam.name, ((arc[1:] + arc[:-1]) / 2.0)[kept])
    for letter, name in (("N", "N"), ("V", "Q"), ("M", "moment")):
        values = getattr(at, letter)
        offs = (
            (values - getattr(station, name))[sorted({*begins, *(begins + 1)})],
            ((values[1:] + values[:-1]) / 2.0)[kept] - getattr(middle, name),
        )
        yield letter, min(float(np.max(np.nan_to_num(np.abs(off), nan=np.inf), initial=0.0)) for off in offs)


def _beyond(off: float, size: float, last: float) -> float:
    """Relative difference `off / size`; zero if it is at most the round-off `last`."""
    if off <= last:
        return 0.0
    return _size(off / size) if size else math.inf


def largest_force(exact: Equilibrium) -> float:
    """Return the largest contact force, at least the force below which nothing acts."""
    return max([least_force(exact.scene), *(math.hypot(*item.force) for item in exact.contacts.values())])


def _forces(exact: Equilibrium) -> tuple[float, float]:
    """Return the largest force and the largest moment; without a considerable moment the force times the longest beam."""
    scene, t = exact.scene, exact.load_parameter
    acting = [
        *exact.reactions.values(),
        *((*np.multiply(scene.gravity_at(t), beam.mass), 0.0) for beam in scene.beams),
    ]
    for item in scene.load_histories:
        along, (first, last) = item.load.force_per_length is not None, item.load.span
        span = (last - first) * scene.beam(item.load.beam).length if along else 1.0
        acting.append(np.multiply(item.at(t), span))
    x, y, moments = np.array(acting).T
    length, moment = max(beam.length for beam in scene.beams), float(np.abs(moments).max())
    size = max(largest_force(exact), float(np.hypot(x, y).max()), moment / length)
    return size, moment if moment > 1e-3 * size * length else size * length


def _misplaced(response: Response, k: int, exact: Equilibrium) -> Iterator[tuple[str, float, float]]:
    """Yield pairs and supported ends, how far the answer's axes violate their constraints, and the lengths of the beams."""
    scene = exact.scene
    for spec in scene.contacts:
        if spec.pair in exact.contacts:
            arc = float(response.contacts[spec.pair].arc_position[k])
            place, cut = _on_axis(*response.axis_line(spec.beam, k), arc)
            far = math.hypot(*(place - place_of(response, scene, spec.node, k)))
            apart = abs(far - face_of(scene, spec).reach(arc))
            yield spec.pair, max(0.0, apart - cut), scene.beam(spec.beam).length
    for support in scene.all_supports:
        way = (place_of(response, scene, support.node, k) - scene.place(support.node)).tolist()
        motion = scene.prescribed_motions[support.node].at(exact.load_parameter)
        off = [_size(abs(x - to)) for x, to in zip(way, motion, strict=False) if to is not None]
        if off:
            yield support.node, max(off), scene.beam(support.beam).length


def _on_axis(arcs: Array, line: Array, arc: float) -> tuple[Array, float]:
    """Point of the answer's axis, and a bound of the chord's distance from a smooth axis: the triangle with its neighbours' directions."""
    k = int(np.clip(np.searchsorted(arcs, arc) - 1, 0, len(arcs) - 2))
    part = (arc - arcs[k]) / (arcs[k + 1] - arcs[k])
    chords = np.diff(line, axis=0)
    way, beside = chords[k], chords[max(k - 1, 0) : k + 2]
    turn = min(max(angle(way, chord) for chord in beside), _SHARPEST)
    return line[k] + part * way, 0.5 * math.hypot(*way) * math.tan(turn)
