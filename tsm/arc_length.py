"""Arc-length control: the load parameter is an unknown and may turn back.

A step goes a given distance along the tangent of the path, measured in displacements and rotations only (Crisfield 1981), and
returns to it on the plane across the tangent (Riks 1972). With the unknowns x, the load parameter t, the unbalanced force f, its
derivatives K in x and f_t in t, and the part tau of the path's tangent in x::

    [ K    f_t ] [ dx ]     [ f ]
    [ tau   0  ] [ dt ] = - [ tau . (x - x_predicted) ]

K is solved for both right-hand sides at once, so its band is kept; the path passes limit points of the load.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tsm.contact_set import initial_state
from tsm.elements.properties import Array
from tsm.events import Event, EventKind, Margin, broken, margins
from tsm.friction import regripped, slip_rates
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.path import PathTangent
from tsm.result import Result, collect
from tsm.root import find_root
from tsm.settings import Settings
from tsm.solve import SolveError
from tsm.state import State
from tsm.status import Status
from tsm.step import Step
from tsm.structure import Structure

_LOCATED, _APART = 1e-9, 1e-12
"""Load component, in parts of the one before, and bracket of lengths, in parts of the step, at which a limit point is found."""


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
        If `arc_length` or `steps` is not positive, or the load has stages.
    """
    if not (np.isfinite(arc_length) and arc_length > 0):
        raise ValueError(f"arc_length = {arc_length!r}: must be positive and finite")
    if steps < 1:
        raise ValueError(f"steps = {steps!r}: must be at least 1")
    if structure.stages > 1:
        raise ValueError(f"stages = {structure.stages}: arc-length control follows a single stage, use solve")
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


class _Direction(NamedTuple):
    """Unit vector along the path at an equilibrium."""

    x: Array  # its part over the unknowns of the system; shape (equations + contact unknowns,)
    load: float  # its part along the load parameter
    tangent: PathTangent  # tangent of the path there


class _Path:
    """The path up to its last equilibrium."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model, self.settings = model, settings
        self.newton = Newton(model, settings)
        self.here = self._start()
        per_beam = np.where(model.kind < 2, model.extent / model.length, 1.0) * self.newton.per_step
        self.weight = np.where(model.kind < 3, per_beam, 0.0) ** 2
        self.direction = self._direction(self.here, None)
        self.growth, self.iterations = 1.0, 0
        self.failure = Status.SINGULAR_TANGENT

    def advance(self, arc_length: float) -> tuple[Step, Status]:
        """One step, shortened where it does not converge, with the limit point it passed if any."""
        cutbacks, self.iterations = 0, 0
        while (reached := self._step(length := arc_length * self.growth)) is None:
            cutbacks += 1
            self.growth /= 2
            if self.growth < self.settings.smallest_step:
                return self._record(self.here, cutbacks), self.failure
        there, direction = reached
        assert self.direction is not None, "a step needs a direction"
        if broken(self._margins(self.here, self.direction), self._margins(there, direction)):
            return self._record(there, cutbacks), Status.CONTACT_CHANGED
        begin = self.direction.load
        turns = direction.load * begin < 0
        events = (self._limit_point(length, begin, direction.load),) if turns else ()
        self.direction.tangent.release()
        self.here, self.direction = there, direction
        self.growth = min(2 * self.growth, 1.0)
        return self._record(there, cutbacks, events), Status.CONVERGED

    def _margins(self, equilibrium: Equilibrium, direction: _Direction) -> list[Margin]:
        drive = self.newton.assembler.drive(equilibrium.state.load_parameter)
        rates = slip_rates(self.newton, equilibrium, drive)
        ahead = {k: math.copysign(rate, rate * direction.load) for k, rate in rates.items()}
        return margins(self.newton, equilibrium, ahead)

    def _start(self) -> Equilibrium:
        """Undeformed equilibrium whose contacts with friction slip or stick as the load grows."""
        start = self.newton.solve(initial_state(self.model))
        if not self.model.rubbed:
            return start
        state = regripped(self.newton, start.state, self.newton.assembler.drive(0.0), start.state)
        if isinstance(state, Status):
            return replace(start, status=state)
        return replace(start, state=state, system=self.newton.assembler.linearise(state))

    def _record(self, equilibrium: Equilibrium, cutbacks: int, events: tuple[Event, ...] = ()) -> Step:
        return Step(
            equilibrium=equilibrium,
            requested=True,
            status=Status.CONVERGED,
            iterations=self.iterations,
            cutbacks=cutbacks,
            events=events,
        )

    def _direction(self, equilibrium: Equilibrium, last: _Direction | None) -> _Direction | None:
        """Direction of the path in the sense of the last one; at first, towards an increasing load."""
        t, tangent = equilibrium.state.load_parameter, PathTangent(self.newton, equilibrium)
        x = tangent.rates(t, t)
        if x is None:
            return None
        size = float(np.sqrt(x @ (self.weight * x)))
        ahead = 1.0 if last is None else float(x @ (self.weight * last.x))
        sign = 1.0 if ahead >= 0 else -1.0
        return _Direction(sign * x / size, sign / size, tangent)

    def _step(self, length: float) -> tuple[Equilibrium, _Direction] | None:
        """Equilibrium a distance along the direction of the path."""
        if self.direction is None:
            return None
        here, (x, load, _) = self.here, self.direction
        t = here.state.load_parameter + length * load
        start = self.newton.update(here.state, length * x, here.system, t=t)
        there = self.newton.solve(start, across=self.weight * x)
        self.iterations += there.iterations
        direction = self._direction(there, self.direction) if there.status is Status.CONVERGED else None
        self.failure = Status.SINGULAR_TANGENT if there.status is Status.CONVERGED else there.status
        return None if direction is None else (there, direction)

    def _limit_point(self, length: float, before: float, after: float) -> Event:
        """Limit point within a step: where the direction of the path has no load component."""

        def evaluate(s: float) -> tuple[float, State] | None:
            reached = self._step(s)
            return None if reached is None else (reached[1].load, reached[0].state)

        small, apart = _LOCATED * abs(before), _APART * length
        state = find_root(evaluate, (0.0, before), (length, after), small=small, apart=apart)
        t = (state or self.here.state).load_parameter
        return Event(kind=EventKind.LIMIT_POINT, load_parameter=t)
