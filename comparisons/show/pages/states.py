"""The states of contacts with friction as bands over the load parameter."""

from collections.abc import Mapping
from itertools import groupby

import numpy as np

from comparisons.response import CONTACT_STATES, SLIPS, Response
from comparisons.show.pages.markup import scrolling, text
from comparisons.show.pages.page import Section

WIDTH, HEIGHT, LABEL, GAP, RIM = 600, 16, 18, 10, 14
"""Sizes of the picture: of the bands, one band, the label above it, the space between bands, and the rim."""
STROKE = 7
"""Distance of the strokes of a hatched band."""
HATCHED = SLIPS[-1]
"""The state whose bands are hatched, which distinguishes it in grey print."""


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
    height = len(bands) * (LABEL + HEIGHT + GAP) + 24
    last = max(parts[-1][2] for _, parts in bands)
    rows = "\n".join(_row(number, label, parts, last) for number, (label, parts) in enumerate(bands))
    axis = "\n".join(
        f'<text x="{RIM + part * WIDTH:.1f}" y="{height - 8}" text-anchor="middle">{part * last:g}</text>'
        for part in (0.0, 0.25, 0.5, 0.75, 1.0)
    )
    legend = " ".join(
        f'<span class="switch"><svg class="swatch" viewBox="0 0 40 10" aria-hidden="true">'
        f"{_rect(state, 0.0, 0.0, 40.0, 10.0)}</svg>{text(state)}</span>"
        for state in CONTACT_STATES
    )
    drawn = (
        f'<svg viewBox="0 0 {WIDTH + 2 * RIM} {height}" style="min-width:30rem;max-width:46rem;width:100%" role="img" '
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


def _row(number: int, label: str, parts: list[tuple[str, float, float]], last: float) -> str:
    top = number * (LABEL + HEIGHT + GAP) + 4
    shapes = "".join(
        f"<g><title>{text(state)} from {begin:.6g} to {end:.6g}</title>"
        f"{_rect(state, RIM + begin / last * WIDTH, top + LABEL, (end - begin) / last * WIDTH, HEIGHT)}</g>"
        for state, begin, end in parts
    )
    return f'<text x="{RIM}" y="{top + LABEL - 5}">{text(label)}</text>{shapes}'


def _rect(state: str, left: float, top: float, width: float, height: float) -> str:
    """Return a rectangle in the colour of a state, hatched for `HATCHED`."""
    drawn = (
        f'<rect x="{left:.2f}" y="{top:.0f}" width="{width:.2f}" height="{height:.0f}" '
        f'fill="{CONTACT_STATES[state]}"/>'
    )
    if state != HATCHED:
        return drawn
    feet = np.arange(left, left + width - height, STROKE)
    strokes = "".join(f"M{foot:.1f},{top + height:.0f}l{height:.0f},-{height:.0f}" for foot in feet)
    return f'{drawn}<path d="{strokes}" stroke="#16181d" stroke-width="1"/>' if strokes else drawn
