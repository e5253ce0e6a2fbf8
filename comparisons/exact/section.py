"""Sections of a rod, and integration along a part with a constant force by spectral collocation."""

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from comparisons.exact.reissner import Flexibility

Array = NDArray[Any]  # real or complex: derivatives are complex steps


def integrals(x: Array, points: int) -> Array:
    """Return the matrix from values at Gauss points of (0, 1) to the integrals over xi from 0 to `(1 + x)/2`, x (k,).

    Legendre's polynomial `P_k` has the integral `(P_k+1 - P_k-1)/(2 k + 1)`.
    """
    nodes, w = legendre.leggauss(points)
    degree = np.arange(points)
    coefficients = (2 * degree[:, None] + 1) / 2.0 * legendre.legvander(nodes, points - 1).T * w
    P = legendre.legvander(x, points)
    primitive = np.column_stack([x + 1.0, (P[:, 2:] - P[:, :-2]) / (2 * np.arange(1, points) + 1)])
    return np.asarray(primitive @ coefficients / 2.0)


_POINTS, _PICARD = 36, 24
_INTEGRATION = integrals(np.append(legendre.leggauss(_POINTS)[0], 1.0), _POINTS)
"""Integrals from 0 to the Gauss points of (0, 1), and in the last row to 1."""


class Section(NamedTuple):
    """Position, angle and moment at a section of a rod."""

    x: Array
    y: Array
    theta: Array
    moment: Array


def tangent(theta: Array, force: tuple[Array, Array], flexibility: Flexibility) -> tuple[Array, Array]:
    """Derivative `r' = (1 + N/EA) d1 + (Q/GA) d2` of the position by arc length."""
    c, s = np.cos(theta), np.sin(theta)
    stretch = 1.0 + flexibility.stretch * (force[0] * c + force[1] * s)
    shear = flexibility.shear * (force[1] * c - force[0] * s)
    return stretch * c - shear * s, stretch * s + shear * c


def integrate(start: Section, force: tuple[Array, Array], length: Array, flexibility: Flexibility) -> Section:
    """Section at the end of a part with a constant force, by Picard's iteration at the Gauss points."""
    n = force[0][..., None], force[1][..., None]
    weights = length[..., None, None] * _INTEGRATION
    theta = start.theta[..., None] + np.zeros(_POINTS + 1)
    for _ in range(_PICARD):
        dx, dy = tangent(theta[..., :-1], n, flexibility)
        moment = start.moment[..., None] - (weights @ (dx * n[1] - dy * n[0])[..., None])[..., 0]
        theta = start.theta[..., None] + (weights @ moment[..., :-1, None])[..., 0]
    dx, dy = (component[..., None] for component in tangent(theta[..., :-1], n, flexibility))
    x, y = start.x + (weights @ dx)[..., -1, 0], start.y + (weights @ dy)[..., -1, 0]
    return Section(x, y, theta[..., -1], moment[..., -1])
