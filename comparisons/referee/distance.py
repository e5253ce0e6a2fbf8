"""How far an answer is from the exact equilibrium next to it."""

import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.start import Given
from comparisons.referee.state import Equilibrium
from comparisons.scene import Scene

Array = NDArray[np.float64]

LEAST = 1e-4
"""Smallest force that distances are relative to, over EI/L^2: Newton's methods of the models end at 1e-10, and so much bends by 3e-5 L."""
LAST_PLACES, UNRESOLVED = 8.0 * float(np.finfo(float).eps), 1e-4
"""A force follows from a stretch, which positions resolve to a few units in the last place: so much of EA is round-off, up to this part
of the largest force."""


_SHARPEST = 1.4
"""Largest turn from one chord to the next that enters the bound of what chords cut off [rad]: beyond, its tangent grows without limit."""


@dataclass(frozen=True, kw_only=True)
class Distance:
    """Largest differences between an answer and the exact equilibrium; infinite for what the answer states of something else.

    Attributes
    ----------
    force : float
        Of the contact forces as vectors, over the largest of them.
    arc_position : float
        Of the contacts' arc positions, over their beam's length.
    reaction : float
        Of the supports' forces, and of their moments, over the largest force or moment there, contacts and loads included.
    tip : float
        Of the beams' less held ends, over the beam's length.
    shape : float
        Of the axes, over the beam's length.
    place : float
        Of what the answer has to keep by itself: its axis at the contacts from the touching points, and at the supports from the
        prescribed places, over the beam's length and beyond what the chords of the stated axis cut off.
    """

    force: float
    arc_position: float
    reaction: float
    tip: float
    shape: float
    place: float

    @property
    def largest(self) -> tuple[str, float]:
        """Name and size of the largest but `place`, which chords of the stated axis limit and which has a bound of its own."""
        own = [item for item in fields(self) if item.name != "place"]
        name = max(own, key=lambda item: _size(getattr(self, item.name))).name
        return name.replace("_", " "), float(getattr(self, name))


def _size(value: float) -> float:
    return math.inf if math.isnan(value) else value


def distance(scene: Scene, given: Given, exact: Equilibrium) -> Distance:
    """Return the distances of `given` from `exact`."""
    size, moment = scales(scene, exact)
    force, arc = [0.0], [0.0]
    largest = max(
        [LEAST * least_force(scene), *(float(np.hypot(*item.force)) for item in exact.contacts.values())]
    )
    last = LAST_PLACES * max(beam.EA for beam in scene.beams)
    length = max(beam.length for beam in scene.beams)
    for pair, contact in exact.contacts.items():
        touched = next(item.beam for item in scene.contacts if item.pair == pair)
        force.append(_beyond(float(np.hypot(*(contact.force - given.forces[pair]))), largest, last))
        arc.append(abs(contact.arc_position - given.arcs[pair]) / scene.beam(touched).length)
    reaction = [0.0 if given.reactions.keys() == exact.reactions.keys() else math.inf]
    for end, held in exact.reactions.items():
        off = held - np.array(given.reactions.get(end, (math.nan,) * 3))
        reaction += [
            _beyond(float(np.hypot(*off[:2])), size, last),
            _beyond(abs(float(off[2])), moment, last * length),
        ]
    tip, shape = [0.0], [0.0]
    for beam in scene.beams:
        there = exact.ends[f"{beam.name}.{scene.tip(beam.name)}"]
        tip.append(float(np.hypot(*(there - given.tips.get(beam.name, (math.inf,) * 2)))) / beam.length)
        arcs, line = given.axes[beam.name]
        apart = exact.shape(beam.name, arcs).position - line
        shape.append(float(np.hypot(*apart.T).max()) / beam.length)
    return Distance(
        force=_max(force), arc_position=_max(arc), reaction=_max(reaction), tip=_max(tip), shape=_max(shape),
        place=_max([0.0, *_misplaced(scene, given)]),
    )  # fmt: skip


def _beyond(off: float, size: float, last: float) -> float:
    """Difference over the size; zero where it is round-off of the models: `last` at most, and `UNRESOLVED` of the size."""
    return 0.0 if off <= min(last, UNRESOLVED * size) else _size(off / size)


def _max(values: list[float]) -> float:
    """Largest value; not a number counts as infinite."""
    return max(map(_size, values))


def least_force(scene: Scene) -> float:
    """Smallest EI/L^2 of the beams."""
    return min(beam.EI / beam.length**2 for beam in scene.beams)


def scales(scene: Scene, exact: Equilibrium) -> tuple[float, float]:
    """Return the largest force and the largest moment, forces times the longest beam's length where no moment is larger."""
    t = exact.load_parameter
    forces = [float(np.hypot(*item.force)) for item in exact.contacts.values()]
    forces += [float(np.hypot(*held[:2])) for held in exact.reactions.values()]
    forces += [t * math.hypot(*load.force) for load in scene.loads]
    moments = [abs(float(held[2])) for held in exact.reactions.values()]
    moments += [abs(t * load.moment) for load in scene.loads]
    length = max(beam.length for beam in scene.beams)
    size = max(LEAST * least_force(scene), *forces, *(value / length for value in moments), 0.0)
    return size, max([size * length * LEAST, *moments]) if max(
        moments, default=0.0
    ) > 1e-3 * size * length else size * length


def _misplaced(scene: Scene, given: Given) -> list[float]:
    found = []
    for spec in scene.contacts:
        if spec.pair not in given.arcs:
            continue
        beam = scene.beam(spec.beam)
        arcs, line = given.axes[spec.beam]
        place, cut = _on(arcs, line, given.arcs[spec.pair])
        apart = float(np.hypot(*(place - node_place(scene, given, spec.node))))
        found.append(max(0.0, abs(apart - scene.offset(spec)) - cut) / beam.length)
    for support in scene.all_supports:
        here = np.array(scene.place(support.node))
        end = _end(given, support.node) - here
        for component in range(2):
            motion = support.motion[component]
            if motion is not None:
                found.append(
                    abs(float(end[component]) - given.load_parameter * motion)
                    / scene.beam(support.beam).length
                )
    return found


def node_place(scene: Scene, given: Given, node: str) -> Array:
    """Position of a contact's node: the pin's, or that of a beam's end as the answer has it."""
    if "." in node:
        return _end(given, node)
    return np.array(scene.pin(node).position(given.load_parameter))


def _end(given: Given, node: str) -> Array:
    beam, end = node.split(".")
    return np.asarray(given.axes[beam][1][0 if end == "start" else -1])


def _on(arcs: Array, line: Array, at: float) -> tuple[Array, float]:
    """Place on a stated axis, and what its chords may cut off there: the corner, if the axis turns at once within the chord."""
    k = int(np.clip(np.searchsorted(arcs, at) - 1, 0, len(arcs) - 2))
    part = (at - arcs[k]) / (arcs[k + 1] - arcs[k])
    first, last = max(k - 1, 0), min(k + 2, len(arcs) - 1)
    way = line[k + 1] - line[k]
    before, behind = (
        line[k] - line[first] if first < k else way,
        line[last] - line[k + 1] if last > k + 1 else way,
    )
    turn = min(max(_angle(before, way), _angle(way, behind)), _SHARPEST)
    cut = 0.5 * float(np.hypot(*way)) * math.tan(turn)
    return (1.0 - part) * line[k] + part * line[k + 1], cut


def _angle(a: Array, b: Array) -> float:
    return abs(math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]))
