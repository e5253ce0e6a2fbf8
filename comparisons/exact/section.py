"""Sections of a rod, and integration along a part with a constant force by spectral collocation.

The rod has the stiffnesses EA, GA and EI and the section axes `d1 = (cos theta, sin theta)`, `d2 = (-sin theta, cos theta)`:

    theta' = m/EI,   r' = (1 + N/EA) d1 + (Q/GA) d2,   m' = -r' x n,   N = n.d1,  Q = n.d2

Lengths are in units of the rod's length L, forces in EI/L^2, moments in EI/L.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[Any]  # real or complex: derivatives are complex steps

COMPLEX_STEP = 1e-60
POINTS, PICARD = 36, 24
SAME = 4e-15
"""Change of an angle, or relative change of its derivatives, in the last iteration."""


class Flexibility(NamedTuple):
    """Axial and shear flexibility of a rod, `EI/(EA L^2)` and `EI/(GA L^2)`; zero is rigid."""

    stretch: float
    shear: float


class Section(NamedTuple):
    """Position, angle and moment at a section of a rod."""

    x: Array
    y: Array
    theta: Array
    moment: Array


def rule(points: int) -> tuple[Array, Array]:
    """Gauss points of (0, 1), and their weights."""
    nodes, weights = legendre.leggauss(points)
    return (nodes + 1.0) / 2.0, weights / 2.0


def integrals(fractions: Array) -> Array:
    """Return the matrix from values at the Gauss points to the integrals from 0 to fractions (k,), shape (POINTS, k)."""
    nodes, _ = legendre.leggauss(POINTS)
    primitives = legendre.legint(np.linalg.inv(legendre.legvander(nodes, POINTS - 1)), lbnd=-1)
    return np.asarray(legendre.legvander(2.0 * fractions - 1.0, POINTS) @ primitives / 2.0).T


GAUSS, _ = rule(POINTS)
_ONCE, _END = integrals(GAUSS), integrals(np.ones(1))
_TWICE = _ONCE @ _ONCE


def tangent(theta: Array, force: tuple[Array, Array], flexibility: Flexibility) -> tuple[Array, Array]:
    """Derivative `r' = (1 + N/EA) d1 + (Q/GA) d2` of the position by arc length."""
    c, s = np.cos(theta), np.sin(theta)
    stretch = 1.0 + flexibility.stretch * (force[0] * c + force[1] * s)
    shear = flexibility.shear * (force[1] * c - force[0] * s)
    return stretch * c - shear * s, stretch * s + shear * c


def integrate(
    start: Section,
    force: tuple[Array, Array],
    length: Array,
    flexibility: Flexibility,
    fractions: Array | None = None,
) -> Section:
    """Section at the end of a part with a constant force, or sections (..., k) at fractions (k,) of it, by Picard's iteration."""
    x, y, theta_0, m_0, nx, ny, h = (value[..., None] for value in (*start, *force, length))

    def rates(theta: Array) -> tuple[Array, Array, Array]:
        dx, dy = tangent(theta, (nx, ny), flexibility)
        return dx, dy, dy * nx - dx * ny

    theta = straight = theta_0 + h * m_0 * GAUSS
    for _ in range(PICARD):
        last, theta = theta, straight + h**2 * (rates(theta)[2] @ _TWICE)
        change = theta - last
        slope = SAME * np.abs(theta.imag).max(initial=0.0)
        if np.all(np.abs(change.real) <= SAME) and np.all(np.abs(change.imag) <= slope):
            break
    to, (dx, dy, dm) = _END if fractions is None else integrals(fractions), rates(theta)
    turns = h * ((m_0 + h * (dm @ _ONCE)) @ to)
    ends = x + h * (dx @ to), y + h * (dy @ to), theta_0 + turns, m_0 + h * (dm @ to)
    return Section(*(end[..., 0] for end in ends) if fractions is None else ends)
