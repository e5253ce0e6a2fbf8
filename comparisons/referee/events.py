"""The events that an answer states, held against its own states and against exact equilibria followed to each event."""

from collections.abc import Iterator, Mapping

import numpy as np

from comparisons.referee.distance import gap_off, largest_force
from comparisons.referee.equilibrium import SearchStatus
from comparisons.referee.path import PASSES, changes_of, reach
from comparisons.referee.state import Equilibrium, described
from comparisons.response import ContactEvent, Response
from comparisons.scene import ContactSpec, Scene

OPENS, CLOSES = ("release", "slip-off"), ("touch",)
KINDS = (*OPENS, *CLOSES, "slip", "stick", PASSES)
"""Kinds of contact events."""
CRITICAL = ("limit-point", "bifurcation")
"""Kinds of events without a contact."""
ENDING = ("line-contact", "end-contact")
"""Kinds of events at which a contact ends the solution."""


def misstated(
    response: Response, scene: Scene, found: Mapping[int, Equilibrium], allowed: float
) -> Iterator[str]:
    """Yield events that are not those of the answer's states, or at which the exact contact is elsewhere or has another force.

    An event beside one of the exact equilibria `found`, by the numbers of their load parameters, is compared with the equilibrium that
    follows from it: at a contact that is closed there, arc position and force; of one that is open, the gap. With friction,
    `friction.rubbing` compares the events instead.
    """
    specs, times = {spec.pair: spec for spec in scene.contacts}, response.load_parameter
    for event in response.events or ():
        t = event.load_parameter
        if event.kind in CRITICAL or (
            event.kind in ENDING and event.pair in specs and not response.completed
        ):
            continue
        last = times[-1] if response.completed else scene.times[-1]
        if event.kind not in KINDS or event.pair not in specs or not 0.0 <= t <= last:
            yield f"no contact of the scene has the event {event.kind} of {event.pair} at load parameter {t:.6g}"
            continue
        after = int(np.searchsorted(times, t))
        # the load parameter of a pass-through is interpolated
        if event.kind == PASSES or any(spec.friction for spec in scene.contacts):
            continue
        for k in (after - 1, after)[: 1 if event.kind in OPENS else 2]:
            there = _at(scene, found.get(k), t) if _alone(response, event, k) else None
            wrong = "" if there is None else _wrong(scene, specs[event.pair], event, there, allowed)
            if wrong:
                yield f"{event.kind} of {event.pair} at load parameter {t:.6g}: {wrong}"
    for spec in scene.contacts:
        yield from _disorder(response, spec)


def _alone(response: Response, event: ContactEvent, k: int) -> bool:
    """Whether nothing else changes between an event and a load parameter beside it."""
    if not 0 <= k < len(response.load_parameter):
        return False
    low, high = sorted((event.load_parameter, float(response.load_parameter[k])))
    return not any(low <= one.load_parameter <= high for one in changes_of(response) if one is not event)


def _disorder(response: Response, spec: ContactSpec) -> Iterator[str]:
    """Yield an event that closes a closed contact, or that opens or moves an open one."""
    own = [event for event in response.events or () if event.pair == spec.pair and event.kind in KINDS]
    force, times = response.contacts[spec.pair].force, response.load_parameter
    closed = bool(own) and own[0].kind not in CLOSES
    for event in own:
        # a contact may begin without force, closed from the start
        if closed == (event.kind in CLOSES) and not (event is own[0] and force[0] != 0.0):
            yield f"{event.kind} of {spec.pair} at load parameter {event.load_parameter:.6g} where it is {'closed' if closed else 'open'}"
        closed = event.kind not in OPENS
    if own and own[-1].load_parameter < times[-1] and closed != (force[-1] != 0.0):
        yield f"{spec.pair} is {'open' if closed else 'closed'} at the end, not as its last event says"


def _at(scene: Scene, near: Equilibrium | None, t: float) -> Equilibrium | None:
    """Return the equilibrium with the same contacts at an event beside a load parameter; None if there is none."""
    if near is None:
        return None
    found = reach(scene, near.solution, t, near.solution.layout.grips, halvings=2)
    return described(scene, found) if found.status is SearchStatus.FOUND else None


def _wrong(scene: Scene, spec: ContactSpec, event: ContactEvent, there: Equilibrium, allowed: float) -> str:
    """Return what an event states otherwise than the equilibrium there; empty if it states the same."""
    length = scene.beam(spec.beam).length
    contact = there.contacts.get(spec.pair)
    if contact is None and event.kind not in CLOSES:
        return ""
    if contact is None:
        off = gap_off(scene, there, spec, 0.0) / length
        return "" if off <= allowed else f"the node is {off:.2g} L away"
    off = abs(contact.arc_position - event.arc_position) / length
    if not off <= allowed:
        return f"arc position off by {off:.2g}"
    force = 0.0 if event.kind in CLOSES else float(np.hypot(*contact.force))
    off = abs(force - event.force) / largest_force(scene, there)
    return "" if off <= allowed else f"contact force off by {off:.2g}"
