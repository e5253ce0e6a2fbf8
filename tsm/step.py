"""Accepted steps, and the log of the march between two of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from tsm.critical import CriticalPoint
from tsm.elements.properties import Array
from tsm.events import Event, EventKind
from tsm.newton import Equilibrium
from tsm.pairs import PairModel
from tsm.state import Touch
from tsm.status import Status


@dataclass(frozen=True, kw_only=True)
class Step:
    """An accepted step, or the end of the march.

    Attributes
    ----------
    equilibrium : Equilibrium
        Last accepted configuration.
    requested : bool
        Whether it lies on a prescribed load parameter.
    status : Status
        CONVERGED, or why the march ends here.
    iterations : int
        Newton iterations spent since the step before, failed attempts and location of events included.
    cutbacks : int
        Attempts given up since the step before.
    events : tuple of Event
        Contact events since the step before.
    critical : tuple of CriticalPoint
        Critical points since the step before.
    index : int
        Index of the equilibrium, see `tsm.stability`.
    spent : ndarray, shape (1 + pairs,)
        Work of pins, supports and loads up to here, then the dissipation of every pair, see `tsm.energy`; empty without friction.
    """

    equilibrium: Equilibrium
    requested: bool
    status: Status
    iterations: int
    cutbacks: int
    events: tuple[Event, ...]
    critical: tuple[CriticalPoint, ...] = ()
    index: int = -1
    spent: Array = field(default_factory=lambda: np.zeros(0))


@dataclass(kw_only=True)
class StepLog:
    """Events, iterations and cut-backs since the last yielded step, and what was spent since the start; attributes as in `Step`."""

    iterations: int = 0
    cutbacks: int = 0
    events: list[Event] = field(default_factory=list)
    critical: list[CriticalPoint] = field(default_factory=list)
    spent: Array = field(default_factory=lambda: np.zeros(0))

    def note(
        self, kind: EventKind, load_parameter: float, pair: PairModel, touch: Touch, force: float
    ) -> None:
        """Record an event of a closed contact, with the force before the event."""
        self.events.append(
            Event(
                kind=kind,
                load_parameter=load_parameter,
                pair=pair.pair.name,
                element=touch.element - pair.target.first,
                arc_position=pair.arc_position(touch),
                force=force,
            )
        )

    def note_release(self, released: float) -> None:
        """Record the released energy of a jump with the slip-off that caused it, the last one in the log."""
        n = max(n for n, event in enumerate(self.events) if event.kind is EventKind.SLIP_OFF)
        self.events[n] = replace(self.events[n], released=released)

    def hand_on(
        self, equilibrium: Equilibrium, requested: bool, status: Status, index: int, stage: int
    ) -> Step:
        """Return the step of a stage that ends here, and start anew."""
        if stage > 1:
            self.events = [replace(event, stage=stage) for event in self.events]
        step = Step(
            equilibrium=equilibrium,
            requested=requested,
            status=status,
            iterations=self.iterations,
            cutbacks=self.cutbacks,
            events=tuple(self.events),
            critical=tuple(self.critical),
            index=index,
            spent=self.spent.copy(),
        )
        self.iterations = self.cutbacks = 0
        self.events, self.critical = [], []
        return step
