"""The Reissner rod with loads along it, natural curvature and taper, by Gauss collocation; see `rod`.

With the internal force ``n(s) = n - P(s)``, of which n is constant between two contacts and ``P' = q`` is the load per length, natural
curvature k0, and flexibilities ``e, u, b = 1/EA, 1/GA, 1/EI`` that depend on s, where ``g = e - u``::

    phi' = b m + k0,   m' = f = -Q (1 + g N),   r' = (1 + e N) d_1 + u Q d_2

The inner unknowns are the angles at p Gauss nodes, as in `rod`. Half of the end residual is held where the inner equations are
eliminated: ``c/2`` times it is added to the equation at the node c.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tsm.elements.collocation import collocation
from tsm.elements.properties import Array, cosine, sine
from tsm.elements.rod import Arrival, Condensed, Field, Flexibility

INPUTS = 9
"""Number of inputs: those of `rod`, then the arc position of the start, and the load parameter."""


class Course(NamedTuple):
    """What varies along segments, at the same points of each; shapes (s, p), or (2, s, p)."""

    flexibility: Flexibility  # 1/EA, 1/GA, 1/EI
    slope: Flexibility  # their derivatives in the arc position
    # P, the resultant of the load from the start of the element, by which the internal force has fallen;
    # shape (2, s, p)
    resultant: Array
    load: Array  # q, the load per length; shape (2, s, p)
    resultant_rate: Array  # derivative of P in the load parameter; shape (2, s, p)

    def single(self, s: int) -> Course:
        """What varies along one segment."""
        own = slice(s, s + 1)
        flexibility, slope = (Flexibility(*(v[own] for v in part)) for part in (self.flexibility, self.slope))
        return Course(
            flexibility, slope, self.resultant[:, own], self.load[:, own], self.resultant_rate[:, own]
        )


class VaryingSegments(NamedTuple):
    """Rods between two contacts, s of them; the first four are those of `rod.Segments`, at the Gauss nodes."""

    flexibility: Flexibility  # flexibilities, each of shape (s, p)
    force: Array  # internal force; shape (2, s, p)
    length: Array  # undeformed length; shape (s, 1)
    angle: Array  # angles of the sections, from the x axis; shape (s, p)
    course: Course  # what varies along the segments
    curvature: Array  # natural curvature; shape (s, 1)
    constant: Array  # part n of the internal force, constant between two contacts; shape (2, s, 1)
    begin: Array  # arc position of the start within the element; shape (s, 1)
    owner: Array  # elements of the segments, counted over the exact ones; shape (s,)
    at_end: Course  # what varies, at the ends of the segments, of shape (s, 1)


class _Bent(NamedTuple):
    """Moment and derivative of the angle at the Gauss nodes, shape (s, p)."""

    moment: Array
    turn: Array


def _bent(segments: VaryingSegments, field: Field, moment: Array) -> _Bent:
    along = moment + segments.length * (field.values[0] @ collocation(segments.angle.shape[1]).once.T)
    return _Bent(along, segments.flexibility.bend * along + segments.curvature)


def arrival(segments: VaryingSegments, field: Field, start: Array, moment: Array, end: Array) -> Arrival:
    """Residuals with given angle and moment at the start and angle at the end, each of shape (s, 1); `bent` is the derivative of the angle."""
    table = collocation(segments.angle.shape[1])
    turn = _bent(segments, field, moment).turn
    inside = (
        segments.angle - start - table.c * ((end - start) / 2) - segments.length * (turn @ _half_way(table).T)
    )
    end_residual = start + segments.length * (turn @ table.w)[:, None] - end
    return Arrival(end_residual[:, 0], inside, turn)


def _half_way(table: Any) -> Array:
    """Integrals to the Gauss nodes, less half of what they are at the end, shape (p, p)."""
    half: Array = table.once - np.outer(table.c, table.w) / 2
    return half


def condense(segments: VaryingSegments, field: Field, arrived: Arrival, moment: Array) -> Condensed:
    """Eliminate the angles inside; the derivatives are by the nine inputs."""
    table, h = collocation(segments.angle.shape[1]), segments.length
    slope, turned = _by_angle(field)
    f_by, r_by = _by_inputs(segments, field, turned)
    bend, bent = segments.flexibility.bend, _bent(segments, field, moment)
    # derivative of the angle's derivative by the inputs, without what passes through the angles
    turn_by = h[:, :, None] * bend[:, :, None] * (table.once @ f_by)
    turn_by[:, :, 1] += bend
    along = segments.course.slope.bend * bent.moment
    turn_by[:, :, 7] += along
    turn_by[:, :, 5] += along * table.c + bend * (field.values[0] @ table.once.T)

    half, (count, p) = _half_way(table), segments.angle.shape
    matrix = np.eye(p) - (h * h)[:, :, None] * (half @ (bend[:, :, None] * table.once)) * slope[:, None, :]
    right = h[:, :, None] * (half @ turn_by)
    right[:, :, 0] += 1 - table.c / 2
    right[:, :, 2] += table.c / 2
    right[:, :, 5] += bent.turn @ half.T
    right[:, :, 6] -= arrived.inside
    inner: Array = np.linalg.solve(matrix, right)

    weights = np.empty((count, 4, p), dtype=right.dtype)
    weights[:, 0] = h * h * ((table.w * bend) @ table.once) * slope
    weights[:, 1] = h * table.w * slope
    weights[:, 2:] = (h * table.w * turned).transpose(1, 0, 2)
    direct = np.empty((count, 4, INPUTS), dtype=right.dtype)
    direct[:, 0] = h * (table.w @ turn_by)
    direct[:, 0, [0, 2]] += (1, -1)
    direct[:, 0, 5] += bent.turn @ table.w
    direct[:, 1] = h * (table.w @ f_by)
    direct[:, 1, 1] += 1
    direct[:, 2:] = h[:, :, None] * (table.w @ r_by).transpose(1, 0, 2)
    direct[:, 1:, 5] += (field.values @ table.w).T
    return Condensed(weights @ inner + direct, inner)


def _by_angle(field: Field) -> tuple[Array, Array]:
    """Derivatives of f (s, p) and r' (2, s, p) by the angle at the node."""
    turned = np.stack([-field.gq * field.c - field.turn * field.s, field.turn * field.c - field.gq * field.s])
    slope: Array = field.N * field.turn - field.gq * field.q
    return slope, turned


def _by_inputs(segments: VaryingSegments, field: Field, turned: Array) -> tuple[Array, Array]:
    """Derivatives of f (s, p, 9) and r' (2, s, p, 9) at the nodes by the inputs, the angle held; f falls with n as r' does with the angle."""
    table, (stretch, shear, _) = collocation(segments.angle.shape[1]), segments.flexibility
    gc = (stretch - shear) * field.c
    xx, xy, yy = shear + gc * field.c, gc * field.s, stretch - gc * field.c
    course = segments.course
    (e, u, _), (px, py), (tx, ty) = course.slope, course.load, course.resultant_rate
    # Q = -q
    along = np.stack(
        [
            e * field.N * field.c + u * field.q * field.s - xx * px - xy * py,
            e * field.N * field.s - u * field.q * field.c - xy * px - yy * py,
        ]
    )
    f_along = field.q * (e - u) * field.N + turned[0] * px + turned[1] * py
    shape = (*field.N.shape, INPUTS)
    f_by, r_by = np.zeros(shape, field.N.dtype), np.zeros((2, *shape), field.N.dtype)
    f_by[:, :, 3], f_by[:, :, 4] = -turned
    f_by[:, :, 5], f_by[:, :, 7] = f_along * table.c, f_along
    f_by[:, :, 8] = turned[0] * tx + turned[1] * ty
    r_by[0, :, :, 3], r_by[0, :, :, 4] = xx, xy
    r_by[1, :, :, 3], r_by[1, :, :, 4] = xy, yy
    r_by[:, :, :, 5], r_by[:, :, :, 7] = along * table.c, along
    r_by[0, :, :, 8], r_by[1, :, :, 8] = -(xx * tx + xy * ty), -(xy * tx + yy * ty)
    return f_by, r_by


def tangent_rate(segments: VaryingSegments, field: Field, inside: Array, inputs: Array) -> Array:
    """Change (2, s, p) of r' at the Gauss nodes with the angles inside (s, p) and the inputs (s, 9)."""
    _, turned = _by_angle(field)
    rate: Array = turned * inside + (_by_inputs(segments, field, turned)[1] @ inputs[:, :, None])[..., 0]
    return rate


def tangent_slope(course: Course, force: tuple[Any, Any], angle: Any) -> tuple[Array, Array]:
    """Derivatives (2,) of the tangent vector r' at one section by the arc position and by the load parameter, the angle and n held.

    ``course``: what varies, at a single point. ``force``: internal force there. ``angle``: angle of the
    section.
    """
    c, s = cosine(angle), sine(angle)
    nx, ny = force
    (stretch, shear, _), (e, u, _) = (
        [value[0, 0] for value in part] for part in (course.flexibility, course.slope)
    )
    N, Q, g = nx * c + ny * s, ny * c - nx * s, stretch - shear
    compliance = np.array([[shear + g * c * c, g * c * s], [g * c * s, stretch - g * c * c]])
    own = np.array([e * N * c - u * Q * s, e * N * s + u * Q * c])
    return own - compliance @ course.load[:, 0, 0], -(compliance @ course.resultant_rate[:, 0, 0])
