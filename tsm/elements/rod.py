"""The Reissner rod between two loads, by Gauss collocation.

Between two loads the internal force n is constant. With phi the angle of the section's normal, ``N, Q = n . d_1, n . d_2`` along
and across it, and ``g = 1/EA - 1/GA``::

    phi' = m / EI,   m' = f = -Q (1 + g N),   r' = (1 + N/EA) d_1 + (Q/GA) d_2

The inner unknowns are the angles at p Gauss nodes, with one equation each. The values at the ends are superconvergent, of order 2p. No
equation is divided by the length h, which may be zero or negative.

The inner equations are eliminated while some data of the ends are held. The choice of these data decides the conditioning:

- With the angle and the moment at the start, the inner problem is an initial value problem. It is regular under compression, but
  exponentially ill-conditioned under strong tension.
- With both angles it is a boundary value problem. It is regular under tension, but singular at ``-N h^2/EI = pi^2``.
- With ``m_i h/EI + (phi_j - phi_i)``, as here, the determinant for a straight rod with Q = 0 is ``(1 + sinc k)/2``,
  ``k^2 = -N (1 + g N) h^2/EI``. The inner problem is regular at every axial force.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tsm.elements.collocation import collocation
from tsm.elements.properties import Array, cosine, sine

INPUTS = 7
"""Number of inputs: angle and moment at the start, angle at the end, force x and y, length, and the constant 1 for the inner residual."""
# the 13 entries of `_direct` in the transfer: rows end residual, moment, vector
_PARTS = np.zeros((13, 4, 7))
_PARTS[0, [0, 0, 1], [0, 2, 1]] = 1, -1, 1
_PARTS[[1, 2, 3, 4], 0, [1, 3, 4, 5]] = 1
_PARTS[[5, 6, 10], 1, [3, 4, 5]] = 1
_PARTS[[7, 8, 11], 2, [3, 4, 5]] = 1
_PARTS[[8, 9, 12], 3, [3, 4, 5]] = 1
_DIRECT = _PARTS.reshape(13, -1)


class Flexibility(NamedTuple):
    """Flexibilities of segments, each of shape (s, 1)."""

    stretch: Array  # stretch, shear, bend: 1/EA, 1/GA, 1/EI
    shear: Array
    bend: Array


class Segments(NamedTuple):
    """Rods between two loads, s of them."""

    flexibility: Flexibility  # flexibilities of the segments
    force: Array  # internal force, on the section that looks to the end; shape (2, s, 1)
    length: Array  # undeformed length; shape (s, 1)
    angle: Array  # angles of the sections at the Gauss nodes, from the x axis; shape (s, p)


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


class Arrival(NamedTuple):
    """Residuals of segments."""

    end_residual: Array  # integrated angle at the end less the angle of the section there; shape (s,)
    inside: Array  # residual of the angles inside [rad]; shape (s, p)
    bent: Array  # ``twice @ f``; shape (s, p)


class Condensed(NamedTuple):
    """Segments with their inner equations eliminated."""

    # derivatives of end residual, moment at the end, and vector from start to end, by the inputs; shape
    # (s, 4, 7)
    transfer: Array
    inner: Array  # derivatives of the angles inside by the inputs; shape (s, p, 7)


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


def arrival(segments: Segments, values_at_nodes: Field, start: Array, moment: Array, end: Array) -> Arrival:
    """Residuals with given angle and moment at the start and angle at the end, each of shape (s, 1)."""
    table = collocation(segments.angle.shape[1])
    by_bend = segments.length * segments.flexibility.bend
    by_square = by_bend * segments.length
    rise = by_bend * moment
    bent = values_at_nodes.values[0] @ table.twice.T
    inside = segments.angle - start - table.c * ((rise + end - start) / 2) - by_square * bent
    end_residual = start + rise - end + by_square * values_at_nodes.sums[0, :, 1:]
    return Arrival(end_residual[:, 0], inside, bent)


def condense(segments: Segments, values_at_nodes: Field, arrived: Arrival, moment: Array) -> Condensed:
    """Eliminate the angles inside."""
    table, h, bend = collocation(segments.angle.shape[1]), segments.length, segments.flexibility.bend
    by_bend = h * bend
    by_square = by_bend * h
    slope = values_at_nodes.N * values_at_nodes.turn - values_at_nodes.gq * values_at_nodes.q
    gc = (segments.flexibility.stretch - segments.flexibility.shear) * values_at_nodes.c
    # derivatives of r' by the angle (x, y) and, less what is constant, by the force (xx, xy)
    values = np.empty((4, *slope.shape), dtype=slope.dtype)
    np.subtract(
        -values_at_nodes.gq * values_at_nodes.c, values_at_nodes.turn * values_at_nodes.s, out=values[0]
    )
    np.subtract(
        values_at_nodes.turn * values_at_nodes.c, values_at_nodes.gq * values_at_nodes.s, out=values[1]
    )
    np.multiply(gc, values_at_nodes.c, out=values[2])
    np.multiply(gc, values_at_nodes.s, out=values[3])
    inner = _eliminate(segments, arrived, slope, values[:2], moment)

    weights = np.empty((len(h), 4, slope.shape[1]), dtype=slope.dtype)
    scaled = h * table.w
    np.multiply(by_square * slope, table.ends[:, 1], out=weights[:, 0])
    np.multiply(slope, scaled, out=weights[:, 1])
    np.multiply(values[0], scaled, out=weights[:, 2])
    np.multiply(values[1], scaled, out=weights[:, 3])
    return Condensed(weights @ inner + _direct(segments, values_at_nodes, values @ table.ends, moment), inner)


def _eliminate(segments: Segments, arrived: Arrival, slope: Array, turned: Array, moment: Array) -> Array:
    """Derivatives of the angles inside by the inputs, shape (s, p, 7)."""
    table, h, bend = collocation(segments.angle.shape[1]), segments.length, segments.flexibility.bend
    count, p = segments.angle.shape
    by_bend = h * bend
    by_square = by_bend * h
    matrix = (-by_square * slope)[:, None, :] * table.twice
    matrix.reshape(count, -1)[:, :: p + 1] += 1
    bent = turned @ table.twice.T * -by_square
    half = table.c / 2
    right = np.empty((count, p, INPUTS), dtype=matrix.dtype)
    right[:, :, 0] = 1 - half
    right[:, :, 1] = by_bend * half
    right[:, :, 2] = half
    right[:, :, 3] = bent[0]
    right[:, :, 4] = bent[1]
    right[:, :, 5] = 2 * by_bend * arrived.bent + (bend * moment) * half
    right[:, :, 6] = -arrived.inside
    solved: Array = np.linalg.solve(matrix, right)
    return solved


def _direct(segments: Segments, values_at_nodes: Field, sums: Array, moment: Array) -> Array:
    """Part of the transfer that does not pass through the angles inside, shape (s, 4, 7)."""
    stretch, shear, bend = (value[:, 0] for value in segments.flexibility)
    h = segments.length[:, 0]
    by_bend = h * bend
    total, later = sums[:, :, 0] * h, sums[:2, :, 1] * (-h * by_bend)
    entries = np.empty((13, len(h)), dtype=sums.dtype)
    entries[0] = 1
    entries[1] = by_bend
    entries[2:4] = later
    entries[4] = bend * moment[:, 0] + 2 * by_bend * values_at_nodes.sums[0, :, 1]
    np.negative(total[:2], out=entries[5:7])
    entries[7] = h * shear + total[2]
    entries[8] = total[3]
    entries[9] = h * stretch - total[2]
    entries[10:] = values_at_nodes.sums[:, :, 0]
    return (entries.T @ _DIRECT).reshape(-1, 4, INPUTS)


class Tangent(NamedTuple):
    """Tangent vector r' of the axis at a section, with its derivatives."""

    vector: tuple[Any, Any]  # r' (x, y)
    turned: tuple[Any, Any]  # its derivative by the angle
    compliance: tuple[Any, Any, Any]  # its derivative by the force: xx, xy, yy


def tangent(stretch: float, shear: float, force: tuple[Any, Any], angle: Any) -> Tangent:
    """Tangent vector of the axis where the section's angle and the internal force are known."""
    c, s = cosine(angle), sine(angle)
    nx, ny = force
    g = stretch - shear
    turn, gq = 1 + g * (nx * c + ny * s), g * (nx * s - ny * c)
    return Tangent(
        (c + stretch * nx - gq * s, s + stretch * ny + gq * c),
        (-gq * c - turn * s, turn * c - gq * s),
        (shear + g * c * c, g * c * s, stretch - g * c * c),
    )
