"""Equilibrium at one load parameter: Newton's method with a fixed set of closed contacts, and an active-set iteration around it."""

from dataclasses import dataclass, replace

import numpy as np

from fem_reference.contact.contact import Touch
from fem_reference.contact.end_section import ROTATION
from fem_reference.contact.friction import mapped, slipping
from fem_reference.statement.arrays import Floats, determinant
from fem_reference.statement.status import Status
from fem_reference.system.state import State, imbalance
from fem_reference.system.system import Correction, Tangent, linearise

_LARGEST_GROWTH, _SMALLEST_DAMPING = 5.0, 1 / 64
"""Growth from a correction to the next beyond which only half of the first one is taken, and the least part that is taken."""
_MAX_CONTACT_CHANGES, _MAX_AUGMENTATIONS = 6, 12
"""Largest numbers of changes of the set of closed contacts, and of augmented Lagrangian steps, in one attempt."""
_MAX_PENETRATION = 1e-3
"""Largest accepted penetration, relative to the strip's length."""
_BALANCE = 1e-6
"""Largest accepted imbalance of reactions, contact forces and loads, relative to `State.force_scale`."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Attempt:
    """Result of one search for equilibrium."""

    status: Status  # outcome
    state: State  # last state
    iterations: int = 0  # number of linear solutions
    pair: int | None = None  # index of the contact that the status refers to, or None


@dataclass(frozen=True, kw_only=True, eq=False)
class Control:
    """Displacement control: ``c . (u - origin) = delta`` is prescribed, and the load parameter is an unknown."""

    origin: Floats  # displacements ``(n, 2)`` [m]
    c: Floats  # unit vector ``(n, 2)``
    delta: float  # displacement along it [m]

    def missing(self, state: State) -> float:
        """What a state lacks of the prescribed displacement [m]."""
        return self.delta - float(np.sum(self.c * (state.u - self.origin)))

    def completed(self, tangent: Tangent, correction: Correction) -> Correction | None:
        """Correction with the change of the load parameter that gives the prescribed displacement; None if it is not finite."""
        t = tangent.state.t
        rate = tangent.rate(t, t + tangent.state.model.settings.min_step)
        along = 0.0 if rate is None else float(np.sum(self.c * rate.u))
        dt = (self.missing(tangent.state) - float(np.sum(self.c * correction.u))) / along if along else np.inf
        if rate is None or not np.isfinite(dt):
            return None
        return Correction(u=correction.u + dt * rate.u, forces=correction.forces + dt * rate.forces, t=dt)


def iterate(state: State, control: Control | None = None) -> Attempt:
    """Iterate with a fixed set of closed contacts; never raises.

    If a correction is larger than the previous one by `_LARGEST_GROWTH`, the previous step is repeated with half
    its length (natural monotonicity test, Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3).
    """
    most = state.model.settings.max_iterations
    base, last, size, damping = state, Correction(u=0 * state.u, forces=0 * state.forces), np.inf, 1.0
    for iteration in range(most + 1):
        attempt = judged(state)
        done = control is None or abs(control.missing(state)) <= displacement_tolerance(state)
        if attempt.status is Status.CONVERGED and not done:
            attempt = replace(attempt, status=Status.ITERATION_LIMIT)
        if attempt.status is not Status.ITERATION_LIMIT or iteration == most:
            break
        tangent = linearise(state)
        correction = None if tangent is None else tangent.correction()
        if control is not None and tangent is not None and correction is not None:
            correction = control.completed(tangent, correction)
        if correction is None:
            attempt = replace(attempt, status=Status.SINGULAR)
            break
        following = float(np.abs(correction.u).max())
        if following > _LARGEST_GROWTH * size and damping > _SMALLEST_DAMPING:
            damping /= 2
        else:
            base, last, size, damping = state, correction, following, 1.0
        state = corrected(base, last, damping)
    return replace(attempt, iterations=iteration)


def corrected(state: State, correction: Correction, damping: float = 1.0) -> State:
    """Return the state after ``damping`` times a correction."""
    u, forces = state.u + damping * correction.u, state.forces + damping * correction.forces
    return state.moved(u, state.t + damping * correction.t, forces)


def displacement_tolerance(state: State) -> float:
    """Difference of two states' displacements [m] that Newton's tolerance allows."""
    return 10 * state.model.settings.tolerance * state.model.length


def judged(state: State) -> Attempt:
    """Attempt that ends with this iterate: its status is ``ITERATION_LIMIT`` if another iteration is needed."""
    model = state.model
    error = float(np.abs(state.reduced).max())
    errors = np.abs(state.residuals)
    if not np.isfinite(error + errors.sum()):
        return Attempt(status=Status.NOT_FINITE, state=state)
    for number, touch in enumerate(state.touches):
        if touch.closed and not (touch.at.stationary or touch.at.inside):
            return Attempt(status=Status.LOST_CONTACT, state=state, pair=number)
    force, length = tolerances(state)
    turning = [(tie.component == ROTATION, model.sections[tie.section].height) for tie in model.ties]
    limits = [
        *(force / touch.pair.penalty + model.length_round_off for touch in state.closed),
        *(force if touch.direction else length for touch in state.rubbing),
        *(2 * length / height if turns else length for turns, height in turning),
    ]
    done = error <= force + model.round_off and bool(np.all(errors <= limits))
    done = done and all(touch.at.stationary for touch in state.closed)
    return Attempt(status=Status.CONVERGED if done else Status.ITERATION_LIMIT, state=state)


def tolerances(state: State) -> tuple[float, float]:
    """Force [N] and displacement [m] that Newton's method leaves."""
    force = state.model.settings.tolerance * state.force_scale
    return force, force / state.model.axial_stiffness + state.model.length_round_off


@np.errstate(all="ignore")  # values that are not finite become a status
def equilibrium(guess: State, *, keep_set: bool = False) -> Attempt:
    """Find the equilibrium with unilateral contact at the load parameter of ``guess``; never raises.

    Newton's method converges with a fixed set of closed contacts. Only then is the set revised and the method repeated: the gaps of
    unconverged iterates open and close no contact. Augmented Lagrangian steps come last. With ``keep_set`` the set of the guess is kept.
    """
    state = guess
    if not keep_set:
        state = guess.touching([_closed_if_penetrated(guess, touch) for touch in guess.touches])
    tried, iterations, augmentations = [state.contact_set], 0, 0
    while True:
        attempt = iterate(state)
        iterations += attempt.iterations
        attempt = replace(attempt, iterations=iterations)
        if attempt.status is not Status.CONVERGED:
            return attempt
        state = attempt.state
        following = state if keep_set else revised(state)
        if following.contact_set != state.contact_set:
            changed = next(i for i, now in enumerate(following.contact_set) if now != state.contact_set[i])
            if following.contact_set in tried:
                return replace(attempt, status=Status.CYCLING, pair=changed)
            if len(tried) > _MAX_CONTACT_CHANGES:
                return replace(attempt, status=Status.UNDECIDED_CONTACT, pair=changed)
            state = following
            tried.append(state.contact_set)
            continue
        deep = [number for number, touch in enumerate(state.touches) if _exceeds_penetration(touch)]
        if not deep:
            return _verified(attempt)
        if augmentations == _MAX_AUGMENTATIONS:
            return replace(attempt, status=Status.AUGMENTATION_LIMIT, pair=deep[0])
        augmentations += 1
        state = state.touching(tuple(map(augmented, state.touches)))


def revised(state: State) -> State:
    """Return a converged state with contacts that open, close, stick or slip where their conditions do not hold."""
    force, length = tolerances(state)
    touches = []
    for touch in state.touches:
        if touch.closed and touch.force < 0:
            touches.append(touch.opened())
        elif touch.rubs:
            touches.append(mapped(touch, (length, force)))
        else:
            touches.append(_closed_if_penetrated(state, touch))
    return state.touching(touches)


def _closed_if_penetrated(state: State, touch: Touch) -> Touch:
    """Close an open contact whose penetration exceeds round-off. With friction it slips at first, as it slid while it was open."""
    if touch.closed or not touch.armed or touch.reported_gap >= -state.model.length_round_off:
        return touch
    return replace(slipping(touch), closed=True)


def _exceeds_penetration(touch: Touch) -> bool:
    """Whether another augmented Lagrangian step is needed."""
    allowed = touch.pair.contact.penetration
    return touch.closed and allowed is not None and abs(touch.gap) > allowed * touch.pair.length


def augmented(touch: Touch) -> Touch:
    """Set the multiplier to the contact force where the penetration is to be removed."""
    return replace(touch, multiplier=touch.force) if touch.augmented else touch


def _verified(attempt: Attempt) -> Attempt:
    """Check elements, slip-off, penetration and balance of a converged state, and set which open contacts may close, see `Touch.armed`."""
    state, model, touches = attempt.state, attempt.state.model, list[Touch]()
    if any((determinant(F) <= 0).any() for F in state.gradients):
        return replace(attempt, status=Status.INVERTED)
    for number, touch in enumerate(state.touches):
        behind, inside = touch.gap < -model.length_round_off, touch.at.inside
        # a node that goes round the end of an axis has left it; the ends of a thick strip are met
        went_round = touch.armed and behind and touch.pair.contact.keep and not touch.pair.ends
        if not inside and (touch.closed or went_round):
            return replace(attempt, status=Status.LOST_CONTACT, pair=number)
        if touch.closed and -touch.gap > _MAX_PENETRATION * touch.pair.length:
            return replace(attempt, status=Status.TOO_DEEP, pair=number)
        # a node beyond an end on the far side has slipped round it, and is armed again when it is back on its side
        armed = touch.armed if touch.closed else not behind or (inside and touch.armed)
        touches.append(touch if armed == touch.armed else replace(touch, armed=armed))
    if imbalance(state) > _BALANCE * state.force_scale + model.balance_round_off:
        return replace(attempt, status=Status.UNBALANCED)
    return replace(attempt, state=state.touching(touches))
