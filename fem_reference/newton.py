"""Newton's method with every contact held open or closed.

The unknowns are displacements and contact forces; with U and H of the gaps' derivatives and ``C = 1 / eps``,

    R = f - sum lam dg/du = 0,     g + C (lam - lam_0) = 0,
    (K - sum lam U H U^T) du - dg/du dlam = -R,     dg/du . du + C dlam = -(g + C (lam - lam_0)).

The sparse matrices that are factorised are the bodies' own, K; a contact enters through the three columns of U.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag
from scipy.sparse.linalg import splu

from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.state import State, residual, state
from fem_reference.status import Status


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


@dataclass(frozen=True, kw_only=True, eq=False)
class Correction:
    """Corrections of the displacements ``(n, 2)`` and of the closed contacts' forces."""

    u: Floats
    forces: Floats

    @property
    def size(self) -> float:
        """Largest displacement [m]."""
        return float(np.abs(self.u).max())


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
        found = correction(model, at, R)
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
    """Largest of contact forces and ``E I / L^2`` [N]."""
    return max(model.force_scale, *(abs(touch.force) for touch in at.touches), 0.0)


def moved(model: Model, at: State, step: Correction, damping: float) -> State:
    """Return the state a part of a correction away."""
    forces = iter(damping * step.forces)
    conditions = tuple(
        replace(one, force=one.force + float(next(forces))) if one.closed else one for one in at.conditions
    )
    return state(model, at.u + damping * step.u, at.t, conditions)


def correction(model: Model, at: State, R: Floats) -> Correction | None:
    """Newton's correction for the residual ``R`` of the unknowns; None if the tangent is singular.

    With ``Y = K^-1 U`` and ``y = K^-1 R`` the displacements are ``du = Y z - y``; of a contact's three components of z the
    first is dlam, the others ``lam H U^T du``.
    """
    closed = at.closed
    try:
        if not closed:
            return Correction(u=-_expanded(model, _solve(model, at.u, R)), forces=np.zeros(0))
        U = model.expansion.T @ np.hstack([touch.slopes for touch in closed])
        solution = _solve(model, at.u, np.column_stack([R, U]))
        y, Y = solution[:, 0], solution[:, 1:]
        first = np.array([1.0, 0.0, 0.0])
        A = block_diag(*(touch.force * touch.curvature - np.outer(first, first) for touch in closed))
        flexibility = np.concatenate([[1 / touch.pair.penalty, 1.0, 1.0] for touch in closed])
        mismatch = np.concatenate([touch.mismatch * first for touch in closed])
        z = np.linalg.solve(np.diag(flexibility) - A @ (U.T @ Y), -A @ (U.T @ y) - mismatch)
    except (RuntimeError, np.linalg.LinAlgError):
        return None
    return Correction(u=_expanded(model, Y @ z - y), forces=z[::3])


def _expanded(model: Model, unknowns: Floats) -> Floats:
    return np.asarray((model.expansion @ unknowns).reshape(-1, 2))


def _solve(model: Model, u: Floats, right: Floats) -> Floats:
    """Solve with every body's own stiffness: ``right`` is ``(m,)`` or ``(m, c)``."""
    parts, start = [], 0
    for body, part in model.each():
        size = body.expansion.shape[1]
        own = splu(body.tangent(u[part]), permc_spec=body.ordering)
        parts.append(own.solve(right[start : start + size]))
        start += size
    return np.concatenate(parts)
