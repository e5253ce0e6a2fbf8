"""Equilibrium at one load parameter: which contacts act is settled around Newton's method."""

from dataclasses import replace

import numpy as np

from fem_reference.model import Model
from fem_reference.newton import Attempt, force_scale, iterate
from fem_reference.settings import Settings
from fem_reference.state import Condition, State, Touch, imbalance, with_conditions
from fem_reference.status import Status


@np.errstate(all="ignore")  # what is not finite becomes a status
def equilibrium(model: Model, guess: State, settings: Settings) -> Attempt:
    """Find the equilibrium at the load parameter of ``guess``, unilateral contact included; never raises.

    Newton's method keeps the contacts as they are; at its end those that pull are opened, those that are penetrated are
    closed, and it goes on, so that an overshoot of a gap does not make it cycle. A set that comes back is cycling.
    Augmented Lagrangian steps follow once the set is settled.
    """
    at = with_conditions(guess, tuple(_closing(model, touch) for touch in guess.touches))
    attempt = Attempt(status=Status.UNDECIDED_CONTACT, state=at, iterations=0)
    tried, iterations, augmentations = [_set(at)], 0, 0
    while True:
        attempt = iterate(model, at, settings)
        iterations += attempt.iterations
        attempt = replace(attempt, iterations=iterations)
        if attempt.status is not Status.CONVERGED:
            return attempt
        at = attempt.state
        settled = with_conditions(at, tuple(_settled(model, touch) for touch in at.touches))
        if _set(settled) != _set(at):
            changed = next(
                i for i, touch in enumerate(settled.touches) if touch.closed != at.touches[i].closed
            )
            if _set(settled) in tried:
                return replace(attempt, status=Status.CYCLING, pair=changed)
            if len(tried) > settings.max_contact_changes:
                return replace(attempt, status=Status.UNDECIDED_CONTACT, pair=changed)
            at = settled
            tried.append(_set(at))
            continue
        deep = [number for number, touch in enumerate(at.touches) if _too_deep(model, touch)]
        if not deep:
            return _checked(model, attempt, settings)
        if augmentations == settings.max_augmentations:
            return replace(attempt, status=Status.AUGMENTATION_LIMIT, pair=deep[0])
        augmentations += 1
        at = with_conditions(at, tuple(_augmented(touch) for touch in at.touches))


def _set(at: State) -> tuple[bool, ...]:
    return tuple(touch.closed for touch in at.touches)


def _closing(model: Model, touch: Touch) -> Condition:
    """Close an open contact that is penetrated."""
    if touch.closed or not _penetrated(model, touch):
        return touch.condition
    return replace(touch.condition, closed=True)


def _settled(model: Model, touch: Touch) -> Condition:
    """Open a closed contact that pulls, close an open one that is penetrated by more than round-off."""
    if touch.closed and touch.force < 0:
        return touch.condition.opened(armed=True)
    return _closing(model, touch)


def _penetrated(model: Model, touch: Touch) -> bool:
    return touch.condition.armed and touch.shown_gap < -model.length_round_off


def _too_deep(model: Model, touch: Touch) -> bool:
    wanted = touch.pair.contact.penetration
    return touch.closed and wanted is not None and abs(touch.gap) > wanted * _length(model, touch)


def _length(model: Model, touch: Touch) -> float:
    return model.problem.strips[touch.pair.strips[0]].length


def _augmented(touch: Touch) -> Condition:
    wanted = touch.closed and touch.pair.contact.penetration is not None
    return replace(touch.condition, multiplier=touch.force) if wanted else touch.condition


def _checked(model: Model, attempt: Attempt, settings: Settings) -> Attempt:
    """Judge a converged state by what it means."""
    at = attempt.state
    for number, touch in enumerate(at.touches):
        outside = not touch.projection.inside
        # Past an end the node may only be on the side it came from; on the other one it has slipped round the end.
        slipped = touch.condition.armed and touch.gap < -model.length_round_off and touch.pair.contact.keep
        if outside and (touch.closed or slipped):
            return replace(attempt, status=Status.LOST_CONTACT, pair=number)
        if touch.closed and -touch.gap > settings.max_penetration * _length(model, touch):
            return replace(attempt, status=Status.TOO_DEEP, pair=number)
    # A sum over the nodes gathers their round-off like a random walk.
    floor = np.sqrt(at.u.size) * model.round_off
    if imbalance(model, at) > settings.balance_tolerance * force_scale(model, at) + floor:
        return replace(attempt, status=Status.UNBALANCED)
    armed = tuple(_rearmed(model, touch) for touch in at.touches)
    return replace(attempt, state=with_conditions(at, armed))


def _rearmed(model: Model, touch: Touch) -> Condition:
    """A node beyond an end on the far side has left the strip; it may touch again once it is back on its side."""
    if touch.closed:
        return touch.condition
    ahead = touch.gap >= -model.length_round_off
    if touch.projection.inside:
        return replace(touch.condition, armed=touch.condition.armed or ahead)
    return replace(touch.condition, armed=ahead)
