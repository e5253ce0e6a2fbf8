"""Events: the changes of contacts on the way."""

from dataclasses import dataclass

import numpy as np

from fem_reference.model import Model
from fem_reference.slip_events import about_to_change
from fem_reference.state import State
from fem_reference.touch import Touch

TOUCH, RELEASE, SLIP, STICK, SLIP_OFF = "touch", "release", "slip", "stick", "slip-off"
"""Kinds of events."""


@dataclass(frozen=True, kw_only=True)
class ContactEvent:
    """A change of a contact."""

    kind: str  # ``"touch"``, ``"release"``, ``"slip"``, ``"stick"`` or ``"slip-off"``
    # pair, load_parameter: index of the contact, and the load parameter: with friction in the scene that of
    # the event, else of the first accepted state behind it
    pair: int
    load_parameter: float
    arc_position: float  # arc_position, force: coordinate [m] and magnitude of the force [N] before the event
    force: float
    direction: int  # direction of the slip behind it, 1 or -1; 0 without slip


def contact_event(kind: str, touch: Touch, pair: int, t: float, direction: int) -> ContactEvent:
    """Return an event of a contact that was in a state before."""
    force = float(np.hypot(touch.force, touch.tangential_force))
    return ContactEvent(
        kind=kind,
        pair=pair,
        load_parameter=t,
        arc_position=float(touch.projection.zeta),
        force=force,
        direction=direction,
    )


def changes(model: Model, before: State, after: State) -> list[ContactEvent]:
    """Events by which the contacts of an accepted state became those of the next one."""
    found = []
    for pair, ((closed, old), (closes, new)) in enumerate(
        zip(before.contact_set, after.contact_set, strict=True)
    ):
        touch = before.touches[pair]
        if closed != closes:
            located = about_to_change(model, touch)
            at = touch if located or closed else after.touches[pair]
            t = before.t if located else after.t
            found.append(contact_event(TOUCH if closes else RELEASE, at, pair, t, new))
        elif old != new:
            found.append(contact_event(SLIP if new else STICK, after.touches[pair], pair, after.t, new))
    return found
