"""Outcome of a batch: tables over all structures, and a `Result` for each structure on demand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import overload

import numpy as np

from tsm.batch.record import Record
from tsm.elements.properties import Array
from tsm.events import Event, passed
from tsm.model import Model
from tsm.newton import Equilibrium
from tsm.result import Result, SupportHistory, collect
from tsm.status import Status
from tsm.step import Step
from tsm.structure import Structure
from tsm.system import Assembler


class Recorded(Sequence[Result]):
    """Results of recorded structures, each made when it is asked for.

    Parameters
    ----------
    structures : sequence of Structure
        What was solved.
    targets : ndarray, shape (s,)
        Prescribed load parameters.
    record : Record
        What was reached.
    seconds : float
        What one of them took, on the average.
    """

    def __init__(
        self, structures: Sequence[Structure], targets: Array, record: Record, seconds: float
    ) -> None:
        self.structures, self.targets, self.record, self.seconds = structures, targets, record, seconds

    def __len__(self) -> int:
        return len(self.structures)

    @overload
    def __getitem__(self, n: int) -> Result: ...
    @overload
    def __getitem__(self, n: slice) -> Sequence[Result]: ...
    def __getitem__(self, n: int | slice) -> Result | Sequence[Result]:
        if isinstance(n, slice):
            return [self[m] for m in range(*n.indices(len(self)))]
        n = range(len(self))[n]
        record, model = self.record, Model(self.structures[n])
        assembler = Assembler(model)
        steps = [self._step(assembler, n, k) for k in range(record.reached[n])]
        if n in record.end:
            steps.append(record.end[n])
        events: list[Event] = []
        for event in record.events[n]:
            events.extend([event] if isinstance(event, Event) else passed(model, event))
        steps[-1] = replace(steps[-1], cutbacks=int(record.cutbacks[n]), events=tuple(events))
        return collect(model, steps, record.status[n], self.seconds)

    def _step(self, assembler: Assembler, n: int, k: int) -> Step:
        """Step to load parameter k, as the stepper would have yielded it."""
        state = self.record.state(n, k, float(self.targets[k]))
        iterations = int(self.record.iterations[n, k])
        equilibrium = Equilibrium(
            state=state,
            status=Status.CONVERGED,
            iterations=iterations,
            residuals=(),
            system=assembler.linearise(state),
        )
        return Step(
            equilibrium=equilibrium,
            requested=True,
            status=Status.CONVERGED,
            iterations=iterations,
            cutbacks=0,
            events=(),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class BatchResult(Sequence[Result]):
    """Outcome of N structures; as a sequence, their results one by one, with status, message, events and shapes.

    Attributes
    ----------
    status : tuple of Status
        COMPLETED or the reason for the stop, for every structure.
    load_parameter : ndarray, shape (s,)
        Prescribed load parameters; what a structure did not reach is nan in the tables.
    force, arc_position : dict of ndarray, shape (N, s)
        Contact force, 0 where the pair is open, and arc position, nan there, by pair name.
    supports : dict of SupportHistory
        What the supports exert, by supported end ``beam.start``: force (N, s, 2) and moment (N, s).
    tips : dict of ndarray, shape (N, s, 2)
        Position of the beam's end, by beam.
    newton_iterations : ndarray of int, shape (N, s)
        Iterations since the previous prescribed load parameter, 0 where it was not reached.
    cutbacks : ndarray of int, shape (N,)
        Steps given up.
    wall_seconds : float
        Duration of all.
    results : sequence of Result
        The structures one by one.
    """

    status: tuple[Status, ...]
    load_parameter: Array
    force: dict[str, Array]
    arc_position: dict[str, Array]
    supports: dict[str, SupportHistory]
    tips: dict[str, Array]
    newton_iterations: Array
    cutbacks: Array
    wall_seconds: float
    results: Sequence[Result] = field(repr=False)

    def __len__(self) -> int:
        return len(self.results)

    def __iter__(self) -> Iterator[Result]:
        return iter(self.results)

    @overload
    def __getitem__(self, n: int) -> Result: ...
    @overload
    def __getitem__(self, n: slice) -> Sequence[Result]: ...
    def __getitem__(self, n: int | slice) -> Result | Sequence[Result]:
        return self.results[n]


def from_record(
    structures: Sequence[Structure], model: Model, targets: Array, record: Record, seconds: float
) -> BatchResult:
    """Tables of recorded structures, all numbered as a model."""
    reached = np.arange(len(targets)) < record.reached[:, None]
    held = np.full((*reached.shape, model.dof_count), 0.0)
    held[..., model.fixed] = record.reaction
    held = np.where(reached[..., None], held, np.nan).reshape(*reached.shape, -1, 3)
    reactions = {
        name: np.where(own | ~reached[..., None], held[:, :, node], 0.0)
        for name, (node, own) in model.supports.items()
    }
    supports = {
        name: SupportHistory(force=table[..., :2], moment=table[..., 2]) for name, table in reactions.items()
    }
    tips = {}
    for n, (name, place) in enumerate(model.beams.items()):
        dof = 3 * place.nodes[-1]
        ends = np.array([structure.beams[n].end for structure in structures])
        tip = ends[:, None] + record.q[:, :, dof : dof + 2]
        tips[name] = np.where(reached[..., None], tip, np.nan)
    return BatchResult(
        status=tuple(record.status),
        load_parameter=targets,
        force={pair.pair.name: record.normal[:, :, k] for k, pair in enumerate(model.pairs)},
        arc_position={pair.pair.name: record.arc[:, :, k] for k, pair in enumerate(model.pairs)},
        supports=supports,
        tips=tips,
        newton_iterations=record.iterations,
        cutbacks=record.cutbacks,
        wall_seconds=seconds,
        results=Recorded(structures, targets, record, seconds / len(structures)),
    )


def from_results(results: Sequence[Result], targets: Array, seconds: float) -> BatchResult:
    """Tables of structures that were solved one by one."""
    count, first = len(targets), results[0]

    def table(rows: list[Array], fill: float = np.nan) -> Array:
        whole = np.full((len(rows), count, *rows[0].shape[1:]), fill, dtype=rows[0].dtype)
        for part, row in zip(whole, rows, strict=True):
            part[: len(row)] = row
        return whole

    return BatchResult(
        status=tuple(result.status for result in results),
        load_parameter=targets,
        force={name: table([r.contacts[name].force for r in results]) for name in first.contacts},
        arc_position={
            name: table([r.contacts[name].arc_position for r in results]) for name in first.contacts
        },
        supports={
            name: SupportHistory(
                force=table([r.supports[name].force for r in results]),
                moment=table([r.supports[name].moment for r in results]),
            )
            for name in first.supports
        },
        tips={name: table([r.tips[name] for r in results]) for name in first.tips},
        newton_iterations=table([r.newton_iterations for r in results], 0),
        cutbacks=np.array([result.cutbacks for result in results]),
        wall_seconds=seconds,
        results=tuple(results),
    )
