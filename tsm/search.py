"""The search for the first event within a step."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.events import ROUND_OFF, EventKind
from tsm.margins import Margin
from tsm.path import Point
from tsm.root import find_root
from tsm.status import Status
from tsm.step import StepControl

_GRIPS = frozenset({EventKind.SLIP, EventKind.STICK})
"""Events at which a contact stays closed."""
_PROBE = 1e-3
"""Part of a step after which a margin that is zero at its start shows whether its event is there."""
_COINCIDENT = 1e-6
"""Distance over the longest beam below which a touch and a slip-off are one event, a hand-over."""
_SHORT = 2e-3
"""Length of a step within which contacts are not searched for a slip or stick that has passed at its end."""
_DEGREE, _FINE = 4, 41
"""Degree of the polynomial through a margin, and points at which it is evaluated."""
_LOCATED = 1e-12
"""Largest margin of a located event. Results at the event may depend on its load parameter with a factor of a thousand."""
_APART = 1e-14
"""Width of the bracket of load parameters at which a margin that jumps is located."""


class Search(NamedTuple):
    """Search from the last point of a path, which has margins, to a goal."""

    last: Point
    margins: list[Margin]
    goal: float
    solve: Callable[[float], Point | None]  # point at a load parameter, None where none is found
    measure: Callable[[Point], list[Margin]]
    control: StepControl  # told why a step is given up

    def first(self, after: list[Margin], numbers: list[int]) -> tuple[Point, list[Margin]] | Status:
        """First of the events with some numbers, with the margins of what happens there, or why the step is given up.

        ``after``: margins at the goal. If a force or position jumps, the step is too long.
        """
        located: list[tuple[float, bool, int, Point]] = []
        for n in numbers:
            found = self._located(n, after[n].value)
            if isinstance(found, Status):
                return found
            # at one load parameter a release comes last: another contact that opens may take its pull away
            located.append((found.t, self.margins[n].kind is EventKind.RELEASE, n, found))
        *_, n, event = min(located)
        measured = self.margins if event is self.last else self.measure(event)
        first = measured[n]
        past = (other for other in measured if other.value < -_COINCIDENT)
        if any(other.kind is not EventKind.TOUCH or other.pair != first.pair for other in past):
            return self.control.refuse()
        together = [
            other
            for before, other in zip(self.margins, measured, strict=True)
            if {other.kind, first.kind} == {EventKind.TOUCH, EventKind.SLIP_OFF}
            and other.value <= _COINCIDENT
            and other.value < before.value
        ]
        return event, sorted([first, *together], key=lambda m: m.kind is EventKind.TOUCH)

    def _located(self, n: int, value: float) -> Point | Status:
        """Point at an event, by the number of its margin and the margin's value at the goal."""
        before = self.margins[n]
        if before.value <= ROUND_OFF:
            if before.kind in _GRIPS:
                return self.control.fail(Status.JAMMED)
            ahead = self._ahead()
            rises = ahead is not None and ahead[n].value > ROUND_OFF
            return self.control.refuse(_PROBE) if rises else self.last

        def evaluate(t: float) -> tuple[float, Point] | None:
            point = self.solve(t)
            return None if point is None else (self.measure(point)[n].value, point)

        # the point at the root of the margin, or just past its jump to below zero, located to round-off
        ends = (self.last.t, before.value), (self.goal, value)
        found = find_root(evaluate, *ends, small=_LOCATED, apart=_APART)
        if found is None:
            return self.control.failure
        touches = before.kind is EventKind.TOUCH and before.value < 1.0
        jumps = touches and self.measure(found)[n].value < -ROUND_OFF
        return self.control.refuse() if jumps else found

    def _ahead(self) -> list[Margin] | None:
        """Margins just after the last point."""
        point = self.solve(self.last.t + _PROBE * (self.goal - self.last.t))
        return None if point is None else self.measure(point)

    def pulls_at_first(self) -> bool:
        """Whether a contact that has no force pulls just after the last point, though it may push at the goal."""
        margins = enumerate(self.margins)
        idle = {n for n, m in margins if m.kind is EventKind.RELEASE and abs(m.value) <= ROUND_OFF}
        ahead = self._ahead() if idle else None
        if ahead is None or idle.isdisjoint(broken(self.margins, ahead)):
            return False
        self.control.refuse(_PROBE)
        return True

    def dips(self, points: list[Point]) -> float | None:
        """Part of a step at which a margin of slip or stick is below zero, though not at its end; None if none is.

        ``points``: points inside the step and at its end.
        """
        begin, length = self.last.t, points[-1].t - self.last.t
        if length <= _SHORT or all(margin.kind not in _GRIPS for margin in self.margins):
            return None
        times = np.array([begin, *(point.t for point in points)])
        trails = zip(self.margins, *map(self.measure, points), strict=True)
        grips = ([margin.value for margin in trail] for trail in trails if trail[0].kind in _GRIPS)
        dip = min(
            (t for t in (below(np.array(values), times) for values in grips) if t is not None), default=None
        )
        return None if dip is None else (dip - begin) / length


def broken(before: list[Margin], after: list[Margin]) -> list[int]:
    """Numbers of the margins that became negative; a node over the beam touches its surface before the end."""
    past = [n for n, (_, b) in enumerate(zip(before, after, strict=True)) if b.value < -ROUND_OFF]
    over = {before[n].pair for n in past if before[n].kind is EventKind.TOUCH and before[n].value < 1.0}
    return [n for n in past if before[n].kind is not EventKind.END_CONTACT or before[n].pair not in over]


def below(values: Array, times: Array) -> float | None:
    """Load parameter at which the polynomial through some values of a margin is least, if it is below zero there; else None."""
    line = np.polynomial.Polynomial.fit(times, values, min(len(values) - 1, _DEGREE))
    fine, low = line.linspace(_FINE)
    least = int(np.argmin(found := np.append(values, low)))
    return float(np.append(times, fine)[least]) if found[least] < -ROUND_OFF else None
