"""The energy that friction dissipates in the exact equilibria along an answer, by Gauss quadrature of ``F_t v``."""

import math
from itertools import pairwise

from numpy.polynomial.legendre import leggauss

from comparisons.referee.equilibrium import SearchStatus, Solution
from comparisons.referee.history import History, UnknownFrictionError
from comparisons.referee.march import rates, reach, slip_rate
from comparisons.referee.state import Equilibrium, touching

_POINTS, _WEIGHTS = leggauss(5)
_LEAST = 1e-12
"""Smallest interval of load parameters that is integrated."""


def dissipated(history: History, k: int, exact: Equilibrium) -> dict[str, float]:
    """Return the energy that every contact with friction dissipates from the load parameter before number k up to it.

    The interval is cut where contacts begin to slip, stick, touch or open. The energy is nan if one of these places is not found.
    """
    times = history.response.load_parameter
    begin, end = (float(times[k - 1]) if k else 0.0), float(times[k])
    pairs = [spec.pair for spec in history.scene.contacts if spec.friction]
    corners = [t for pin in history.scene.pins for t in pin.corners if begin < t < end]
    try:
        cuts = dict.fromkeys([begin, *corners]) | _cuts(history, k) | {end: exact.solution}
        spent, there = dict.fromkeys(pairs, 0.0), exact.solution
        for first, last in reversed(list(pairwise(sorted(cuts)))):
            there = cuts[last] or there
            if last - first > _LEAST:
                energies, there = _between(history, first, last, there)
                for pair, energy in energies.items():
                    spent[pair] += energy
    except UnknownFrictionError:
        return dict.fromkeys(pairs, math.nan)
    return spent


def _cuts(history: History, k: int) -> dict[float, Solution | None]:
    """Load parameters before number k, after the one before, at which a contact changes, with the equilibria there."""
    found: dict[float, Solution | None] = {}
    for pair, own in history.phases.items():
        before = history.numbers[pair][k - 1] if k else 0
        for number in range(before + 1, history.numbers[pair][k] + 1):
            if own[number].slip != own[number - 1].slip:
                begin = history.begin(pair, number)
                found[begin.load_parameter] = begin.solution
    return found


def _between(
    history: History, first: float, last: float, there: Solution
) -> tuple[dict[str, float], Solution]:
    """Dissipation between two load parameters without a change, from the equilibrium `there` at the last one; and one at the first."""
    grips = history.around((first + last) / 2.0)
    spent: dict[str, float] = {}
    closed = history.closed((first + last) / 2.0)
    if closed != {touch.spec.pair for touch in there.layout.touches}:
        raise UnknownFrictionError(f"the contacts change at load parameter {last:.6g}")
    for part, weight in zip(_POINTS[::-1], _WEIGHTS[::-1], strict=True):
        t = (first + last) / 2.0 + part * (last - first) / 2.0
        there = reach(history.scene, there, float(t), grips)
        if there.status is not SearchStatus.FOUND:
            raise UnknownFrictionError(f"no equilibrium was found at load parameter {t:.6g}")
        rate = rates(history.scene, there)
        for touch in there.layout.touches:
            if touch.grip is None or not touch.grip.slip:
                continue
            power = touching(there, touch).drag * slip_rate(there, touch, rate) * there.layout.length
            energy = weight * (last - first) / 2.0 * power
            spent[touch.spec.pair] = spent.get(touch.spec.pair, 0.0) + float(energy)
    return spent, there
