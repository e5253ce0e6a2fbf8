"""States of the model: displacements with contacts, and the forces in them."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem_reference.contact.contact import Touch
from fem_reference.contact.end_section import ROTATION, Pose
from fem_reference.contact.friction import slip_residual
from fem_reference.solid.assembly import deformation_gradient
from fem_reference.statement.arrays import Floats
from fem_reference.statement.loads import amount
from fem_reference.statement.problem import Pin
from fem_reference.system.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Displacements and contacts at a load parameter."""

    model: Model  # what is solved
    u: Floats  # nodal displacements ``(n, 2)`` [m]
    gradients: tuple[Floats, ...]  # deformation gradients ``(2, 2, e, q)`` of the bodies
    internal_force: Floats  # internal nodal forces ``(n, 2)`` [N]
    t: float  # load parameter
    touches: tuple[Touch, ...]  # contacts, in the order of the model's pairs
    poses: tuple[Pose, ...]  # motions of the model's end sections
    tie_forces: Floats  # forces and moments of the model's ties on their ends ``(k,)`` [N or N m]

    @cached_property
    def closed(self) -> tuple[Touch, ...]:
        """Closed contacts."""
        return tuple(touch for touch in self.touches if touch.closed)

    @cached_property
    def rubbing(self) -> tuple[Touch, ...]:
        """Closed contacts with friction."""
        return tuple(touch for touch in self.closed if touch.rubs)

    @cached_property
    def contact_set(self) -> tuple[tuple[bool, int], ...]:
        """Whether each contact is closed, and the direction in which it slips."""
        return tuple((touch.closed, touch.direction) for touch in self.touches)

    @cached_property
    def forces(self) -> Floats:
        """Forces ``(c,)`` of the constraints: of closed contacts, tangential ones of those with friction, of ties [N or N m]."""
        normal = [touch.force for touch in self.closed]
        return np.array([*normal, *(touch.tangential for touch in self.rubbing), *self.tie_forces])

    @cached_property
    def residuals(self) -> Floats:
        """Residuals ``(c,)`` of the constraints, ordered as `forces` [m or rad; N in slip]."""
        ties = zip(self.model.ties, self.tie_forces, strict=True)
        return np.array(
            [
                *(touch.gap_residual for touch in self.closed),
                *map(slip_residual, self.rubbing),
                *(tie.residual(self.poses, self.t, force) for tie, force in ties),
            ]
        )

    @cached_property
    def residual(self) -> Floats:
        """Internal forces minus those of loads, contacts and ties, ``(n, 2)``; in equilibrium clamp reactions [N]."""
        R: Floats = self.internal_force - amount(self.model.loads, self.t)
        for touch in self.closed:
            R -= (touch.columns[:, :2] @ (touch.force, touch.tangential)).reshape(-1, 2)
        return R - self.nodal_forces(self.actions) if self.model.sections else R

    @cached_property
    def reduced(self) -> Floats:
        """The `residual` on the unknowns ``(m,)`` [N]."""
        return self.model.restriction @ self.residual.ravel()

    @property
    def actions(self) -> Floats:
        """Forces x, y and moment of ties and dead moments on every end section, ``(e, 3)`` [N, N m]."""
        actions = np.zeros((len(self.model.sections), 3))
        actions[:, ROTATION] = amount(self.model.moments, self.t)
        for tie, force in zip(self.model.ties, self.tie_forces, strict=True):
            actions[tie.section, tie.component] += force
            if tie.other is not None:
                actions[tie.other, tie.component] -= force
        return actions

    def nodal_forces(self, actions: Floats) -> Floats:
        """Nodal forces ``(n, 2)`` of ``actions`` ``(e, 3)`` on the end sections [N]."""
        along = [pose.gradient @ action for pose, action in zip(self.poses, actions, strict=True)]
        return (self.model.columns @ np.concatenate(along)).reshape(-1, 2)

    @property
    def force_scale(self) -> float:
        """Scale of tolerances: largest of contact and tie forces, dead loads and ``E I / L^2``; moments count over L [N]."""
        model, forces = self.model, np.abs(self.forces)
        arms = [model.length if tie.component == ROTATION else 1.0 for tie in model.ties]
        forces[forces.size - len(arms) :] /= arms
        return float(max(model.force_scale, amount(model.largest_loads, self.t), forces.max(initial=0.0)))

    def moved(self, u: Floats, t: float, forces: Floats | None = None) -> "State":
        """Return the state at other displacements, with the same set of closed contacts, and other ``forces`` if given."""
        values = (self.forces if forces is None else forces).tolist()
        normal, others = iter(values), iter(values[len(self.closed) :])
        touches = tuple(
            replace(
                touch,
                at=touch.pair.project(u, t),
                force=next(normal) if touch.closed else 0.0,
                tangential=next(others) if touch.rubs else 0.0,
            )
            for touch in self.touches
        )
        return build_state(self.model, u, t, touches, np.array(list(others)))

    def touching(self, touches: "tuple[Touch, ...] | list[Touch]") -> "State":
        """Return the state with other variables of its contacts at the same displacements."""
        return replace(self, touches=tuple(touches))


def build_state(model: Model, u: Floats, t: float, touches: tuple[Touch, ...], tie_forces: Floats) -> State:
    """Build a state at given displacements."""
    gradients = tuple(deformation_gradient(body.mesh, u[body.part]) for body in model.bodies)
    forces = [body.internal_force(F) for body, F in zip(model.bodies, gradients, strict=True)]
    return State(
        model=model,
        u=u,
        gradients=gradients,
        internal_force=np.concatenate(forces),
        t=t,
        touches=touches,
        poses=tuple(section.pose(u) for section in model.sections),
        tie_forces=tie_forces,
    )


def at_rest(model: Model, t: float = 0.0) -> State:
    """Return the undeformed state with all contacts open."""
    u, touches = np.zeros((model.nodes, 2)), list[Touch]()
    for pair in model.pairs:
        at = pair.project(u, t)
        touches.append(Touch(pair=pair, at=at, begin=at if pair.contact.friction else None))
    return build_state(model, u, t, tuple(touches), np.zeros(len(model.ties)))


Reaction = tuple[Floats, float, Floats]
"""Force ``(2,)`` on a strip [N], moment about the held point [N m], and the place of this point ``(2,)`` [m]."""


def reactions(state: State) -> tuple[dict[str, Reaction], dict[str, Reaction]]:
    """Reactions of clamps and supports, and of springs to the ground, by end.

    The point is the middle of a clamped edge, or the mean of a section.
    """
    found = dict[str, Reaction]()
    for body in state.model.bodies:
        for end in body.strip.clamped:
            edge, nodes = body.mesh.edges[end], body.mesh.nodes
            middle = nodes[edge[[0, -1]]].mean(axis=0)
            forces = state.residual[body.part][edge]
            turning = moment(nodes[edge] + state.u[body.part][edge] - middle, forces)
            found[f"{body.strip.name}.{end}"] = forces.sum(axis=0), turning, body.offset + middle
    held, sprung = dict[int, Floats](), dict[int, Floats]()
    for tie, value in zip(state.model.ties, state.tie_forces, strict=True):
        if tie.other is None:
            (sprung if tie.flexibility else held).setdefault(tie.section, np.zeros(3))[tie.component] = value
    supports, springs = (
        {
            state.model.sections[n].node: (f[:2], float(f[ROTATION]), state.poses[n].position)
            for n, f in kind.items()
        }
        for kind in (held, sprung)
    )
    return found | supports, springs


def imbalance(state: State) -> float:
    """Largest component of the sum of all external forces, and of their moment about the first strip's start over L [N]."""
    model, nodal = state.model, amount(state.model.loads, state.t)
    total, turning = np.zeros(2), float(amount(model.moments, state.t).sum())
    for body in model.bodies:
        loads = nodal[body.part]
        total += loads.sum(axis=0)
        turning += moment(body.offset + body.mesh.nodes + state.u[body.part], loads)
    for force, free_moment, place in (one for kind in reactions(state) for one in kind.values()):
        total += force
        turning += free_moment + moment(place, force)
    for touch in state.closed:
        if isinstance(touch.pair.node, Pin):
            total += touch.vector
            turning += moment(touch.pair.position(state.u, state.t), touch.vector)
        turning += touch.tangential * touch.at.distance  # T acts on the touched curve, not at the node
    return float(np.abs([*total, turning / model.length]).max())


def stored_energy(state: State) -> tuple[float, float]:
    """Strain and contact energy ``eps g^2 / 2``, springs left out [J]."""
    bodies = zip(state.model.bodies, state.gradients, strict=True)
    strain = sum(body.strain_energy(F) for body, F in bodies)
    return strain, sum(touch.pair.penalty * touch.gap**2 / 2 for touch in state.closed)


def moment(arms: Floats, forces: Floats) -> float:
    """Moment of forces ``(..., 2)`` with their arms ``(..., 2)`` [N m]."""
    return float((arms[..., 0] * forces[..., 1] - arms[..., 1] * forces[..., 0]).sum())
