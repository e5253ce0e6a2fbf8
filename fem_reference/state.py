"""A state of the model and the forces in it, in the strip's frame."""

from dataclasses import dataclass

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.contact import Projection
from fem_reference.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Displacements with their contact.

    Parameters
    ----------
    u
        Nodal displacements ``(n, 2)`` in the strip's frame [m].
    pin
        Pin position ``(2,)`` [m].
    closed
        Whether the contact acts.
    force
        Contact force lam, pushing the strip away from the pin; zero if open [N].
    projection
        The pin seen from the contact curve.
    slopes, curvature
        Factors ``U`` and ``H`` of the gap's derivatives, see `fem_reference.contact.gap_derivatives`.
    """

    u: Floats
    pin: Floats
    closed: bool
    force: float
    projection: Projection
    slopes: Floats
    curvature: Floats

    @property
    def gap(self) -> float:
        """Signed distance of pin and strip; beyond an end of the strip, the distance to that end [m]."""
        return float(self.projection.gap if self.projection.inside else self.projection.end_distance)


def state(model: Model, u: Floats, pin: Floats, *, closed: bool, force: float) -> State:
    """Project the pin and collect the state."""
    projection = model.project(u, pin)
    slopes, curvature = model.gap_derivatives(projection)
    return State(
        u=u,
        pin=pin,
        closed=closed,
        force=force if closed else 0.0,
        projection=projection,
        slopes=slopes,
        curvature=curvature,
    )


def residual(model: Model, at: State) -> Floats:
    """Internal force minus contact force, ``(n, 2)``; in equilibrium, the support's force [N]."""
    return model.internal_force(at.u) - at.force * at.slopes[:, 0].reshape(-1, 2)


def push(model: Model, at: State) -> Floats:
    """Force ``-s lam n`` of the pin on the strip, ``(2,)`` [N]."""
    return -model.problem.contact.sign * at.force * at.projection.normal


def clamp_reaction(model: Model, at: State) -> tuple[Floats, float]:
    """Force ``(2,)`` [N] of the clamp on the strip and its moment about the clamped point [N m]."""
    held = np.ones(at.u.size, dtype=bool)
    held[model.stiffness.unknowns] = False
    forces = np.where(held.reshape(-1, 2), residual(model, at), 0.0)
    arm = model.mesh.nodes + at.u - model.clamped_point
    return forces.sum(axis=0), float((arm[:, 0] * forces[:, 1] - arm[:, 1] * forces[:, 0]).sum())


def imbalance(model: Model, at: State) -> float:
    """Largest component of clamp reaction plus pin force, moments about the clamped point over L [N]."""
    force, moment = clamp_reaction(model, at)
    p, arm = push(model, at), at.pin - model.clamped_point
    total = (moment + arm[0] * p[1] - arm[1] * p[0]) / model.problem.strip.length
    return float(np.abs(np.append(force + p, total)).max())
