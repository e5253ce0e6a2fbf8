"""The phases of the contacts in an answer: open, slip one way or the other, or stick, with where each begins."""

import math

import numpy as np

from comparisons.answer import Array, ContactEvent, Ints, Response
from comparisons.frozen import Frozen
from comparisons.referee.path import SAME, changes_of
from comparisons.scene import ContactSpec, Scene

OPEN, UNKNOWN = 9, 8
"""Numbers of an open contact and of a slip whose sign an answer does not state, next to the signs -1, 0 and 1 of the slip rate."""
_EDGE = 0.05
"""Distance of a force from the edge of the cone, over the cone, up to which an answer without states of friction slips."""
_MOVED = 1e-3
"""Change of an arc position between two load parameters, over the length, from which such an answer slips."""


class Phase(Frozen):
    """A phase of a contact, which begins between the load parameters `low` and `high`, with the phase before it."""

    spec: ContactSpec
    low: float = 0.0
    high: float = 0.0
    event: ContactEvent | None = None  #: The answer's event at which it begins.
    #: Sign of the slip rate, 0 in stick, `UNKNOWN` for a slip between two load parameters; `OPEN` for an open contact.
    slip: int
    before: "Phase | None"

    @property
    def stated(self) -> float:
        """Where it begins by the answer's events; nan without an event."""
        rest = math.nan if self.before else 0.0
        return self.event.load_parameter if self.event else rest

    @property
    def does(self) -> str:
        """What the contact does in it."""
        return {0: "sticks", OPEN: "opens"}.get(self.slip, "slips")

    @property
    def begin(self) -> float:
        """Where it begins, as far as the answer says."""
        return (self.low + self.high) / 2.0 if np.isnan(self.stated) else self.stated


def states(response: Response, scene: Scene, spec: ContactSpec) -> tuple[Ints, str]:
    """Return the state of a contact at every load parameter, and how it was taken if the answer does not state its friction."""
    contact = response.contacts[spec.pair]
    closed = contact.force != 0.0
    if not spec.friction:
        return np.where(closed, 1, OPEN), ""
    if contact.friction is not None:
        return np.where(closed, np.sign(contact.friction.slip), OPEN), ""
    # since the load parameter before; at the first, up to the next
    change = np.nan_to_num(np.diff(contact.arc_position))
    change = np.append(change[:1], change) if len(change) else np.zeros(len(closed))
    slip = np.where(np.abs(change) > _MOVED * scene.beam(spec.beam).length, np.sign(change), 0.0)
    taken = "changes of its arc position"
    if contact.vector is not None:
        ratio = np.array([_leaning(response, spec, contact.vector[k], k) for k in range(len(closed))])
        slip = np.where(np.abs(ratio) >= 1.0 - _EDGE, np.sign(ratio), slip)
        taken = "the direction of its force and " + taken
    return np.where(closed, slip, OPEN).astype(np.int64), taken


def _leaning(response: Response, spec: ContactSpec, force: Array, k: int) -> float:
    """Tangential over normal force of a contact, over the coefficient of friction, by the direction of the answer's axis."""
    arc, line = response.axis_line(spec.beam, k)
    x, y = (
        np.interp(response.contacts[spec.pair].arc_position[k], arc, way)
        for way in np.gradient(line, arc, axis=0).T
    )
    side = -1.0 if spec.side == "left" else 1.0
    normal = side * (x * force[1] - y * force[0])
    return float((x * force[0] + y * force[1]) / (spec.friction * normal)) if normal > 0.0 else 0.0


def phases(response: Response, spec: ContactSpec, column: Ints) -> tuple[tuple[Phase, ...], tuple[int, ...]]:
    """Return the phases of a contact in order, the first from 0, and the number of the phase at every load parameter."""
    times = np.concatenate([[0.0], response.load_parameter])
    events = changes_of(response, spec.pair)
    found: list[Phase] = []
    numbers: list[int] = []
    for k, now in enumerate(map(int, column)):
        low, high = float(times[k]), float(times[k + 1])
        between = [event for event in events if event.load_parameter <= high]
        before = found[-1].slip if found else _before(between, now)
        # at an event an answer may state the state before or behind it
        if between and between[-1].load_parameter >= high - SAME and not _may_be(between[-1], before, now):
            between = [event for event in between if event.load_parameter < high - SAME]
        events = events[len(between) :]
        if not found:
            found.append(Phase(spec=spec, slip=_before(between, now), before=None))
        for n, event in enumerate(between):
            slip = now if event is between[-1] else _after(event, between[n + 1])
            found.append(Phase(spec=spec, low=low, high=high, event=event, slip=slip, before=found[-1]))
        if found[-1].slip != now:
            found.append(Phase(spec=spec, low=low, high=high, slip=now, before=found[-1]))
        numbers.append(len(found) - 1)
    return tuple(found), tuple(numbers)


def _may_be(event: ContactEvent, before: int, now: int) -> bool:
    """Whether a state is the one behind an event, and not still the one before."""
    return {"stick": now == 0, "slip": now not in (0, before)}.get(event.kind, True)


def _before(events: list[ContactEvent], now: int) -> int:
    """State at the start, from the first events, or from the first load parameter if there are none."""
    kinds = {"touch": OPEN, "stick": UNKNOWN, "slip": 0, "release": UNKNOWN, "slip-off": UNKNOWN}
    return kinds.get(events[0].kind, now) if events else now


def _after(event: ContactEvent, following: ContactEvent) -> int:
    """State after an event that another one follows before the next load parameter."""
    if event.kind == "touch":
        return 0 if following.kind == "slip" else UNKNOWN
    return {"stick": 0, "slip": UNKNOWN}.get(event.kind, OPEN)
