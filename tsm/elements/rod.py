"""The Reissner rod between two loads, by Gauss collocation (../shared section of the README: the exact element).

Between two loads the internal force n is constant. With phi the angle of the section's normal, ``N, Q = n . d_1, n . d_2`` along
and across it, and ``g = 1/EA - 1/GA``::

    phi' = m / EI,   m' = f = -Q (1 + g N),   r' = (1 + N/EA) d_1 + (Q/GA) d_2

The unknowns inside are the angles at p Gauss nodes, each with its equation; the ends are superconvergent, of order 2p. Nothing is
divided by the length h, which may be zero, or negative.

The equations inside are eliminated. Which data of the ends are held meanwhile is a choice: with the start's angle and moment the
inner problem is an initial value problem, regular under compression but exponentially ill-conditioned under strong tension; with
both angles a boundary value problem, regular under tension but singular at ``-N h^2/EI = pi^2``. Half way between, with
``m_i h/EI + (phi_j - phi_i)`` held, its determinant is ``(1 + sinc k)/2``, ``k^2 = -N h^2/EI``: regular at every axial force.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.collocation import Collocation
from tsm.elements.properties import Array

INPUTS = 7
"""Angle and moment at the start, angle at the end, force x and y, length; the last input is 1: the residual inside."""


class Flexibility(NamedTuple):
    """Of segments; each of shape (s, 1).

    Attributes
    ----------
    stretch, shear, bend : ndarray
        1/EA, 1/GA, 1/EI.
    """

    stretch: Array
    shear: Array
    bend: Array


class Field(NamedTuple):
    """What the angles at the Gauss nodes say of s segments.

    Attributes
    ----------
    values : ndarray, shape (8, s, p)
        f, r' (x, y), d r'/d phi (x, y), d r'/d n (xx, xy, yy); ``d f/d n = -d r'/d phi``.
    slope : ndarray, shape (s, p)
        d f/d phi.
    sums : ndarray, shape (8, s, 2)
        Integrals of the values over the unit interval: ``int v`` and ``int (1 - x) v``.
    """

    values: Array
    slope: Array
    sums: Array


class Condensed(NamedTuple):
    """Segments with their inner equations eliminated.

    Attributes
    ----------
    miss : ndarray, shape (s,)
        Angle on arrival less the angle that is there.
    residual : ndarray, shape (s, p)
        Of the inner equations [rad].
    transfer : ndarray, shape (s, 4, 7)
        Derivatives of miss, moment at the end, and vector from start to end, by the inputs.
    inner : ndarray, shape (s, p, 7)
        Derivatives of the angles inside by the inputs.
    """

    miss: Array
    residual: Array
    transfer: Array
    inner: Array


def field(table: Collocation, flexibility: Flexibility, force: Array, angle: Array) -> Field:
    """Evaluate the rod's equations at the Gauss nodes.

    Parameters
    ----------
    table : Collocation
        Of order p.
    flexibility : Flexibility
        Of the segments.
    force : ndarray, shape (2, s, 1)
        Internal force on the section that looks to the end.
    angle : ndarray, shape (s, p)
        Angles of the sections.
    """
    c, s = np.cos(angle), np.sin(angle)
    nx, ny = force
    stretch, shear, _ = flexibility
    g = stretch - shear
    N, Q = nx * c + ny * s, ny * c - nx * s
    gN, gQ = g * N, g * Q
    along, across = 1 + stretch * N, shear * Q
    turn = 1 + gN
    values = np.empty((8, *angle.shape), dtype=N.dtype)
    values[0] = -Q * turn
    values[1] = along * c - across * s
    values[2] = along * s + across * c
    values[3] = gQ * c - turn * s
    values[4] = gQ * s + turn * c
    gcc = g * c * c
    values[5] = shear + gcc
    values[6] = g * c * s
    values[7] = stretch - gcc
    return Field(values, N * turn - gQ * Q, values @ table.ends)


def condense(
    table: Collocation,
    flexibility: Flexibility,
    at: Field,
    ends: tuple[Array, Array, Array],
    length: Array,
    angle: Array,
) -> Condensed:
    """Eliminate the angles inside.

    Parameters
    ----------
    table, flexibility, angle
        As for `field`.
    at : Field
        Of the same angles.
    ends : tuple of ndarray, shape (s, 1)
        Angle and moment at the start, angle at the end.
    length : ndarray, shape (s, 1)
        Undeformed length.
    """
    start, moment, end = ends
    p, c, bend = len(table.c), table.c, flexibility.bend
    by_bend, by_square = length * bend, length * length * bend
    sums, turned = at.sums, at.values[3:5]
    rise = (by_bend / 2) * moment
    force = at.values[0] @ table.twice.T
    residual = angle - start - c * (rise + (end - start) / 2) - by_square * force
    matrix = (-by_square * at.slope)[:, None, :] * table.twice
    matrix.reshape(len(matrix), -1)[:, :: p + 1] += 1
    right = np.empty((len(matrix), p, 6), dtype=matrix.dtype)
    right[:, :, 0] = 1
    right[:, :, 1] = c
    right[:, :, 2:4] = ((turned @ table.twice.T) * -by_square).transpose(1, 2, 0)
    right[:, :, 4] = (2 * by_bend) * force
    right[:, :, 5] = -residual
    solved = np.linalg.solve(matrix, right)
    inner = np.empty((len(matrix), p, INPUTS), dtype=matrix.dtype)
    half = solved[:, :, 1] / 2
    inner[:, :, 0] = solved[:, :, 0] - half
    inner[:, :, 1] = by_bend * half
    inner[:, :, 2] = half
    inner[:, :, 3:] = solved[:, :, 2:]
    inner[:, :, 5] += (bend * moment) * half

    weights = np.empty((len(matrix), 4, p), dtype=matrix.dtype)
    weights[:, 0] = table.ends[:, 1] * (by_square * at.slope)
    weights[:, 1] = table.w * (length * at.slope)
    weights[:, 2:] = (turned * (length * table.w)).transpose(1, 0, 2)
    transfer = weights @ inner
    total, later = sums[..., 0], sums[..., 1]
    by_bend, by_square, h = by_bend[:, 0], by_square[:, 0], length[:, 0]
    transfer[:, 0, 0] += 1
    transfer[:, 0, 1] += by_bend
    transfer[:, 0, 2] -= 1
    transfer[:, 0, 3:5] -= (by_square * later[3:5]).T
    transfer[:, 0, 5] += (bend * moment)[:, 0] + 2 * by_bend * later[0]
    transfer[:, 1, 1] += 1
    transfer[:, 1, 3:5] -= (h * total[3:5]).T
    transfer[:, 1:, 5] += total[:3].T
    compliance = h * total[5:8]
    transfer[:, 2, 3] += compliance[0]
    transfer[:, 2, 4] += compliance[1]
    transfer[:, 3, 3] += compliance[1]
    transfer[:, 3, 4] += compliance[2]
    miss = (start + 2 * rise - end)[:, 0] + by_square * later[0]
    return Condensed(miss, residual, transfer, inner)


class Tangent(NamedTuple):
    """Tangent vector r' of the axis at a section, with its derivatives.

    Attributes
    ----------
    vector : tuple of 2 numbers
        r' (x, y).
    turned : tuple of 2 numbers
        Its derivative by the angle.
    compliance : tuple of 3 numbers
        Its derivative by the force: xx, xy, yy.
    """

    vector: tuple[float, float]
    turned: tuple[float, float]
    compliance: tuple[float, float, float]


def tangent(stretch: float, shear: float, force: tuple[float, float], angle: float) -> Tangent:
    """Tangent vector of the axis where the section's angle and the internal force are known."""
    c, s = np.cos(angle), np.sin(angle)
    nx, ny = force
    g = stretch - shear
    N, Q = nx * c + ny * s, ny * c - nx * s
    along, across, turn = 1 + stretch * N, shear * Q, 1 + g * N
    return Tangent(
        (along * c - across * s, along * s + across * c),
        (g * Q * c - turn * s, g * Q * s + turn * c),
        (shear + g * c * c, g * c * s, stretch - g * c * c),
    )
