"""A state of the model and the forces in it."""

from dataclasses import dataclass, replace

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.contact import Pair
from fem_reference.curve import Projection
from fem_reference.model import Model


@dataclass(frozen=True, kw_only=True)
class Condition:
    """What is decided about a contact, rather than computed from displacements.

    Parameters
    ----------
    closed
        Whether the contact acts.
    armed
        Whether it may: not after its node has left the strip over an end, until it is back on its side.
    force
        Contact force lam, pushing the two apart; zero if open [N].
    multiplier
        Force lam_0 of the augmented Lagrangian, found before; zero for the penalty alone [N].
    """

    closed: bool = False
    armed: bool = True
    force: float = 0.0
    multiplier: float = 0.0

    def opened(self, *, armed: bool) -> "Condition":
        """Return the open contact."""
        return Condition(closed=False, armed=armed)


@dataclass(frozen=True, kw_only=True, eq=False)
class Touch:
    """One contact in a state.

    Parameters
    ----------
    pair, condition
        The contact and what is decided about it.
    projection
        The node seen from the contact curve.
    slopes, curvature
        Factors ``U (2 n, 3)`` and ``H (3, 3)`` of the gap's derivatives, see `fem_reference.contact`.
    """

    pair: Pair
    condition: Condition
    projection: Projection
    slopes: Floats
    curvature: Floats

    @property
    def closed(self) -> bool:
        """Whether the contact acts."""
        return self.condition.closed

    @property
    def force(self) -> float:
        """Contact force lam [N]."""
        return self.condition.force

    @property
    def gap(self) -> float:
        """Signed distance of node and strip, whether or not the closest point is on the strip [m]."""
        return float(self.pair.gap(self.projection))

    @property
    def shown_gap(self) -> float:
        """The gap; beyond an end of the strip, the distance to that end [m]."""
        beyond = self.projection.end_distance - self.pair.radius
        return self.gap if self.projection.inside else float(beyond)

    @property
    def mismatch(self) -> float:
        """``g + (lam - lam_0) / eps`` [m], zero if open."""
        added = self.force - self.condition.multiplier
        return self.gap + added / self.pair.penalty if self.closed else 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Displacements with their contacts.

    Parameters
    ----------
    u
        Nodal displacements ``(n, 2)``, each in the frame of its strip [m].
    t
        Load parameter, which places the pins.
    touches
        The contacts, in the order of the model's pairs.
    """

    u: Floats
    t: float
    touches: tuple[Touch, ...]

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """What is decided about the contacts."""
        return tuple(touch.condition for touch in self.touches)

    @property
    def closed(self) -> tuple[Touch, ...]:
        """The contacts that act."""
        return tuple(touch for touch in self.touches if touch.closed)


def state(model: Model, u: Floats, t: float, conditions: tuple[Condition, ...]) -> State:
    """Project the nodes and collect the state."""
    touches = []
    for pair, condition in zip(model.pairs, conditions, strict=True):
        projection = pair.project(u, t)
        U, H = pair.gap_derivatives(projection)
        kept = condition if condition.closed else condition.opened(armed=condition.armed)
        touches.append(Touch(pair=pair, condition=kept, projection=projection, slopes=U, curvature=H))
    return State(u=u, t=t, touches=tuple(touches))


def at_rest(model: Model, t: float = 0.0) -> State:
    """The undeformed state with every contact open."""
    return state(model, np.zeros((model.nodes, 2)), t, (Condition(),) * len(model.pairs))


def with_conditions(at: State, conditions: tuple[Condition, ...]) -> State:
    """Return the same displacements with other contact conditions."""
    touches = zip(at.touches, conditions, strict=True)
    return replace(at, touches=tuple(replace(touch, condition=condition) for touch, condition in touches))


def residual(model: Model, at: State) -> Floats:
    """Internal force minus end loads and contact forces, ``(n, 2)``; in equilibrium, the clamps' forces [N]."""
    R = model.internal_force(at.u) - at.t * model.load
    for touch in at.closed:
        R -= touch.force * touch.slopes[:, 0].reshape(-1, 2)
    return R


def push(touch: Touch) -> Floats:
    """Force ``-s lam n`` of the node on the strip, ``(2,)``, in the global frame [N]."""
    return np.asarray(-touch.pair.contact.sign * touch.force * touch.projection.normal)


def clamp_reactions(model: Model, at: State) -> list[tuple[Floats, float]]:
    """Force ``(2,)`` [N] of each clamp on its strip, in the global frame, and its moment about the clamped point [N m]."""
    R, found = residual(model, at), []
    for body, part in model.each():
        edge = body.clamped_edge
        forces = R[part][edge]
        arm = body.mesh.nodes[edge] + at.u[part][edge] - body.clamped_point
        moment = float((arm[:, 0] * forces[:, 1] - arm[:, 1] * forces[:, 0]).sum())
        found.append((np.asarray(body.strip.frame @ forces.sum(axis=0)), moment))
    return found


def imbalance(model: Model, at: State) -> float:
    """Largest component of the clamps' reactions plus pins' forces and end loads, moments about the first strip's start over L [N]."""
    strips = model.problem.strips
    total, moment = np.zeros(2), 0.0
    for (force, own), body in zip(clamp_reactions(model, at), model.bodies, strict=True):
        place = np.array(body.strip.start) - strips[0].start
        total += force
        moment += own + _cross(place + body.strip.frame @ body.clamped_point, force)
    for touch in at.closed:
        if len(touch.pair.strips) == 1:
            total += push(touch)
            moment += _cross(touch.pair.position(at.u, at.t), push(touch))
    for body, part in model.each():
        loads = at.t * model.load[part] @ body.strip.frame.T
        place = np.array(body.strip.start) - strips[0].start
        points = place + (body.mesh.nodes + at.u[part]) @ body.strip.frame.T
        total += loads.sum(axis=0)
        moment += float((points[:, 0] * loads[:, 1] - points[:, 1] * loads[:, 0]).sum())
    return float(np.abs([*total, moment / model.length]).max())


def _cross(arm: Floats, force: Floats) -> float:
    return float(arm[0] * force[1] - arm[1] * force[0])
