"""Events of a scene with friction: a node touches or leaves, a slip comes to rest, or a contact that sticks begins to slip.

Slip counts from accepted states, and a contact sticks where its slip came to rest. An accepted state therefore lies at every
such event, so that the answer does not depend on the load steps.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, isfinite, nan

from fem_reference.active_set import equilibrium, revised
from fem_reference.dissipation import slip_rates
from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.state import State, with_conditions
from fem_reference.status import Status
from fem_reference.touch import Touch
from fem_reference.track import Accepted, accept, predict

_MAX_STEPS = 80
_PRECISION = 1e-14
"""Interval of the load parameter at which a search ends."""
_VANISHED = 1e-9
"""Value at which a search ends, relative to the one at the beginning of the step."""
_COINCIDENT = 1e-4
"""Interval of the load parameter in which different events may be simultaneous."""
_TOUCHING = 1e-9
"""Gap of a contact that touches, over the strip's length, and force of one that leaves, over the scale of forces."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SlipEvent:
    """A contact's change to stick, or to slip in a ``direction``; None for a touch and a release."""

    # pair, direction: index of the contact, and the direction 1 or -1 in which its node slips afterwards; 0
    # where it sticks
    pair: int
    direction: int | None
    at: Accepted  # accepted state at the event
    first: bool = True  # whether no other contact opens or closes, sticks or slips before


def first_slip_event(
    model: Model, last: Accepted, candidate: Accepted, settings: Settings
) -> SlipEvent | None:
    """Locate the first event between an accepted state and the next one; None without an event, and in a scene without friction.

    Within a step shorter than `_COINCIDENT` other changes that come first count as simultaneous, and the event is not located.
    """
    if all(condition.friction is None for condition in last.state.conditions):
        return None
    events = [
        event
        for number, touch in enumerate(last.state.touches)
        if (event := _event(model, last, candidate, number, settings)) is not None
    ]
    if not events:
        return None
    event = min(events, key=lambda event: event.at.state.t)
    here, now = event.at.state.contact_set, revised(model, event.at.state, settings).contact_set
    if all(a == b for number, (a, b) in enumerate(zip(here, now, strict=True)) if number != event.pair):
        return event
    short = candidate.state.t - last.state.t < _COINCIDENT
    return None if short else replace(event, first=False)


def _slip_rate(at: Accepted, pair: int, *, forward: bool) -> float:
    """Rate of slip of a closed contact [m]; nan if it is singular."""
    rates = slip_rates(at.tangent, pair, forward=forward)
    return nan if rates is None else rates[0]


def _event(
    model: Model, last: Accepted, candidate: Accepted, pair: int, settings: Settings
) -> SlipEvent | None:
    """Locate the event of one contact."""
    before, after = last.state.touches[pair], candidate.state.touches[pair]
    if before.closed != after.closed:
        expected = _touch(model, last, pair)
    elif before.friction is None or after.friction is None:
        return None
    elif before.friction.direction:
        expected = _rest(last, candidate, pair)
    else:
        expected = _start(pair, after.friction.direction)
    if expected is None:
        return None
    value, direction = expected
    at = last if value(last) < 0 else _root(model, last, candidate.state.t, value, settings)
    if at is None or direction is None:
        return None if at is None else SlipEvent(pair=pair, direction=None, at=at)
    conditions = list(at.state.conditions)
    friction = conditions[pair].friction
    assert friction is not None, "a contact keeps its friction"
    conditions[pair] = replace(conditions[pair], friction=replace(friction, direction=direction))
    changed = accept(model, with_conditions(at.state, tuple(conditions)), settings)
    return None if changed is None else SlipEvent(pair=pair, direction=direction, at=changed)


Expected = tuple[Callable[[Accepted], float], int | None]
"""A value that is positive before an event and vanishes there, and the direction of slip from there on."""


def about_to_change(model: Model, touch: Touch) -> bool:
    """Whether an open contact touches without force, or a closed one bears none."""
    if touch.closed:
        return touch.force <= _TOUCHING * model.force_scale
    return touch.gap <= _TOUCHING * model.problem.strips[touch.pair.strips[0]].length


def _touch(model: Model, last: Accepted, pair: int) -> Expected | None:
    """Return the gap of an open contact, or the force of a closed one; None if it is zero already."""
    touch = last.state.touches[pair]
    if about_to_change(model, touch):
        return None
    return (lambda at: at.state.touches[pair].force if touch.closed else at.state.touches[pair].gap), None


def _rest(last: Accepted, candidate: Accepted, pair: int) -> Expected | None:
    """Return the rate of a slip that comes to rest, at the last state at a corner of a pin's path; None if it does not."""
    (_, sign), (_, following) = (at.state.contact_set[pair] for at in (last, candidate))
    rests = (
        sign * _slip_rate(candidate, pair, forward=False) < 0 < sign * _slip_rate(last, pair, forward=True)
    )
    if not rests and following == sign:
        return None
    return lambda at: sign * _slip_rate(at, pair, forward=at is last), 0


def _start(pair: int, direction: int) -> Expected | None:
    """Return the tangential force that a contact bears until it slips in a direction; None if it sticks."""
    return (lambda at: _margin(at.state, pair, direction), direction) if direction else None


def _margin(state: State, pair: int, direction: int) -> float:
    """Tangential force that a contact bears until it slips in a direction [N]."""
    touch = state.touches[pair]
    return touch.pair.contact.friction * touch.force - direction * touch.tangential_force


def _root(
    model: Model,
    last: Accepted,
    end: float,
    value: Callable[[Accepted], float],
    settings: Settings,
) -> Accepted | None:
    """Accepted state with the contact set of ``last`` at which a positive ``value`` vanishes up to ``end``; None without one.

    Regula falsi in Illinois' form between the states with a positive and a negative value. A state that does not converge
    counts as one beyond the root.
    """
    low, v_low, high, v_high = last, value(last), end, -inf
    vanished, side = _VANISHED * v_low, 0
    for _ in range(_MAX_STEPS):
        width = high - low.state.t
        if width <= _PRECISION:
            break
        share = v_low / (v_low - v_high) if isfinite(v_high) else 0.5
        t = end if _ == 0 else low.state.t + min(max(share, 1e-6), 1 - 1e-6) * width
        at = same_set(model, low, t, settings)
        v = -inf if at is None else value(at)
        if at is not None and v > 0:
            if t == end:
                return None
            low, v_low = at, v
            v_high = v_high / 2 if side > 0 else v_high
            side = 1
        else:
            high, v_high = t, v
            v_low = v_low / 2 if side < 0 else v_low
            side = -1
        if at is not None and abs(v) <= vanished:
            return at
    return low


def same_set(model: Model, last: Accepted, t: float, settings: Settings) -> Accepted | None:
    """Equilibrium at ``t`` with the contact set of a state before; None if it does not converge."""
    attempt = equilibrium(model, predict(model, (last,), t, 1), settings, keep_set=True)
    return accept(model, attempt.state, settings, last) if attempt.status is Status.CONVERGED else None
