"""The discrete model: bodies with consecutive node numbers, and the contact pairs and ties that couple them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_diag, csr_matrix, identity, kron, vstack

from fem_reference.contact.contact import Carrier, Pair
from fem_reference.contact.curve import contact_curve
from fem_reference.contact.end_section import (
    ROTATION,
    EndSection,
    Tie,
    anchor_stiffness,
    end_rows,
    inner_rows,
)
from fem_reference.statement.arrays import Floats
from fem_reference.statement.conditions import ENDS
from fem_reference.statement.loads import PointLoad
from fem_reference.statement.problem import Contact, Pin, SolidProblem
from fem_reference.statement.settings import Settings
from fem_reference.system.body import Body, build_body


@dataclass(frozen=True, kw_only=True, eq=False)
class Model:
    """Constant data of a solution."""

    problem: SolidProblem  # input data
    settings: Settings  # tolerances and limits
    bodies: tuple[Body, ...]  # discretised strips
    pairs: tuple[Pair, ...]  # contacts
    expansion: csr_matrix  # matrix ``(2 n, m)`` from the unknowns to the displacements
    restriction: csr_matrix  # transposed expansion: from nodal forces to the forces on the unknowns
    loads: Floats  # dead nodal forces added in every stage, ``(s, n, 2)`` [N]
    sections: tuple[EndSection, ...]  # sections with a support, joint, anchor or moment
    columns: Floats  # columns ``(2 n, 4 e)`` of the sections
    ties: tuple[Tie, ...]  # ties of these sections: components of supports, then of springs, then of joints
    moments: Floats  # dead moments on the sections that are added in every stage, ``(s, e)`` [N m]
    largest_loads: Floats  # largest dead force, or moment over L, added in every stage, ``(s,)`` [N]
    length: float  # length L of the longest strip [m]
    force_scale: float  # largest ``E I / L^2`` of the strips, a scale of forces without load [N]
    axial_stiffness: float  # largest ``E A / L`` of the strips [N/m]
    round_off: float  # round-off of a nodal force [N]
    length_round_off: float  # round-off of a position: 8 machine epsilons of the largest coordinate [m]

    @property
    def nodes(self) -> int:
        """Number of nodes n."""
        return int(self.bodies[-1].part.stop)

    @property
    def unknowns(self) -> int:
        """Number of unknown displacements m."""
        return int(self.expansion.shape[1])

    @property
    def balance_round_off(self) -> float:
        """Round-off of a sum of nodal forces, which grows like a random walk [N]."""
        return float(np.sqrt(2 * self.nodes)) * self.round_off

    def body(self, strip: str) -> Body:
        """Return the body of a strip."""
        return next(body for body in self.bodies if body.strip.name == strip)

    def displacements(self, unknowns: Floats) -> Floats:
        """Displacements ``(n, 2)`` from the unknowns ``(m,)``."""
        return (self.expansion @ unknowns).reshape(-1, 2)


def build(problem: SolidProblem, settings: Settings | None = None) -> Model:
    """Discretise a problem."""
    bodies = list[Body]()
    for strip in problem.strips:
        bodies.append(build_body(strip, bodies))
    length, sections = max(strip.length for strip in problem.strips), tuple(_sections(problem, bodies))
    numbers = {section.node: number for number, section in enumerate(sections)}
    loads = np.zeros((problem.stages, bodies[-1].part.stop, 2))
    moments, largest = np.zeros((problem.stages, len(sections))), np.zeros(problem.stages)
    for load in problem.loads:
        body = next(body for body in bodies if body.strip.name == load.strip)
        forces = load.on_sections(body.strip, body.mesh.stations)
        loads[load.stage, body.part] += body.mesh.sections.T @ forces
        if isinstance(load, PointLoad) and load.moment:
            moments[load.stage, numbers[load.node]] += load.moment
        size = max(float(np.hypot(*forces.sum(axis=0))), abs(load.moment) / length)
        largest[load.stage] = max(largest[load.stage], size)
    expansion = block_diag([body.expansion for body in bodies], format="csr")
    carried = [csr_matrix((0, bodies[-1].part.stop)), *(section.carrier.rows for section in sections)]
    distances = [float(np.hypot(*point)) for strip in problem.strips for point in (strip.start, strip.end)]
    return Model(
        problem=problem,
        settings=settings or Settings(),
        bodies=tuple(bodies),
        pairs=tuple(_pair(problem, bodies, contact) for contact in problem.contacts),
        expansion=expansion,
        restriction=csr_matrix(expansion.T),
        loads=loads,
        sections=sections,
        columns=kron(vstack(carried), np.eye(2)).T.toarray(),
        ties=tuple(_ties(problem, numbers)),
        moments=moments,
        largest_loads=largest,
        length=length,
        force_scale=max(strip.bending_stiffness / strip.length**2 for strip in problem.strips),
        axial_stiffness=max(strip.axial_stiffness for strip in problem.strips),
        round_off=max(body.round_off for body in bodies),
        length_round_off=8 * float(np.finfo(float).eps) * max(*distances, length),
    )


def _joined(problem: SolidProblem) -> set[str]:
    """Ends that are joined to others."""
    return {end for joint in problem.joints for end in joint.ends}


def _carrier(bodies: list[Body], body: Body, rows: csr_matrix) -> Carrier:
    """Points with the weights ``rows`` of a body's nodes."""
    shape = rows.shape[0], bodies[-1].part.stop
    everywhere = csr_matrix((rows.data, rows.indices + body.part.start, rows.indptr), shape=shape)
    # the weights of a first moment sum to zero
    shift = np.outer(np.round(rows.sum(axis=1), 9), body.offset)
    reference = shift + rows @ body.mesh.nodes
    return Carrier(reference=reference, rows=everywhere, transposed=csr_matrix(everywhere.T))


def _sections(problem: SolidProblem, bodies: list[Body]) -> Iterator[EndSection]:
    """End sections that are supported, joined, anchored or loaded by a moment, and sections inside that are loaded by one."""
    bent = {load.node: load for load in problem.loads if isinstance(load, PointLoad) and load.moment}
    held = {item.node for item in (*problem.supports, *problem.springs)}
    needed = held | _joined(problem) | set(bent)
    for body in bodies:
        strip, mesh = body.strip, body.mesh
        ends = {f"{strip.name}.{end}": end for end in ENDS}
        anchored = "" if strip.clamped else f"{strip.name}.start"
        here = [node for node in ends if node == anchored or node in needed]
        found = {node: end_rows(strip, mesh, ends[node]) for node in here}
        for node, load in bent.items():
            if load.strip == strip.name and node not in ends:
                found[node] = inner_rows(strip, mesh, load.at)
        for node, (rows, height) in found.items():
            yield EndSection(
                node=node,
                strip=strip.name,
                arc=bent[node].at * strip.length if node in bent else np.nan,
                carrier=_carrier(bodies, body, rows),
                height=height,
                anchor_stiffness=anchor_stiffness(strip) if node == anchored else 0.0,
            )


def _pair(problem: SolidProblem, bodies: list[Body], contact: Contact) -> Pair:
    """Build a contact pair."""
    named = {body.strip.name: body for body in bodies}
    touched, strips = named[contact.strip], [contact.strip]
    curve, rows = contact_curve(touched.strip, touched.mesh, contact)
    node: Pin | Carrier | None = problem.pin(contact.node)
    if node is None:
        name, end = contact.node.split(".")
        strips.append(name)
        section = named[name].mesh.sections[[0 if end == "start" else -1]]
        node = _carrier(bodies, named[name], section)
    # a point in contact with an axis does not meet its ends
    meets = contact.surface == "face" or (isinstance(node, Pin) and node.radius > 0)
    corners = identity(len(touched.mesh.nodes), format="csr")
    return Pair(
        contact=contact,
        curve=curve,
        carrier=_carrier(bodies, touched, rows),
        node=node,
        penalty=problem.penalty(contact),
        length=touched.strip.length,
        strips=tuple(strips),
        ends={
            end: _carrier(bodies, touched, corners[touched.mesh.edges[end][[0, -1]]])
            for end in ENDS
            if meets and f"{contact.strip}.{end}" not in _joined(problem)
        },
        origin=np.array(problem.strips[0].start),
    )


def _ties(problem: SolidProblem, numbers: dict[str, int]) -> Iterator[Tie]:
    """Ties of supports, springs and joints between the sections with the given ``numbers``."""
    for support in problem.supports:
        for component, rate in enumerate(support.motion):
            if rate is not None:
                rates = np.zeros(problem.stages)
                rates[: 1 + len(support.onward)] = [rate, *(change[component] for change in support.onward)]
                yield Tie(section=numbers[support.node], component=component, rates=tuple(rates.tolist()))
    for spring in problem.springs:
        for component, stiffness in enumerate(spring.stiffness):
            if stiffness:
                yield Tie(section=numbers[spring.node], component=component, flexibility=1 / stiffness)
    for joint in problem.joints:
        for end in joint.ends[1:]:
            hinge = joint.stiffness_of(end)
            pair = numbers[end], numbers[joint.ends[0]]
            for component in range(2 if hinge == 0 else 3):
                flexibility = 1 / hinge if hinge and component == ROTATION else 0.0
                yield Tie(section=pair[0], component=component, other=pair[1], flexibility=flexibility)
