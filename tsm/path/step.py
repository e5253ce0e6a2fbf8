"""Accepted steps, and the log of the march between two of them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field, replace

import numpy as np

from tsm.contact.ends import clearance
from tsm.contact.events import Event, EventKind, normal_force
from tsm.elements.properties import Array
from tsm.model.model import Model
from tsm.model.state import State, touch_of
from tsm.path.critical import CriticalPoint
from tsm.path.margins import WATCHES, Margin
from tsm.statement.status import Status
from tsm.system.equilibrium import Equilibrium

NEAR = 1e-9
"""Distance in the load parameter below which a corner of a pin's path coincides with a prescribed load parameter."""


@dataclass(kw_only=True)
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
    events : list of Event
        Contact events since the step before.
    critical : list of CriticalPoint
        Critical points since the step before.
    index : int
        Index of the equilibrium, see `tsm.system.stability`.
    spent : ndarray, shape (1 + pairs,)
        Work of pins, supports and loads up to here, then the dissipation of every pair, see `tsm.path.energy`;
        empty without friction.
    """

    equilibrium: Equilibrium
    requested: bool = True
    status: Status = Status.CONVERGED
    iterations: int = 0
    cutbacks: int = 0
    events: list[Event] = field(default_factory=list)
    critical: list[CriticalPoint] = field(default_factory=list)
    index: int = -1
    spent: Array = field(default_factory=lambda: np.zeros(0))

    def note(self, kind: EventKind, point: Equilibrium, state: State, k: int) -> None:
        """Record an event of a contact that is closed in a state, with its force at a point."""
        pair, touch = point.model.pairs[k], touch_of(state, k)
        pushes = kind is not EventKind.TOUCH and point.state.touches[k] is not None
        self.events.append(
            Event(
                kind=kind,
                load_parameter=state.load_parameter,
                pair=pair.pair.name,
                element=touch.element - pair.target.first,
                arc_position=pair.arc_position(touch),
                force=normal_force(point, k) if pushes else 0.0,
            )
        )

    def applied(self, point: Equilibrium, state: State, margin: Margin, *, alone: bool = True) -> State:
        """State after an event at a point, which is recorded; `alone` if no contact takes over. Raises StopError where the path ends."""
        k, touches = margin.pair, margin.kind is EventKind.TOUCH
        if not touches and state.touches[k] is not None:
            self.note(margin.kind, point, state, k)
        after = next(w.apply for w in WATCHES if w.kind is margin.kind)(point, state, margin, alone)
        if touches and after.touches[k] is not None:
            self.note(margin.kind, point, after, k)
        return after

    def note_end(self, model: Model, state: State, k: int) -> None:
        """Record that pair k meets an end, or the side that it does not touch, where the path ends."""
        self.events.append(
            Event(
                kind=EventKind.END_CONTACT,
                load_parameter=state.load_parameter,
                pair=model.pairs[k].pair.name,
                arc_position=clearance(model, state, k).arc,
            )
        )

    def release(self, kind: EventKind, energy: float) -> None:
        """Record the energy released in a fall with the last event of a kind, which caused it."""
        n = max(n for n, event in enumerate(self.events) if event.kind is kind)
        self.events[n] = replace(self.events[n], released=energy)


def ends(load_parameters: list[float], turns: tuple[float, ...], begin: float) -> list[float]:
    """Load parameters at which a step must end: the prescribed ones, and the turns of pin paths after `begin` before the last of them.

    A turn near a prescribed one is left out, unless a stage begins there.
    """
    ahead = turns[bisect_right(turns, begin + NEAR) : bisect_left(turns, load_parameters[-1])]
    places = [bisect_left(load_parameters, turn - NEAR) for turn in ahead]
    apart = [t for t, n in zip(ahead, places, strict=True) if load_parameters[n] > t + NEAR]
    begins = [t for t in ahead if t == round(t) and t not in load_parameters]
    return sorted({*load_parameters, *apart, *begins})
