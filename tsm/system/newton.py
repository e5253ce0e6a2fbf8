"""Newton's method. It returns the last iterate with a status and never raises."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tsm.elements.properties import Array
from tsm.model.contact import crowded, owned
from tsm.model.model import Model
from tsm.model.scales import ROUND_OFF, SHARP, TURN, WAY, largest, units_of
from tsm.model.state import State, profile_of
from tsm.statement.settings import Settings
from tsm.statement.status import Status
from tsm.system.equilibrium import Equilibrium
from tsm.system.system import Assembler, Drag, Linearisation

MAX_ITERATIONS = 25
"""Iterations before a step is given up."""
_LONGEST, _LONGEST_WHOLE = 1.0, 1.4
"""Largest Newton step, in units of .3 L and .7 rad; the second value holds where no contact passes from element to element."""
_START, _CLOSE = 1e-2, 1e-9
"""A start below this part of the tolerance is the solution. From one only below the tolerance one more step is taken if it is shorter than the second value."""
_RISE, _SHORTEST = 10.0, 0.1
"""Merit test of exact elements. An iteration that raises the residual tenfold is halved, at most three times. A stricter test refuses
iterations that would converge."""
_NEARBY = 1e-3
"""Largest residual before the last step at which tangent and rates of exact elements serve after it too."""
_NEAR = 1.0
"""Residual below which the number of Gauss nodes may be raised."""
_CARRIED = 16 * float(np.finfo(float).eps)
"""Round-off of the forces that beams carry. It exceeds the tolerance in slender ones that are taut."""
_FALLS = 0.1
"""A residual below this part of the last one is not round-off yet."""
_PAST = 0.05
"""Part of an element's length by which a contact may lie past a node to which the iteration sent it back and forth: the tangents of two
elements differ there, and between them neither has an equilibrium within its ends."""
_CRITICAL = 1e-6
"""Largest round-off of the residual at which an equilibrium is accepted. A contact whose round-off is larger is too near a node: in the paper's critical area."""


def _scales(model: Model) -> tuple[Array, Array, float]:
    """Factors that make residuals comparable, reciprocals of the largest step, over all unknowns, and scaled round-off of the residual."""
    sharp = np.where(np.isin(np.arange(10), (0, 1, 2, 8)), 1.0, SHARP)
    # the forces of a long frame of short beams are those of its extent
    residual = 1 / (units_of(model.sizes._replace(force_scale=model.least_force))[1] * sharp)
    way, turn = 1 / (WAY * model.extent), 1 / TURN
    step = np.array([way, way, turn, 0.0, 0.0, 0.0, 0.0, 0.0, way, turn])
    EA, EI, l0 = (
        value[model.closed] for value in (model.properties.EA, model.properties.EI, model.properties.l0)
    )
    noise = ROUND_OFF * (EA * model.extent / l0 + EI / l0**2).max(initial=0.0) / model.least_force
    if len(model.kind) > model.equations or any(group.internal for group in model.groups):
        noise = max(noise, ROUND_OFF * np.abs(model.coordinates).max() / (SHARP * model.length))
    return residual[model.kind], step[model.kind], float(noise)


class Newton:
    """Newton's method on forces, contact positions and directions together.

    The norm is the largest scaled entry of the residual: forces over ``EI/L^2``, moments over ``EI/L``,
    positions over L/1000. L is the longest beam, so that no scale can vanish. An iteration has converged if
    its norm is below `tolerance`. It has also converged if the norm falls no more and the last two are below the
    round-off of the residual, ``4 eps (EA L/l0 + EI/l0^2)`` in closed form, ``4 eps`` of the node positions where they are
    equations, ``4 eps k_c L`` for a contact of stiffness k_c, or the round-off of the forces that the beams carry.
    """

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model = model
        self.assembler = Assembler(model)
        self.integration_tolerance = settings.integration_tolerance
        self.tolerance = settings.tolerance
        self.scale, self.per_step, self.noise = _scales(model)
        if model.springs is not None:
            self.noise = max(self.noise, model.springs.noise(model.extent, model.least_force))
        # friction asks for rates as accurate as its events
        self.carries = self.assembler.internal and not model.rubbed

    def apart(self, one: State, other: State) -> float:
        """Size of the motion from one state to another, the one measure of how far they are apart."""
        return self.size(self.motion(one, other, other))

    def motion(self, one: State, other: State, like: State) -> Array:
        """Changes of the free displacements and rotations, then of the rotations inside the elements, at the places of a third state.

        Positions inside need no entries: they follow from the rotations and the nodes.
        """
        nodes, rods = (other.q - one.q)[self.model.free], self.model.rods
        return np.concatenate([nodes, rods.turned(one, other, like)]) if rods else nodes

    def potential(self, state: State) -> float:
        """Strain energy less the work of the dead loads."""
        work = self.model.loads.dot(state.load_parameter, state.q)
        if self.model.along.loaded and self.model.rods:
            work += self.model.rods.load_work(state)
        return self.assembler.energy(state) - work

    def size(self, motion: Array) -> float:
        """Largest entry of a motion, in largest Newton steps; nan inside does not count."""
        nodes = self.model.equations
        size, inside = largest(motion[:nodes], self.per_step[:nodes]), motion[nodes:]
        return max(size, float(np.fmax.reduce(np.abs(inside))) / TURN) if len(inside) else size

    def norm(self, system: Linearisation) -> float:
        """Scaled norm of a residual."""
        inside = max(forces.inside for forces in system.groups)
        return max(largest(system.residual, self.scale), inside / SHARP)

    @np.errstate(all="ignore")  # an iterate may be anywhere; what is not finite has a status
    def solve(self, start: State, drag: Drag | None = None, *, across: Array | None = None) -> Equilibrium:
        """Iterate from a start to equilibrium, or to the last iterate with its status.

        ``start``: its load parameter is held unless there is a constraint. ``drag``: resistance to leaving a
        configuration. ``across`` (equations + contact unknowns,): constraint row; the load parameter is an
        unknown too, and every step is orthogonal to this vector.
        """
        state, past, part = start, 0.0, 0.0
        taken: tuple[State, Array, Linearisation] | None = None
        nearby: tuple[Linearisation, Array] | None = None
        residuals: list[float] = []
        owners: list[tuple[int, ...]] = []
        fallback: Equilibrium | None = None
        for iteration in range(MAX_ITERATIONS + 1):
            system = self.assembler.linearise(state, drag)
            residual, left = self.norm(system), MAX_ITERATIONS - iteration
            if fallback is not None and not residual <= self.tolerance:
                return fallback
            risen = taken is not None and self.assembler.internal and not residual <= _RISE * residuals[-1]
            if risen and part > _SHORTEST and left:
                part /= 2
            else:
                residuals.append(residual)
                owners.append(tuple(touch.element for touch in state.touches if touch is not None))
                more = self.with_more_nodes(state, system, residuals) if left else None
                if more is not None:
                    state, taken, nearby = more, None, None
                    continue
                status = self._status(system, residuals, owners, left)
                step = (
                    self._step(system, across) if status is None else self._closer(system, residuals, status)
                )
                here = Equilibrium(
                    newton=self,
                    state=state,
                    status=status or Status.SINGULAR_TANGENT,
                    iterations=iteration,
                    residuals=tuple(residuals),
                    system=system,
                    nearby=nearby if owners[-2:-1] == owners[-1:] else None,
                )
                if step is None:
                    return here
                fallback = None if status is None else here
                past = _PAST if past or _alternates(owners) else 0.0
                (change, load, rate), part = step, 1.0
                taken = state, change, system
                nearby = (system, rate) if self.carries and residual <= _NEARBY else None
            assert taken is not None, "a part of a step is of a step"
            t = taken[0].load_parameter + part * load
            state = self.update(*taken, t=t, residual=True, part=part, past=past)
        raise AssertionError("the last iteration returns")

    def _closer(
        self, system: Linearisation, residuals: list[float], status: Status
    ) -> tuple[Array, float, Array] | None:
        """Step from a start within the tolerance, which leaves the square of its error; None where the tangent is nearly singular."""
        if status is not Status.CONVERGED or len(residuals) > 1 or residuals[-1] <= _START * self.tolerance:
            return None
        step = self._step(system, None)
        return step if step is not None and largest(step[0], self.per_step) <= _CLOSE else None

    def _step(self, system: Linearisation, across: Array | None) -> tuple[Array, float, Array] | None:
        """Newton step of the unknowns and of the load parameter, and rates of the unknowns; None if the tangent is singular."""
        more = [-self.assembler.rate(system)] if self.carries or across is not None else []
        solved = self.assembler.solve(system, *more)
        if solved is None:
            return None
        back, rate = solved[:, 0], solved[:, -1]
        load = 0.0 if across is None else -float(across @ back) / float(across @ rate)
        return back + load * rate, load, rate

    def _status(
        self, system: Linearisation, residuals: list[float], owners: list[tuple[int, ...]], left: int
    ) -> Status | None:
        """Status with which the iteration ends, None if it goes on."""
        if not np.isfinite(residuals[-1]):
            return Status.NOT_FINITE
        if self.converged(residuals, system):
            rods = self.model.rods
            if rods and rods.inaccurate(system.groups[rods.number], self.integration_tolerance):
                return Status.INACCURATE
            return Status.TWO_CONTACTS if crowded(self.model, system.state) else Status.CONVERGED
        if left:
            return None
        return Status.PING_PONG if _alternates(owners) else Status.ITERATION_LIMIT

    def with_more_nodes(self, state: State, system: Linearisation, residuals: list[float]) -> State | None:
        """State with more Gauss nodes in the exact elements; None if it is far from equilibrium or needs no more."""
        rods = self.model.rods
        if rods is None or not residuals[-1] <= _NEAR:
            return None
        if len(residuals) > 1 and residuals[-2] <= _NEAR and not self.converged(residuals, system):
            return None
        return rods.refined(state, system.groups[rods.number], self.integration_tolerance)

    def converged(self, residuals: list[float], system: Linearisation) -> bool:
        """Whether the last residual is small enough, or the last two are round-off and fall no more."""
        small, larger = residuals[-1] <= self.tolerance, max(residuals[-2:])
        falls = residuals[-1] < _FALLS * larger
        if small or len(residuals) == 1 or falls or larger > max(self.noise, _CRITICAL):
            return small
        carried = max(float(np.abs(forces.ends[[0, 1, 3, 4]]).max()) for forces in system.groups)
        return larger <= max(self.noise, max(system.noise, _CARRIED * carried) / self.model.least_force)

    def prescribed(self, state: State, t: float) -> State:
        """State at a load parameter, its supports where they are prescribed."""
        if not self.model.moves:
            return replace(state, load_parameter=t)
        q = state.q.copy()
        q[self.model.fixed] = self.model.motions.at(t)
        q[self.model.slaves] = q[self.model.masters]  # ends behind hinges move with their joints
        return replace(state, load_parameter=t, q=q)

    def update(
        self,
        state: State,
        step: Array,
        system: Linearisation,
        *,
        t: float | None = None,
        residual: bool = False,
        part: float = 1.0,
        past: float = 0.0,
    ) -> State:
        """State after a step, shortened so that no node and no contact moves too far at once.

        ``state``: where the step starts. ``step`` (equations + contact unknowns,): change of the unknowns.
        ``system``: linear system that the step solves. ``residual``: whether the step removes the residual.
        ``part``: fraction of the admissible step that is taken. ``past``: part of an element's length by
        which a contact may lie past its end.
        """
        model = self.model
        dq, dz = step[: model.equations], step[model.equations :]
        size, longest = largest(step, self.per_step), _LONGEST_WHOLE if model.whole else _LONGEST
        factor = part * (longest / size if size > longest else 1.0)
        begin, end = state.load_parameter, state.load_parameter if t is None else t
        if end != begin:
            state = self.prescribed(state, end)
        q = state.q.copy()
        q[model.free] += factor * dq
        q[model.slaves] = q[model.masters]
        if not np.isfinite(size):
            return replace(state, q=q)
        dofs = np.zeros(model.dof_count)
        dofs[model.free], dofs[model.fixed] = dq, model.motions.change(begin, end)
        profile, rods = None, model.rods
        if rods:
            tangent, profile = system.tangent.groups[rods.number], profile_of(state)
            inside = rods.inside(tangent, dofs, dz, end - begin, float(residual))
            profile = replace(profile, angle=profile.angle + factor * inside)
        taken = (factor * dz).tolist()
        touches = tuple(
            touch and (pair.moved(touch, taken[pair.slots]) if pair.slot >= 0 else touch)
            for pair, touch in zip(model.pairs, state.touches, strict=True)
        )
        moved = State(load_parameter=end, q=q, touches=touches, armed=state.armed, profile=profile)
        return owned(model, moved, past)


def _alternates(owners: list[tuple[int, ...]]) -> bool:
    """Whether the owners of the contacts alternated over the last six iterations."""
    last = owners[-6:]
    return len(last) == 6 and last[0] != last[1] and all(a == b for a, b in zip(last, last[2:], strict=False))
