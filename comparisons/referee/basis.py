"""Shape functions of the rotation on an element: two linear functions and integrated Legendre polynomials.

On ``xi`` in [-1, 1] they are ``(1 - xi)/2``, ``(1 + xi)/2`` and the bubbles ``(P_j - P_(j-2))/(2 j - 1)``, j = 2..p. The bubbles vanish at
both ends and have orthogonal derivatives ``P_(j-1)``, so that their bending stiffness is diagonal. The size of the last
coefficients shows whether the element is small enough (Szabo and Babuska, Finite Element Analysis, 1991).
"""

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

Array = NDArray[np.float64]

DEGREE = 16
"""Degree p of the rotation on an element."""
POINTS = DEGREE + 4
"""Gauss points of an element."""


def shapes(xi: Array) -> tuple[Array, Array]:
    """Return the shape functions and their derivatives in xi, each (..., p + 1), beginning with the two linear functions."""
    legendre = legvander(xi, DEGREE)
    j = np.arange(2, DEGREE + 1)
    half = np.full(np.shape(xi), 0.5)
    bubbles = (legendre[..., 2:] - legendre[..., :-2]) / (2.0 * j - 1.0)
    values = np.concatenate([(0.5 - xi / 2.0)[..., None], (0.5 + xi / 2.0)[..., None], bubbles], axis=-1)
    slopes = np.concatenate([-half[..., None], half[..., None], legendre[..., 1:-1]], axis=-1)
    return values, slopes


GAUSS, WEIGHTS = leggauss(POINTS)
VALUES, SLOPES = shapes(GAUSS)
"""Shape functions and derivatives at the Gauss points, (points, p + 1)."""
AMPLITUDE = 2.0 / (2.0 * np.arange(2, DEGREE + 1) - 1.0)
"""Bounds of the bubbles j = 2..p."""


_COEFFICIENTS = np.linalg.inv(legvander(GAUSS, POINTS - 1))


def up_to(xi: Array) -> Array:
    """Return the matrix (m, points) from values at the Gauss points to the integrals from -1 to xi (m,)."""
    table = legvander(xi, POINTS)
    j = np.arange(1, POINTS)
    integrals = np.column_stack([xi + 1.0, (table[:, 2:] - table[:, :-2]) / (2.0 * j + 1.0)])
    return np.asarray(integrals @ _COEFFICIENTS)
