"""Shapes under a slider and histories beside them: the data of a section that moves, and its markup."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from comparisons.errors import error_columns, forces, moments, size
from comparisons.response import Array, Response
from comparisons.response.material import frictions, frictions_found
from comparisons.scene import Scene
from comparisons.show import palette
from comparisons.show.pages.markup import scrolling, text
from comparisons.show.pages.page import Section
from comparisons.show.symbols import end_symbols

POINTS = 61
"""Points of a deformed axis."""
ARC = 25
"""Points of an undeformed axis that is an arc."""
SYMBOL = 0.03
"""Size of the symbol of a support, a spring or a hinge over the size of the scene."""
DIGITS = 5
"""Decimals of the coordinates, over the size of the scene."""
DASHES = ("7 3", "2 3", "9 3 2 3", "12 3", "5 2 1 2 1 2", "3 2", "9 2 2 2 2 2", "4 4", "14 2 2 2")
"""Dashes of the lines of runs, which distinguish runs without colour."""
INKS = {palette.BLACK: "var(--ink)", palette.GREY: "var(--grey)"}


@dataclass(frozen=True, kw_only=True, eq=False)
class Track:
    """A quantity over the load parameters.

    Attributes
    ----------
    title, unit : str
        What it is.
    values : dict of ndarray, shape (s,)
        By the label of the run, nan where it has none.
    errors : dict of ndarray, shape (s,)
        Distance from the reference, by run; empty without a reference.
    error_title : str
        What the errors are.
    """

    title: str
    unit: str
    values: dict[str, Array]
    errors: dict[str, Array] = field(default_factory=dict)
    error_title: str = ""


def tracks(responses: Mapping[str, Response], reference: str, scene: Scene) -> list[Track]:
    """Return forces, arc positions, moments and frictions over the load parameters, with the errors of `comparisons.errors`.

    A scene without contact has the forces of its supports. What vanishes in all responses is left out.

    Parameters
    ----------
    responses : mapping of Response
        By label.
    reference : str
        The label whose values the errors are against.
    scene : Scene
        The scene of the responses.
    """
    force, length = _units(scene)
    shown = {label: response for label, response in responses.items() if len(response.load_parameter)}
    rubbed = any(frictions_found(response, scene) for response in shown.values())
    title = "friction" if any(contact.friction for contact in scene.contacts) else "spurious friction"
    title = "friction found" if rubbed else title
    acting = "contact force" if scene.contacts else "support force"
    quantities: dict[str, tuple[str, str, str, Callable[[Response], Mapping[str, Array]]]] = {
        "force": (acting, force, "the largest force", forces),
        "arc": ("arc position", length, "the length", _arcs),
        "moment": ("support moment", f"{force} {length}", "the largest moment", moments),
        "friction": (
            title,
            "1",
            "the contact forces",
            lambda response: frictions_found(response, scene) if rubbed else frictions(response, scene),
        ),
    }
    found = []
    for quantity, (title, unit, scale, read) in quantities.items():
        values = {label: read(response) for label, response in shown.items()}
        errors = {
            label: error_columns(response, responses[reference], scene, quantity)
            for label, response in shown.items()
            if label != reference and reference in shown
        }
        names = list(dict.fromkeys(name for one in values.values() for name in one))
        names = [
            name
            for name in names
            if any(np.any(np.nan_to_num(one.get(name, 0.0))) for one in values.values())
        ]
        found += [
            Track(
                title=f"{title} {name}" if len(names) > 1 else title,
                unit=unit,
                values={label: _numbers(one.get(name), shown[label]) for label, one in values.items()},
                errors={label: one[name] for label, one in errors.items() if name in one},
                error_title=f"error against the {reference}, over {scale}",
            )
            for name in names
        ]
    return found


def _numbers(values: Array | None, response: Response) -> Array:
    """Return numbers, shape (s,): of vectors the magnitudes, and nan of a quantity that the response does not have."""
    if values is None:
        return np.full(len(response.load_parameter), np.nan)
    return size(values) if values.ndim > 1 else values


def _arcs(response: Response) -> dict[str, Array]:
    return {pair: contact.arc_position for pair, contact in response.contacts.items()}


def motion_section(
    title: str,
    scene: Scene,
    responses: Mapping[str, Response],
    shown: Sequence[Track],
    *,
    focus: str,
    vtu: Mapping[str, str] | None = None,
) -> Section:
    """Return a section with the deformed axes of all runs under a slider, switches for each run, and histories.

    Parameters
    ----------
    title : str
        Heading.
    scene : Scene
        Gives pins and units.
    responses : mapping of Response
        By label, which begins with a model's name.
    shown : sequence of Track
        The histories.
    focus : str
        The label of the run whose tip is shown enlarged.
    vtu : mapping of str
        Path of the VTU files of the load parameters, by label. ``{}`` in it is replaced by the number of the load parameter, from 1.
    """
    labels = _ordered([*responses, *(label for track in shown for label in track.values)])
    times = max((one.load_parameter for one in responses.values()), key=len)
    if not len(times):
        return Section(title=title, html="<p>No run reached a load parameter.</p>")
    first = scene.beams[0]
    _, length = _units(scene)
    data = {
        "load_parameter": times,
        "length": {"unit": length, "beam": first.length},
        "beams": [
            [beam.place(part) for part in np.linspace(0.0, 1.0, ARC if beam.turn else 2)]
            for beam in scene.beams
        ],
        "pins": [
            {
                "name": pin.name,
                "path": pin.points,
                "radius": pin.radius or 0.0,
                "at": [pin.position(float(t)) for t in times],
            }
            for pin in scene.pins
        ],
        "symbols": _symbols(scene, responses[focus], len(times)),
        "tip": responses[focus].tips[first.name],
        "focus": focus,
        "runs": [
            {
                "label": label,
                **_line_style(label, number),
                "lines": _lines(scene, responses[label]) if label in responses else [],
            }
            for number, label in enumerate(labels)
        ],
        "tracks": shown,
        "vtu": vtu or {},
    }
    return Section(title=title, html=_markup(data, len(times)), data=data)


def _symbols(scene: Scene, response: Response, steps: int) -> list[dict[str, Any]]:
    """Return the symbols of supports, springs and hinges as lines about their nodes, and the places of the nodes at every load parameter.

    Where the response has stopped, its last places stay.
    """
    size, decimals = _size(scene)
    last = len(response.load_parameter) - 1
    return [
        {
            "lines": np.round(SYMBOL * size * one.segments, decimals),
            "at": [
                np.round(one.at(_deformed(scene, response, one.item.beam, min(k, last))), decimals)
                for k in range(steps)
            ],
        }
        for one in end_symbols(scene)
    ]


def _deformed(scene: Scene, response: Response, beam: str, k: int) -> Array:
    """Return the axis of a beam at load parameter number k; before the first one, its undeformed ends."""
    if k >= 0:
        return response.axis_line(beam, k)[1]
    return np.array([scene.beam(beam).start, scene.beam(beam).end])


def _size(scene: Scene) -> tuple[float, int]:
    """Return the size of a scene, and the decimals of coordinates that a screen can show."""
    ends = np.array([[beam.start, beam.end] for beam in scene.beams]).reshape(-1, 2)
    size = float(np.ptp(ends, axis=0).max())
    return size, DIGITS - int(np.floor(np.log10(size)))


def _ordered(labels: Sequence[str]) -> list[str]:
    """Return the labels once, in the order of drawing: the wide solid below, the exact answers on top."""
    return sorted(dict.fromkeys(labels), key=lambda label: -palette.style(label).width)


def _line_style(label: str, number: int) -> dict[str, Any]:
    """Colour, dashes and width. The page replaces black and grey by colours that are light on a dark screen."""
    style = palette.style(label)
    return {
        "colour": INKS.get(style.colour, style.colour),
        "dash": "none" if style.unbroken else DASHES[number % len(DASHES)],
        "width": style.width,
    }


def _lines(scene: Scene, response: Response) -> list[list[Array]]:
    """Return the deformed axes (POINTS, 2) of all beams at every load parameter, rounded to what a screen can show."""
    _, decimals = _size(scene)
    return [
        [np.round(_thinned(*response.axis_line(beam.name, k)), decimals) for beam in scene.beams]
        for k in range(len(response.load_parameter))
    ]


def _thinned(arc: Array, line: Array) -> Array:
    at = np.linspace(arc[0], arc[-1], POINTS)
    return np.stack([np.interp(at, arc, line[:, i]) for i in (0, 1)], axis=1)


def _units(scene: Scene) -> tuple[str, str]:
    force, length = (unit.strip() for unit in scene.units.split(","))
    return force, length


def _markup(data: Mapping[str, Any], steps: int) -> str:
    """Return the frame that the script fills: switches, slider, drawings, charts and the table of values."""
    switches = "\n".join(
        f'<label class="switch"><input type="checkbox" checked data-switch="{number}">'
        f'<svg class="swatch" viewBox="0 0 40 10" aria-hidden="true">{_swatch(run)}</svg>{text(run["label"])}</label>'
        for number, run in enumerate(data["runs"])
    )
    charts = "\n".join(_chart_markup(number, track) for number, track in enumerate(data["tracks"]))
    bands = "; bands reach from a model to the reference" if any(t.errors for t in data["tracks"]) else ""
    return f"""<noscript><p>The drawings of this section take a script; the files below hold the same numbers.</p></noscript>
<div class="controls" data-moving>
<label class="slider">load parameter <input type="range" min="0" max="{steps - 1}" step="1" value="{steps - 1}"></label>
<output aria-live="polite"></output>
<button type="button" class="play" aria-pressed="false">play</button>
</div>
<fieldset class="switches"><legend>shown</legend>
{switches}
</fieldset>
<div class="drawings">
<figure><svg class="shapes" role="img" aria-label="deformed axes at the load parameter of the slider"></svg>
<figcaption>Deformed axes, with the symbols of supports, springs and hinges; stars are pins, circles their true radii, dotted lines their paths; thin grey: other load parameters.</figcaption></figure>
<figure><svg class="zoom" role="img" aria-label="the surroundings of the tip, enlarged"></svg>
<figcaption>The tip, enlarged.</figcaption></figure>
</div>
<p class="vtu"></p>
{_values_table(data["tracks"], data["runs"])}
<div class="charts">
{charts}
</div>
<p class="hint">Charts: point at them, or move along them with the arrow keys{bands}.</p>"""


def _swatch(run: Mapping[str, Any]) -> str:
    return (
        f'<line x1="1" y1="5" x2="39" y2="5" style="stroke:{run["colour"]};stroke-width:{run["width"]};'
        f'stroke-dasharray:{run["dash"]}"/>'
    )


def _chart_markup(number: int, track: Track) -> str:
    def chart(kind: str, title: str) -> str:
        label = f"{title} against the load parameter"
        return (
            f'<figure><figcaption>{text(title)}</figcaption><svg class="chart" data-track="{number}" data-kind="{kind}" '
            f'tabindex="0" role="img" aria-label="{text(label)}"></svg></figure>'
        )

    value = chart("values", f"{track.title} [{track.unit}]")
    return value + (chart("errors", f"{track.title}, {track.error_title}") if track.errors else "")


def _values_table(shown: Sequence[Track], runs: Sequence[Mapping[str, Any]]) -> str:
    """Return the table whose cells the script fills."""
    head, cells = '<th scope="col">model</th>', ""
    for number, track in enumerate(shown):
        head += f'<th scope="col">{text(track.title)} [{text(track.unit)}]</th>'
        cells += f'<td data-track="{number}" data-kind="values">-</td>'
        if track.errors:
            head += '<th scope="col">error</th>'
            cells += f'<td data-track="{number}" data-kind="errors">-</td>'
    rows = "\n".join(
        f'<tr data-run="{number}"><th scope="row">{text(run["label"])}</th>{cells}</tr>'
        for number, run in enumerate(runs)
    )
    inner = f'<table class="values">\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n</table>'
    return '<p class="caption now"></p>\n' + scrolling("values at the load parameter of the slider", inner)
