"""How far the row of a stick is from the integral of the slip rate, along the referee's own equilibria.

In stick ``v = A s' + lever psi' + roll phi'`` is zero all along. The row of `friction` is its trapezium from the beginning of the stick; it is
off by the areas between path and chord in the planes of s and A, and of psi and the lever, ::

    c = (A - A*)/2 (s - s*) - int (A - A*) ds + (lever - lever*)/2 (psi - psi*) - int (lever - lever*) dpsi

a polynomial of the load parameter through equilibria whose rows have its values: a fixed point, since an area changes the path little.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from comparisons.referee.friction.slip import place
from comparisons.referee.grip import Grip, Hold
from comparisons.referee.newton import Solution
from comparisons.referee.path import reach

_PLACES = (1.0 - np.cos(np.pi * np.arange(9) / 8.0)) / 2.0
"""Load parameters in an interval from 0 to 1."""
_APART = 1e-9
"""Largest difference of the areas through nine and five points, over the length."""
_SAME = 1e-14
"""Change of the areas over the length at which they are found."""
_SWEEPS, _LEAST = 30, 1e-4
"""Largest number of corrections, and smallest interval of load parameters that is halved."""

Array = NDArray[np.float64]
Holds = dict[str, Hold]


def roll(
    near: Solution, span: tuple[float, float], grips: Mapping[str, Grip], begins: Holds
) -> tuple[Holds, Holds] | None:
    """Follow contacts that stick between two load parameters without a change.

    From an equilibrium with the same contacts `near` the end, with the `grips` of all closed contacts and the places of those that stick
    where they begin. Return where the sticks began, with the areas up to the end, and the places there; None without equilibria.
    """
    first, last = span
    times, found = first + (last - first) * _PLACES, [near] * len(_PLACES)
    holds = {pair: hold for pair in begins if (hold := grips[pair].hold) is not None}
    areas = {pair: Polynomial([hold.area(first)], domain=span) for pair, hold in holds.items()}
    length = near.layout.length
    for _ in range(_SWEEPS):
        own = {pair: replace(hold, areas=(*hold.areas, (first, areas[pair]))) for pair, hold in holds.items()}
        held = {**grips, **{pair: replace(grips[pair], hold=hold) for pair, hold in own.items()}}
        start = near
        for k in reversed(range(1, len(times))):
            start = found[k] = reach(start if found[k] is near else found[k], float(times[k]), held)
            if not start.found:
                return None
        trails = {pair: _trail(hold, begins[pair], found[1:], pair) for pair, hold in holds.items()}
        changes = {pair: _area(times, trail) for pair, trail in trails.items()}
        rough = [
            _area(times[::2], trail[:, ::2])(last) - changes[pair](last) for pair, trail in trails.items()
        ]
        if last - first > _LEAST and max(map(abs, rough)) > _APART * length:
            middle = float(times[len(times) // 2])
            half = roll(found[len(times) // 2], (first, middle), grips, begins)
            if half is None:
                return None
            grips = {**grips, **{pair: replace(grips[pair], hold=hold) for pair, hold in half[0].items()}}
            return roll(found[-1], (middle, last), grips, half[1])
        before, areas = areas, {pair: change + holds[pair].area(first) for pair, change in changes.items()}
        if all(np.abs((areas[pair] - before[pair])(times)).max() <= _SAME * length for pair in holds):
            ends = {pair: found[-1].layout.touch(pair) for pair in holds}
            return own, {pair: place(found[-1], touch) for pair, touch in ends.items()}
    return None


def _trail(hold: Hold, begin: Hold, found: list[Solution], pair: str) -> Array:
    """Changes (4, n) of s, A, psi and the lever since the stick began, at the begin of an interval and at equilibria."""
    touches = [item.layout.touch(pair) for item in found]
    unit, touch = found[0].layout.length, touches[0]
    places = [hold, begin, *(place(item, own) for item, own in zip(found, touches, strict=True))]
    rows = [
        [item.arc_position, item.stretch, item.shear, unit * touch.lever(item.arc_position / unit)]
        for item in places
    ]
    trail = np.array(rows[1:]).T - np.array(rows[:1]).T
    trail[2] -= 2.0 * np.pi * np.rint(trail[2] / (2.0 * np.pi))
    return trail


def _area(times: Array, trail: Array) -> Polynomial:
    """Change of c since the first load parameter."""
    arc, stretch, shear, lever = (
        Polynomial.fit(times, row, len(times) - 1, domain=[times[0], times[-1]]) for row in trail
    )
    area = (arc * stretch + shear * lever) / 2.0
    area = area - (stretch * arc.deriv() + lever * shear.deriv()).integ(lbnd=times[0])
    whole: Polynomial = area - area(times[0])
    return whole
