"""A beam as a rod: its undeformed axis, its stiffnesses along the axis, the resultant of the dead load on it, and its face.

The undeformed axis is a straight line, or an arc that turns left by `turn`. At the arc position s it has the angle ``beta(s) = beta(0) +
kappa0 s`` from the x axis, ``kappa0 = turn/length``. The rotation theta of a section is measured from its undeformed direction, so that
the curvature is ``kappa0 + theta'`` and the moment ``EI theta'``. A dead load q per undeformed length gives the force ``c - W(s)``, with
``W' = q``, ``W(0) = 0`` and c constant between stations.

The face is the envelope of circles about the points of the axis. Their radius is h/2 where the height h is constant, and ``h/2 /
sqrt(1 + (h'/2)^2)`` where it tapers, so that the face of an undeformed straight beam is at h/2 from the axis. A round pin of radius R
touches with its centre R further from the axis.
"""

import math
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyint, polymul, polyval

from comparisons.answer import Array
from comparisons.scene import BeamSpec, ContactSpec, Scene

_TERMS = 5
"""Number of coefficients of a polynomial: a tapered width times the cube of a tapered height has most."""


def units_of(scene: Scene) -> tuple[float, float]:
    """Return the units of length and force: the longest beam's length, and the largest EI over its square."""
    length = max(beam.length for beam in scene.beams)
    return length, max(beam.EI for beam in scene.beams) / length**2


def value(table: Any, s: Any) -> Any:
    """Polynomials (k, ...) at arc positions by Horner's rule; constants stay as they are, so that a uniform rod costs nothing."""
    found = table[-1]
    for row in table[-2::-1]:
        found = row + found * s
    return found


class Strained(NamedTuple):
    """EI, 1/EA, 1/GA, N, Q, force vector n (2, ...) and `way`, ``r'`` minus the undeformed tangent (2, ...), at points of a rod."""

    EI: Any
    stretch: Any
    shear: Any
    N: Any
    Q: Any
    n: Any
    way: Any


class Piece(NamedTuple):
    """A piece of a rod with a polynomial load, shape (1,), or an array (...) of pieces, in the units of `units_of`.

    Arc positions and rotations are arrays that broadcast against the pieces, and may be complex.
    """

    #: Coefficients (5, 5, ...) of EA, GA, EI, W_x and W_y as polynomials in the arc position, ascending.
    coefficients: Array
    curvature: Array
    start_angle: Array  #: Angle of the undeformed axis at the start of the rod.

    def angle(self, s: Any) -> Any:
        """Angle beta of the undeformed axis."""
        return self.curvature * s + self.start_angle

    def between(self, a: Any, b: Any) -> Array:
        """Vector (2, ...) between two points of the undeformed axis."""
        angle = self.angle((a + b) / 2.0)
        chord = (b - a) * np.sinc(self.curvature * (b - a) / (2.0 * math.pi))
        return np.array([chord * np.cos(angle), chord * np.sin(angle)])

    def strained(self, c: Any, s: Any, theta: Any) -> Strained:
        """Return the forces, and ``r' = (1 + N/EA) d1 + (Q/GA) d2`` minus the undeformed tangent, without cancellation."""
        EA, GA, EI, *W = value(self.coefficients, s)
        stretch, shear, n, half = 1.0 / EA, 1.0 / GA, c - W, theta / 2.0
        angle, chord = theta + self.angle(s), 2.0 * np.sin(half)
        x, y = np.cos(angle), np.sin(angle)
        N, Q = n[0] * x + n[1] * y, n[1] * x - n[0] * y
        along, across = stretch * N, shear * Q
        way = np.array([
            along * x - across * y - chord * np.sin(angle - half), along * y + across * x + chord * np.cos(angle - half)
        ])  # fmt: skip
        return Strained(EI, stretch, shear, N, Q, n, way)

    def tangent(self, c: Any, s: Any, theta: Any) -> Any:
        """Return ``r'`` (2, ...)."""
        return self.strained(c, s, theta).way + np.array([np.cos(self.angle(s)), np.sin(self.angle(s))])


def trimmed(table: Array) -> Array:
    """Coefficients (k, 5, ...) without the highest powers, if these are zero."""
    return table[: 1 + np.flatnonzero(np.any(table, axis=(1, 2)))[-1]]


def rod_of(scene: Scene, beam: BeamSpec, t: float) -> tuple[list[float], list[Piece]]:
    """Return a beam as pieces, and the arc positions of their ends: the beam's ends, ends of line loads, and point loads inside."""
    length, force = units_of(scene)
    extent = beam.length / length
    width, height = (_linear(given, extent) for given in (beam.width, beam.height))
    area: Any = np.ones(1)
    second = area
    if beam.tapers:
        area, second = polymul(width, height), polymul(polymul(width, height), polymul(height, height))
    stiffness, sizes = (
        np.zeros((_TERMS, 3)),
        np.array(beam.stiffness(0.0)) / (force, force, force * length**2),
    )
    for column, size, shape in zip(stiffness.T, sizes, (area, area, second), strict=True):
        column[: len(shape)] = size * shape / shape[0]
    loads = [item for item in scene.load_histories if item.load.beam == beam.name]
    densities = [
        (item.load.span[0] * extent, item.load.span[1] * extent, np.array([item.at(t)[:2]]) * length / force)
        for item in loads
        if item.load.force_per_length is not None
    ]
    if beam.density:
        weight = beam.density * beam.section(0.0)[0] * length / force * area / area[0]
        densities.append((0.0, extent, np.outer(weight, scene.gravity_at(t))))
    breaks = {item.load.at * extent for item in loads if item.load.at is not None}
    places = sorted({0.0, extent, *breaks, *(s for a, b, _ in densities for s in (a, b))})
    axis = np.array([beam.turn / extent]), np.array([math.atan2(*beam.direction[::-1]) - beam.turn / 2.0])
    before: Any = np.zeros(2)
    pieces = []
    for a, b in pairwise(places):
        q = np.zeros((_TERMS - 1, 2))
        for first, last, density in densities:
            if first <= a and b <= last:
                q[: len(density)] += density
        W = polyint(q, lbnd=a)
        W[0] += before
        before = polyval(b, W)
        pieces.append(Piece(np.hstack([stiffness, W])[..., None], *axis))
    return places, pieces


def _linear(given: float | tuple[float, float] | None, extent: float) -> Array:
    """Coefficients of a dimension along the beam."""
    first, last = np.broadcast_to(given or 0.0, 2)
    return np.array([first, (last - first) / extent])


class Face(NamedTuple):
    """Place of a node, or of a round pin's centre, that touches a beam: at the distance `reach` from the axis."""

    left: float  #: 1 on the left of the beam, -1 on its right.
    start: float  #: Distance at the start of the beam.
    slope: float  #: Derivative of the distance by the arc position.
    radius: float  #: Radius of the pin; 0 for a point.

    def reach(self, arc: Any) -> Any:
        """Distance at arc positions."""
        return self.start + self.slope * arc

    def lever(self, arc: Any) -> Any:
        """Distance of the face from the axis at arc positions, positive on the right of the beam."""
        return self.left * (self.radius - self.reach(arc))

    @property
    def tilt(self) -> float:
        """Sine of the angle of the face from the axis."""
        return self.left * self.slope


def face_of(scene: Scene, spec: ContactSpec, unit: float = 1.0) -> Face:
    """Return where the node of a pair touches, in units of length."""
    beam, left, radius = scene.beam(spec.beam), 1.0 if spec.side == "left" else -1.0, scene.radius(spec)
    first, last = (scene.offset(spec, part) - radius for part in (0.0, 1.0))
    steep = (last - first) / beam.length
    slope = steep / math.hypot(1.0, steep)
    return Face(left, (radius + first * math.sqrt(1.0 - slope**2)) / unit, slope, radius / unit)


def axis_at_rest(beam: BeamSpec, arcs: Array) -> Array:
    """Undeformed positions (m, 2) of points of a beam's axis."""
    return np.array([beam.place(part) for part in (arcs / beam.length).tolist()])


def cross(a: Array, b: Array) -> Any:
    """Cross product of plane vectors (..., 2)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def angle(a: Array, b: Array) -> float:
    """Angle between two vectors."""
    return abs(math.atan2(cross(a, b), a @ b))


def largest(values: Any) -> float:
    """Return the largest absolute value of an array, zero without values."""
    return float(np.abs(values).max(initial=0.0))
