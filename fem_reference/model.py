"""The discrete model: bodies with consecutive node numbers, and the contact pairs and ties that couple them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.sparse import block_diag, csr_matrix, identity

from fem_reference.arrays import Array, Floats
from fem_reference.body import ANCHORED, Body, build_body
from fem_reference.conditions import ENDS, EndLoad, Joint
from fem_reference.contact import Carrier, Pair
from fem_reference.curve import contact_curve
from fem_reference.end_section import EndSection, Tie, anchor_stiffness, end_rows, inner_rows
from fem_reference.loads import PointLoad
from fem_reference.mesh import edge_weights
from fem_reference.problem import Contact, Pin, SolidProblem

_RESOLVED = 0.05
"""Largest round-off of a nodal force, over the forces that bend or load the strips. Measured on strips of one bending stiffness: at .018
the tip is right to 2e-6 of the length, at .14 Newton's method takes no steps of use."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Model:
    """Constant data of a solution."""

    problem: SolidProblem  # input data
    bodies: tuple[Body, ...]  # discretised strips
    parts: tuple[slice, ...]  # range of each body in the model's nodal arrays
    pairs: tuple[Pair, ...]  # contacts
    expansion: csr_matrix  # matrix ``(2 n, m)`` from the unknowns to the displacements
    # nodal forces ``(s, n, 2)`` of the dead forces that are added in every stage, each in the frame of its
    # strip [N]
    loads: Floats
    # sections, columns: end sections that are supported, joined, anchored or loaded by a moment, sections
    # inside with a moment, and their columns ``(2 n, 4 e)``
    sections: tuple[EndSection, ...]
    columns: Floats
    ties: tuple[Tie, ...]  # ties of these sections: components of supports, then of springs, then of joints
    moments: Floats  # dead moments on the sections that are added in every stage, ``(s, e)`` [N m]

    @cached_property
    def restriction(self) -> csr_matrix:
        """Transposed expansion ``(m, 2 n)``: from nodal forces to the forces on the unknowns."""
        return csr_matrix(self.expansion.T)

    @cached_property
    def nodes(self) -> int:
        """Number of nodes n."""
        return int(self.parts[-1].stop)

    @cached_property
    def unknowns(self) -> int:
        """Number of unknown displacements m."""
        return int(self.expansion.shape[1])

    @cached_property
    def unknowns_of_bodies(self) -> tuple[slice, ...]:
        """Range of each body in the unknowns."""
        ends = np.cumsum([0, *(body.expansion.shape[1] for body in self.bodies)]).tolist()
        return tuple(slice(a, b) for a, b in pairwise(ends))

    @cached_property
    def force_scale(self) -> float:
        """Largest ``E I / L^2`` of the strips, a scale of forces that is independent of the load [N]."""
        return max(body.force_scale for body in self.bodies)

    @cached_property
    def largest_loads(self) -> tuple[float, ...]:
        """Largest dead force, or moment over the longest strip, that is added in every stage [N]."""
        found = [0.0] * self.problem.stages
        for load in self.problem.loads:
            found[load.stage] = max(
                found[load.stage], float(np.hypot(*load.force)), abs(load.moment) / self.length
            )
        for inner in self.problem.inner_loads:
            body, _ = self.body(inner.strip)
            total = inner.on_sections(body.strip, body.mesh.stations).sum(axis=0)
            moment = abs(inner.moment) if isinstance(inner, PointLoad) else 0.0
            found[inner.stage] = max(found[inner.stage], float(np.hypot(*total)), moment / self.length)
        return tuple(found)

    @cached_property
    def axial_stiffness(self) -> float:
        """Largest ``E A / L`` of the strips [N/m]."""
        return max(strip.axial_stiffness for strip in self.problem.strips)

    @cached_property
    def length(self) -> float:
        """Length of the longest strip [m]."""
        return max(strip.length for strip in self.problem.strips)

    @cached_property
    def round_off(self) -> float:
        """Round-off of a nodal force [N]."""
        return max(body.round_off for body in self.bodies)

    @property
    def ill_conditioned(self) -> bool:
        """Whether round-off hides the forces that bend the strips; measured, answers are right up to half of this limit."""
        return self.round_off > _RESOLVED * max(self.force_scale, *self.largest_loads)

    @property
    def balance_round_off(self) -> float:
        """Round-off of a sum of nodal forces, which grows like a random walk [N]."""
        return float(np.sqrt(2 * self.nodes)) * self.round_off

    @cached_property
    def length_round_off(self) -> float:
        """Round-off of a position [m]: 8 machine epsilons times the largest distance of a strip from the global origin."""
        points = [point for strip in self.problem.strips for point in (strip.start, strip.end)]
        distance = max(np.hypot(*point) for point in points)
        return 8 * float(np.finfo(float).eps) * max(float(distance), self.length)

    def body(self, strip: str) -> tuple[Body, slice]:
        """Return the body of a strip and its range of nodes."""
        number = [item.name for item in self.problem.strips].index(strip)
        return self.bodies[number], self.parts[number]

    def internal_force(self, u: Array) -> Array:
        """Internal nodal forces ``(n, 2)``, each in the frame of its strip [N]."""
        return np.concatenate([body.internal_force(u[part]) for body, part in self.bodies_and_nodes()])

    def strain_energy(self, u: Array) -> float:
        """Strain energy of the bodies [J]."""
        return sum(body.strain_energy(u[part]) for body, part in self.bodies_and_nodes())

    def bodies_and_nodes(self) -> list[tuple[Body, slice]]:
        """Return every body with its range of nodes."""
        return list(zip(self.bodies, self.parts, strict=True))


def build(problem: SolidProblem) -> Model:
    """Discretise a problem."""
    bodies = tuple(build_body(strip) for strip in problem.strips)
    ends = np.cumsum([0, *(len(body.mesh.nodes) for body in bodies)])
    parts = tuple(slice(int(a), int(b)) for a, b in pairwise(ends))
    sections = _sections(problem, bodies, parts)
    columns = [section.columns for section in sections]
    numbers = {section.node: number for number, section in enumerate(sections)}
    moments = np.zeros((problem.stages, len(sections)))
    bearing: list[EndLoad | PointLoad] = [*problem.loads, *problem.inner_moments]
    for load in bearing:
        if load.moment:
            moments[load.stage, numbers[load.node]] += load.moment
    return Model(
        problem=problem,
        bodies=bodies,
        parts=parts,
        pairs=tuple(_pair(problem, contact, bodies, parts) for contact in problem.contacts),
        expansion=block_diag([body.expansion for body in bodies], format="csr"),
        loads=np.concatenate([_dead_forces(problem, body) for body in bodies], axis=1),
        sections=sections,
        columns=np.hstack(columns) if columns else np.zeros((2 * parts[-1].stop, 0)),
        ties=_ties(problem, numbers),
        moments=moments,
    )


def _dead_forces(problem: SolidProblem, body: Body) -> Floats:
    """Nodal forces ``(s, n, 2)`` of the dead forces of every stage on a body's ends and inside it, in the strip's frame [N]."""
    forces = np.zeros((problem.stages, len(body.mesh.nodes), 2))
    for load in problem.loads:
        if load.strip == body.strip.name:
            edge = body.mesh.edges[load.end]
            share = edge_weights(body.strip.element, body.mesh.places[edge, 1])
            forces[load.stage, edge] += share[:, None] * (np.array(load.force) @ body.strip.frame)
    for inner in problem.inner_loads:
        if inner.strip == body.strip.name:
            on_sections = inner.on_sections(body.strip, body.mesh.stations)
            forces[inner.stage] += body.mesh.sections.T @ on_sections @ body.strip.frame
    return forces


def _sections(
    problem: SolidProblem, bodies: tuple[Body, ...], parts: tuple[slice, ...]
) -> tuple[EndSection, ...]:
    """End sections that are supported, joined, anchored or loaded by a moment, and sections inside that are loaded by one."""
    needed = {support.node for support in problem.supports} | {spring.node for spring in problem.springs}
    needed |= {end for joint in problem.joints for end in joint.ends}
    needed |= {load.node for load in problem.loads if load.moment}
    anchored = {f"{body.strip.name}.{ANCHORED}" for body in bodies if body.anchor is not None}
    ends = [
        _section(
            problem,
            body,
            (part, parts[-1].stop),
            f"{body.strip.name}.{end}",
            end_rows(body.strip, body.mesh, end),
            anchor_stiffness(body.strip) if f"{body.strip.name}.{end}" in anchored else 0.0,
        )
        for body, part in zip(bodies, parts, strict=True)
        for end in ENDS
        if f"{body.strip.name}.{end}" in needed | anchored
    ]
    loaded = {load.node: load for load in problem.inner_moments}
    inside = [
        _section(
            problem,
            body,
            (part, parts[-1].stop),
            load.node,
            inner_rows(body.strip, body.mesh, load.at),
        )
        for body, part in zip(bodies, parts, strict=True)
        for load in loaded.values()
        if load.strip == body.strip.name
    ]
    return (*ends, *inside)


def _section(
    problem: SolidProblem,
    body: Body,
    among: tuple[slice, int],
    node: str,
    weights: tuple[csr_matrix, float],
    anchored: float = 0.0,
) -> EndSection:
    """Build the section ``node`` of a body, whose nodes are a range among all of the model, from its weights and height."""
    strip, (rows, height) = body.strip, weights
    mean, first_moment = (rows @ body.mesh.nodes) @ strip.frame.T
    return EndSection(
        node=node,
        position=mean + (np.array(strip.start) - np.array(problem.strips[0].start)),
        rows=_among_all(rows, *among),
        first_moment=first_moment,
        frame=strip.frame,
        height=height,
        anchor_stiffness=anchored,
    )


def _ties(problem: SolidProblem, numbers: dict[str, int]) -> tuple[Tie, ...]:
    """Ties of supports and joints between the sections with the given ``numbers``."""
    rest = (0.0,) * (problem.stages - 1)
    supports = [
        Tie(
            section=numbers[support.node],
            component=component,
            rates=(rate, *(change[component] for change in support.onward), *rest[len(support.onward) :]),
        )
        for support in problem.supports
        for component, rate in enumerate(support.motion)
        if rate is not None
    ]
    springs = [
        Tie(section=numbers[spring.node], component=component, flexibility=1 / stiffness)
        for spring in problem.springs
        for component, stiffness in enumerate(spring.stiffness)
        if stiffness
    ]
    joints = [
        Tie(section=numbers[end], component=component, other=numbers[joint.ends[0]], flexibility=flexibility)
        for joint in problem.joints
        for end in joint.ends[1:]
        for component, flexibility in enumerate(_flexibilities(joint, end))
    ]
    return (*supports, *springs, *joints)


def _flexibilities(joint: Joint, end: str) -> tuple[float, ...]:
    """Flexibilities of the tied components x, y and, unless the end turns freely, rotation."""
    stiffness = joint.stiffness_of(end)
    if stiffness is None:
        return 0.0, 0.0, 0.0
    return (0.0, 0.0, 1 / stiffness) if stiffness else (0.0, 0.0)


def _pair(
    problem: SolidProblem, contact: Contact, bodies: tuple[Body, ...], parts: tuple[slice, ...]
) -> Pair:
    """Build a contact pair."""
    numbers = {strip.name: number for number, strip in enumerate(problem.strips)}
    touched, origin = numbers[contact.strip], np.array(problem.strips[0].start)
    curve = contact_curve(bodies[touched].strip, bodies[touched].mesh, contact)

    def carrier(number: int, rows: csr_matrix) -> Carrier:
        return _carrier(bodies[number], parts[number], parts[-1].stop, rows, origin)

    node: Pin | Carrier | None = problem.pin(contact.node)
    strips: tuple[int, ...] = (touched,)
    if node is None:
        name, end = contact.node.split(".")
        strips = (touched, numbers[name])
        node = carrier(strips[1], bodies[strips[1]].mesh.sections[[0 if end == "start" else -1]])
    return Pair(
        contact=contact,
        curve=curve,
        carrier=carrier(touched, curve.rows),
        node=node,
        penalty=problem.penalty(contact),
        strips=strips,
        ends=_free_ends(problem, bodies[touched], contact, carrier),
        origin=origin,
    )


def _free_ends(
    problem: SolidProblem, body: Body, contact: Contact, carrier: Callable[[int, csr_matrix], Carrier]
) -> dict[str, Carrier]:
    """Corners of the ends that no other strip shares; none for a point in contact with an axis."""
    radius = next((pin.radius for pin in problem.pins if pin.name == contact.node), 0.0)
    if contact.surface == "axis" and not radius:
        return {}
    joined = {end for joint in problem.joints for end in joint.ends}
    number = [strip.name for strip in problem.strips].index(contact.strip)
    weights = identity(len(body.mesh.nodes), format="csr")
    free = (end for end in ENDS if f"{contact.strip}.{end}" not in joined)
    return {end: carrier(number, weights[body.mesh.edges[end][[0, -1]]]) for end in free}


def _carrier(body: Body, part: slice, nodes: int, rows: csr_matrix, origin: Floats) -> Carrier:
    """Points with the weights ``rows`` of a body's nodes, among all ``nodes`` of the model."""
    reference: Floats = (rows @ body.mesh.nodes) @ body.strip.frame.T + (np.array(body.strip.start) - origin)
    return Carrier(reference=reference, rows=_among_all(rows, part, nodes), frame=body.strip.frame)


def _among_all(rows: csr_matrix, part: slice, nodes: int) -> csr_matrix:
    """Weights of a body's nodes as weights of all ``nodes`` of the model."""
    placed = rows.tocoo()
    return csr_matrix((placed.data, (placed.row, placed.col + part.start)), shape=(rows.shape[0], nodes))
