"""Differences between an answer and the exact equilibrium near it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.faces import touching_distance
from comparisons.referee.loads import dead_loads
from comparisons.referee.start import AnswerState
from comparisons.referee.state import Equilibrium
from comparisons.scene import BeamSpec, Scene

Array = NDArray[np.float64]

LEAST = 1e-4
"""Smallest force scale of relative differences, over EI/L^2. Such a force bends a beam by 3e-5 L."""
LAST_PLACES, UNRESOLVED = 8.0 * float(np.finfo(float).eps), 1e-4
"""Round-off of a force, over EA, and its bound over the largest force.

A model computes an axial force from a stretch, and positions resolve a stretch to a few units in the last place.
"""

COMPARED = ("force", "arc_position", "reaction", "tip", "shape")
"""The differences that are held against the allowance, by their names; `place` has its own limit."""
_SHARPEST = 1.4
"""Largest angle between neighbouring chords in the bound of the chords' error [rad]; beyond it the tangent grows without limit."""


@dataclass(frozen=True, kw_only=True)
class Distance:
    """Largest differences between an answer and the exact equilibrium; infinite for missing or unknown items.

    Attributes
    ----------
    force : float
        Difference of a contact force as a vector, over the largest contact force.
    arc_position : float
        Difference of an arc position, over the beam's length.
    reaction : float
        Difference of a reaction force or moment, over the largest force or moment of supports, contacts and loads.
    tip : float
        Distance of a beam's free or less restrained end, over the beam's length.
    shape : float
        Distance of an axis, over the beam's length.
    place : float
        Violation of the constraints by the answer itself: distance of its axis from the touching points of the contacts and from the
        prescribed positions of the supports, over the beam's length, less the error of the chords between the points of the axis.
    where : dict of str
        The pair, supported end or beam that has the largest difference, by the names above; none where there is nothing to compare.
    """

    force: float
    arc_position: float
    reaction: float
    tip: float
    shape: float
    place: float
    where: Mapping[str, str] = field(default_factory=dict, repr=False)

    @property
    def largest(self) -> tuple[str, float]:
        """Name and size of the largest difference without `place`, which has its own limit."""
        name = max(COMPARED, key=lambda name: _size(getattr(self, name)))
        return name.replace("_", " "), float(getattr(self, name))

    def line(self) -> str:
        """Return the largest difference in words, as ``force off by 0.2 (pin->strip)``."""
        name, size = self.largest
        return f"{name} off by {size:.2g}{self.at(name.replace(' ', '_'))}"

    def at(self, name: str) -> str:
        """Return where a difference is largest in brackets, as `` (pin->strip)``; nothing where there is nothing to compare."""
        return f" ({self.where[name]})" if name in self.where else ""

    def sizes(self) -> dict[str, float]:
        """Return the differences by name."""
        return {name: getattr(self, name) for name in (*COMPARED, "place")}


def _size(value: float) -> float:
    """Return a value, infinite for nan."""
    return math.inf if math.isnan(value) else value


def distance(
    scene: Scene, answer: AnswerState, exact: Equilibrium, largest: tuple[float, float] = (0.0, 0.0)
) -> Distance:
    """Return the differences between an answer and the exact equilibrium.

    Forces and moments are relative to the largest at this load parameter, or to `largest` if that is larger.
    """
    size, moment = map(max, scales(scene, exact), largest)
    found: dict[str, dict[str, float]] = {name: {} for name in COMPARED}
    largest_contact = max(
        [LEAST * least_force(scene), *(float(np.hypot(*item.force)) for item in exact.contacts.values())]
    )
    last = LAST_PLACES * max(beam.EA for beam in scene.beams)
    length = max(beam.length for beam in scene.beams)
    for pair, contact in exact.contacts.items():
        touched = next(item.beam for item in scene.contacts if item.pair == pair)
        off = float(np.hypot(*(contact.force - answer.forces[pair])))
        found["force"][pair] = _beyond(off, largest_contact, last)
        apart = abs(contact.arc_position - answer.arcs[pair])
        found["arc_position"][pair] = apart / scene.beam(touched).length
    found["reaction"] = dict.fromkeys(answer.reactions.keys() - exact.reactions.keys(), math.inf)
    for end, held in exact.reactions.items():
        x, y, turn = held - np.array(answer.reactions.get(end, (math.nan,) * 3))
        found["reaction"][f"force of {end}"] = _beyond(float(np.hypot(x, y)), size, last)
        found["reaction"][f"moment of {end}"] = _beyond(abs(float(turn)), moment, last * length)
    for beam in scene.beams:
        there = exact.ends[f"{beam.name}.{scene.tip(beam.name)}"]
        off = float(np.hypot(*(there - answer.tips.get(beam.name, (math.inf,) * 2))))
        found["tip"][beam.name] = off / beam.length
        arcs, line = answer.axes[beam.name]
        between = exact.shape(beam.name, arcs).position - line
        found["shape"][beam.name] = float(np.hypot(*between.T).max()) / beam.length
    found["place"] = _misplaced(scene, answer)
    where = {name: max(sizes, key=lambda key: _size(sizes[key])) for name, sizes in found.items() if sizes}
    sizes = {name: _size(found[name][where[name]]) if name in where else 0.0 for name in found}
    return Distance(**sizes, where=where)


def _beyond(off: float, size: float, last: float) -> float:
    """Relative difference `off / size`; zero if it is at most the round-off `last` and `UNRESOLVED` of the size."""
    return 0.0 if off <= min(last, UNRESOLVED * size) else _size(off / size)


def bending_force(beam: BeamSpec) -> float:
    """EI/L^2 of a beam."""
    return beam.EI / beam.length**2


def least_force(scene: Scene) -> float:
    """Smallest EI/L^2 of the beams."""
    return min(map(bending_force, scene.beams))


def scales(scene: Scene, exact: Equilibrium) -> tuple[float, float]:
    """Return the largest force and the largest moment; without a considerable moment the force times the longest beam."""
    t = exact.load_parameter
    acting = list(dead_loads(scene, t))
    forces = [float(np.hypot(*item.force)) for item in exact.contacts.values()]
    forces += [float(np.hypot(*held[:2])) for held in exact.reactions.values()]
    forces += [math.hypot(*load.force) for load in acting]
    moments = [abs(float(held[2])) for held in exact.reactions.values()]
    moments += [abs(load.moment) for load in acting]
    length = max(beam.length for beam in scene.beams)
    size = max(LEAST * least_force(scene), *forces, *(value / length for value in moments), 0.0)
    considerable = max(moments, default=0.0) > 1e-3 * size * length
    return size, max(size * length * LEAST, *moments) if considerable else size * length


def _misplaced(scene: Scene, answer: AnswerState) -> dict[str, float]:
    """Violations of contact and support constraints by the answer's axes, over the beams' lengths, by pair and supported end."""
    distances: dict[str, float] = {}
    for spec in scene.contacts:
        if spec.pair not in answer.arcs:
            continue
        beam = scene.beam(spec.beam)
        arcs, line = answer.axes[spec.beam]
        place, cut = _on_axis(arcs, line, answer.arcs[spec.pair])
        apart = float(np.hypot(*(place - node_place(scene, answer, spec.node))))
        distances[spec.pair] = (
            max(0.0, abs(apart - touching_distance(scene, spec, answer.arcs[spec.pair])) - cut) / beam.length
        )
    for support in scene.all_supports:
        here = np.array(scene.place(support.node))
        way = (_end(answer, support.node) - here).tolist()
        off = [
            abs(x - motion) / scene.beam(support.beam).length
            for x, motion in zip(
                way, scene.prescribed_motions[support.node].at(answer.load_parameter)[:2], strict=True
            )
            if motion is not None
        ]
        if off:
            distances[support.node] = max(map(_size, off))
    return distances


def node_place(scene: Scene, answer: AnswerState, node: str) -> Array:
    """Position of a contact's node, which is a pin or the end of a beam's axis in the answer."""
    if "." in node:
        return _end(answer, node)
    return np.array(scene.pin(node).position(answer.load_parameter))


def _end(answer: AnswerState, node: str) -> Array:
    """Position of a beam's end in the answer."""
    beam, end = node.split(".")
    return np.asarray(answer.axes[beam][1][0 if end == "start" else -1])


def _on_axis(arcs: Array, line: Array, arc: float) -> tuple[Array, float]:
    """Point of the answer's axis at an arc position, and a bound of the chord's distance from a smooth axis.

    The bound is the height of the triangle between the chord and its neighbours' directions.
    """
    k = int(np.clip(np.searchsorted(arcs, arc) - 1, 0, len(arcs) - 2))
    part = (arc - arcs[k]) / (arcs[k + 1] - arcs[k])
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
    """Angle between two vectors."""
    return abs(math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]))
