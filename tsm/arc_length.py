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
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from tsm.contact.contact_set import initial_state
from tsm.contact.events import Event, EventKind
from tsm.contact.root import find_root
from tsm.elements.properties import Array
from tsm.model.model import Model
from tsm.path.friction import regripped
from tsm.path.margins import Margin, broken, margins
from tsm.path.path import SMALLEST
from tsm.path.step import Step
from tsm.result.result import Result
from tsm.solve import ended
from tsm.statement.settings import Settings
from tsm.statement.status import RefusedError, Status, StopError
from tsm.statement.structure import Structure
from tsm.system.equilibrium import Equilibrium
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
    begin, model = time.perf_counter(), Model(structure)
    taken: list[Step] = []
    status = Status.COMPLETED
    try:
        path = _Path(model, settings or Settings())
        while len(taken) < steps:
            taken.append(path.advance(arc_length))
    except (StopError, RefusedError) as stop:
        status = stop.status
    return ended(model, taken, status, begin, throw=throw)


class _Direction(NamedTuple):
    """Unit vector along the path."""

    x: Array  # its part over the unknowns of the system; shape (equations + contact unknowns,)
    load: float  # its part along the load parameter


class _Path:
    """The path up to its last point."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.newton = Newton(model, settings)
        start = self.newton.solve(initial_state(model))
        if not start.converged:
            raise StopError(start.status)
        self.here = regripped(start, self._drive(start), start.state)
        per_beam = np.where(model.kind < 2, model.extent / model.length, 1.0) * self.newton.per_step
        self.weight = np.where(model.kind < 3, per_beam, 0.0) ** 2
        self.direction = self._direction(self.here, None)
        self.growth = 1.0

    def _drive(self, point: Equilibrium) -> Drive:
        return self.newton.assembler.drive(point.t)

    def advance(self, arc_length: float) -> Step:
        """One step, shortened where it does not converge, with the limit point it passed if any."""
        step = Step(equilibrium=self.here)
        while True:
            try:
                length = arc_length * self.growth
                there, direction = self._step(length, step)
                break
            except RefusedError:
                step.cutbacks += 1
                self.growth /= 2
                if self.growth < SMALLEST:
                    raise
        begin = self.direction.load
        if broken(self._margins(self.here, begin), self._margins(there, direction.load)):
            raise StopError(Status.CONTACT_CHANGED)
        if direction.load * begin < 0:
            step.events.append(self._limit_point(length, begin, direction.load, step))
        self.here.release()
        self.here, self.direction = there, direction
        self.growth = min(2 * self.growth, 1.0)
        step.equilibrium = there
        return step

    def _margins(self, point: Equilibrium, load: float) -> list[Margin]:
        """Margins on the way on which the load parameter grows or falls."""
        found, way, stick = margins(point, self._drive(point)), math.copysign(1, load), EventKind.STICK
        return [m._replace(value=way * m.value) if m.kind is stick else m for m in found]

    def _direction(self, point: Equilibrium, last: _Direction | None) -> _Direction:
        """Direction of the path in the sense of the last one; at first, towards an increasing load."""
        rates = point.rates(self._drive(point))
        if rates is None:
            raise RefusedError(Status.SINGULAR_TANGENT)
        x = rates.unknowns
        size = float(np.sqrt(x @ (self.weight * x)))
        sign = 1.0 if last is None or x @ (self.weight * last.x) >= 0 else -1.0
        return _Direction(sign * x / size, sign / size)

    def _step(self, length: float, log: Step) -> tuple[Equilibrium, _Direction]:
        """Equilibrium a distance along the direction of the path."""
        here, (x, load) = self.here, self.direction
        start = self.newton.update(here.state, length * x, here.system, t=here.t + length * load)
        point = self.newton.solve(start, across=self.weight * x)
        log.iterations += point.iterations
        if not point.converged:
            raise RefusedError(point.status)
        return point, self._direction(point, self.direction)

    def _limit_point(self, length: float, before: float, after: float, log: Step) -> Event:
        """Limit point within a step: where the direction of the path has no load component."""

        def evaluate(s: float) -> tuple[float, float]:
            point, direction = self._step(s, log)
            return direction.load, point.t

        small, apart, t = _LOCATED * abs(before), _APART * length, None
        with suppress(RefusedError):
            t = find_root(evaluate, (0.0, before), (length, after), small=small, apart=apart)
        return Event(kind=EventKind.LIMIT_POINT, load_parameter=self.here.t if t is None else t)
