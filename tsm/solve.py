"""The two ways to solve: `march` yields accepted steps, `solve` collects them."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator

import numpy as np

from tsm.elements import ELEMENTS, Integrated
from tsm.elements.properties import Array
from tsm.model.model import Model
from tsm.path.follow import Follower
from tsm.path.step import Step
from tsm.result.result import Result, collect
from tsm.statement.settings import Settings
from tsm.statement.status import Status
from tsm.statement.structure import Structure

_MEMORY = 0.8
"""Part of the machine's memory that a solution may take."""
CLOSED, EXACT_ONE, BORDER = 500, 2100, 50
"""Measured memory of one accepted load parameter [byte]: for an element in closed form, for an exact element, and for
each pair of an element and a contact unknown, since these couple with all other unknowns in dense columns."""


class SolveError(RuntimeError):
    """A solution stopped; `result` holds all accepted load parameters.

    Attributes
    ----------
    result : Result
        Partial result; its status is the reason for the stop.
    """

    def __init__(self, result: Result) -> None:
        super().__init__(f"{result.status.name}: {result.message}")
        self.result = result


def march(structure: Structure, load_parameters: Array, settings: Settings | None = None) -> Iterator[Step]:
    """Yield accepted steps; those with `requested` lie on the load parameters exactly.

    Parameters
    ----------
    structure : Structure
        What to solve.
    load_parameters : array_like
        Increasing values in (0, 1]; with stages, up to their number.
    settings : Settings, optional
        Numerical settings.

    Raises
    ------
    ValueError
        If the load parameters do not increase in this range, or a node starts behind the surface it touches.
    """
    targets = checked(load_parameters, structure.stages)
    yield from Follower(Model(structure), settings or Settings()).march(targets)


def solve(
    structure: Structure,
    load_parameters: Array,
    settings: Settings | None = None,
    *,
    throw: bool = True,
    watch: Callable[[Step], None] | None = None,
) -> Result:
    """Equilibrium at all load parameters.

    Parameters
    ----------
    structure, load_parameters, settings
        As for `march`.
    throw : bool
        Whether to raise where the solution stops.
    watch : callable, optional
        Called with every accepted step.

    Returns
    -------
    Result
        Result with the status COMPLETED. Without `throw`, a solution that stopped returns a partial result
        with the reason as status.

    Raises
    ------
    SolveError
        Where the solution stops; carries the partial result.
    ValueError
        As for `march`, or if the memory of the machine does not hold the solution.

    Examples
    --------
    >>> import numpy as np, tsm
    >>> section = tsm.Section(EA=8.4, GA=2.7, EI=2.8e-4)
    >>> cantilever = tsm.Structure(
    ...     beams=(tsm.Beam(name="cantilever", start=(0, 0), end=(1, 0), section=section, elements=10),),
    ...     supports=(tsm.Support(beam="cantilever", end="start"),),
    ...     pins=(tsm.Pin(name="pin", path=((1, 0), (0, 0.6366))),),
    ...     contacts=(tsm.ContactPair(node="pin", beam="cantilever", side="right"),),
    ... )
    >>> result = tsm.solve(cantilever, np.linspace(0.02, 1, 50))
    >>> f"{result.contacts['pin->cantilever'].force[-1]:.6f} N"
    '0.002288 N'
    """
    targets = checked(load_parameters, structure.stages)
    _check_memory(structure, len(targets))
    begin = time.perf_counter()
    model = Model(structure)
    steps = []
    for step in Follower(model, settings or Settings()).march(targets):
        steps.append(step)
        if watch is not None:
            watch(step)
    return ended(model, steps, steps[-1].status, begin, throw=throw)


def ended(model: Model, steps: list[Step], status: Status, begin: float, *, throw: bool) -> Result:
    """Result of a solution that began at a time; if it stopped and is to raise, it raises."""
    status = Status.COMPLETED if status is Status.CONVERGED else status
    result = collect(model, steps, status, time.perf_counter() - begin)
    if throw and status is not Status.COMPLETED:
        raise SolveError(result)
    return result


def checked(load_parameters: Array, stages: int) -> Array:
    """Load parameters as an array, if they increase within (0, number of stages]."""
    targets = np.asarray(load_parameters, dtype=float)
    ok = targets.ndim == 1 and targets.size > 0 and bool(np.isfinite(targets).all())
    if not (ok and targets[0] > 0 and targets[-1] <= stages and bool((np.diff(targets) > 0).all())):
        raise ValueError(f"load_parameters = {load_parameters!r}: must increase within (0, {stages}]")
    return targets


def _check_memory(structure: Structure, load_parameters: int) -> None:
    """Raise a ValueError unless the solution, with one more load parameter that is being solved, fits into the machine."""
    kinds = {beam.name: ELEMENTS[beam.element] for beam in structure.beams}
    elements = sum(beam.elements for beam in structure.beams)
    own = sum(
        beam.elements * (EXACT_ONE if isinstance(kinds[beam.name], Integrated) else CLOSED)
        for beam in structure.beams
    )
    unknowns = sum(kinds[pair.beam].contact_unknowns for pair in structure.contacts)
    needed = (load_parameters + 1) * (own + BORDER * unknowns * elements + 8 * unknowns**2)
    there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    if needed > _MEMORY * there:
        raise ValueError(
            f"load_parameters = {load_parameters}: with {elements} elements and {len(structure.contacts)} contacts needs "
            f"{needed / 1e9:.3g} GB, more than {_MEMORY:.0%} of the memory here ({there / 1e9:.3g} GB)"
        )
