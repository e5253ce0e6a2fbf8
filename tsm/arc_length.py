"""Arc-length control: the load parameter is an unknown and may turn back.

A step goes a given distance along the tangent of the path, measured in displacements and rotations only
(Crisfield 1981), and returns to it on the plane across the tangent (Riks 1972). With the unknowns x, the load
parameter t, the unbalanced force f, its derivatives K in x and f_t in t, and the part tau of the path's
tangent in x::

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

from tsm.contact.contact_set import initial_state
from tsm.contact.events import Event, EventKind
from tsm.contact.root import find_root
from tsm.elements.properties import Array
from tsm.model.model import Model
from tsm.path.friction import regripped
from tsm.path.margins import Margin, broken, margins
from tsm.path.path import SMALLEST, Point
from tsm.path.step import Step
from tsm.result.result import Result
from tsm.solve import ended
from tsm.statement.settings import Settings
from tsm.statement.status import Status
from tsm.statement.structure import Structure
from tsm.system.newton import Newton
from tsm.system.system import Drive

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
        Length of a step: root of the sum of squares of displacements over 0.3 L and rotations over 0.7 rad, L
        the longest beam.
    steps : int
        Number of steps.
    settings : Settings, optional
        Numerical settings.
    throw : bool
        Whether to raise where the path cannot be followed.

    Returns
    -------
    Result
        One entry per step; `load_parameter` need not increase. `events` holds the limit points, located where
        the load parameter is stationary along the path.

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
    status = path.status
    while status is Status.CONVERGED and len(taken) < steps:
        step = path.advance(arc_length)
        status = step.status
        taken += [step] * (status is Status.CONVERGED)
    return ended(model, taken, status, begin, throw=throw)


class _Direction(NamedTuple):
    """Unit vector along the path."""

    x: Array  # its part over the unknowns of the system; shape (equations + contact unknowns,)
    load: float  # its part along the load parameter


class _Path:
    """The path up to its last point."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.newton = Newton(model, settings)
        start = Point(self.newton, self.newton.solve(initial_state(model)))
        gripped = regripped(start, self._drive(start), start.state) if model.rubbed else start
        self.status = gripped if isinstance(gripped, Status) else gripped.equilibrium.status
        self.here = start if isinstance(gripped, Status) else gripped
        per_beam = np.where(model.kind < 2, model.extent / model.length, 1.0) * self.newton.per_step
        self.weight = np.where(model.kind < 3, per_beam, 0.0) ** 2
        self.direction = self._direction(self.here, None)
        self.growth = 1.0

    def _drive(self, point: Point) -> Drive:
        return self.newton.assembler.drive(point.t)

    def advance(self, arc_length: float) -> Step:
        """One step, shortened where it does not converge, with the limit point it passed if any."""
        step = Step(equilibrium=self.here.equilibrium)
        while isinstance(reached := self._step(length := arc_length * self.growth, step), Status):
            step.cutbacks += 1
            self.growth /= 2
            if self.growth < SMALLEST:
                return replace(step, status=reached)
        there, direction = reached
        assert self.direction is not None, "a step needs a direction"
        begin = self.direction.load
        if broken(self._margins(self.here, begin), self._margins(there, direction.load)):
            return replace(step, status=Status.CONTACT_CHANGED)
        if direction.load * begin < 0:
            step.events.append(self._limit_point(length, begin, direction.load, step))
        self.here.release()
        self.here, self.direction = there, direction
        self.growth = min(2 * self.growth, 1.0)
        step.equilibrium = there.equilibrium
        return step

    def _margins(self, point: Point, load: float) -> list[Margin]:
        """Margins on the way on which the load parameter grows or falls."""
        found = margins(point, self._drive(point))
        return [
            m._replace(value=math.copysign(1, load) * m.value) if m.kind is EventKind.STICK else m
            for m in found
        ]

    def _direction(self, point: Point, last: _Direction | None) -> _Direction | None:
        """Direction of the path in the sense of the last one; at first, towards an increasing load."""
        rates = point.rates(self._drive(point))
        if rates is None:
            return None
        x = rates.unknowns
        size = float(np.sqrt(x @ (self.weight * x)))
        ahead = 1.0 if last is None else float(x @ (self.weight * last.x))
        sign = 1.0 if ahead >= 0 else -1.0
        return _Direction(sign * x / size, sign / size)

    def _step(self, length: float, log: Step) -> tuple[Point, _Direction] | Status:
        """Point a distance along the direction of the path, or why there is none."""
        if self.direction is None:
            return Status.SINGULAR_TANGENT
        here, (x, load) = self.here, self.direction
        start = self.newton.update(here.state, length * x, here.system, t=here.t + length * load)
        there = self.newton.solve(start, across=self.weight * x)
        log.iterations += there.iterations
        if not there.converged:
            return there.status
        point = Point(self.newton, there)
        direction = self._direction(point, self.direction)
        return Status.SINGULAR_TANGENT if direction is None else (point, direction)

    def _limit_point(self, length: float, before: float, after: float, log: Step) -> Event:
        """Limit point within a step: where the direction of the path has no load component."""

        def evaluate(s: float) -> tuple[float, float] | None:
            reached = self._step(s, log)
            return None if isinstance(reached, Status) else (reached[1].load, reached[0].t)

        small, apart = _LOCATED * abs(before), _APART * length
        t = find_root(evaluate, (0.0, before), (length, after), small=small, apart=apart)
        return Event(kind=EventKind.LIMIT_POINT, load_parameter=self.here.t if t is None else t)
