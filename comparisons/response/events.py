"""Events of a path in words, and the forces of a contact at its load parameters and events."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from comparisons.response.along import FIRST
from comparisons.response.record import ContactEvent, Response

RELEASE, SLIP_OFF = "release", "slip-off"
"""Events that open a contact."""
_WORDS = {
    "touch": "{node} touches {beam} at arc position {arc}",
    RELEASE: "{node} leaves {beam} at arc position {arc}",
    SLIP_OFF: "{node} slips off {beam} at arc position {arc}; contact force before {force}",
    "slip": "{node} begins to slip on {beam} at arc position {arc}; contact force {force}",
    "stick": "{node} comes to stick on {beam} at arc position {arc}; contact force {force}",
    "limit-point": "limit point of the path",
    "bifurcation": "bifurcation of the path",
    "pass-through": "",
}
"""Sentences by kind of event; that a contact passes a node of the mesh is no event of the structure."""


def event_words(event: ContactEvent, with_unit: Callable[[float, str], str]) -> str:
    """Return an event in words; empty for one that changes nothing but the element in contact.

    Parameters
    ----------
    event : ContactEvent
        The event.
    with_unit : callable
        ``with_unit(value, kind)``: a number of a kind of quantity as text.
    """
    node, _, beam = event.pair.partition("->")
    words = _WORDS.get(event.kind, "{kind} {pair}").format(
        node=node,
        beam=beam,
        kind=event.kind,
        pair=event.pair,
        arc=with_unit(event.arc_position, "length"),
        force=with_unit(event.force, "force"),
    )
    return f"{words}; {with_unit(event.released, 'energy')} released" if words and event.released else words


def opening(response: Response, pair: str) -> ContactEvent | None:
    """Return the last event that opened a contact; None if there is none, or the model locates no events."""
    opened = [
        event for event in response.events or () if event.pair == pair and event.kind in (RELEASE, SLIP_OFF)
    ]
    return opened[-1] if opened else None


class ContactForce(NamedTuple):
    """A contact force, with its load parameter and arc position."""

    force: float
    load_parameter: float
    arc_position: float


def peak_force(response: Response, pair: str) -> ContactForce | None:
    """Return the first largest force of a contact at the load parameters and before the events; None if it never pushes."""
    found = sorted(_forces(response, pair), key=lambda one: one.load_parameter)
    least = (1.0 - FIRST) * max((one.force for one in found), default=0.0)
    return next((one for one in found if one.force >= least), None)


def last_force(response: Response, pair: str) -> ContactForce | None:
    """Return the last force of a contact at the load parameters and before the events; None if it never pushes."""
    return max(_forces(response, pair), key=lambda one: one.load_parameter, default=None)


def _forces(response: Response, pair: str) -> Iterator[ContactForce]:
    contact = response.contacts[pair]
    for force, t, arc in zip(contact.force, response.load_parameter, contact.arc_position, strict=True):
        if force > 0.0:
            yield ContactForce(float(force), float(t), float(arc))
    for event in response.events or ():
        if event.pair == pair and event.force > 0.0:
            yield ContactForce(event.force, event.load_parameter, event.arc_position)
