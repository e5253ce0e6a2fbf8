"""Derivatives of a contact's rows by complex steps: all seven variables at once, exact to round-off (Squire and Trapp 1998)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.properties import Array

_STEP = 1e-30
_STEPS = np.zeros((9, 7), dtype=complex)
_STEPS[[3, 4, 2, 5, 6, 7, 8], range(7)] = 1j * _STEP
"""Steps in displacements (6), force (2) and position."""


def varied(x: Any, xi: Any, force: Any) -> tuple[Array, Array, Array]:
    """Displacements, position and force as arrays (8,): with a step in each of ``dx, dy, theta_i, theta_j, F_x, F_y, xi``, then without."""
    given = np.array([*x, *force, xi])
    moved = np.empty((9, 8), dtype=complex)
    moved[:, :7] = given.real[:, None] + _STEPS
    moved[:, 7] = given
    return moved[:6], moved[8], moved[6:8]


def plain(values: Any) -> Any:
    """Values (..., 8) without a step; they are complex only where the variables are."""
    last = np.asarray(values)[..., -1]
    return last if np.any(last.imag) else last.real


def derivatives(values: Any) -> Array:
    """Derivatives (..., 7) of values (..., 8)."""
    return np.asarray(values)[..., :7].imag / _STEP
