"""The energy that friction dissipates in the exact equilibria along an answer, by Gauss quadrature of ``F_t v``."""

import math
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from comparisons.referee.friction.history import History
from comparisons.referee.friction.slip import slip_rate
from comparisons.referee.grip import Grip, UnknownFrictionError
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
    pairs = [spec.pair for spec in history.scene.contacts if spec.friction]
    between = [t for t in corners(history.scene) if begin < t < end]
    try:
        cuts = dict.fromkeys([begin, *between]) | _cuts(history, k) | {end: exact}
        spent, there = dict.fromkeys(pairs, 0.0), None
        for first, last in reversed(list(pairwise(sorted(cuts)))):
            there = cuts[last] or there
            if last - first > _LEAST:
                energies, there = _between(history, first, last, there)
                for pair, energy in energies.items():
                    spent[pair] += energy
    except UnknownFrictionError:
        return dict.fromkeys(pairs, math.nan)
    return spent


def _cuts(history: History, k: int) -> dict[float, Equilibrium | None]:
    """Load parameters before number k, after the one before, at which a contact changes, with the equilibria there."""
    found: dict[float, Equilibrium | None] = {}
    for pair, own in history.phases.items():
        before = history.numbers[pair][k - 1] if k else 0
        for phase in own[before + 1 : history.numbers[pair][k] + 1]:
            if phase.before is not None and phase.slip != phase.before.slip:
                begin = history.begin(phase)
                found[begin.load_parameter] = begin
    return found


def _between(
    history: History, first: float, last: float, there: Equilibrium | None
) -> tuple[dict[str, float], Equilibrium | None]:
    """Dissipation between two load parameters without a change, and the equilibrium at the first; `there` is one at the last, in any state."""
    middle = (first + last) / 2.0
    grips, closed = history.around(middle), history.closed(middle)
    if not any(grip.slip for grip in grips.values()):
        return {}, None
    if there is None or closed != there.closed.keys():
        there = history.near(middle, closed, grips)
    spent: dict[str, float] = {}
    spans = [(first, last, _DEPTH)]
    while spans:
        low, high, depth = spans.pop()
        powers, there = _powers(low, high, there, grips)
        terms = np.abs([_LEGENDRE @ values for values in powers.values()])
        if depth and np.any(terms[:, -2:].sum(axis=1) > _SMOOTH * terms[:, 0]):
            spans += [(low, (low + high) / 2.0, depth - 1), ((low + high) / 2.0, high, depth - 1)]
            continue
        for pair, values in powers.items():
            spent[pair] = spent.get(pair, 0.0) + float(_WEIGHTS @ values) * (high - low) / 2.0
    return spent, there


def _powers(
    low: float, high: float, there: Equilibrium, grips: dict[str, Grip]
) -> tuple[dict[str, Array], Equilibrium]:
    """``F_t v`` of the slipping contacts at the Gauss points between two load parameters, and the equilibrium at the first of them."""
    powers: dict[str, Array] = {}
    for k in reversed(range(len(_POINTS))):
        t = float((low + high) / 2.0 + _POINTS[k] * (high - low) / 2.0)
        there = reach(there, t, grips)
        if not there.found:
            raise UnknownFrictionError(f"no equilibrium was found at load parameter {t:.6g}")
        for touch in there.layout.touches:
            if touch.grip is not None and touch.grip.slip:
                power = there.contacts[touch.spec.pair].drag * slip_rate(there, touch) * there.layout.length
                powers.setdefault(touch.spec.pair, np.zeros(len(_POINTS)))[k] = power
    return powers, there
