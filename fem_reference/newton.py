"""Newton's method for displacements and contact forces with a fixed set of closed contacts."""

from dataclasses import dataclass

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.end_section import ROTATION
from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.stages import amount
from fem_reference.state import State, build_state, residual, tie_residuals, with_contact_forces
from fem_reference.status import Status
from fem_reference.tangent import Correction, linearise

_SMALLEST_DAMPING = 1 / 64
"""Least part of a correction that is taken."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Attempt:
    """Result of one search for equilibrium."""

    status: Status  # status, state: outcome and last state
    state: State
    iterations: int  # number of linear solutions
    pair: int | None = None  # index of the contact that the status refers to, or None


def iterate(model: Model, state: State, settings: Settings) -> Attempt:
    """Iterate with a fixed set of closed contacts; never raises.

    If a correction is larger than the previous one by `Settings.largest_growth`, the previous step is repeated with half
    its length (natural monotonicity test, Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3).
    """
    base, last, damping = state, Correction(u=np.full((1, 2), np.inf), forces=np.zeros(0)), 1.0
    for iteration in range(settings.max_iterations + 1):
        R = model.restriction @ residual(model, state).ravel()
        status, pair = check_convergence(model, state, R, settings)
        if status is not Status.ITERATION_LIMIT or iteration == settings.max_iterations:
            break
        tangent = linearise(model, state)
        correction = None if tangent is None else tangent.correction(R)
        if correction is None:
            status = Status.SINGULAR
            break
        if correction.size > settings.largest_growth * last.size and damping > _SMALLEST_DAMPING:
            damping /= 2
        else:
            base, last, damping = state, correction, 1.0
        state = updated(model, base, last, damping)
    return Attempt(status=status, state=state, iterations=iteration, pair=pair)


def check_convergence(model: Model, state: State, R: Floats, settings: Settings) -> tuple[Status, int | None]:
    """Status of an iterate with the residual ``R`` ``(m,)``, and the pair that the status refers to.

    The status is ``ITERATION_LIMIT`` if another iteration is needed.
    """
    error = float(np.abs(R).max())
    gap_residuals = [abs(touch.gap_residual) for touch in state.touches]
    tie_residual = largest_tie_residual(model, state)
    slip_residuals = [abs(touch.slip_residual) for touch in state.rubbing]
    if not np.isfinite(error + sum(gap_residuals) + sum(slip_residuals) + tie_residual):
        return Status.NOT_FINITE, None
    for number, touch in enumerate(state.touches):
        if touch.closed and not (touch.projection.stationary or touch.projection.inside):
            return Status.LOST_CONTACT, number
    allowed = settings.tolerance * force_scale(model, state)
    allowed_slip = allowed / model.axial_stiffness + model.length_round_off
    converged = (
        tie_residual <= allowed_slip
        and all(touch.projection.stationary for touch in state.closed)
        and all(
            residual <= (allowed if touch.friction and touch.friction.direction else allowed_slip)
            for residual, touch in zip(slip_residuals, state.rubbing, strict=True)
        )
        and error <= allowed + model.round_off
        and all(
            gap_residual <= allowed / touch.pair.penalty + model.length_round_off
            for gap_residual, touch in zip(gap_residuals, state.touches, strict=True)
        )
    )
    return (Status.CONVERGED if converged else Status.ITERATION_LIMIT), None


def force_scale(model: Model, state: State) -> float:
    """Force that tolerances refer to: the largest of contact and tie forces, dead loads and ``E I / L^2`` [N].

    Moments count over the length of the longest strip.
    """
    ties = [
        abs(float(force)) / (model.length if tie.component == ROTATION else 1.0)
        for tie, force in zip(model.ties, state.tie_forces, strict=True)
    ]
    contacts = [abs(float(force)) for force in state.contact_forces]
    return max(model.force_scale, float(amount(model.largest_loads, state.t)), *contacts, *ties)


def largest_tie_residual(model: Model, state: State) -> float:
    """Largest residual of the ties; an angle counts times half the section's height [m]."""
    arms = [
        model.sections[tie.section].height / 2 if tie.component == ROTATION else 1.0 for tie in model.ties
    ]
    return float(np.abs(tie_residuals(model, state) * arms).max(initial=0.0))


def updated(model: Model, state: State, correction: Correction, damping: float) -> State:
    """Return the state after ``damping`` times a correction."""
    changes, forces = damping * correction.forces, state.contact_forces
    conditions = with_contact_forces(state.conditions, forces + changes[: forces.size])
    ties = state.tie_forces + changes[forces.size :]
    return build_state(model, state.u + damping * correction.u, state.t, conditions, ties)
