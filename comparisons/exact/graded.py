"""Integrals along a rod from values at Gauss points, which may be graded towards the clamp.

The Gauss points lie on (0, 1) in `xi`. The map `s = (exp(g xi) - 1)/(exp(g) - 1)` with the grading g has the finest spacing at
s = 0. Polynomials in xi up to the degree of the points are integrated exactly. The adjoint `from_left^T` gives weighted
integrals from every point to 1, so that a symmetric bilinear form becomes a symmetric matrix.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class GradedGrid(NamedTuple):
    """Points on (0, 1) (n,), weights (n,), and the matrix (n, n) of the integrals from 0 to every point."""

    arcs: Array
    weights: Array
    from_left: Array
    grading: float

    def integrals(self, arcs: ArrayLike) -> Array:
        """Return the matrix (k, n) of the integrals from 0 to `arcs` (k,)."""
        xi = np.log1p(np.asarray(arcs, dtype=np.float64) * np.expm1(self.grading)) / self.grading
        return integrals(2.0 * xi - 1.0, len(self.weights)) * _density(len(self.weights), self.grading)


def graded_grid(points: int, grading: float) -> GradedGrid:
    """Return a grid with `grading > 0`, the logarithm of the ratio of the spacings at both ends."""
    x, w = legendre.leggauss(points)
    density = _density(points, grading)
    return GradedGrid(
        arcs=np.expm1(grading * (x + 1.0) / 2.0) / np.expm1(grading),
        weights=w / 2.0 * density,
        from_left=integrals(x, points) * density,
        grading=grading,
    )


def _density(points: int, grading: float) -> Array:
    """`ds/dxi` at the points."""
    xi = (legendre.leggauss(points)[0] + 1.0) / 2.0
    return np.asarray(grading * np.exp(grading * xi) / np.expm1(grading))


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
