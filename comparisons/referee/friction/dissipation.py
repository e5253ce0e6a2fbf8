"""The energy that friction dissipates in the exact equilibria along an answer, by Gauss quadrature of ``F_t v``."""

import math
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from comparisons.referee.friction.history import History
from comparisons.referee.friction.slip import slip_rate
from comparisons.referee.grip import UnknownFrictionError
from comparisons.referee.path import corners, reach
from comparisons.referee.state import Equilibrium

Array = NDArray[np.float64]

_POINTS, _WEIGHTS = leggauss(6)
_LEGENDRE = np.linalg.inv(legvander(_POINTS, len(_POINTS) - 1))
"""From values at the Gauss points to the coefficients of Legendre's polynomials."""
_SMOOTH = 1e-5
"""Largest sum of the last two coefficients over the first; the error of the integral is about its square."""
_DEPTH = 8
"""Number of times that an interval is halved at most."""
_LEAST = 1e-12
"""Smallest interval of load parameters that is integrated."""


def dissipated(history: History, k: int, exact: Equilibrium) -> dict[str, float]:
    """Return what every contact with friction dissipates since the load parameter before number k; nan where a change is not found."""
    times = history.response.load_parameter
    begin, end = (float(times[k - 1]) if k else 0.0), float(times[k])
    spent: dict[str, float] = {spec.pair: 0.0 for spec in history.scene.contacts if spec.friction}
    cuts: dict[float, Equilibrium | None] = dict.fromkeys(
        t for t in corners(history.scene) if begin < t < end
    )
    try:
        for pair, own in history.phases.items():
            before = history.numbers[pair][k - 1] if k else 0
            for phase in own[before + 1 : history.numbers[pair][k] + 1]:
                if phase.before is not None and phase.slip != phase.before.slip:
                    change = history.begin(phase)
                    cuts[change.load_parameter] = change
        cuts |= {begin: None, end: exact}
        there: Equilibrium | None = None
        for first, last in reversed(list(pairwise(sorted(cuts)))):
            there = cuts[last] or there
            if last - first > _LEAST:
                there = _between(history, first, last, there, spent)
    except UnknownFrictionError:
        return dict.fromkeys(spent, math.nan)
    return spent


def _between(
    history: History, first: float, last: float, there: Equilibrium | None, spent: dict[str, float]
) -> Equilibrium | None:
    """Add the dissipation between two load parameters without a change; `there` is an equilibrium next to them, as is the returned one."""
    middle = (first + last) / 2.0
    grips, closed = history.around(middle), history.closed(middle)
    slipping = [pair for pair, grip in grips.items() if grip.slip]
    if not slipping:
        return None
    now = history.near(middle, closed, grips) if there is None or closed != there.closed.keys() else there

    def power(t: float) -> Array:
        nonlocal now
        now = reach(now, t, grips)
        if not now.found:
            raise UnknownFrictionError(f"no equilibrium was found at load parameter {t:.6g}")
        rates = [slip_rate(now, now.layout.touch(pair)) * now.layout.length for pair in slipping]
        return np.array([now.contacts[pair].drag for pair in slipping]) * rates

    def energy(low: float, high: float, depth: int) -> Array:
        places = (low + high) / 2.0 + _POINTS * (high - low) / 2.0
        powers = np.array([power(float(t)) for t in places[::-1]])[::-1]
        terms, half = np.abs(_LEGENDRE @ powers), (low + high) / 2.0
        if depth and np.any(terms[-2:].sum(axis=0) > _SMOOTH * terms[0]):
            return energy(half, high, depth - 1) + energy(low, half, depth - 1)
        return np.asarray(_WEIGHTS @ powers * (high - low) / 2.0)

    for pair, lost in zip(slipping, energy(first, last, _DEPTH).tolist(), strict=True):
        spent[pair] += lost
    return now
