"""States of the model: displacements with contacts, and the forces in them."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.end_section import ROTATION, Pose
from fem_reference.friction import friction_at, settled, stretch_column
from fem_reference.model import Model
from fem_reference.stages import amount
from fem_reference.touch import Condition, Touch


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Displacements and contacts at a load parameter.

    Parameters
    ----------
    u
        Nodal displacements ``(n, 2)``, each in the frame of its strip [m].
    internal_force
        Internal nodal forces ``(n, 2)`` at these displacements [N].
    t
        Load parameter.
    touches
        Contacts, in the order of the model's pairs.
    poses
        Motions of the model's end sections.
    tie_forces
        Forces and moments of the model's ties on their ends ``(c,)`` [N or N m].
    """

    u: Floats
    internal_force: Floats
    t: float
    touches: tuple[Touch, ...]
    poses: tuple[Pose, ...]
    tie_forces: Floats

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """Conditions of all contacts."""
        return tuple(touch.condition for touch in self.touches)

    @cached_property
    def closed(self) -> tuple[Touch, ...]:
        """Closed contacts."""
        return tuple(touch for touch in self.touches if touch.closed)

    @cached_property
    def rubbing(self) -> tuple[Touch, ...]:
        """Closed contacts with friction."""
        return tuple(touch for touch in self.closed if touch.friction is not None)

    @property
    def contact_set(self) -> tuple[tuple[bool, int], ...]:
        """Whether each contact is closed, and the direction in which it slips."""
        return tuple(
            (touch.closed, 0 if touch.friction is None else touch.friction.direction)
            for touch in self.touches
        )

    @property
    def contact_forces(self) -> Floats:
        """Forces of the closed contacts, then tangential forces of those with friction, ``(c,)`` [N]."""
        return np.array(
            [
                *(touch.force for touch in self.closed),
                *(touch.tangential_force for touch in self.rubbing),
            ]
        )


def build_state(
    model: Model, u: Floats, t: float, conditions: tuple[Condition, ...], tie_forces: Floats | None = None
) -> State:
    """Build the state at given displacements: project the nodes and differentiate the gaps. Ties are without force by default."""
    touches = []
    for pair, condition in zip(model.pairs, conditions, strict=True):
        projection = pair.project(u, t)
        U, H = pair.gap_derivatives(projection)
        if condition.friction is not None:
            U = np.hstack([U, stretch_column(pair, projection)])
        consistent = condition if condition.closed else condition.opened(armed=condition.armed)
        touches.append(Touch(pair=pair, condition=consistent, projection=projection, slopes=U, curvature=H))
    return State(
        u=u,
        internal_force=model.internal_force(u),
        t=t,
        touches=tuple(touches),
        poses=tuple(section.pose(u) for section in model.sections),
        tie_forces=np.zeros(len(model.ties)) if tie_forces is None else tie_forces,
    )


def at_rest(model: Model, t: float = 0.0) -> State:
    """Return the undeformed state with all contacts open."""
    u = np.zeros((model.nodes, 2))
    conditions = tuple(
        Condition(friction=friction_at(pair.project(u, t)) if pair.contact.friction else None)
        for pair in model.pairs
    )
    return build_state(model, u, t, conditions)


def as_accepted(state: State) -> State:
    """Return the state with slip counted from it, see `fem_reference.friction.settled`."""
    if all(condition.friction is None for condition in state.conditions):
        return state
    return with_conditions(
        state,
        tuple(
            touch.condition
            if touch.condition.friction is None
            else replace(
                touch.condition,
                friction=settled(touch.pair, touch.projection, touch.condition.friction, closed=touch.closed),
            )
            for touch in state.touches
        ),
    )


def with_contact_forces(conditions: tuple[Condition, ...], forces: Floats) -> tuple[Condition, ...]:
    """Return the conditions with ``forces`` ``(c,)`` in the order of `State.contact_forces`."""
    values = iter(forces)
    normal = tuple(
        replace(condition, force=float(next(values))) if condition.closed else condition
        for condition in conditions
    )
    return tuple(
        replace(condition, friction=replace(condition.friction, force=float(next(values))))
        if condition.closed and condition.friction is not None
        else condition
        for condition in normal
    )


def with_conditions(state: State, conditions: tuple[Condition, ...]) -> State:
    """Return the state with other contact conditions at the same displacements."""
    touches = zip(state.touches, conditions, strict=True)
    return replace(state, touches=tuple(replace(touch, condition=condition) for touch, condition in touches))


def residual(model: Model, state: State) -> Floats:
    """Internal forces minus dead loads, contact and tie forces, ``(n, 2)``; in equilibrium the clamp forces [N]."""
    R: Floats = state.internal_force - amount(model.loads, state.t)
    for touch in state.closed:
        R -= touch.force * touch.slopes[:, 0].reshape(-1, 2)
        if touch.friction is not None:
            R -= touch.friction.force * touch.slopes[:, 1].reshape(-1, 2)
    if model.sections:
        R -= section_forces(model, state, section_actions(model, state))
    return R


def section_actions(model: Model, state: State) -> Floats:
    """Forces x, y and moment of ties and dead moments on every end section, ``(e, 3)`` [N, N m]."""
    actions = np.zeros((len(model.sections), 3), dtype=state.tie_forces.dtype)
    actions[:, ROTATION] = amount(model.moments, state.t)
    for tie, force in zip(model.ties, state.tie_forces, strict=True):
        actions[tie.section, tie.component] += force
        if tie.other is not None:
            actions[tie.other, tie.component] -= force
    return actions


def section_forces(model: Model, state: State, actions: Floats) -> Floats:
    """Nodal forces ``(n, 2)`` of ``actions`` ``(e, 3)`` on the end sections [N]."""
    along = [pose.gradient @ action for pose, action in zip(state.poses, actions, strict=True)]
    return np.asarray(model.columns @ np.concatenate(along)).reshape(-1, 2)


def tie_residuals(model: Model, state: State) -> Floats:
    """Residuals ``(c,)`` of the ties [m or rad]."""
    return np.array(
        [
            tie.residual(state.poses, state.t, force)
            for tie, force in zip(model.ties, state.tie_forces.real, strict=True)
        ]
    )


def contact_force(touch: Touch) -> Floats:
    """Force ``-s lam n + T t`` ``(2,)`` of the node on the strip, in the global frame [N]."""
    normal = -touch.pair.contact.sign * touch.force * touch.projection.normal
    if touch.friction is None:
        return np.asarray(normal)
    return np.asarray(normal + touch.friction.force * touch.projection.tangent)


Reaction = tuple[Floats, float]
"""Force ``(2,)`` on a strip in the global frame [N], and moment about the supported point [N m]."""


def spring_forces(model: Model, state: State) -> dict[str, Reaction]:
    """Forces and moments of the springs to the ground by end. They act at the mean of the section."""
    return _tie_reactions(model, state, [item.node for item in model.problem.springs], grounded=True)


def _tie_reactions(model: Model, state: State, nodes: list[str], *, grounded: bool) -> dict[str, Reaction]:
    """Sums of the ties' forces at the ends ``nodes`` that a support or, if ``grounded``, a spring holds."""
    found = dict.fromkeys(nodes, (np.zeros(2), 0.0))
    for tie, value in zip(model.ties, state.tie_forces, strict=True):
        if tie.other is None and tie.grounded == grounded:
            force, moment = found[model.sections[tie.section].node]
            values = np.append(force, moment)
            values[tie.component] = value
            found[model.sections[tie.section].node] = (values[:2], float(values[ROTATION]))
    return found


def reactions(model: Model, state: State) -> dict[str, Reaction]:
    """Reactions of clamps and supports by end. The point is the middle of a clamped edge, or the mean of a section."""
    R, found = residual(model, state), dict[str, Reaction]()
    for body, part in model.bodies_and_nodes():
        for end in body.strip.clamped:
            edge = body.mesh.edges[end]
            forces = R[part][edge]
            arm = body.mesh.nodes[edge] + state.u[part][edge] - body.middle(end)
            moment = _moment(arm, forces)
            found[f"{body.strip.name}.{end}"] = (np.asarray(body.strip.frame @ forces.sum(axis=0)), moment)
    nodes = [support.node for support in model.problem.supports]
    return found | _tie_reactions(model, state, nodes, grounded=False)


def imbalance(model: Model, state: State) -> float:
    """Largest component of the sum of all external forces and moments [N].

    External are the reactions of clamps, supports and springs, the forces of the pins and the dead loads. Moments refer to the start
    of the first strip and are divided by the length of the longest one.
    """
    origin = np.array(model.problem.strips[0].start)
    total, moment = np.zeros(2), float(amount(model.moments, state.t).sum())
    nodal = amount(model.loads, state.t)
    places = {
        section.node: section.position + pose.displacement
        for section, pose in zip(model.sections, state.poses, strict=True)
    }
    for body, part in model.bodies_and_nodes():
        start = np.array(body.strip.start) - origin
        points = start + (body.mesh.nodes + state.u[part]) @ body.strip.frame.T
        loads = nodal[part] @ body.strip.frame.T
        total += loads.sum(axis=0)
        moment += _moment(points, loads)
        for end in body.strip.clamped:
            places[f"{body.strip.name}.{end}"] = start + body.strip.frame @ body.middle(end)
    held = (*reactions(model, state).items(), *spring_forces(model, state).items())
    for node, (force, free_moment) in held:
        total += force
        moment += free_moment + _moment(places[node], force)
    for touch in state.closed:
        if len(touch.pair.strips) == 1:
            total += contact_force(touch)
            moment += _moment(touch.pair.position(state.u, state.t), contact_force(touch))
        if touch.friction is not None:  # T acts on the touched curve, not at the node
            moment += touch.friction.force * float(touch.projection.distance)
    return float(np.abs([*total, moment / model.length]).max())


def contact_energy(state: State) -> float:
    """Energy ``eps g^2 / 2`` of all closed contacts [J]."""
    return sum(touch.pair.penalty * touch.gap**2 / 2 for touch in state.closed)


def spring_energy(model: Model, state: State) -> float:
    """Energy ``C F^2 / 2`` of the springs to the ground and in hinges [J]."""
    flexibilities = np.array([tie.flexibility for tie in model.ties])
    return float((flexibilities * state.tie_forces**2).sum() / 2)


def _moment(arms: Floats, forces: Floats) -> float:
    """Moment of forces ``(..., 2)`` with their arms ``(..., 2)`` [N m]."""
    return float((arms[..., 0] * forces[..., 1] - arms[..., 1] * forces[..., 0]).sum())
