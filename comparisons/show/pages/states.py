"""The states of contacts with friction as bands over the load parameter."""

from collections.abc import Mapping
from itertools import groupby

import numpy as np

from comparisons.response import CONTACT_STATES, Response
from comparisons.show.pages.markup import scrolling, text
from comparisons.show.pages.page import Section

WIDTH, HEIGHT, LABEL, GAP = 900, 18, 340, 8
"""Sizes of the picture: of the bands, one band, the labels, and the space between bands."""


def states_section(responses: Mapping[str, Response]) -> Section | None:
    """Return a section with one band for each run and contact with friction; None without friction.

    A change of state lies at the load parameter at which the model located it, or in the middle between two load parameters.
    """
    bands = [
        (f"{label}, {pair}" if len(response.contacts) > 1 else label, band(response, pair))
        for label, response in responses.items()
        for pair, contact in response.contacts.items()
        if contact.friction is not None and len(response.load_parameter)
    ]
    if not bands:
        return None
    height = len(bands) * (HEIGHT + GAP) + 30
    rows = "\n".join(_row(number, label, parts) for number, (label, parts) in enumerate(bands))
    axis = "\n".join(
        f'<text x="{LABEL + part * WIDTH:.1f}" y="{height - 8}" text-anchor="middle">{part:g}</text>'
        for part in (0.0, 0.25, 0.5, 0.75, 1.0)
    )
    legend = " ".join(
        f'<span class="switch"><svg class="swatch" viewBox="0 0 40 10" aria-hidden="true">'
        f'<rect width="40" height="10" fill="{colour}"/></svg>{text(state)}</span>'
        for state, colour in CONTACT_STATES.items()
    )
    drawn = (
        f'<svg viewBox="0 0 {LABEL + WIDTH + 20} {height}" style="min-width:40rem;width:100%" role="img" '
        f'aria-label="contact states over the load parameter">\n{rows}\n{axis}\n</svg>'
    )
    caption = "What each contact with friction does, over the load parameter."
    return Section(
        title="Stick and slip",
        html=f"<p>{caption}</p>\n<p>{legend}</p>\n{scrolling('contact states', drawn)}",
    )


def band(response: Response, pair: str) -> list[tuple[str, float, float]]:
    """Return the states of a contact in their order, each with the load parameters between which it lasts."""
    contact = response.contacts[pair]
    assert contact.friction is not None, "a band belongs to a contact with friction"
    times = response.load_parameter
    located = sorted(
        event.load_parameter
        for event in response.events or ()
        if event.pair == pair and event.kind != "pass-through"
    )
    states = contact.friction.states(contact.force)
    parts: list[tuple[str, float, float]] = []
    begin = 0.0
    runs = [(state, len(list(same))) for state, same in groupby(states)]
    last = 0
    for number, (state, count) in enumerate(runs):
        last += count
        if number == len(runs) - 1:
            end = float(times[-1])
        else:
            between = [t for t in located if times[last - 1] <= t <= times[last]]
            end = between[-1] if between else float(np.mean(times[last - 1 : last + 1]))
        parts.append((state, begin, end))
        begin = end
    return parts


def _row(number: int, label: str, parts: list[tuple[str, float, float]]) -> str:
    top = number * (HEIGHT + GAP) + 4
    shapes = "".join(
        f'<rect x="{LABEL + begin * WIDTH:.2f}" y="{top}" width="{(end - begin) * WIDTH:.2f}" height="{HEIGHT}" '
        f'fill="{CONTACT_STATES[state]}"><title>{text(state)} from {begin:.6g} to {end:.6g}</title></rect>'
        for state, begin, end in parts
    )
    return f'<text x="0" y="{top + HEIGHT - 5}">{text(label)}</text>{shapes}'
