"""Derivatives of a function of few numbers by complex steps: all of them at once, exact to round-off (Squire and Trapp 1998)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.properties import Array

STEP = 1e-30
"""Imaginary step. The square of it is below every number here."""


def varied(values: Any) -> Array:
    """The n numbers as arrays (n + 1,): with a step in each of them in turn, then without."""
    given = np.array(values)
    moved = np.empty((len(given), len(given) + 1), dtype=complex)
    moved[:] = given.real[:, None]
    moved.reshape(-1)[:: len(given) + 2] += 1j * STEP
    moved[:, -1] = given
    return moved


def plain(values: Any) -> Any:
    """Values (..., n + 1) without a step; they are complex only where the numbers are."""
    last = np.asarray(values)[..., -1]
    return last if np.any(np.abs(last.imag) > 0.0) else last.real  # nan has no step


def derivatives(values: Any) -> Array:
    """Derivatives (..., n) of values (..., n + 1)."""
    return np.asarray(values)[..., :-1].imag / STEP
