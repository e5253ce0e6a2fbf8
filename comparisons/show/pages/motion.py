"""Shapes under a slider and histories beside them: the data of a section that moves, and its markup."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from comparisons.errors import error_columns
from comparisons.quantities import QUANTITIES, size
from comparisons.response import Array, Response
from comparisons.response.table import unit_names
from comparisons.scene import Scene
from comparisons.show import palette
from comparisons.show.pages.page import Section, scrolling, text
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
    """A quantity over s load parameters: values (s,) by the label of the run, nan where it has none.

    The `errors` (s,) are the distance from the reference, empty without one, and `error_title` says what they
    are.
    """

    title: str
    unit: str
    values: dict[str, Array]
    errors: dict[str, Array] = field(default_factory=dict)
    error_title: str = ""


def tracks(responses: Mapping[str, Response], reference: str, scene: Scene) -> list[Track]:
    """Return the quantities that are drawn, with errors against the label `reference`.

    The errors are those of `comparisons.errors`. A scene without contact has the forces of its supports. What
    vanishes in all responses is left out.
    """
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
    vtu: Mapping[str, str] | None = None,
) -> Section:
    """Return a section with the deformed axes under a slider, a switch for each run, and histories.

    The labels of runs begin with a model's name. The tip of the run `focus` is enlarged. `vtu` has the path
    of the VTU files by label; ``{}`` in it is replaced by the number of the load parameter, from 1.
    """
    times = max((one.load_parameter for one in responses.values()), key=len)
    if not len(times):
        return Section(title=title, html="<p>No run reached a load parameter.</p>")
    labels = dict.fromkeys([*responses, *(label for track in shown for label in track.values)])
    # the wide solid below, the exact answers on top
    ordered = sorted(labels, key=lambda label: -palette.style(label).width)
    first, ends = scene.beams[0], np.array([[beam.start, beam.end] for beam in scene.beams]).reshape(-1, 2)
    size = float(np.ptp(ends, axis=0).max())
    decimals = DIGITS - int(np.floor(np.log10(size)))
    data = {
        "load_parameter": times,
        "length": {"unit": unit_names(scene.units)["length"], "beam": first.length},
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
        "symbols": [
            {
                "lines": np.round(SYMBOL * size * one.segments, decimals),
                "at": np.round(
                    [one.at(_axis(scene, responses[focus], one.item.beam, k)) for k in range(len(times))],
                    decimals,
                ),
            }
            for one in end_symbols(scene)
        ],
        "tip": responses[focus].tips[first.name],
        "focus": focus,
        "runs": [
            {
                "label": label,
                **_line_style(label, number),
                "lines": _lines(scene, responses.get(label), decimals),
            }
            for number, label in enumerate(ordered)
        ],
        "tracks": shown,
        "vtu": vtu or {},
    }
    return Section(title=title, html=_markup(data, len(times)), data=data)


def _axis(scene: Scene, response: Response, beam: str, k: int) -> Array:
    """Return the axis of a beam at load parameter number k or the last one reached; its ends before that."""
    last = min(k, len(response.load_parameter) - 1)
    if last >= 0:
        return response.axis_line(beam, last)[1]
    return np.array([scene.beam(beam).start, scene.beam(beam).end])


def _line_style(label: str, number: int) -> dict[str, Any]:
    """Colour, dashes and width. The page replaces black and grey by colours that are light on a dark screen."""
    style = palette.style(label)
    dash = "none" if style.unbroken else DASHES[number % len(DASHES)]
    return {"colour": INKS.get(style.colour, style.colour), "dash": dash, "width": style.width}


def _lines(scene: Scene, response: Response | None, decimals: int) -> list[list[Array]]:
    """Return the deformed axes (POINTS, 2) of all beams at every load parameter, rounded to what a screen can show."""

    def thinned(arc: Array, line: Array) -> Array:
        at = np.linspace(arc[0], arc[-1], POINTS)
        return np.asarray(np.round([np.interp(at, arc, line[:, i]) for i in (0, 1)], decimals).T)

    if response is None:
        return []
    steps = range(len(response.load_parameter))
    return [[thinned(*response.axis_line(beam.name, k)) for beam in scene.beams] for k in steps]


def _markup(data: Mapping[str, Any], steps: int) -> str:
    """Return the frame that the script fills: switches, slider, drawings, charts and the table of values."""
    runs = list(enumerate(data["runs"]))
    switches = "\n".join(
        f'<label class="switch"><input type="checkbox" checked data-switch="{number}">'
        f'<svg class="swatch" viewBox="0 0 40 10" aria-hidden="true"><line x1="1" y1="5" x2="39" y2="5" '
        f'style="stroke:{run["colour"]};stroke-width:{run["width"]};stroke-dasharray:{run["dash"]}"/></svg>'
        f"{text(run['label'])}</label>"
        for number, run in runs
    )
    # every track has a chart and a column of its values, and of its errors where there are some
    columns = []
    for number, track in enumerate(data["tracks"]):
        columns.append((number, "values", f"{track.title} [{track.unit}]", f"{track.title} [{track.unit}]"))
        if track.errors:
            columns.append((number, "errors", "error", f"{track.title}, {track.error_title}"))
    charts = "\n".join(
        f'<figure><figcaption>{text(title)}</figcaption><svg class="chart" data-track="{number}" '
        f'data-kind="{kind}" tabindex="0" role="img" aria-label="{text(title)} against the load parameter">'
        "</svg></figure>"
        for number, kind, _, title in columns
    )
    head = "".join(f'<th scope="col">{text(name)}</th>' for name in ("model", *(one[2] for one in columns)))
    cells = "".join(f'<td data-track="{one[0]}" data-kind="{one[1]}">-</td>' for one in columns)
    rows = "\n".join(
        f'<tr data-run="{number}"><th scope="row">{text(run["label"])}</th>{cells}</tr>'
        for number, run in runs
    )
    values = f'<table class="values">\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n</table>'
    bands = (
        "; bands reach from a model to the reference" if any(one[1] == "errors" for one in columns) else ""
    )
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
<p class="caption now"></p>
{scrolling("values at the load parameter of the slider", values)}
<div class="charts">
{charts}
</div>
<p class="hint">Charts: point at them, or move along them with the arrow keys{bands}.</p>"""
