"""Newton's method with every contact held open or closed; displacements and contact forces are its unknowns."""

from dataclasses import dataclass, replace

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.state import State, residual, state
from fem_reference.status import Status
from fem_reference.tangent import Correction, linearise


@dataclass(frozen=True, kw_only=True, eq=False)
class Attempt:
    """What one search for equilibrium ended with.

    Parameters
    ----------
    status, state
        How it ended, and the last state.
    iterations
        Number of linear solutions.
    pair
        Number of the contact that the status is about; None if it is about none.
    """

    status: Status
    state: State
    iterations: int
    pair: int | None = None


def iterate(model: Model, at: State, settings: Settings) -> Attempt:
    """Iterate with the contacts held as they are; never raises.

    A correction that the next one exceeds was too long: the iteration goes back and takes half of it (the natural
    monotonicity test, Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3).
    """
    base, last, damping = at, Correction(u=np.full((1, 2), np.inf), forces=np.zeros(0)), 1.0
    for iteration in range(settings.max_iterations + 1):
        R = model.expansion.T @ residual(model, at).ravel()
        status, pair = judge(model, at, R, settings)
        if status is not Status.ITERATION_LIMIT or iteration == settings.max_iterations:
            break
        tangent = linearise(model, at)
        found = None if tangent is None else tangent.correction(R)
        if found is None:
            status = Status.SINGULAR
            break
        if found.size > settings.largest_growth * last.size and damping > settings.smallest_damping:
            damping /= 2
        else:
            base, last, damping = at, found, 1.0
        at = moved(model, base, last, damping)
    return Attempt(status=status, state=at, iterations=iteration, pair=pair)


def judge(model: Model, at: State, R: Floats, settings: Settings) -> tuple[Status, int | None]:
    """Status of an iterate and the pair it is about; ``ITERATION_LIMIT`` as long as another iteration is wanted."""
    error = float(np.abs(R).max())
    mismatch = [abs(touch.mismatch) for touch in at.touches]
    if not np.isfinite(error + sum(mismatch)):
        return Status.NOT_FINITE, None
    for number, touch in enumerate(at.touches):
        if touch.closed and not touch.projection.stationary:
            return Status.LOST_CONTACT, number
    allowed = settings.tolerance * force_scale(model, at)
    wanted = error > allowed + model.round_off or any(
        miss > allowed / touch.pair.penalty + model.length_round_off
        for miss, touch in zip(mismatch, at.touches, strict=True)
    )
    return (Status.ITERATION_LIMIT if wanted else Status.CONVERGED), None


def force_scale(model: Model, at: State) -> float:
    """Largest of contact forces, end loads and ``E I / L^2`` [N]."""
    return max(model.force_scale, at.t * model.largest_load, *(abs(touch.force) for touch in at.touches))


def moved(model: Model, at: State, step: Correction, damping: float) -> State:
    """Return the state a part of a correction away."""
    forces = iter(damping * step.forces)
    conditions = tuple(
        replace(one, force=one.force + float(next(forces))) if one.closed else one for one in at.conditions
    )
    return state(model, at.u + damping * step.u, at.t, conditions)
