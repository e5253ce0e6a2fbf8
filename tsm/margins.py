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

from tsm import scales
from tsm.contact_set import changed, closed_at, forbidden
from tsm.ends import clearance
from tsm.events import ROUND_OFF, EventKind, normal_force
from tsm.friction import cone, slip_rate, turned, with_grips
from tsm.newton import Newton
from tsm.path import Point
from tsm.state import UNDECIDED, Grip, State, Touch
from tsm.status import Status
from tsm.system import Drive

GRIPS = frozenset({EventKind.SLIP, EventKind.STICK})
"""Events at which a contact stays closed."""


class Margin(NamedTuple):
    """A dimensionless quantity that is positive until its event happens."""

    kind: EventKind
    pair: int
    value: float


class Watch(NamedTuple):
    """An event that may come."""

    kind: EventKind
    awaited: Callable[[Point, int], bool]  # whether pair k may have it next
    margin: Callable[[Point, int, Drive], float]  # under what changes on the way
    # contacts after it, or why the path ends: at the event, in the state with the changes of events beside it,
    # by its margin, and whether it is alone
    apply: Callable[[Point, State, Margin, bool], State | Status]


def _touch(state: State, k: int) -> Touch:
    touch = state.touches[k]
    assert touch is not None, "this happens at closed contacts"
    return touch


def _closed(point: Point, k: int) -> bool:
    return point.state.touches[k] is not None


def _thick(point: Point, k: int) -> bool:
    return point.model.pairs[k].pair.offset > 0


def _grip(point: Point, k: int) -> Grip:
    """Slip or stick, neither where a contact is open or has no friction."""
    touch = point.state.touches[k]
    return touch.grip if touch is not None and touch.grip is not None else UNDECIDED


def _inside(point: Point, k: int, _drive: Drive) -> float:
    pair = point.model.pairs[k]
    arc = pair.arc_position(_touch(point.state, k))
    return min(arc, pair.target.beam.length - arc) / point.model.length


def _push(point: Point, k: int, _drive: Drive) -> float:
    return normal_force(point.model, point.equilibrium, k) * ROUND_OFF / least_push(point.newton, k)


def _slip_rate(point: Point, k: int, drive: Drive) -> float:
    """Slip rate, positive the way it slips; a pair without a rate slips on."""
    rates = point.rates(drive)
    return 1.0 if rates is None else _grip(point, k).slip * slip_rate(point, rates, k) / point.model.length


def _roundness(point: Point, k: int, _drive: Drive) -> float:
    """Curvature ``theta'/(1 + e)``, ``theta' = m/EI``, by which the beam may still bend round the node, over 1/d."""
    pair, touch, system = point.model.pairs[k], _touch(point.state, k), point.system
    forces, push = system.groups[pair.group.number], system.forces[k]
    curvature = -pair.side * pair.group.curvature(k, touch, point.state, forces, push)
    return 1.0 - abs(pair.reach_at(pair.arc_position(touch))) * curvature


def _gap(point: Point, k: int, _drive: Drive) -> float:
    pair, length = point.model.pairs[k], point.model.length
    seen = pair.group.project(pair, point.state)
    return seen.gap / length if seen.overshoot <= ROUND_OFF * length else 1.0


def _close(point: Point, state: State, margin: Margin, _alone: bool) -> State:
    """State with an open pair closed without force. A pair whose node is on the far side stays open and may not close (not armed)."""
    k, model = margin.pair, point.model
    if margin.value < -ROUND_OFF:
        return changed(model, state, k, None, armed=False)
    pair = model.pairs[k]
    return changed(model, state, k, closed_at(pair, pair.group.project(pair, state)), armed=True)


def _open(point: Point, state: State, margin: Margin, alone: bool) -> State | Status:
    k, kind, pair = margin.pair, margin.kind, point.model.pairs[margin.pair]
    refused = forbidden(point.model, kind, pair, pair.arc_position(_touch(state, k)), alone=alone)
    return refused or changed(point.model, state, k, None, armed=kind is EventKind.RELEASE)


def _turn(point: Point, state: State, margin: Margin, _alone: bool) -> State:
    return with_grips(state, ((margin.pair, turned(point, margin.pair)),))


def _end(_point: Point, _state: State, margin: Margin, _alone: bool) -> Status:
    return Status[margin.kind.name]


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
        lambda point, k, _: cone(point, k) / point.model.force_scale,
        _turn,
    ),
    Watch(EventKind.LINE_CONTACT, lambda point, k: _closed(point, k) and _thick(point, k), _roundness, _end),
    Watch(EventKind.TOUCH, lambda point, k: not _closed(point, k) and point.state.armed[k], _gap, _close),
)
"""The events of a contact."""


def margins(point: Point, drive: Drive) -> list[Margin]:
    """Margins of the events that may come next, under what changes on the way; computed once for each change."""
    if drive not in point.margins:
        point.margins[drive] = _margins(point, drive)
    return point.margins[drive]


def _margins(point: Point, drive: Drive) -> list[Margin]:
    return [
        Margin(watch.kind, k, watch.margin(point, k, drive))
        for k in range(len(point.model.pairs))
        for watch in WATCHES
        if watch.awaited(point, k)
    ]


def applied(point: Point, state: State, margin: Margin, *, alone: bool) -> State | Status:
    """State after an event at a point, or why the path ends there; `alone` if no contact takes over."""
    watch = next(watch for watch in WATCHES if watch.kind is margin.kind)
    return watch.apply(point, state, margin, alone)


def least_push(newton: Newton, k: int) -> float:
    """Tensile contact force that is round-off: of the touched beam, which may be far softer than others, unless a beam's end touches it."""
    pair = newton.model.pairs[k]
    beam, section = pair.target.beam, pair.target.beam.section
    own = max(ROUND_OFF, newton.tolerance) * section.EI / beam.length**2
    noise = scales.ROUND_OFF * section.EA * beam.elements
    return max(own, noise if pair.node < 0 else newton.noise * newton.model.least_force)
