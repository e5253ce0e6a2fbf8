"""The extremes of a smooth history between its samples."""

import numpy as np

from comparisons.response import Array

BESIDE = 5
"""Samples to either side of the extreme one."""


def summit(x: Array, y: Array) -> tuple[float, float]:
    """Return the greatest value of a history and its place, by the polynomial of degree 8 through eleven samples around it."""
    k = int(np.clip(np.argmax(y), BESIDE, len(y) - 1 - BESIDE))
    part = slice(k - BESIDE, k + BESIDE + 1)
    fit = np.polynomial.Polynomial.fit(x[part] - x[k], y[part], 8)
    turns = [float(root.real) for root in fit.deriv().roots() if abs(root.imag) < 1e-9]
    place = min(turns, key=abs, default=np.nan)
    return float(fit(place)), float(place + x[k])
