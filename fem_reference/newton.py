"""Equilibrium at one position of the pin: Newton's method, with the contact's status settled around it.

The unknowns are displacements and contact force; with U and H of the gap's derivatives and ``C = 1 / eps``,

    R = f - lam dg/du = 0,     g + C lam = 0,
    (K - lam U H U^T) du - dg/du dlam = -R,     dg/du . du + C dlam = -(g + C lam).

The sparse matrix that is factorised is the solid's own, K; the contact enters through the three columns of U.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import splu

from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.state import State, imbalance, residual, state
from fem_reference.status import Status


@dataclass(frozen=True, kw_only=True, eq=False)
class Attempt:
    """What one search for equilibrium ended with: its status, last state and number of linear solutions."""

    status: Status
    state: State
    iterations: int


@np.errstate(all="ignore")  # what is not finite becomes a status
def equilibrium(model: Model, guess: State, settings: Settings) -> Attempt:
    """Find the equilibrium with the pin where ``guess`` has it, unilateral contact included; never raises.

    Inside an iteration the contact is held closed or open; at its end a contact that pulls is opened, one that is
    penetrated is closed, and the iteration goes on, so that an overshoot of the gap does not make it cycle.
    """
    iterations = 0
    at = guess if guess.closed or not _contradicted(model, guess) else _switched(model, guess)
    for _ in range(settings.max_contact_changes + 1):
        attempt = _newton(model, at, settings)
        iterations += attempt.iterations
        at, status = attempt.state, attempt.status
        if status is not Status.CONVERGED or not _contradicted(model, at):
            break
        at = _switched(model, at)
    else:
        status = Status.UNDECIDED_CONTACT
    if status is Status.CONVERGED:
        status = _check(model, at, settings)
    return Attempt(status=status, state=at, iterations=iterations)


def _contradicted(model: Model, at: State) -> bool:
    """Whether a closed contact pulls or an open one is penetrated by more than round-off."""
    return at.force < 0 if at.closed else at.gap < -model.length_round_off


def _check(model: Model, at: State, settings: Settings) -> Status:
    """Judge a converged state by what it means."""
    # Past an end the pin may only be on the side it came from; on the other one it has slipped round the end.
    if not at.projection.inside and (at.closed or at.projection.gap < -model.length_round_off):
        return Status.LOST_CONTACT
    # A sum over the nodes gathers their round-off like a random walk.
    floor = np.sqrt(at.u.size) * model.round_off
    if imbalance(model, at) > settings.balance_tolerance * _force_scale(model, at) + floor:
        return Status.UNBALANCED
    return Status.CONVERGED


def _switched(model: Model, at: State) -> State:
    return state(model, at.u, at.pin, closed=not at.closed, force=0.0)


def _force_scale(model: Model, at: State) -> float:
    """Larger of contact force and ``E I / L^2`` [N]."""
    return max(abs(at.force), model.force_scale)


def _newton(model: Model, at: State, settings: Settings) -> Attempt:
    """Iterate with the contact held as it is."""
    unknowns = model.stiffness.unknowns
    for iteration in range(settings.max_iterations + 1):
        R = residual(model, at).ravel()[unknowns]
        status = _judge(model, at, R, settings)
        if status is not Status.ITERATION_LIMIT or iteration == settings.max_iterations:
            break
        correction = _correction(model, at, R)
        if correction is None:
            status = Status.SINGULAR
            break
        u = at.u.copy()
        u.reshape(-1)[unknowns] += correction[0]
        at = state(model, u, at.pin, closed=at.closed, force=at.force + correction[1])
    return Attempt(status=status, state=at, iterations=iteration)


def _judge(model: Model, at: State, R: Floats, settings: Settings) -> Status:
    """Status of an iterate; ``ITERATION_LIMIT`` as long as another iteration is wanted."""
    mismatch = abs(_contact_residual(model, at))
    error = float(np.abs(R).max())
    if not np.isfinite(error + mismatch):
        return Status.NOT_FINITE
    if at.closed and not at.projection.stationary:
        return Status.LOST_CONTACT
    allowed = settings.tolerance * _force_scale(model, at)
    if (
        error > allowed + model.round_off
        or mismatch > allowed / model.problem.contact.penalty + model.length_round_off
    ):
        return Status.ITERATION_LIMIT
    return Status.CONVERGED


def _contact_residual(model: Model, at: State) -> float:
    """``g + lam / eps`` [m], zero if open."""
    return float(at.projection.gap + at.force / model.problem.contact.penalty) if at.closed else 0.0


def _correction(model: Model, at: State, R: Floats) -> tuple[Floats, float] | None:
    """Corrections of the unclamped displacements and of the contact force; None if the tangent is singular.

    With ``Y = K^-1 U`` and ``y = K^-1 R`` the displacements are ``du = Y z - y``, ``z = (dlam, lam H U^T du)``.
    """
    try:
        solve = splu(model.solid_stiffness(at.u), permc_spec="NATURAL").solve
        if not at.closed:
            return -solve(R), 0.0
        U = at.slopes[model.stiffness.unknowns]
        solution = solve(np.column_stack([R, U]))
        y, Y = solution[:, 0], solution[:, 1:]
        first = np.array([1.0, 0.0, 0.0])
        A = at.force * at.curvature - np.outer(first, first)
        small = np.diag([1 / model.problem.contact.penalty, 1.0, 1.0]) - A @ (U.T @ Y)
        z = np.linalg.solve(small, -A @ (U.T @ y) - _contact_residual(model, at) * first)
    except (RuntimeError, np.linalg.LinAlgError):
        return None
    return Y @ z - y, float(z[0])
