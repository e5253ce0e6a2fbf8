"""The Reissner rod between two contacts, by Gauss collocation.

The internal force is ``n(s) = n - P(s)``: n is constant between two contacts, and ``P' = q`` is the load per
length. With phi the angle of the section's normal, ``N, Q = n(s) . d_1, n(s) . d_2`` along and across it, the
flexibilities ``e, u, b = 1/EA, 1/GA, 1/EI``, the natural curvature k0, and ``g = e - u``::

    phi' = b m + k0,   m' = f = -Q (1 + g N),   r' = (1 + e N) d_1 + u Q d_2

The inner unknowns are the angles at p Gauss nodes, with one equation each. The values at the ends are
superconvergent, of order 2p. No equation is divided by the length h, which may be zero or negative.

The inner equations are eliminated while some data of the ends are held. The choice of these data decides the
conditioning:

- With the angle and the moment at the start, the inner problem is an initial value problem. It is regular under compression, but
  exponentially ill-conditioned under strong tension.
- With both angles it is a boundary value problem. It is regular under tension, but singular at ``-N h^2/EI = pi^2``.
- With ``m_i h/EI + (phi_j - phi_i)``, as here, the determinant for a straight rod with Q = 0 is ``(1 + sinc k)/2``,
  ``k^2 = -N (1 + g N) h^2/EI``. The inner problem is regular at every axial force.

So half of the end residual is held: ``c/2`` times it is added to the equation at the node c.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tsm.elements.collocation import collocation
from tsm.elements.properties import Array, cosine, sine

INPUTS = 9
"""Number of inputs: angle and moment at the start, angle at the end, force x and y, length, the constant 1
for the inner residual; where a course varies, then the arc position of the start and the load parameter."""
ARC, LOAD = 7, 8
"""The last two inputs."""


class Flexibility(NamedTuple):
    """Flexibilities of segments, each of shape (s, 1), or (s, p) at points where they vary."""

    stretch: Array  # stretch, shear, bend: 1/EA, 1/GA, 1/EI
    shear: Array
    bend: Array


class Course(NamedTuple):
    """What varies along segments, at the same points of each; shapes (s, p), or (2, s, p)."""

    flexibility: Flexibility  # 1/EA, 1/GA, 1/EI
    slope: Flexibility  # their derivatives in the arc position
    resultant: Array  # P, the resultant of the load from the start of the element; shape (2, s, p)
    load: Array  # q, the load per length; shape (2, s, p)
    resultant_rate: Array  # derivative of P in the load parameter; shape (2, s, p)


class Segments(NamedTuple):
    """Rods between two contacts, s of them."""

    flexibility: Flexibility
    force: Array  # internal force, on the section that looks to the end; shape (2, s, 1), or (2, s, p)
    length: Array  # undeformed length; shape (s, 1)
    angle: Array  # angles of the sections at the Gauss nodes, from the x axis; shape (s, p)
    constant: Array  # part n of the internal force; shape (2, s, 1)
    owner: Array  # elements of the segments, counted over the exact ones; shape (s,)
    begin: Array  # arc position of the start within the element; shape (s, 1)
    curvature: Any = 0.0  # natural curvature; shape (s, 1)
    course: Course | None = None  # what varies at the Gauss nodes; None if nothing does


class Field(NamedTuple):
    """Forces and tangent vectors of the rod at the Gauss nodes."""

    values: Array  # f and r' (x, y); shape (3, s, p)
    sums: Array  # their integrals over the unit interval: ``int v`` and ``int (1 - x) v``; shape (3, s, 2)
    c: Array  # c, s, N, q, turn, gq: cosine and sine, ``N``, ``-Q``, ``1 + g N``, ``-g Q``; shape (s, p)
    s: Array
    N: Array
    q: Array
    turn: Array
    gq: Array

    @property
    def slope(self) -> Array:
        """Derivative (s, p) of f by the angle."""
        slope: Array = self.N * self.turn - self.gq * self.q
        return slope


class Arrival(NamedTuple):
    """Residuals of segments."""

    end_residual: Array  # integrated angle at the end less the angle of the section there; shape (s,)
    inside: Array  # residual of the angles inside [rad]; shape (s, p)
    bent: Array  # ``twice @ f``, or the derivative of the angle where a course varies; shape (s, p)


class Condensed(NamedTuple):
    """Segments with their inner equations eliminated; i is the number of inputs, 7 or 9."""

    # derivatives of end residual, moment at the end, and vector from start to end, by the inputs; shape (s, 4, i)
    transfer: Array
    inner: Array  # derivatives of the angles inside by the inputs; shape (s, p, i)


def field(segments: Segments) -> Field:
    """Evaluate the rod's equations at the Gauss nodes."""
    c, s = np.cos(segments.angle), np.sin(segments.angle)
    nx, ny = segments.force
    stretch, shear, _ = segments.flexibility
    g = stretch - shear
    N, q = nx * c + ny * s, nx * s - ny * c
    turn, gq = 1 + g * N, g * q
    values = np.empty((3, *c.shape), dtype=N.dtype)
    values[0] = q * turn
    values[1] = c + stretch * nx - gq * s
    values[2] = s + stretch * ny + gq * c
    return Field(values, values @ collocation(c.shape[1]).ends, c, s, N, q, turn, gq)


def moments(segments: Segments, values_at_nodes: Field, moment: Array) -> Array:
    """Moments (s, p) at the Gauss nodes."""
    once = collocation(segments.angle.shape[1]).once
    at_nodes: Array = moment + segments.length * (values_at_nodes.values[0] @ once.T)
    return at_nodes


def arrival(segments: Segments, values_at_nodes: Field, start: Array, moment: Array, end: Array) -> Arrival:
    """Residuals with given angle and moment at the start and angle at the end, each of shape (s, 1)."""
    table, h, bend = collocation(segments.angle.shape[1]), segments.length, segments.flexibility.bend
    if segments.course is None:
        by_bend = h * bend
        rise, bent = by_bend * moment, values_at_nodes.values[0] @ table.twice.T
        inside = segments.angle - start - table.c * ((rise + end - start) / 2) - by_bend * h * bent
        end_residual = start + rise - end + by_bend * h * values_at_nodes.sums[0, :, 1:]
    else:
        bent = bend * moments(segments, values_at_nodes, moment) + segments.curvature
        inside = segments.angle - start - table.c * ((end - start) / 2) - h * (bent @ table.half.T)
        end_residual = start + h * (bent @ table.w)[:, None] - end
    return Arrival(end_residual[:, 0], inside, bent)


def condense(segments: Segments, values_at_nodes: Field, arrived: Arrival, moment: Array) -> Condensed:
    """Eliminate the angles inside."""
    table, h, at, course = (
        collocation(segments.angle.shape[1]),
        segments.length,
        values_at_nodes,
        segments.course,
    )
    stretch, shear, bend = segments.flexibility
    slope, gc = at.slope, (stretch - shear) * at.c
    # derivatives of r' by the angle (x, y) and, less what is constant, by the force (xx, xy)
    values = np.empty((4, *slope.shape), dtype=slope.dtype)
    np.subtract(-at.gq * at.c, at.turn * at.s, out=values[0])
    np.subtract(at.turn * at.c, at.gq * at.s, out=values[1])
    np.multiply(gc, at.c, out=values[2])
    np.multiply(gc, at.s, out=values[3])

    weights = np.empty((len(h), 4, slope.shape[1]), dtype=slope.dtype)
    scaled = h * table.w
    np.multiply(slope, scaled, out=weights[:, 1])
    np.multiply(values[0], scaled, out=weights[:, 2])
    np.multiply(values[1], scaled, out=weights[:, 3])
    if course is None:
        by_bend = h * bend
        by_square = by_bend * h
        np.multiply(by_square * slope, table.ends[:, 1], out=weights[:, 0])
        matrix = (-by_square * slope)[:, None, :] * table.twice
        right = np.zeros((*slope.shape, ARC), dtype=slope.dtype)
        bent = values[:2] @ table.twice.T * -by_square
        right[:, :, 3], right[:, :, 4] = bent
        right[:, :, 1] = by_bend * (table.c / 2)
        right[:, :, 5] = 2 * by_bend * arrived.bent + (bend * moment) * (table.c / 2)
        direct = _direct(segments, at, values @ table.ends, moment)
    else:
        weights[:, 0] = h * h * ((table.w * bend) @ table.once) * slope
        matrix = -(h * h)[:, :, None] * (table.half @ (bend[:, :, None] * table.once)) * slope[:, None, :]
        right, direct = _along(segments, course, at, arrived, values, moment)
    matrix.reshape(len(h), -1)[:, :: slope.shape[1] + 1] += 1
    right[:, :, 0] += 1 - table.c / 2
    right[:, :, 2] += table.c / 2
    right[:, :, 6] -= arrived.inside
    inner = np.linalg.solve(matrix, right)
    return Condensed(weights @ inner + direct, inner)


def _direct(segments: Segments, at: Field, sums: Array, moment: Array) -> Array:
    """Part of the transfer that does not pass through the angles inside, shape (s, 4, 7)."""
    stretch, shear, bend = (value[:, 0] for value in segments.flexibility)
    h = segments.length[:, 0]
    by_bend = h * bend
    total = sums[:, :, 0] * h
    direct = np.zeros((len(h), 4, ARC), dtype=sums.dtype)
    direct[:, 0, 0] = direct[:, 1, 1] = 1
    direct[:, 0, 2] = -1
    direct[:, 0, 1] = by_bend
    direct[:, 0, 3:5] = (sums[:2, :, 1] * (-h * by_bend)).T
    direct[:, 0, 5] = bend * moment[:, 0] + 2 * by_bend * at.sums[0, :, 1]
    direct[:, 1, 3:5] = -total[:2].T
    direct[:, 2, 3], direct[:, 3, 4] = h * shear + total[2], h * stretch - total[2]
    direct[:, 2, 4] = direct[:, 3, 3] = total[3]
    direct[:, 1:, 5] = at.sums[:, :, 0].T
    return direct


def _along(
    segments: Segments, course: Course, at: Field, arrived: Arrival, values: Array, moment: Array
) -> tuple[Array, Array]:
    """Right-hand sides (s, p, 9) and direct part (s, 4, 9) where a course varies."""
    table, h, (stretch, shear, bend) = (
        collocation(segments.angle.shape[1]),
        segments.length,
        segments.flexibility,
    )
    turned, xx, xy, yy = values[:2], shear + values[2], values[3], stretch - values[2]
    (e, u, b), (px, py), (tx, ty) = course.slope, course.load, course.resultant_rate
    # derivatives of f and r' at the nodes by the inputs, the angle held; f falls with n as r' does with the angle
    by = np.zeros((3, *at.N.shape, INPUTS), at.N.dtype)
    by[0, :, :, 3], by[0, :, :, 4] = -turned
    by[1, :, :, 3], by[1, :, :, 4], by[2, :, :, 3], by[2, :, :, 4] = xx, xy, xy, yy
    by[0, :, :, ARC] = at.q * (e - u) * at.N + turned[0] * px + turned[1] * py
    by[1, :, :, ARC] = e * at.N * at.c + u * at.q * at.s - xx * px - xy * py
    by[2, :, :, ARC] = e * at.N * at.s - u * at.q * at.c - xy * px - yy * py
    by[0, :, :, LOAD] = turned[0] * tx + turned[1] * ty
    by[1, :, :, LOAD], by[2, :, :, LOAD] = -(xx * tx + xy * ty), -(xy * tx + yy * ty)
    by[:, :, :, 5] = by[:, :, :, ARC] * table.c
    # derivative of the angle's derivative
    turn_by = h[:, :, None] * bend[:, :, None] * (table.once @ by[0])
    turn_by[:, :, 1] += bend
    along = b * moments(segments, at, moment)
    turn_by[:, :, ARC] += along
    turn_by[:, :, 5] += along * table.c + bend * (at.values[0] @ table.once.T)
    right: Array = h[:, :, None] * (table.half @ turn_by)
    right[:, :, 5] += arrived.bent @ table.half.T
    direct = np.empty((len(h), 4, INPUTS), dtype=right.dtype)
    direct[:, 0] = h * (table.w @ turn_by)
    direct[:, 0, [0, 2]] += (1, -1)
    direct[:, 0, 5] += arrived.bent @ table.w
    direct[:, 1:] = h[:, :, None] * (table.w @ by).transpose(1, 0, 2)
    direct[:, 1, 1] += 1
    direct[:, 1:, 5] += (at.values @ table.w).T
    return right, direct


def tangent(stretch: Any, shear: Any, force: tuple[Any, Any], angle: Any) -> tuple[Any, Any]:
    """Tangent vector r' of the axis where the section's angle and the internal force are known."""
    c, s = cosine(angle), sine(angle)
    nx, ny = force
    gq = (stretch - shear) * (nx * s - ny * c)
    return c + stretch * nx - gq * s, s + stretch * ny + gq * c
