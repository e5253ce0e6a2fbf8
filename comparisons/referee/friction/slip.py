"""The slip rate of a contact with friction, and its integral in stick, along the referee's own equilibria.

In stick ``v = A s' + lever psi' + roll phi'`` is zero all along. The row of `friction` is its trapezium from the beginning of the stick; it is
off by the areas between path and chord in the planes of s and A, and of psi and the lever, ::

    c = (A - A*)/2 (s - s*) - int (A - A*) ds + (lever - lever*)/2 (psi - psi*) - int (lever - lever*) dpsi

a polynomial of the load parameter through equilibria whose rows have its values: a fixed point, since an area changes the path little.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.polynomial import Polynomial

from comparisons.answer import Array
from comparisons.referee.equations import element_before, rows, wrapped
from comparisons.referee.grip import Grip, Hold
from comparisons.referee.layout import Touch
from comparisons.referee.path import SAME, corners, reach, tangent
from comparisons.referee.rod import largest
from comparisons.referee.state import Equilibrium

Sticks = Mapping[str, tuple[Hold, Hold]]
"""Where contacts began to stick, and the places up to which they were followed."""

_AHEAD = 1e-4
"""Load parameters over which rates are differences, of second order, since the equations are not linear in prescribed rotations."""
_PLACES = (1.0 - np.cos(np.pi * np.arange(9) / 8.0)) / 2.0
"""Load parameters in an interval from 0 to 1."""
_APART = 1e-9
"""Largest difference of the areas through nine and five points, over the length."""
_SAME = 1e-14
"""Change of the areas over the length at which they are found."""
_SWEEPS, _LEAST = 30, 1e-4
"""Largest number of corrections, and smallest interval of load parameters that is halved."""


@lru_cache(maxsize=2)
def _rates(now: Equilibrium, behind: bool) -> Array:
    """Rates of the unknowns ahead, or behind, up to the next of the `corners`."""
    scene, sign = now.layout.scene, -1.0 if behind else 1.0
    apart = (sign * (corner - now.load_parameter) for corner in corners(scene))
    ahead = sign * min([_AHEAD, *(part / 2.0 for part in apart if part > SAME)])
    return 2.0 * tangent(now, ahead / 2.0) - tangent(now, ahead)


def slip_rate(now: Equilibrium, pair: str, *, behind: bool = False) -> float:
    """Slip rate of a contact with friction, ahead or behind, in units of the layout: the derivative of the row of a stick that begins here."""
    grip = Grip(friction=0.0, slip=0, hold=place(now, pair))
    numbers, _, derivatives = _rows(now, replace(now.layout.touches[pair], grip=grip))
    return float(derivatives[0] @ np.append(_rates(now, behind), 0.0)[numbers])


def relative_slip_rate(now: Equilibrium, pair: str, *, behind: bool = False) -> float:
    """Slip rate in the direction of the slip, over the largest rate of a position."""
    rate = _rates(now, behind)[now.layout.moving]
    pins = (np.hypot(*np.diff(pin.points, axis=0).T).sum() for pin in now.layout.scene.pins)
    speed = max([largest(rate), *(float(x) / now.layout.length for x in pins), 1e-300])
    return now.layout.grips[pair].slip * slip_rate(now, pair, behind=behind) / speed


def place(now: Equilibrium, pair: str) -> Hold:
    """The place of a contact with friction, at which it may begin to stick."""
    touch = now.layout.touches[pair]
    _, (*_, stretch, shear), _ = _rows(now, touch)
    return Hold(
        load_parameter=now.load_parameter, arc_position=float(now.z[touch.arc]), stretch=stretch, shear=shear,
        direction=float(now.layout.full(now.z)[touch.angle]),
    )  # fmt: skip


def _rows(now: Equilibrium, touch: Touch) -> tuple[list[int], Array, Array]:
    """The rows of a contact in equilibrium."""
    moment = now.system.ends[element_before(now.mesh, touch), 1]
    return rows(now.layout, touch, now.z, moment)


def roll(
    near: Equilibrium, span: tuple[float, float], grips: Mapping[str, Grip], sticks: Sticks
) -> Sticks | None:
    """Follow contacts that stick without a change to an equilibrium near the end."""
    first, last = span
    times, found = first + (last - first) * _PLACES, [near] * len(_PLACES)
    areas = {pair: Polynomial([hold.area(first)], domain=span) for pair, (hold, _) in sticks.items()}
    for _ in range(_SWEEPS):
        own = {
            pair: replace(hold, areas=(*hold.areas, (first, areas[pair])))
            for pair, (hold, _) in sticks.items()
        }
        held = {**grips, **{pair: replace(grips[pair], hold=hold) for pair, hold in own.items()}}
        start = near
        for k in reversed(range(1, len(times))):
            start = found[k] = reach(start if found[k] is near else found[k], float(times[k]), held)
            if not start.found:
                return None
        trails = {pair: _trail(stick, found[1:], pair) for pair, stick in sticks.items()}
        changes = {pair: _area(times, trail) for pair, trail in trails.items()}
        rough = [
            _area(times[::2], trail[:, ::2])(last) - changes[pair](last) for pair, trail in trails.items()
        ]
        if last - first > _LEAST and max(map(abs, rough)) > _APART:
            middle = float(times[len(times) // 2])
            half = roll(found[len(times) // 2], (first, middle), grips, sticks)
            return half and roll(found[-1], (middle, last), grips, half)
        before = areas
        areas = {pair: change + sticks[pair][0].area(first) for pair, change in changes.items()}
        if all(np.abs((areas[pair] - before[pair])(times)).max() <= _SAME for pair in sticks):
            return {pair: (hold, place(found[-1], pair)) for pair, hold in own.items()}
    return None


def _trail(stick: tuple[Hold, Hold], found: list[Equilibrium], pair: str) -> Array:
    """Changes (4, n) of s, A, psi and the lever since the stick began, at the begin of an interval and at equilibria."""
    face = found[0].layout.touches[pair].face
    places = [*stick, *(place(item, pair) for item in found)]
    values = [[item.arc_position, item.stretch, item.shear, face.lever(item.arc_position)] for item in places]
    trail = np.array(values[1:]).T - np.array(values[:1]).T
    trail[2] = wrapped(trail[2])
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
