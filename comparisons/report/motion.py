"""Sections of a page about answers: shapes under a slider with histories, bands of stick and slip."""

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import field
from itertools import cycle, groupby

import numpy as np

from comparisons.answer import CONTACT_STATES, SLIPS, Array, Response
from comparisons.answer.axis import axes_at_stations, place_of
from comparisons.answer.errors import error_columns
from comparisons.answer.quantities import QUANTITIES, size
from comparisons.answer.table import unit_names
from comparisons.frozen import Frozen
from comparisons.report import palette
from comparisons.report.brief import across, at_largest
from comparisons.report.pages import Section, piece, rendered
from comparisons.report.symbols import SYMBOL, axis, end_symbols
from comparisons.scene import Scene

STATIONS = np.linspace(0.0, 1.0, 41)
"""Points of a deformed axis, over its length."""
ARC = 25
"""Points of an undeformed axis that is an arc."""
DIGITS = 7
"""Decimals of the coordinates, over the size of the scene."""
DASHES = ("7 3", "2 3", "9 3 2 3", "12 3", "5 2 1 2 1 2", "3 2", "9 2 2 2 2 2", "4 4", "14 2 2 2")
"""Dashes of the lines of runs, which distinguish runs without colour."""
INKS = {palette.BLACK: "var(--ink)", palette.GREY: "var(--grey)"}
"""Colours of the page that are light on a dark screen, in place of black and grey."""
HATCH = "repeating-linear-gradient(135deg,#16181d 0 1px,{} 1px 5px)"
STATES = {**CONTACT_STATES, SLIPS[-1]: HATCH.format(CONTACT_STATES[SLIPS[-1]])}
"""Backgrounds of the bands; one is hatched, which distinguishes it in grey print."""


class Track(Frozen):
    """A quantity over s load parameters: values (s,) by run, nan for none, and errors (s,)."""

    title: str
    unit: str
    values: dict[str, Array]
    errors: dict[str, Array] = field(default_factory=dict)
    error_title: str = ""


def tracks(responses: Mapping[str, Response], reference: str, scene: Scene) -> list[Track]:
    """Return the quantities that act in some response, with errors against `reference`."""
    units = unit_names(scene.units)
    shown = {label: response for label, response in responses.items() if len(response.load_parameter)}
    found = []
    for quantity, row in QUANTITIES.items():
        if row.drawn is None:
            continue
        values = {label: row.drawn(response, scene) for label, response in shown.items()}
        errors = {
            label: error_columns(response, responses[reference], scene, quantity)
            for label, response in shown.items()
            if label != reference and reference in shown
        }
        names = dict.fromkeys(name for one in values.values() for name in one)
        acts = [name for name in names if any(np.nan_to_num(v.get(name, 0.0)).any() for v in values.values())]
        found += [
            Track(
                title=f"{row.called(scene)} {name}" if len(acts) > 1 else row.called(scene),
                unit=units.get(row.unit, "1"),
                values={label: _numbers(one.get(name), shown[label]) for label, one in values.items()},
                errors={label: one[name] for label, one in errors.items() if name in one},
                error_title=f"error against the {reference}, over {row.relative_to}",
            )
            for name in acts
        ]
    return found


def _numbers(values: Array | None, response: Response) -> Array:
    """Return numbers, shape (s,): of vectors the magnitudes, and nan of a quantity that the response does not have."""
    if values is None:
        return np.full(len(response.load_parameter), np.nan)
    return size(values) if values.ndim > 1 else values


def motion_section(
    title: str,
    scene: Scene,
    responses: Mapping[str, Response],
    shown: Sequence[Track],
    *,
    focus: str,
    first: Container[str] = (),
    vtu: Mapping[str, str] | None = None,
) -> Section:
    """Return axes under a slider with their distances from the run `focus`, switches, histories, and links of `vtu`.

    It begins where the force of `focus` is largest, with the runs `first`, or all.
    """
    times = max((one.load_parameter for one in responses.values()), key=len)
    if not len(times):
        return Section(title, "<p>No run reached a load parameter.</p>")
    labels = dict.fromkeys([*responses, *(label for track in shown for label in track.values)])
    # the wide solid below, the exact answers on top
    ordered = sorted(labels, key=lambda label: -palette.style(label).width)
    ends = np.array([[beam.start, beam.end] for beam in scene.beams]).reshape(-1, 2)
    extent = float(np.ptp(ends, axis=0).max())
    decimals = DIGITS - int(np.floor(np.log10(extent)))
    beams = {
        label: [
            np.round(axes_at_stations(one, beam.name, range(len(one.load_parameter)), STATIONS), decimals)
            for beam in scene.beams
        ]
        for label, one in responses.items()
    }
    runs = [
        {
            "label": label,
            "shown": not first or label in first,
            "colour": INKS.get(style.colour, style.colour),
            "width": style.width,
            "dash": "none" if style.unbroken else dash,
            "lines": list(zip(*beams.get(label, []), strict=True)),
        }
        for label, style, dash in zip(ordered, map(palette.style, ordered), cycle(DASHES))
    ]
    exact = responses[focus]
    start = at_largest(exact) if len(exact.load_parameter) else len(times) - 1
    words, values = across(scene, times)
    data = {
        "load_parameter": times,
        "across": {"title": words, "values": values},
        "start": start,
        "length": {"unit": unit_names(scene.units)["length"]},
        "beams": [axis(beam, ARC if beam.turn else 2)[1] for beam in scene.beams],
        "pins": [
            {
                "name": pin.name,
                "path": pin.points,
                "radius": pin.radius or 0.0,
                "at": list(map(pin.position, times.tolist())),
            }
            for pin in scene.pins
        ],
        "symbols": [
            {
                "lines": np.round(SYMBOL * extent * one.segments, decimals),
                "at": np.round(_places(exact, scene, one.item.node, len(times)), decimals),
            }
            for one in end_symbols(scene)
        ],
        "focus": focus,
        "runs": runs,
        "tracks": shown,
        "vtu": vtu or {},
    }
    picture = rendered("motion", runs=runs, pins=scene.pins, last=len(times) - 1, start=start)
    more = rendered("charts", runs=runs, tracks=shown, across=words)
    return Section(title, picture.rstrip("\n"), data, more.rstrip("\n"))


def _places(response: Response, scene: Scene, node: str, count: int) -> list[Array]:
    """Return the places of a node at `count` load parameters; it stays at the last one reached, or at rest."""
    last = len(response.load_parameter) - 1
    return [place_of(response, scene, node, min(k, last)) for k in range(count)]


def states_section(responses: Mapping[str, Response]) -> Iterator[Section]:
    """Yield a section with one band for each run and contact with friction; nothing without friction."""
    bands = {
        f"{label}, {pair}" if len(response.contacts) > 1 else label: band(response, pair)
        for label, response in responses.items()
        for pair, contact in response.contacts.items()
        if contact.friction is not None and len(response.load_parameter)
    }
    if bands:
        last = max(parts[-1][2] for parts in bands.values())
        yield Section("Stick and slip", piece("states", bands, STATES, last))


def band(response: Response, pair: str) -> list[tuple[str, float, float]]:
    """Return the states of a contact in their order, each with the load parameters between which it lasts."""
    contact, times = response.contacts[pair], response.load_parameter
    assert contact.friction is not None, "a band belongs to a contact with friction"
    located = [
        event.load_parameter
        for event in response.events or ()
        if event.pair == pair and event.kind != "pass-through"
    ]
    parts: list[tuple[str, float, float]] = []
    begin, last = 0.0, 0
    for state, same in groupby(contact.friction.states(contact.force)):
        last += len(list(same))
        around = times[last - 1 : last + 1]
        end = max((t for t in located if around[0] <= t <= around[-1]), default=float(around.mean()))
        parts.append((state, begin, end))
        begin = end
    return parts
