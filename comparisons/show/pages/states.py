"""The states of contacts with friction as bands over the load parameter."""

from collections.abc import Mapping
from itertools import groupby

import numpy as np

from comparisons.response import CONTACT_STATES, SLIPS, Response
from comparisons.show.pages.page import Section, piece

HATCH = "repeating-linear-gradient(135deg,#16181d 0 1px,{} 1px 5px)"
COLOURS = {**CONTACT_STATES, SLIPS[-1]: HATCH.format(CONTACT_STATES[SLIPS[-1]])}
"""Backgrounds of the bands; one is hatched, which distinguishes it in grey print."""


def states_section(responses: Mapping[str, Response]) -> Section | None:
    """Return a section with one band for each run and contact with friction; None without friction."""
    bands = {
        f"{label}, {pair}" if len(response.contacts) > 1 else label: band(response, pair)
        for label, response in responses.items()
        for pair, contact in response.contacts.items()
        if contact.friction is not None and len(response.load_parameter)
    }
    if not bands:
        return None
    last = max(parts[-1][2] for parts in bands.values())
    return Section("Stick and slip", piece("states", bands, COLOURS, last))


def band(response: Response, pair: str) -> list[tuple[str, float, float]]:
    """Return the states of a contact in their order, each with the load parameters between which it lasts."""
    contact, times = response.contacts[pair], response.load_parameter
    assert contact.friction is not None, "a band belongs to a contact with friction"
    events = [event for event in response.events or () if event.pair == pair and event.kind != "pass-through"]
    located = sorted(event.load_parameter for event in events)
    parts: list[tuple[str, float, float]] = []
    begin, last = 0.0, 0
    for state, same in groupby(contact.friction.states(contact.force)):
        last += len(list(same))
        end = float(times[-1])
        if last < len(times):
            between = [t for t in located if times[last - 1] <= t <= times[last]]
            end = between[-1] if between else float(np.mean(times[last - 1 : last + 1]))
        parts.append((state, begin, end))
        begin = end
    return parts
