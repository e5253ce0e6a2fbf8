"""Shape functions of the rotation on an element: two linear ones and integrated Legendre polynomials up to a high degree.

With ``xi`` in [-1, 1]: ``(1 - xi)/2``, ``(1 + xi)/2`` and ``(P_j - P_(j-2))/(2 j - 1)``, j = 2..p, which vanish at both ends and whose
derivatives ``P_(j-1)`` are orthogonal. So the bending stiffness of their coefficients is a diagonal matrix, whatever the degree, and the
size of the last coefficients shows whether the element is small enough (Szabo and Babuska, Finite Element Analysis, 1991).
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
    """Return the shape functions and their derivatives in xi, each of shape (..., p + 1); first the two linear ones."""
    legendre = legvander(xi, DEGREE)
    j = np.arange(2, DEGREE + 1)
    half = np.full(np.shape(xi), 0.5)
    bubbles = (legendre[..., 2:] - legendre[..., :-2]) / (2.0 * j - 1.0)
    values = np.concatenate([(0.5 - xi / 2.0)[..., None], (0.5 + xi / 2.0)[..., None], bubbles], axis=-1)
    slopes = np.concatenate([-half[..., None], half[..., None], legendre[..., 1:-1]], axis=-1)
    return values, slopes


GAUSS, WEIGHTS = leggauss(POINTS)
VALUES, SLOPES = shapes(GAUSS)
"""At the Gauss points, shape (points, p + 1)."""
AMPLITUDE = 2.0 / (2.0 * np.arange(2, DEGREE + 1) - 1.0)
"""Bound of the bubble functions j = 2..p."""


_COEFFICIENTS = np.linalg.inv(legvander(GAUSS, POINTS - 1))


def up_to(xi: Array) -> Array:
    """Return the table (m, points) of the integrals from -1 to xi (m,) of what has given values at the Gauss points."""
    table = legvander(xi, POINTS)
    j = np.arange(1, POINTS)
    integrals = np.column_stack([xi + 1.0, (table[:, 2:] - table[:, :-2]) / (2.0 * j + 1.0)])
    return np.asarray(integrals @ _COEFFICIENTS)
