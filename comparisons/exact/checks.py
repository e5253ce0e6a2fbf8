"""Checks of the input of the exact solutions."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray


def require_positive(**values: float) -> None:
    """Raise `ValueError` naming the first value that is not positive and finite."""
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} = {value}: must be positive and finite")


def require_stiffness(**values: float) -> None:
    """Raise `ValueError` naming the first value that is not positive; infinite is rigid."""
    for name, value in values.items():
        if not value > 0.0:
            raise ValueError(f"{name} = {value}: must be positive")


def path_points(points: ArrayLike) -> NDArray[np.float64]:
    """Return the vertices ``(s, 2)`` of a path; raise `ValueError` if they are not finite or of another shape."""
    path = np.asarray(points, dtype=np.float64)
    if path.ndim != 2 or path.shape[1] != 2 or len(path) == 0 or not np.all(np.isfinite(path)):
        raise ValueError(f"points, shape {path.shape}: must be finite and of shape (s, 2), s >= 1")
    return path
