"""Result of a solution: histories over the prescribed load parameters, shapes, section forces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tsm.contact.events import Event, normal_force, traction
from tsm.elements.properties import Array
from tsm.model.contact import on_rigid_nodes
from tsm.model.groups.base import Stations
from tsm.model.model import Model
from tsm.path.critical import CriticalPoint
from tsm.path.friction import grips
from tsm.path.step import Step
from tsm.result import present
from tsm.result.deformation import Deformation, deformation
from tsm.statement.status import Status
from tsm.system.equilibrium import Equilibrium
from tsm.system.system import Assembler


@dataclass(frozen=True, kw_only=True)
class ContactHistory:
    """One contact pair over the load.

    Attributes
    ----------
    force : ndarray, shape (s,)
        Contact force, 0 where the pair is open.
    arc_position : ndarray, shape (s,)
        Distance along the undeformed axis from the beam's start, nan where the pair is open.
    gap : ndarray, shape (s,)
        Distance of the node from the contact surface; what Newton's method left where the pair is closed, nan
        where the node is not over the beam or has slipped past it.
    friction : FrictionHistory or None
        What friction does, None without friction.
    """

    force: Array
    arc_position: Array
    gap: Array
    friction: FrictionHistory | None = None


@dataclass(frozen=True, kw_only=True)
class FrictionHistory:
    """Friction of a contact pair over the load.

    Attributes
    ----------
    tangential, normal : ndarray, shape (s,)
        Force on the beam along its tangent, positive from start to end, and across it away from the node; 0 where the pair is open.
    slip : ndarray of int, shape (s,)
        Sign of the slip rate, +1 towards the beam's end; 0 in stick and where the pair is open.
    dissipated : ndarray, shape (s,)
        Energy dissipated since the start; nan of a path that `trace` followed, which may go back.
    """

    tangential: Array
    normal: Array
    slip: Array
    dissipated: Array


@dataclass(frozen=True, kw_only=True)
class SupportHistory:
    """What a support exerts on the end of its beam.

    Attributes
    ----------
    force : ndarray, shape (s, 2)
        Force (x, y), zero in a free direction.
    moment : ndarray, shape (s,)
        Moment about the supported end, anticlockwise; zero where the rotation is free.
    """

    force: Array
    moment: Array


@dataclass(frozen=True, kw_only=True, repr=False)
class Result:
    """Outcome of a solution. It prints itself in a few lines and draws itself.

    Attributes
    ----------
    status : Status
        COMPLETED or the reason for the stop.
    message : str
        One sentence: the status and what was reached.
    load_parameter : ndarray, shape (s,)
        Prescribed load parameters that were reached.
    contacts : dict of ContactHistory
        By pair name, ``node->beam``.
    supports : dict of SupportHistory
        By supported end, ``beam.start``.
    springs : dict of SupportHistory
        Force and moment of the springs to the ground on the structure, by beam's end, ``beam.end``.
    tips : dict of ndarray, shape (s, 2)
        Position of the beam's end, by beam.
    newton_iterations : ndarray of int, shape (s,)
        Iterations since the previous prescribed load parameter.
    cutbacks : int
        Steps given up.
    events : tuple of Event
        Contact events and critical points in order.
    index : ndarray of int, shape (s,)
        Number of negative eigenvalues of the energy under the supports and closed contacts: 0 where the equilibrium is stable, -1
        where a contact has no energy.
    critical : tuple of CriticalPoint
        Critical points of the path, with their modes.
    work : ndarray, shape (s,), or empty
        Work of pins, supports and loads since the start; empty without friction, where the potential has it all.
    deformation : Deformation or None
        The most deformed element at every accepted step, also between the prescribed load parameters; None if all are exact.
    unknowns : int
        Number of unknowns.
    wall_seconds : float
        Duration of the solution.
    """

    status: Status
    message: str
    load_parameter: Array
    contacts: dict[str, ContactHistory]
    supports: dict[str, SupportHistory]
    springs: dict[str, SupportHistory]
    tips: dict[str, Array]
    newton_iterations: Array
    cutbacks: int
    events: tuple[Event, ...]
    index: Array
    critical: tuple[CriticalPoint, ...]
    work: Array
    deformation: Deformation | None
    unknowns: int
    wall_seconds: float
    model: Model
    equilibria: tuple[Equilibrium, ...]

    __repr__ = present.summary
    _repr_html_ = present.html
    arrays = present.arrays
    table = present.table
    plot = present.plot

    @cached_property
    def strain_energy(self) -> Array:
        """Strain energy of beams and contact dents, shape (s,)."""
        assembler = Assembler(self.model)
        return np.array([assembler.energy(equilibrium.state) for equilibrium in self.equilibria])

    @cached_property
    def integration_error(self) -> float:
        """Largest estimated error of the integration inside exact elements, see `Settings.integration_tolerance`; 0 without such elements."""
        if (rods := self.model.rods) is None:
            return 0.0
        systems = (equilibrium.system.groups[rods.number] for equilibrium in self.equilibria)
        return max((rods.integration_error(forces) for forces in systems), default=0.0)

    def shape(self, beam: str, k: int) -> Array:
        """Deformed nodes of a beam at accepted load parameter k: x, y, rotation; shape (elements + 1, 3)."""
        nodes = self.model.beams[beam].nodes
        shape = self.equilibria[k].state.q.reshape(-1, 3)[nodes].copy()
        shape[:, :2] += self.model.coordinates[nodes]
        return shape

    def axis_line(self, beam: str, k: int, points_per_element: int | None = None) -> tuple[Array, Array]:
        """Deflected axis of a beam at accepted load parameter k.

        Parameters
        ----------
        beam : str
            Name of the beam.
        k : int
            Number of the accepted load parameter.
        points_per_element : int, optional
            Intervals in every element: 10, and of exact elements so many that the beam has 100.

        Returns
        -------
        arc : ndarray, shape (m,)
            Distance along the undeformed axis.
        xy : ndarray, shape (m, 2)
            Deformed position.
        """
        return self.equilibria[k].axis_line(beam, points_per_element)

    def stations(self, beam: str, k: int) -> Stations:
        """Lines along a beam at accepted load parameter k: its elements, or short pieces of the segments of exact ones."""
        place, state = self.model.beams[beam], self.equilibria[k].state
        shape, forces = self.shape(beam, k), self.section_forces(beam, k)
        return self.model.group_of(place).stations(place, state, shape, forces)

    def section_forces(self, beam: str, k: int) -> Array:
        """Axial force, shear force and moment at both ends of the elements of a beam.

        Positive are tension, a force to the left of the beam's direction on the right-hand cut, and an anticlockwise
        moment on it. Axial and shear force are along and across the chord, of exact elements along and across the section's axis.

        Returns
        -------
        ndarray, shape (elements, 2, 3)
        """
        place, system = self.model.beams[beam], self.equilibria[k].system
        group = self.model.group_of(place)
        numbers = self.model.place[place.first : place.last + 1]
        x, y, moment = (system.groups[group.number].ends[:, numbers].T.reshape(-1, 2, 3) * [[-1], [1]]).T
        along = (x + 1j * y).T * group.section_axes(place, self.shape(beam, k)).conj()
        return np.stack([along.real, along.imag, moment.T], axis=2)


def collect(model: Model, steps: list[Step], status: Status, seconds: float) -> Result:
    """Result of the accepted steps."""
    requested = [step for step in steps if step.requested]
    equilibria = tuple(step.equilibrium for step in requested)
    spent = np.cumsum([step.iterations for step in steps])
    upto = spent[[k for k, step in enumerate(steps) if step.requested]] if steps else np.zeros(0, int)
    return Result(
        status=status,
        message=status.value + _where(model, steps, status),
        load_parameter=np.array([e.state.load_parameter for e in equilibria]),
        contacts={pair.pair.name: _contact(model, requested, k) for k, pair in enumerate(model.pairs)},
        supports={
            name: _history([np.where(held, e.system.nodal[3 * node : 3 * node + 3], 0.0) for e in equilibria])
            for name, (node, held) in model.supports.items()
        },
        springs=_springs(model, equilibria),
        tips={
            name: model.coordinates[place.nodes[-1]]
            + np.array([e.state.q[3 * place.nodes[-1] :][:2] for e in equilibria]).reshape(-1, 2)
            for name, place in model.beams.items()
        },
        newton_iterations=np.diff(upto, prepend=0),
        cutbacks=sum(step.cutbacks for step in steps),
        events=tuple(event for step in steps for event in step.events),
        index=np.array([step.index for step in requested], dtype=np.int64),
        critical=tuple(point for step in steps for point in step.critical),
        work=np.array([step.spent[0] for step in requested if len(step.spent)]),
        deformation=deformation(model, [step.equilibrium for step in steps]),
        unknowns=model.unknowns,
        wall_seconds=seconds,
        model=model,
        equilibria=equilibria,
    )


def _where(model: Model, steps: list[Step], status: Status) -> str:
    """Where a solution stopped, who meets which end of which beam there, and what to try where a node of the paper's elements is in the way."""
    if status is Status.COMPLETED:
        return ""
    state = steps[-1].equilibrium.state if steps else None
    reached = next((s.equilibrium.state.load_parameter for s in reversed(steps) if s.requested), 0.0)
    stopped = state.load_parameter if state else 0.0
    where = f"; stopped at load parameter {stopped:.6g}, last reported {reached:.6g}"
    if status is Status.CUTBACK_FLOOR and state:
        for pair in on_rigid_nodes(model, state):
            beam = pair.target.beam
            where += (
                f'; {pair.pair.name}: the contact lies on a node, where elements "{beam.element}" are rigid: '
                f"try {beam.elements + 1} elements"
            )
    if status is Status.END_CONTACT:
        event = steps[-1].events[-1]
        pair = next(pair for pair in model.pairs if pair.pair.name == event.pair)
        ends = {0.0: "the start", pair.target.beam.length: "the end"}
        what = f"{ends.get(event.arc_position, 'the other side')} of {pair.pair.beam}"
        where = f": {pair.pair.node} meets {what} at load parameter {event.load_parameter:.9g}{where}"
    return where


def _contact(model: Model, steps: list[Step], k: int) -> ContactHistory:
    rows = [_contact_at(step.equilibrium, k) for step in steps]
    force, arc, gap = np.array(rows).reshape(-1, 3).T
    friction = _friction(steps, k) if model.pairs[k].rubs else None
    return ContactHistory(force=force, arc_position=arc, gap=gap, friction=friction)


def _contact_at(equilibrium: Equilibrium, k: int) -> tuple[float, float, float]:
    model, state = equilibrium.model, equilibrium.state
    pair = model.pairs[k]
    touch = state.touches[k]
    if touch is not None:
        left = equilibrium.system.residual[model.equations :][pair.slots][:2]
        return normal_force(equilibrium, k), pair.arc_position(touch), float(np.hypot.reduce(left))
    seen = model.project(pair, state)
    over = state.armed[k] and seen.overshoot <= 0
    return 0.0, np.nan, seen.gap if over else np.nan


def _friction(steps: list[Step], k: int) -> FrictionHistory:
    rows = []
    for step in steps:
        grip = grips(step.equilibrium.state).get(k)
        here = traction(step.equilibrium, k) if grip else None
        force = (here.tangential, here.normal) if here else (0.0, 0.0)
        rows.append((*force, grip.slip if grip else 0, step.spent[1 + k] if len(step.spent) else np.nan))
    tangential, normal, slip, dissipated = np.array(rows).reshape(-1, 4).T
    return FrictionHistory(
        tangential=tangential, normal=normal, slip=slip.astype(np.int64), dissipated=dissipated
    )


def _springs(model: Model, equilibria: tuple[Equilibrium, ...]) -> dict[str, SupportHistory]:
    """Forces of the springs to the ground, ``-k u``."""
    histories = {}
    for spring in model.structure.springs:
        name = f"{spring.beam}.{spring.end}"
        node, stiffness = 3 * model.end_node(name), np.array([spring.x, spring.y, spring.rotation])
        histories[name] = _history([-stiffness * e.state.q[node : node + 3] for e in equilibria])
    return histories


def _history(rows: list[Array]) -> SupportHistory:
    table = np.array(rows).reshape(-1, 3)
    return SupportHistory(force=table[:, :2], moment=table[:, 2])
