"""Margins of the contact events that may come next: numbers that are positive before the event and negative after it.

A step in which a margin becomes negative ends at the root of the margin, and the contact changes there. An
event is a row of `WATCHES`: where it may happen, its margin, and what becomes of its contact.

A node at a distance d from the axis touches at one point while the beam bends less than a circle of radius d:
for a round pin of radius R on the face of a beam of height h, ``d = R + h/2``. Where the curvature reaches
1/d, the distance to the node is no longer least at the contact point, and the beam would touch along a line.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tsm.contact.contact_set import changed, closed_at, opened
from tsm.contact.ends import clearance
from tsm.contact.events import ROUND_OFF, EventKind, normal_force, over
from tsm.contact.root import find_root
from tsm.elements.properties import Array
from tsm.model.state import UNDECIDED, Grip, State, touch_of
from tsm.path.friction import cone, least_push, leaves_cone, slip_rate, turned, with_grips
from tsm.statement.status import RefusedError, Status, StopError
from tsm.system.equilibrium import Equilibrium
from tsm.system.system import Drive

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


class Margin(NamedTuple):
    """A dimensionless quantity that is positive until its event happens."""

    kind: EventKind
    pair: int
    value: float


class Watch(NamedTuple):
    """An event that may come."""

    kind: EventKind
    awaited: Callable[[Equilibrium, int], bool]  # whether pair k may have it next
    margin: Callable[[Equilibrium, int, Drive], float]  # under what changes on the way
    # contacts after it: at the event, in the state with the changes of events beside it, by its margin, and whether
    # it is alone; raises StopError where the path ends
    apply: Callable[[Equilibrium, State, Margin, bool], State]


def _closed(point: Equilibrium, k: int) -> bool:
    return point.state.touches[k] is not None


def _thick(point: Equilibrium, k: int) -> bool:
    return point.model.pairs[k].pair.offset > 0


def _grip(point: Equilibrium, k: int) -> Grip:
    """Slip or stick, neither where a contact is open or has no friction."""
    touch = point.state.touches[k]
    return touch.grip if touch is not None and touch.grip is not None else UNDECIDED


def _inside(point: Equilibrium, k: int, _drive: Drive) -> float:
    pair = point.model.pairs[k]
    arc = pair.arc_position(touch_of(point.state, k))
    return min(arc, pair.target.beam.length - arc) / point.model.length


def _push(point: Equilibrium, k: int, _drive: Drive) -> float:
    return normal_force(point, k) * ROUND_OFF / least_push(point, k)


def _slip_rate(point: Equilibrium, k: int, drive: Drive) -> float:
    """Slip rate, positive the way it slips; a pair without a rate slips on."""
    rates = point.rates(drive)
    return 1.0 if rates is None else _grip(point, k).slip * slip_rate(point, rates, k) / point.model.length


def _roundness(point: Equilibrium, k: int, _drive: Drive) -> float:
    """Curvature ``theta'/(1 + e)``, ``theta' = m/EI``, by which the beam may still bend round the node, over 1/d."""
    pair, system = point.model.pairs[k], point.system
    group = point.model.group_of(pair.target)
    forces, push = system.groups[group.number], system.forces[k]
    curvature = -pair.side * group.curvature(k, point.state, forces, push)
    return 1.0 - abs(pair.reach_at(pair.arc_position(touch_of(point.state, k)))) * curvature


def _gap(point: Equilibrium, k: int, _drive: Drive) -> float:
    pair, model = point.model.pairs[k], point.model
    seen = model.project(pair, point.state)
    return seen.gap / model.length if over(model, seen) else 1.0


def _close(point: Equilibrium, state: State, margin: Margin, _alone: bool) -> State:
    """State with an open pair closed without force. A pair whose node is on the far side stays open and may not close (not armed)."""
    k, model = margin.pair, point.model
    if margin.value < -ROUND_OFF:
        return changed(model, state, k, None, armed=False)
    pair = model.pairs[k]
    return changed(model, state, k, closed_at(pair, model.project(pair, state)), armed=True)


def _open(point: Equilibrium, state: State, margin: Margin, alone: bool) -> State:
    return opened(point.model, state, margin.pair, margin.kind, alone=alone)


def _turn(point: Equilibrium, state: State, margin: Margin, _alone: bool) -> State:
    return with_grips(state, {margin.pair: turned(point, margin.pair)})


def _end(_point: Equilibrium, state: State, margin: Margin, _alone: bool) -> State:
    met = (state, margin.pair) if margin.kind is EventKind.END_CONTACT else None
    raise StopError(Status[margin.kind.name], met)


WATCHES = (
    Watch(
        EventKind.END_CONTACT,
        _thick,
        lambda point, k, _: clearance(point.model, point.state, k).distance / point.model.length,
        _end,
    ),
    Watch(EventKind.SLIP_OFF, _closed, _inside, _open),
    Watch(EventKind.RELEASE, _closed, _push, _open),
    Watch(EventKind.STICK, lambda point, k: _grip(point, k).slip != 0, _slip_rate, _turn),
    Watch(
        EventKind.SLIP,
        lambda point, k: _grip(point, k).held is not None,
        lambda point, k, _: cone(point, k) / max(point.model.force_scale, least_push(point, k) / ROUND_OFF),
        _turn,
    ),
    Watch(EventKind.LINE_CONTACT, lambda point, k: _closed(point, k) and _thick(point, k), _roundness, _end),
    Watch(EventKind.TOUCH, lambda point, k: not _closed(point, k) and point.state.armed[k], _gap, _close),
)
"""The events of a contact."""


def margins(point: Equilibrium, drive: Drive) -> list[Margin]:
    """Margins of the events that may come next, under what changes on the way; computed once for each change."""
    if drive not in point.margins:
        numbers = range(len(point.model.pairs))
        awaited = ((watch, k) for k in numbers for watch in WATCHES if watch.awaited(point, k))
        point.margins[drive] = [Margin(watch.kind, k, watch.margin(point, k, drive)) for watch, k in awaited]
    return point.margins[drive]


class Search(NamedTuple):
    """Search from the last point of a path, which has margins, to a goal. A search raises RefusedError where the step is too long."""

    last: Equilibrium
    margins: list[Margin]
    goal: float
    solve: Callable[[float], Equilibrium]  # point at a load parameter
    measure: Callable[[Equilibrium], list[Margin]]

    def first(self, after: list[Margin], numbers: list[int]) -> tuple[Equilibrium, list[Margin]]:
        """First of the events with some numbers, with the margins of what happens there.

        ``after``: margins at the goal. If a force or position jumps, the step is too long.
        """
        # a margin that is zero needs no search, and may refuse the step
        smallest_first = sorted(numbers, key=lambda n: self.margins[n].value)
        located = {n: self._located(n, after[n].value) for n in smallest_first}
        # at one load parameter a release comes last: another contact that opens may take its pull away
        n = min(numbers, key=lambda n: (located[n].t, self.margins[n].kind is EventKind.RELEASE))
        event = located[n]
        measured = self.margins if event is self.last else self.measure(event)
        first = measured[n]
        past = (other for other in measured if other.value < -_COINCIDENT)
        if any(other.kind is not EventKind.TOUCH or other.pair != first.pair for other in past):
            raise RefusedError
        together = [
            other
            for before, other in zip(self.margins, measured, strict=True)
            if {other.kind, first.kind} == {EventKind.TOUCH, EventKind.SLIP_OFF}
            and other.value <= _COINCIDENT
            and other.value < before.value
        ]
        return event, sorted([first, *together], key=lambda m: m.kind is EventKind.TOUCH)

    def _located(self, n: int, value: float) -> Equilibrium:
        """Equilibrium at an event, by the number of its margin and the margin's value at the goal."""
        before = self.margins[n]
        if before.value <= ROUND_OFF:
            if before.kind in _GRIPS:
                ahead = self.last.newton.assembler.drive(self.last.t, self.goal)
                if before.kind is EventKind.SLIP and leaves_cone(self.last, before.pair, ahead):
                    return self.last
                raise RefusedError(Status.JAMMED)
            ahead = self._ahead()
            if ahead and ahead[n].value > ROUND_OFF:
                raise RefusedError(part=_PROBE)
            return self.last

        def evaluate(t: float) -> tuple[float, Equilibrium]:
            point = self.solve(t)
            return self.measure(point)[n].value, point

        # the point at the root of the margin, or just past its jump to below zero, located to round-off
        ends = (self.last.t, before.value), (self.goal, value)
        found = find_root(evaluate, *ends, small=_LOCATED, apart=_APART)
        touches = before.kind is EventKind.TOUCH and before.value < 1.0
        if found is None or (touches and self.measure(found)[n].value < -ROUND_OFF):
            raise RefusedError
        return found

    def _ahead(self) -> list[Margin]:
        """Margins just after the last point, none where no point is found."""
        try:
            return self.measure(self.solve(self.last.t + _PROBE * (self.goal - self.last.t)))
        except RefusedError:
            return []

    def check_pulls(self) -> None:
        """Refuse a step after whose begin a contact that has no force pulls, though it may push at the goal."""
        idle = {
            n for n, m in enumerate(self.margins) if m.kind is EventKind.RELEASE and abs(m.value) <= ROUND_OFF
        }
        ahead = self._ahead() if idle else []
        if ahead and not idle.isdisjoint(broken(self.margins, ahead)):
            raise RefusedError(part=_PROBE)

    def check_dips(self, points: list[Equilibrium]) -> None:
        """Refuse a step inside which a margin of slip or stick is below zero, though not at its end.

        ``points``: points inside the step and at its end.
        """
        begin, length = self.last.t, points[-1].t - self.last.t
        if length <= _SHORT or all(margin.kind not in _GRIPS for margin in self.margins):
            return
        times = np.array([begin, *(point.t for point in points)])
        trails = zip(self.margins, *map(self.measure, points), strict=True)
        grips = (np.array([m.value for m in trail]) for trail in trails if trail[0].kind in _GRIPS)
        dips = [dip for dip in (below(values, times) for values in grips) if dip is not None]
        if dips:
            raise RefusedError(part=(min(dips) - begin) / length)


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
