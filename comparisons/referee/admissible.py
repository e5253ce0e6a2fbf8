"""Admissibility of an equilibrium under unilateral contact: contact forces push, and no node or round pin is inside a beam."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.rod import face_slope, touching_distance
from comparisons.referee.start import pull_allowed
from comparisons.referee.state import Equilibrium
from comparisons.scene import ContactSpec, Scene

Array = NDArray[np.float64]

INSIDE = 1e-9
"""Largest accepted penetration over the beam's length, for the round-off of the models' contacts."""
_POINTS = 201
_BESIDE = 1e-12
"""Relative distance of two arc positions on either side of a contact."""


def inadmissible(scene: Scene, exact: Equilibrium) -> Iterator[str]:
    """Yield a sentence for every violation of unilateral contact; `comparisons.referee.rubbing` judges friction."""
    for spec in scene.contacts:
        beam = scene.beam(spec.beam)
        contact = exact.contacts.get(spec.pair)
        if contact is not None:
            if contact.push < -pull_allowed(beam):
                yield f"the contact force of {spec.pair} pulls, {contact.push:.3g}"
            if not 0.0 <= contact.arc_position <= beam.length:
                yield f"{spec.pair} is closed beyond the end of its beam"
        gap, arc = least_gap(scene, exact, spec)
        if gap < -INSIDE * beam.length:
            what = "the round pin" if scene.radius(spec) else "the node"
            yield f"{what} of {spec.pair} is {-gap / beam.length:.2g} L inside the beam at arc position {arc:.4g}"
        for end, room in _rooms(scene, exact, spec):
            if room < -INSIDE * beam.length:
                yield f"the round pin of {spec.pair} overlaps the {end} of the beam by {-room / beam.length:.2g} L"


def _rooms(scene: Scene, exact: Equilibrium, spec: ContactSpec) -> Iterator[tuple[str, float]]:
    """Distance of a round pin beyond an end from the segment across that end, for the ends that no other beam shares."""
    beam, radius, node = scene.beam(spec.beam), scene.radius(spec), exact.place(spec.node)
    for end, arc, out in (("start", 0.0, -1.0), ("end", beam.length, 1.0)):
        half = beam.height_at(arc / beam.length) / 2.0 if spec.surface == "face" else 0.0
        if any(
            f"{spec.beam}.{end}" in item.joint and len(item.joint) > 1
            for item in exact.solution.layout.stations
        ):
            continue
        there = exact.shape(spec.beam, np.array([arc]))
        (x, y), (tx, ty) = node - there.position[0], out * there.tangent[0] / np.hypot(*there.tangent[0])
        along, across = x * tx + y * ty, abs(y * tx - x * ty)
        if along > 0.0:
            yield end, math.hypot(along, max(across - half, 0.0)) - radius


def least_gap(scene: Scene, exact: Equilibrium, spec: ContactSpec) -> tuple[float, float]:
    """Return the smallest gap of a pair, if it is closed on its side of the beam, and its arc position; infinite without a closest point.

    Gaps are evaluated at the local minima of the distance between node and axis, less the radius of the face's circles. At a contact the axis has a kink of the angle 2 a by
    shear, and the contact force is normal to the mean of the two directions. Near it, at the distance d, a round pin penetrates the
    beam by ``a d - (1/offset - curvature) d^2/2``. Only penetration beyond ``a d``, which means line contact, counts.
    """
    beam, node = scene.beam(spec.beam), exact.place(spec.node)
    offset, side = touching_distance(scene, spec, 0.0), 1.0 if spec.side == "left" else -1.0
    if offset == 0.0:
        return np.inf, np.nan
    steep = face_slope(scene, spec)
    arcs, contact, half = np.linspace(0.0, beam.length, _POINTS), exact.contacts.get(spec.pair), 0.0
    if contact is not None:
        arcs = np.sort(np.append(arcs, contact.arc_position))
        half = _kink(exact, spec.beam, contact.arc_position) / 2.0
    away = np.hypot(*(exact.shape(spec.beam, arcs).position - node).T) - steep * arcs
    least = np.flatnonzero((away[1:-1] <= away[:-2]) & (away[1:-1] <= away[2:])) + 1
    best, place = np.inf, np.nan
    for k in least[away[least] < offset + 2.0 * beam.length / _POINTS]:
        arc = _foot(exact, spec.beam, node, steep, (float(arcs[k - 1]), float(arcs[k + 1])))
        there = exact.shape(spec.beam, np.array([arc]))
        (out_x, out_y), (x, y) = node - there.position[0], there.tangent[0]
        gap = math.hypot(out_x, out_y) - offset - steep * arc
        if contact is not None:
            gap += half * abs(arc - contact.arc_position)
        if (contact is None or side * (x * out_y - y * out_x) > 0.0) and gap < best:
            best, place = gap, arc
    return best, place


def _kink(exact: Equilibrium, beam: str, arc: float) -> float:
    """Angle between the directions of the axis before and behind a contact."""
    a, b = exact.shape(beam, arc * np.array([1.0 - _BESIDE, 1.0 + _BESIDE])).tangent
    return abs(math.atan2(a[0] * b[1] - a[1] * b[0], a @ b))


def _foot(exact: Equilibrium, beam: str, node: Array, steep: float, between: tuple[float, float]) -> float:
    """Arc position of the least gap between two arc positions, to 1e-6 of their distance."""
    low, high = between
    for _ in range(8):
        arcs = np.linspace(low, high, 11)
        away = np.hypot(*(exact.shape(beam, arcs).position - node).T) - steep * arcs
        k = int(np.argmin(away))
        low, high = float(arcs[max(k - 1, 0)]), float(arcs[min(k + 1, 10)])
    return (low + high) / 2.0
