"""A section of a rod, and the section at the end of a part with a constant force: spectral collocation."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.exact.reissner import Flexibility

Array = NDArray[Any]  # real or complex: derivatives are complex steps

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(36)
_PICARD = 24


class Section(NamedTuple):
    """Position, angle and moment at a section of a rod."""

    x: Array
    y: Array
    theta: Array
    moment: Array


def _integration_matrix() -> NDArray[np.float64]:
    """Weights of the integrals from 0 to the Gauss points of (0, 1), last row to 1, exact for polynomials through them."""
    P = np.polynomial.legendre.legvander(np.append(_NODES, 1.0), len(_NODES))
    k = np.arange(len(_NODES))
    integrals = np.column_stack([P[:, 0] + P[:, 1], P[:, 2:] - P[:, :-2]])
    return np.asarray(integrals @ (P[:-1, k] * _WEIGHTS[:, None]).T / 4.0, dtype=np.float64)


_INTEGRATION = _integration_matrix()


def tangent(theta: Array, force: tuple[Array, Array], flexibility: Flexibility) -> tuple[Array, Array]:
    """Strained tangent `r' = (1 + N/EA) d1 + (Q/GA) d2`."""
    c, s = np.cos(theta), np.sin(theta)
    stretch = 1.0 + flexibility.stretch * (force[0] * c + force[1] * s)
    shear = flexibility.shear * (force[1] * c - force[0] * s)
    return stretch * c - shear * s, stretch * s + shear * c


def integrate(start: Section, force: tuple[Array, Array], length: Array, flexibility: Flexibility) -> Section:
    """Section at the end of a part with a constant force, by Picard's iteration at the Gauss points."""
    n = force[0][..., None], force[1][..., None]
    weights = length[..., None, None] * _INTEGRATION
    theta = start.theta[..., None] + np.zeros(len(_NODES) + 1)
    for _ in range(_PICARD):
        dx, dy = tangent(theta[..., :-1], n, flexibility)
        moment = start.moment[..., None] - (weights @ (dx * n[1] - dy * n[0])[..., None])[..., 0]
        theta = start.theta[..., None] + (weights @ moment[..., :-1, None])[..., 0]
    dx, dy = (component[..., None] for component in tangent(theta[..., :-1], n, flexibility))
    x, y = start.x + (weights @ dx)[..., -1, 0], start.y + (weights @ dy)[..., -1, 0]
    return Section(x, y, theta[..., -1], moment[..., -1])
