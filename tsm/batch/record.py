"""Configurations of every structure at the prescribed load parameters, the structure as first axis here."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tsm.elements.properties import Array
from tsm.events import Event, Passage
from tsm.model import Model
from tsm.state import State, Touch
from tsm.status import Status
from tsm.step import Step


@dataclass(frozen=True, kw_only=True)
class Record:
    """Configurations of N structures with p pairs at s load parameters, and how each ended.

    Attributes
    ----------
    q : ndarray, shape (N, s, dofs)
        Displacements.
    closed, armed : ndarray of bool, shape (N, s, p)
        Contacts that are closed, and open ones that may close.
    element, xi : ndarray, shape (N, s, p)
        Owners and positions on them.
    force : ndarray, shape (N, s, p, 2)
        Forces on the beam.
    normal, arc : ndarray, shape (N, s, p)
        Contact forces and arc positions; nan where nothing was reached, or the pair is open and has no position.
    reaction : ndarray, shape (N, s, fixed)
        What the supports exert.
    iterations : ndarray of int, shape (N, s)
        Newton iterations since the load parameter before.
    reached : ndarray of int, shape (N,)
        How many of the load parameters.
    cutbacks : ndarray of int, shape (N,)
        Steps given up.
    status : list of Status
        Outcomes of the structures.
    end : dict of Step
        Where structures stopped that did not reach the last load parameter.
    events : list of list
        Events in order; pass-throughs as what they are interpolated between.
    """

    q: Array
    closed: Array
    armed: Array
    element: Array
    xi: Array
    force: Array
    normal: Array
    arc: Array
    reaction: Array
    iterations: Array
    reached: Array
    cutbacks: Array
    status: list[Status]
    end: dict[int, Step]
    events: list[list[Event | Passage]] = field(repr=False)

    def state(self, n: int, k: int, t: float) -> State:
        """Configuration of structure n at load parameter k, whose value is t."""
        touches = touches_of(self.closed[n, k], self.element[n, k], self.xi[n, k], self.force[n, k])
        armed = tuple(bool(flag) for flag in self.armed[n, k])
        return State(load_parameter=t, q=self.q[n, k].copy(), touches=touches, armed=armed)


def touches_of(closed: Array, element: Array, xi: Array, force: Array) -> tuple[Touch | None, ...]:
    """Contacts of one structure from arrays over its p pairs; the forces have the shape (p, 2)."""
    rows = zip(closed, element.tolist(), xi.tolist(), force.tolist(), strict=True)
    return tuple(
        Touch(element=e, xi=place, force=(fx, fy)) if touching else None
        for touching, e, place, (fx, fy) in rows
    )


def empty(model: Model, count: int, steps: int) -> Record:
    """Record without configurations."""
    shape, pairs = (count, steps), (count, steps, len(model.pairs))
    return Record(
        q=np.zeros((*shape, model.dof_count)),
        closed=np.zeros(pairs, dtype=bool),
        armed=np.zeros(pairs, dtype=bool),
        element=np.zeros(pairs, dtype=int),
        xi=np.zeros(pairs),
        force=np.zeros((*pairs, 2)),
        normal=np.full(pairs, np.nan),
        arc=np.full(pairs, np.nan),
        reaction=np.zeros((*shape, len(model.fixed))),
        iterations=np.zeros(shape, dtype=int),
        reached=np.zeros(count, dtype=int),
        cutbacks=np.zeros(count, dtype=int),
        status=[Status.COMPLETED] * count,
        end={},
        events=[[] for _ in range(count)],
    )
