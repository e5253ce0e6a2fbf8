"""A beam as a rod: its undeformed axis, its stiffnesses along the axis, the resultant of the dead load on it, and its face.

The undeformed axis is a straight line, or an arc that turns left by `turn`. At the arc position s it has the angle ``beta(s) = kappa0 s -
turn/2`` from the chord, ``kappa0 = turn/length``. The rotation theta of a section is measured from its undeformed direction, so that the
curvature is ``kappa0 + theta'`` and the moment ``EI theta'``. A dead load q per undeformed length gives the force ``c - W(s)`` in the frame
of the chord, with ``W' = q``, ``W(0) = 0`` and c constant between stations.

The face is the envelope of circles about the points of the axis. Their radius is h/2 where the height h is constant, and ``h/2 /
sqrt(1 + (h'/2)^2)`` where it tapers, so that the face of an undeformed straight beam is at h/2 from the axis. A round pin of radius R
touches where its centre has the distance R more.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyint, polymul, polyval
from numpy.typing import NDArray

from comparisons.scene import BeamSpec, ContactSpec, Scene

Array = NDArray[np.float64]

Units = tuple[float, float]
"""Units of length and force."""


def units_of(scene: Scene) -> Units:
    """Return the longest beam's length, and the largest EI over its square."""
    length = max(beam.length for beam in scene.beams)
    return length, max(beam.EI for beam in scene.beams) / length**2


class Flexibility(NamedTuple):
    """EI, 1/EA and 1/GA at arc positions."""

    EI: Any
    stretch: Any
    shear: Any


@dataclass(frozen=True, kw_only=True, eq=False)
class Rod:
    """A beam in the units of a layout, in the frame of the chord; arc positions may be complex."""

    length: float
    turn: float
    axes: Array
    """Unit vectors along the chord and to its left, as columns."""
    stiffness: tuple[Array, ...]
    """Coefficients of EI, EA and GA as polynomials in the arc position, ascending."""
    greatest: Flexibility
    """Of a taper the smallest EI and the largest 1/EA and 1/GA."""
    load: Array
    """Coefficients (pieces, k, 2) of W on every piece."""
    breaks: Array
    """Arc positions (pieces + 1,) between pieces; inner ones are ends of loads and places of forces inside the beam."""

    @cached_property
    def loaded(self) -> bool:
        """Whether a load acts along the beam."""
        return bool(np.any(self.load))

    @cached_property
    def tapers(self) -> bool:
        """Whether the section changes along the beam."""
        return any(len(item) > 1 for item in self.stiffness)

    @cached_property
    def uniform(self) -> bool:
        """Whether the beam is straight, of one section, and without a load along it."""
        return self.turn == 0.0 and not self.tapers and not self.loaded

    @cached_property
    def curvature(self) -> float:
        """Curvature kappa0 of the undeformed axis."""
        return self.turn / self.length

    def angle(self, s: Any) -> Any:
        """Angle beta of the undeformed axis from the chord."""
        return self.curvature * s - self.turn / 2.0

    def flexibility(self, s: Any) -> Flexibility:
        """Return EI, 1/EA and 1/GA at arc positions."""
        if not self.tapers:
            return self.greatest
        EI, EA, GA = (polyval(s, item) for item in self.stiffness)
        return Flexibility(EI, 1.0 / EA, 1.0 / GA)

    def between(self, a: Any, b: Any) -> Array:
        """Way (..., 2) of the undeformed axis from one arc position to another."""
        if self.turn == 0.0:
            return np.stack([b - a, 0.0 * b], axis=-1)
        half, angle = self.curvature * (b - a) / 2.0, (self.angle(a) + self.angle(b)) / 2.0
        chord = (b - a) * np.sinc(half / math.pi)
        return np.stack([chord * np.cos(angle), chord * np.sin(angle)], axis=-1)

    def direction(self, s: Any) -> Array:
        """Unit tangent (..., 2) of the undeformed axis."""
        return np.stack([np.cos(self.angle(s)), np.sin(self.angle(s))], axis=-1)

    def force(self, piece: int, c: Any, s: Any) -> Any:
        """Force ``c - W`` (2, ...) on a piece at arc positions."""
        return [c[k] - polyval(s, self.load[piece, :, k]) for k in range(2)] if self.loaded else c

    def tangent(self, piece: int, c: Any, s: Any, theta: Any) -> Any:
        """Return ``r' = (1 + N/EA) d1 + (Q/GA) d2`` (2, ...) in the axes of the scene."""
        _, stretch, shear = self.flexibility(s)
        force, angle = self.force(piece, c, s), theta + self.angle(s)
        cos, sin = np.cos(angle), np.sin(angle)
        along = 1.0 + stretch * (force[0] * cos + force[1] * sin)
        across = shear * (force[1] * cos - force[0] * sin)
        return self.axes @ np.array([along * cos - across * sin, along * sin + across * cos])


def rod_of(scene: Scene, beam: BeamSpec, t: float, units: Units) -> Rod:
    """Return a beam as a rod with the load along it at load parameter t."""
    length, force = units
    x, y = beam.direction
    axes = np.array([[x, -y], [y, x]])
    extent = beam.length / length
    width, height = (_linear(given, extent) for given in (beam.width, beam.height))
    EA, GA, EI = beam.stiffness(0.0)
    stiffness = tuple(np.array([item]) for item in (EI / (force * length**2), EA / force, GA / force))
    area = polymul(width, height) if beam.tapers else np.array([beam.section(0.0)[0]])
    if beam.tapers:
        shapes = (polymul(polymul(area, height), height), area, area)
        stiffness = tuple(item * shape / shape[0] for item, shape in zip(stiffness, shapes, strict=True))
    least = [min(item[0], float(polyval(extent, item))) for item in stiffness]
    spans = [(item.load.span, item) for item in scene.load_histories if item.load.beam == beam.name]
    densities = [
        (a * extent, b * extent, (axes.T @ np.array(item.at(t)[:2]) * length / force)[None, :])
        for (a, b), item in spans
        if item.load.force_per_length is not None
    ]
    if beam.density:
        gravity = axes.T @ np.array(scene.gravity_at(t))
        densities.append((0.0, extent, np.outer(beam.density * area * length / force, gravity)))
    places = {item.load.at * extent for _, item in spans if item.load.at is not None}
    breaks, W = _resultants(extent, densities, places)
    return Rod(
        length=extent, turn=beam.turn, axes=axes, stiffness=stiffness,
        greatest=Flexibility(least[0], 1.0 / least[1], 1.0 / least[2]), load=W, breaks=breaks,
    )  # fmt: skip


def _linear(given: float | tuple[float, float] | None, extent: float) -> Array:
    """Coefficients of a dimension along the beam."""
    first, last = given if isinstance(given, tuple) else (given or 0.0, given or 0.0)
    return np.array([first, (last - first) / extent] if first != last else [first])


def _resultants(
    length: float, densities: list[tuple[float, float, Array]], breaks: set[float]
) -> tuple[Array, Array]:
    """Return the arc positions between which loads (from, to, coefficients (k, 2) of q) are one polynomial, and W's coefficients there."""
    places = np.array(sorted({0.0, length, *breaks, *(s for a, b, _ in densities for s in (a, b))}))
    if not densities:
        return places, np.zeros((len(places) - 1, 1, 2))
    size = max(len(q) for _, _, q in densities)
    table, before = np.zeros((len(places) - 1, size + 1, 2)), np.zeros(2)
    for W, a, b in zip(table, places[:-1], places[1:], strict=True):
        q = np.zeros((size, 2))
        for first, last, density in densities:
            if first <= a and b <= last:
                q[: len(density)] += density
        W[:] = polyint(q, lbnd=a)
        W[0] += before
        before = polyval(b, W)
    return places, table


class Face(NamedTuple):
    """Where a node, or the centre of a round pin, touches a beam: at the distance `reach` from a point of the axis."""

    left: float
    """1 on the left of the beam, -1 on its right."""
    start: float
    """Distance at the start of the beam."""
    slope: float
    """Derivative of the distance by the arc position."""
    radius: float
    """Radius of the pin; 0 for a point."""

    def reach(self, arc: Any) -> Any:
        """Distance at arc positions."""
        return self.start + self.slope * arc


def left(spec: ContactSpec) -> float:
    """1 for a node on the left of the beam, -1 on its right."""
    return 1.0 if spec.side == "left" else -1.0


def face_of(scene: Scene, spec: ContactSpec) -> Face:
    """Return where the node of a pair touches."""
    beam, radius = scene.beam(spec.beam), scene.radius(spec)
    steep = (beam.height_at(1.0) - beam.height_at(0.0)) / (2.0 * beam.length)
    if spec.surface == "axis" or not steep:
        return Face(left(spec), scene.offset(spec), 0.0, radius)
    slope = steep / math.hypot(1.0, steep)
    return Face(left(spec), radius + beam.height_at(0.0) / 2.0 * math.sqrt(1.0 - slope**2), slope, radius)


def axis_at_rest(beam: BeamSpec, arcs: Array) -> Array:
    """Undeformed positions (m, 2) of points of a beam's axis, exactly in a line where it is straight."""
    if beam.turn:
        return np.array([beam.place(part) for part in (arcs / beam.length).tolist()])
    return np.asarray(np.array(beam.start) + np.outer(arcs, beam.direction))


def cross(a: Array, b: Array) -> Any:
    """Cross product of plane vectors (..., 2)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def angle(a: Array, b: Array) -> float:
    """Angle between two vectors."""
    return abs(math.atan2(cross(a, b), a @ b))


def largest(values: Any) -> float:
    """Return the largest absolute value of an array, zero without values."""
    return float(np.abs(values).max(initial=0.0))
