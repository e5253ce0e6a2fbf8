"""Arc-length control: the load parameter is an unknown and may turn back.

A step goes a given distance along the tangent of the path, measured in displacements and rotations only (Crisfield 1981), and
returns to it on the plane across the tangent (Riks 1972). With the unknowns x, the load parameter t, the unbalanced force f, its
derivatives K in x and f_t in t, and the part tau of the path's tangent in x::

    [ K    f_t ] [ dx ]     [ f ]
    [ tau   0  ] [ dt ] = - [ tau . (x - x_predicted) ]

K is solved for both right-hand sides at once, so its band is kept; the path passes limit points of the load.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from tsm.contact_set import initial_state
from tsm.elements.properties import Array
from tsm.events import Event, EventKind, broken, margins
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.result import Result, collect
from tsm.settings import Settings
from tsm.solve import SolveError
from tsm.state import State
from tsm.status import Status
from tsm.step import Step
from tsm.structure import Structure
from tsm.system import Linearisation


def trace(
    structure: Structure,
    *,
    arc_length: float,
    steps: int,
    settings: Settings | None = None,
    throw: bool = True,
) -> Result:
    """Follow the equilibrium path from the undeformed state.

    Parameters
    ----------
    structure : Structure
        What to solve; its loads, prescribed displacements and pins scale with the load parameter.
    arc_length : float
        Length of a step: root of the sum of squares of displacements over 0.3 L and rotations over 0.7 rad, L the longest beam.
    steps : int
        Number of steps.
    settings : Settings, optional
        Numerical settings; `smallest_step` bounds the arc length after cut-backs.
    throw : bool
        Whether to raise where the path cannot be followed.

    Returns
    -------
    Result
        One entry per step; `load_parameter` need not increase. `events` holds the limit points, located where the load
        parameter is stationary along the path.

    Raises
    ------
    SolveError
        Where the path cannot be followed; carries the partial result.
    ValueError
        If `arc_length` or `steps` is not positive.
    """
    if not (np.isfinite(arc_length) and arc_length > 0):
        raise ValueError(f"arc_length = {arc_length!r}: must be positive and finite")
    if steps < 1:
        raise ValueError(f"steps = {steps!r}: must be at least 1")
    begin = time.perf_counter()
    model = Model(structure)
    path = _Path(model, settings or Settings())
    taken: list[Step] = []
    status = path.here.status
    while status is Status.CONVERGED and len(taken) < steps:
        step, status = path.advance(arc_length)
        if status is Status.CONVERGED:
            taken.append(step)
    status = Status.COMPLETED if status is Status.CONVERGED else status
    result = collect(model, taken, status, time.perf_counter() - begin)
    if throw and status is not Status.COMPLETED:
        raise SolveError(result)
    return result


@dataclass(frozen=True, kw_only=True)
class _Tangent:
    """Direction of the path over the unknowns of the system, of unit length, of the load parameter, and where it was taken."""

    x: Array
    load: float
    system: Linearisation


class _Path:
    """Where the path has come to."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model = model
        self.settings = settings
        self.newton = Newton(model, settings)
        self.here = self.newton.solve(initial_state(model))
        per_beam = np.where(model.kind < 2, model.extent / model.length, 1.0) * self.newton.per_limit
        self.weight = np.concatenate([per_beam, np.zeros(model.contact_unknowns)]) ** 2
        self.tangent = self._tangent(self.here.state, None)
        self.growth = 1.0
        self.failure = Status.CUTBACK_FLOOR

    def advance(self, arc_length: float) -> tuple[Step, Status]:
        """One step, shortened where it does not converge, with the limit point it passed if any."""
        iterations = cutbacks = 0
        reached: tuple[Equilibrium, _Tangent] | None = None
        while reached is None:
            length = arc_length * self.growth
            reached, spent = self._step(length)
            iterations += spent
            if reached is None:
                cutbacks += 1
                self.growth /= 2
                if self.growth < self.settings.smallest_step:
                    return self._record(self.here, iterations, cutbacks, ()), self.failure
        there, tangent = reached
        before = margins(self.model, self.here, self.newton.tolerance)
        if broken(before, margins(self.model, there, self.newton.tolerance)):
            return self._record(there, iterations, cutbacks, ()), Status.CONTACT_CHANGED
        events: tuple[Event, ...] = ()
        if self.tangent is not None and tangent.load * self.tangent.load < 0:
            found, spent = self._limit_point(length, tangent.load)
            iterations += spent
            events = (found,)
        self.here, self.tangent = there, tangent
        self.growth = min(2 * self.growth, 1.0)
        return self._record(there, iterations, cutbacks, events), Status.CONVERGED

    def _record(self, at: Equilibrium, iterations: int, cutbacks: int, events: tuple[Event, ...]) -> Step:
        return Step(
            equilibrium=at,
            requested=True,
            status=Status.CONVERGED,
            iterations=iterations,
            cutbacks=cutbacks,
            events=events,
        )

    def _tangent(self, state: State, last: _Tangent | None) -> _Tangent | None:
        """Tangent of the path, in the sense of the last one; at first, of an increasing load."""
        assembler = self.newton.assembler
        system = assembler.linearise(state)
        solved = assembler.solve(system, -assembler.rate(state))
        if solved is None:
            return None
        x = solved.x[:, 1]
        size = float(np.sqrt(x @ (self.weight * x)))
        ahead = 1.0 if last is None else float(x @ (self.weight * last.x))
        sign = 1.0 if ahead >= 0 else -1.0
        return _Tangent(x=sign * x / size, load=sign / size, system=system)

    def _moved(
        self, state: State, system: Linearisation, step: Array, load: float, *, residual: bool
    ) -> State:
        moved = self.newton.update(state, step, system, along=load, residual=residual)
        return self.newton.prescribed(moved, state.load_parameter + load)

    def _step(self, length: float) -> tuple[tuple[Equilibrium, _Tangent] | None, int]:
        """Equilibrium a distance along the tangent, and the iterations it took."""
        along, assembler = self.tangent, self.newton.assembler
        if along is None:
            self.failure = Status.SINGULAR_TANGENT
            return None, 0
        state = self._moved(
            self.here.state, along.system, length * along.x, length * along.load, residual=False
        )
        residuals: list[float] = []
        for iteration in range(self.settings.max_iterations + 1):
            system = assembler.linearise(state)
            residuals.append(self.newton.norm(system))
            if not np.isfinite(residuals[-1]):
                self.failure = Status.NOT_FINITE
                return None, iteration
            finer = self.newton.with_more_nodes(state, system, residuals)
            if finer is not None:
                state = finer
                continue
            if self.newton.converged(residuals, system):
                verdict = self.newton.verdict(system)
                if verdict is not Status.CONVERGED:
                    self.failure = verdict
                    return None, iteration
                there = Equilibrium(
                    state=state,
                    status=Status.CONVERGED,
                    iterations=iteration,
                    residuals=tuple(residuals),
                    system=system,
                )
                tangent = self._tangent(state, along)
                return (None if tangent is None else (there, tangent)), iteration
            solved = assembler.solve(system, -assembler.rate(state))
            if solved is None:
                self.failure = Status.SINGULAR_TANGENT
                return None, iteration
            back, rate = solved.x.T
            across = self.weight * along.x
            load = -float(across @ back) / float(across @ rate)
            state = self._moved(state, system, back + load * rate, load, residual=True)
        self.failure = Status.ITERATION_LIMIT
        return None, self.settings.max_iterations

    def _limit_point(self, length: float, after: float) -> tuple[Event, int]:
        """Limit point within a step: where the tangent has no load component, by false position (Illinois)."""
        assert self.tangent is not None, "a path that was followed has a tangent"
        (s0, y0), (s1, y1) = (0.0, self.tangent.load), (length, after)
        state, iterations = self.here.state, 0
        for _ in range(60):
            s = s0 + (s1 - s0) * y0 / (y0 - y1)
            reached, spent = self._step(s)
            iterations += spent
            if reached is None:
                break
            there, tangent = reached
            state = there.state
            if abs(tangent.load) < 1e-9 * abs(self.tangent.load) or abs(s1 - s0) < 1e-12 * length:
                break
            if tangent.load * y0 > 0:
                s0, y0, y1 = s, tangent.load, y1 / 2
            else:
                s1, y1, y0 = s, tangent.load, y0 / 2
        event = Event(
            kind=EventKind.LIMIT_POINT,
            load_parameter=state.load_parameter,
            pair="",
            element=-1,
            arc_position=float("nan"),
            force=0.0,
        )
        return event, iterations
