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

from tsm.elements.collocation import Collocation, collocation
from tsm.elements.properties import Array, cosine, sine
from tsm.elements.varied import STEP

INPUTS = 9
"""Number of inputs: angle and moment at the start, angle at the end, force x and y, length, the constant 1
for the inner residual; where a course varies, then the arc position of the start and the load parameter."""
ARC, LOAD = 7, 8
"""The last two inputs."""


class Course(NamedTuple):
    """What varies along segments, at p points of each."""

    flexibility: Array  # 1/EA, 1/GA, 1/EI; shape (3, s, p)
    slope: Array  # their derivatives in the arc position; shape (3, s, p)
    resultant: Array  # P, the resultant of the load from the start of the element; shape (2, s, p)
    load: Array  # q, the load per length; shape (2, s, p)
    resultant_rate: Array  # derivative of P in the load parameter; shape (2, s, p)


class Segments(NamedTuple):
    """Rods between two contacts, s of them."""

    flexibility: Array  # 1/EA, 1/GA, 1/EI; shape (3, s, 1), or (3, s, p)
    force: Array  # internal force, on the section that looks to the end; shape (2, s, 1), or (2, s, p)
    length: Array  # undeformed length; shape (s, 1)
    angle: Array  # angles of the sections at the Gauss nodes, from the x axis; shape (s, p)
    constant: Array  # part n of the internal force; shape (2, s, 1)
    owner: Array  # elements of the segments, counted over the exact ones; shape (s,)
    begin: Array  # arc position of the start within the element; shape (s, 1)
    curvature: Any = 0.0  # natural curvature; shape (s, 1)
    course: Course | None = None  # what varies at the Gauss nodes; None if nothing does

    @property
    def table(self) -> Collocation:
        """Tables of its number of Gauss nodes."""
        return collocation(self.angle.shape[1])


class Field(NamedTuple):
    """Forces and tangent vectors of the rod at the Gauss nodes."""

    values: Array  # f and r' (x, y); shape (3, s, p)
    sums: Array  # their integrals over the unit interval; shape (3, s)
    c: Array  # c, s, N, q, turn, gq: cosine and sine, ``N``, ``-Q``, ``1 + g N``, ``-g Q``; shape (s, p)
    s: Array
    N: Array
    q: Array
    turn: Array
    gq: Array

    @property
    def slope(self) -> Array:
        """Derivative (s, p) of f by the angle."""
        return self.N * self.turn - self.gq * self.q


class Arrival(NamedTuple):
    """Residuals of segments."""

    end_residual: Array  # integrated angle at the end less the angle of the section there; shape (s,)
    inside: Array  # residual of the angles inside [rad]; shape (s, p)
    bent: Array  # derivative of the angle in the arc position; shape (s, p)


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
    return Field(values, values @ segments.table.w, c, s, N, q, turn, gq)


def moments(segments: Segments, at: Field, moment: Array) -> Array:
    """Moments (s, p) at the Gauss nodes."""
    once = segments.table.once
    return moment + segments.length * (at.values[0] @ once.T)


def arrival(segments: Segments, at: Field, start: Array, moment: Array, end: Array) -> Arrival:
    """Residuals with given angle and moment at the start and angle at the end, each of shape (s, 1)."""
    table, h = segments.table, segments.length
    bent = segments.flexibility[2] * moments(segments, at, moment) + segments.curvature
    inside = segments.angle - start - table.c * ((end - start) / 2) - h * (bent @ table.half.T)
    return Arrival((start - end)[:, 0] + h[:, 0] * (bent @ table.w), inside, bent)


def condense(segments: Segments, at: Field, arrived: Arrival) -> Condensed:
    """Eliminate the angles inside."""
    table, h, course = segments.table, segments.length, segments.course
    stretch, shear, bend = segments.flexibility
    # derivatives of ``h f`` and ``h r'`` at the nodes by the angles, and by the inputs; f falls with n as r' does with the angle
    turned = h * np.array([at.slope, -at.gq * at.c - at.turn * at.s, at.turn * at.c - at.gq * at.s])
    along, by = h * (stretch - shear) * at.c, np.zeros((*turned.shape, ARC if course is None else INPUTS))
    by[0, :, :, 3], by[0, :, :, 4] = -turned[1:]
    by[1, :, :, 3], by[2, :, :, 4] = h * shear + along * at.c, h * stretch - along * at.c
    by[1, :, :, 4] = by[2, :, :, 3] = along * at.s
    if course is not None:
        moved = segments.flexibility + 1j * STEP * course.slope
        for column, load in ((ARC, course.load), (LOAD, course.resultant_rate)):
            ahead = segments._replace(flexibility=moved, force=segments.force - 1j * STEP * load)
            by[..., column] = h * field(ahead).values.imag / STEP
            moved = segments.flexibility
        by[..., 5] = by[..., ARC] * table.c
    by[..., 5] += at.values
    # of ``h theta'``
    bending = table.once @ by[0]
    bending[:, :, 1] += 1
    bending *= (h * bend)[:, :, None]
    if course is not None:
        steep = h * course.slope[2] / bend * (arrived.bent - segments.curvature)
        bending[:, :, ARC] += steep
        bending[:, :, 5] += steep * table.c
    bending[:, :, 5] += arrived.bent
    matrix = (h * bend)[:, :, None] * table.once * turned[0][:, None]
    weights = np.empty((len(h), 4, len(table.c)))
    weights[:, 0], weights[:, 1:] = table.w @ matrix, (table.w * turned).transpose(1, 0, 2)
    matrix = -table.half @ matrix
    matrix.reshape(len(h), -1)[:, :: len(table.c) + 1] += 1
    right = table.half @ bending
    right[:, :, 0] += 1 - table.c / 2
    right[:, :, 2] += table.c / 2
    right[:, :, 6] -= arrived.inside
    inner = np.linalg.solve(matrix, right)
    transfer = weights @ inner
    transfer[:, 0] += table.w @ bending
    transfer[:, 1:] += (table.w @ by).transpose(1, 0, 2)
    transfer[:, 0, :3:2] += 1, -1
    transfer[:, 1, 1] += 1
    return Condensed(transfer, inner)


def tangent(stretch: Any, shear: Any, force: tuple[Any, Any], angle: Any) -> tuple[Any, Any]:
    """Tangent vector r' of the axis where the section's angle and the internal force are known."""
    c, s = cosine(angle), sine(angle)
    nx, ny = force
    gq = (stretch - shear) * (nx * s - ny * c)
    return c + stretch * nx - gq * s, s + stretch * ny + gq * c
