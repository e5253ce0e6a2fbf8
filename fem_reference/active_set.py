"""Equilibrium at one load parameter by an active-set iteration around Newton's method."""

from dataclasses import replace

import numpy as np

from fem_reference.friction import mapped
from fem_reference.model import Model
from fem_reference.newton import Attempt, force_scale, iterate
from fem_reference.settings import Settings
from fem_reference.state import State, imbalance, with_conditions
from fem_reference.status import Status
from fem_reference.touch import Condition, Touch

_BALANCE = 1e-6
"""Largest accepted imbalance of reactions, contact forces and end loads, relative to the same force as `Settings.tolerance`."""


@np.errstate(all="ignore")  # values that are not finite become a status
def equilibrium(model: Model, guess: State, settings: Settings, *, keep_set: bool = False) -> Attempt:
    """Find the equilibrium with unilateral contact at the load parameter of ``guess``; never raises.

    Newton's method converges with a fixed set of closed contacts. Then contacts with tensile force are opened, penetrated
    open contacts are closed, friction is mapped to its cone, and Newton's method is repeated, so that gaps of unconverged
    iterates cause no change. A set that was tried before ends the iteration with `Status.CYCLING`. Augmented Lagrangian
    steps follow when the set no longer changes. With ``keep_set`` the set of the guess is kept.
    """
    state = guess
    if not keep_set:
        state = with_conditions(guess, tuple(_closed_if_penetrated(model, touch) for touch in guess.touches))
    tried, iterations, augmentations = [state.contact_set], 0, 0
    while True:
        attempt = iterate(model, state, settings)
        iterations += attempt.iterations
        attempt = replace(attempt, iterations=iterations)
        if attempt.status is not Status.CONVERGED:
            return attempt
        state = attempt.state
        following = state if keep_set else revised(model, state, settings)
        if following.contact_set != state.contact_set:
            changed = next(i for i, now in enumerate(following.contact_set) if now != state.contact_set[i])
            if following.contact_set in tried:
                return replace(attempt, status=Status.CYCLING, pair=changed)
            if len(tried) > settings.max_contact_changes:
                return replace(attempt, status=Status.UNDECIDED_CONTACT, pair=changed)
            state = following
            tried.append(state.contact_set)
            continue
        deep = [number for number, touch in enumerate(state.touches) if _exceeds_penetration(model, touch)]
        if not deep:
            return _verified(model, attempt, settings)
        if augmentations == settings.max_augmentations:
            return replace(attempt, status=Status.AUGMENTATION_LIMIT, pair=deep[0])
        augmentations += 1
        state = with_conditions(state, tuple(_augmented(touch) for touch in state.touches))


def _closed_if_penetrated(model: Model, touch: Touch) -> Condition:
    """Close an open contact that is penetrated by more than round-off. With friction it first slips as it did while open."""
    if touch.closed or not _penetrated(model, touch):
        return touch.condition
    return replace(slipping(touch), closed=True)


def slipping(touch: Touch) -> Condition:
    """Condition of a contact that slips as it has slid since the last accepted state."""
    friction = touch.condition.friction
    if friction is None:
        return touch.condition
    return replace(touch.condition, friction=replace(friction, direction=int(np.sign(touch.slip))))


def revised(model: Model, state: State, settings: Settings) -> State:
    """Return a converged state with contacts that open, close, stick or slip where their conditions do not hold."""
    allowed = settings.tolerance * force_scale(model, state)
    slip = allowed / model.axial_stiffness + model.length_round_off
    return with_conditions(state, tuple(_revised(model, touch, (slip, allowed)) for touch in state.touches))


def _revised(model: Model, touch: Touch, allowed: tuple[float, float]) -> Condition:
    """Open a closed contact with tensile force; close a penetrated open contact; map friction with ``allowed`` errors."""
    if touch.closed and touch.force < 0:
        return touch.condition.opened(armed=True)
    if touch.friction is not None:
        largest = touch.pair.contact.friction * touch.force
        return replace(touch.condition, friction=mapped(touch.friction, touch.slip, largest, allowed))
    return _closed_if_penetrated(model, touch)


def _penetrated(model: Model, touch: Touch) -> bool:
    return touch.condition.armed and touch.reported_gap < -model.length_round_off


def _exceeds_penetration(model: Model, touch: Touch) -> bool:
    """Whether another augmented Lagrangian step is needed."""
    allowed = touch.pair.contact.penetration
    return touch.closed and allowed is not None and abs(touch.gap) > allowed * _length(model, touch)


def _length(model: Model, touch: Touch) -> float:
    return model.problem.strips[touch.pair.strips[0]].length


def _augmented(touch: Touch) -> Condition:
    """Set the multiplier to the contact force where the penetration is to be removed."""
    augmented = touch.closed and touch.pair.contact.penetration is not None
    return replace(touch.condition, multiplier=touch.force) if augmented else touch.condition


def _verified(model: Model, attempt: Attempt, settings: Settings) -> Attempt:
    """Check slip-off, penetration and global balance of a converged state."""
    state = attempt.state
    for number, touch in enumerate(state.touches):
        outside = not touch.projection.inside
        # Beyond an end a node on the far side of the strip has slipped round the end.
        slipped = touch.condition.armed and touch.gap < -model.length_round_off and touch.pair.contact.keep
        if outside and (touch.closed or slipped):
            return replace(attempt, status=Status.LOST_CONTACT, pair=number)
        if touch.closed and -touch.gap > settings.max_penetration * _length(model, touch):
            return replace(attempt, status=Status.TOO_DEEP, pair=number)
    allowed = _BALANCE * force_scale(model, state) + model.balance_round_off
    if imbalance(model, state) > allowed:
        return replace(attempt, status=Status.UNBALANCED)
    conditions = tuple(_rearmed(model, touch) for touch in state.touches)
    return replace(attempt, state=with_conditions(state, conditions))


def _rearmed(model: Model, touch: Touch) -> Condition:
    """Disarm a node that is beyond an end on the far side; arm it again when it has returned to its side."""
    if touch.closed:
        return touch.condition
    on_its_side = touch.gap >= -model.length_round_off
    if touch.projection.inside:
        return replace(touch.condition, armed=touch.condition.armed or on_its_side)
    return replace(touch.condition, armed=on_its_side)
