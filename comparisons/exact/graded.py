"""Integrals along a rod from values at Gauss points that crowd towards its clamp.

The Gauss points lie on (0, 1) in `xi`; `s = (exp(g xi) - 1)/(exp(g) - 1)` with grading g puts the finest spacing at s = 0. A
polynomial in xi is integrated exactly up to the points' degree, and `from_left^T` is its adjoint: of weighted values it makes weighted
integrals from every point to 1, so that what is symmetric as an integral is symmetric as a matrix.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class GradedGrid(NamedTuple):
    """Points on (0, 1) (n,), weights (n,), and the matrix (n, n) to the integrals from 0 to every point."""

    arcs: Array
    weights: Array
    from_left: Array
    grading: float

    def integrals(self, arcs: ArrayLike) -> Array:
        """Return the matrix (k, n) from values at the points to the integrals from 0 to the `arcs` (k,)."""
        xi = np.log1p(np.asarray(arcs, dtype=np.float64) * np.expm1(self.grading)) / self.grading
        return _integrals(2.0 * xi - 1.0, len(self.weights)) * _density(len(self.weights), self.grading)


def graded_grid(points: int, grading: float) -> GradedGrid:
    """Lay `points` Gauss points graded by `grading > 0`, the logarithm of the ratio of spacings at both ends."""
    x, w = legendre.leggauss(points)
    density = _density(points, grading)
    return GradedGrid(
        arcs=np.expm1(grading * (x + 1.0) / 2.0) / np.expm1(grading),
        weights=w / 2.0 * density,
        from_left=_integrals(x, points) * density,
        grading=grading,
    )


def _density(points: int, grading: float) -> Array:
    """`ds/dxi` at the points."""
    xi = (legendre.leggauss(points)[0] + 1.0) / 2.0
    return np.asarray(grading * np.exp(grading * xi) / np.expm1(grading))


def _integrals(x: Array, points: int) -> Array:
    """Return the matrix from values at Gauss points to the integrals over xi up to `(1 + x)/2`: `P_k` has `(P_k+1 - P_k-1)/(2 k + 1)`."""
    nodes, w = legendre.leggauss(points)
    degree = np.arange(points)
    coefficients = (2 * degree[:, None] + 1) / 2.0 * legendre.legvander(nodes, points - 1).T * w
    P = legendre.legvander(x, points)
    primitive = np.column_stack([x + 1.0, (P[:, 2:] - P[:, :-2]) / (2 * np.arange(1, points) + 1)])
    return np.asarray(primitive @ coefficients / 2.0)
