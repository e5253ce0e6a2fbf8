"""Events on the way: the changes of contacts, and where within a step they are.

In a scene with friction slip counts from accepted states. One lies therefore where a node touches or leaves, a slip comes to rest, or a
contact that sticks begins to slip, so that the answer does not depend on the load steps.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fem_reference.contact.contact import Touch
from fem_reference.path.track import Accepted, accept, located
from fem_reference.system.newton import revised
from fem_reference.system.state import State

TOUCH, RELEASE, SLIP, STICK, SLIP_OFF = "touch", "release", "slip", "stick", "slip-off"
"""Kinds of events."""
_COINCIDENT = 1e-4
"""Interval of the load parameter in which different events may be simultaneous."""
_TOUCHING = 1e-9
"""Gap of a contact that touches, over the strip's length, and force of one that leaves, over the scale of forces."""


@dataclass(frozen=True, kw_only=True)
class ContactEvent:
    """A change of a contact."""

    kind: str  # ``"touch"``, ``"release"``, ``"slip"``, ``"stick"`` or ``"slip-off"``
    pair: int  # index of the contact
    load_parameter: float  # with friction in the scene that of the event, else of the next accepted state
    arc_position: float  # coordinate before the event [m]
    force: float  # magnitude of the force before the event [N]
    direction: int  # direction of the slip behind it, 1 or -1; 0 without slip


def contact_event(kind: str, touch: Touch, pair: int, t: float, direction: int) -> ContactEvent:
    """Return an event of a contact that was in a state before."""
    force, arc = float(np.hypot(touch.force, touch.tangential)), touch.at.zeta
    return ContactEvent(
        kind=kind, pair=pair, load_parameter=t, arc_position=arc, force=force, direction=direction
    )


def changes(before: State, after: State) -> Iterator[ContactEvent]:
    """Events by which the contacts of an accepted state became those of the next one."""
    for pair, (old, new) in enumerate(zip(before.touches, after.touches, strict=True)):
        if old.closed != new.closed:
            met = _about_to_change(before, old)
            kind, at = (TOUCH if new.closed else RELEASE), (old if met or old.closed else new)
            yield contact_event(kind, at, pair, before.t if met else after.t, new.direction)
        elif old.direction != new.direction:
            yield contact_event(SLIP if new.direction else STICK, new, pair, after.t, new.direction)


def _about_to_change(state: State, touch: Touch) -> bool:
    """Whether an open contact touches without force, or a closed one bears none."""
    if touch.closed:
        return touch.force <= _TOUCHING * state.model.force_scale
    return touch.gap <= _TOUCHING * touch.pair.length


Event = tuple[int, Callable[[Accepted], float], int | None]
"""A contact, a value that is positive before its change and vanishes there, and the direction of the slip from there on."""


def first_event(last: Accepted, candidate: Accepted) -> tuple[Accepted, int | None] | None:
    """State at the first event between two accepted states, and a contact that changes before; None without one."""
    found = list[tuple[Accepted, int]]()
    for pair, margin, direction in _expected(last, candidate):
        at = located(last, candidate.t, margin)
        # a slip does not hide a bifurcation before it
        if at is not None and direction is not None and at.index <= max(last.index, 0):
            touches = list(at.state.touches)
            touches[pair] = replace(touches[pair], direction=direction)
            at = accept(at.state.touching(touches))
        if at is not None:
            found.append((at, pair))
    if not found:
        return None
    at, pair = min(found, key=lambda one: one[0].t)
    now = revised(at.state).contact_set
    if all(a == b for k, (a, b) in enumerate(zip(at.state.contact_set, now, strict=True)) if k != pair):
        return at, None
    # in a short step such changes count as simultaneous, and are not located
    return None if candidate.t - last.t < _COINCIDENT else (at, pair)


def _expected(last: Accepted, candidate: Accepted) -> Iterator[Event]:
    """Events in a scene with friction, one for every contact that changes within a step."""
    touches = last.state.touches
    if all(touch.begin is None for touch in touches):
        return
    for pair, (before, after) in enumerate(zip(touches, candidate.state.touches, strict=True)):
        if before.closed != after.closed:
            if not _about_to_change(last.state, before):
                yield pair, partial(_apart, pair), None
        elif before.rubs and before.direction:
            # a slip comes to rest, at the last state at a corner of a pin's path, or goes on
            rate = partial(_speed, pair, before.direction, last)
            if after.direction != before.direction or rate(candidate) < 0 < rate(last):
                yield pair, rate, 0
        elif before.rubs and after.direction:
            yield pair, partial(_grip, pair, after.direction), after.direction


def _apart(pair: int, at: Accepted) -> float:
    """Force of a closed contact [N], or gap of an open one [m]."""
    touch = at.state.touches[pair]
    return touch.force if touch.closed else touch.gap


def _grip(pair: int, direction: int, at: Accepted) -> float:
    """Tangential force that a contact bears until it slips in a direction [N]."""
    touch = at.state.touches[pair]
    return touch.largest_tangential - direction * touch.tangential


def _speed(pair: int, direction: int, last: Accepted, at: Accepted) -> float:
    """Rate of slip in a direction [m]; at the state ``last`` behind a corner of a pin's path."""
    return direction * float(at.slip_rates(pair, forward=at is last)[0])


def clearance(state: State) -> tuple[float, int]:
    """Least clearance ``1 - R kappa`` of a closed contact, positive before it touches a round pin along a line, and its index."""
    found = [
        (1.0 - touch.pair.radius * touch.pair.contact.sign * touch.at.bend / touch.at.stretch**2, number)
        for number, touch in enumerate(state.touches)
        if touch.closed
    ]
    return min(found, default=(np.inf, -1))
