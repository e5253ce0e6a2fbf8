"""Pareto fronts, orders of convergence and cost exponents."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

FEWEST, MOST = 3, 4
"""Points of a fit."""
STEADY = 0.9
"""A local order below this part of the median is not the order of the family."""


def pareto(cost: ArrayLike, error: ArrayLike) -> list[int]:
    """Return the numbers of the points that no other beats in both, by rising cost; a point with a nan is none of them.

    Examples
    --------
    >>> pareto([1, 2, 3, 4], [0.5, 0.7, 0.1, 0.1])
    [0, 2]
    """
    costs, errors = np.asarray(cost, dtype=float), np.asarray(error, dtype=float)
    rising = np.lexsort((errors, costs))
    rising = rising[np.isfinite(costs[rising]) & np.isfinite(errors[rising])]
    before = np.minimum.accumulate(np.append(np.inf, errors[rising]))
    return [int(k) for k in rising[errors[rising] < before[:-1]]]


class Fit(NamedTuple):
    """A power law ``y ~ x^exponent`` from x = first to last; scatter is the largest ``|ln y - ln y_fit|``."""

    exponent: float | None = None
    points: int = 0
    first: float | None = None
    last: float | None = None
    scatter: float | None = None


def power_law(x: Sequence[float], y: Sequence[float]) -> Fit:
    """Return the power law through the points, without an exponent if they are fewer than three or not positive."""
    if len(x) < FEWEST or not (min(x) > 0.0 and min(y) > 0.0):
        return Fit()
    lx, ly = np.log(x), np.log(y)
    exponent, constant = np.polyfit(lx, ly, 1)
    scatter = float(np.abs(ly - exponent * lx - constant).max())
    return Fit(float(exponent), len(x), float(min(x)), float(max(x)), scatter)


def convergence(resolution: Sequence[float], error: Sequence[float], floor: float) -> Fit:
    """Return the power law of an error over rising resolution in its asymptotic range."""
    # it is the longest run of meshes, before the first error below the floor, whose local orders are at least
    # nine tenths of the median positive one: neither chance on coarse meshes nor round-off on fine ones
    x, y = np.asarray(resolution, dtype=float), np.asarray(error, dtype=float)
    above = np.logical_and.accumulate(y > floor)
    x, y = x[above], y[above]
    local = -np.diff(np.log(y)) / np.diff(np.log(x))
    if not (local > 0.0).any():
        return Fit()
    falling = np.flatnonzero(local >= STEADY * np.median(local[local > 0.0]))
    run = max(reversed(np.split(falling, np.flatnonzero(np.diff(falling) > 1) + 1)), key=len)
    chosen = slice(max(run[0], run[-1] + 2 - MOST), run[-1] + 2)
    return power_law(list(x[chosen]), list(y[chosen]))
