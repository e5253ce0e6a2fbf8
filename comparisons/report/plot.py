"""Pictures by matplotlib: what all of them share, panels with one legend, and the overlay of deflected shapes."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from comparisons.answer import Array, Response
from comparisons.answer.table import unit_names
from comparisons.files import replacing
from comparisons.models import find
from comparisons.report import palette
from comparisons.report.symbols import SYMBOL, draw_symbols
from comparisons.scene import BeamSpec, Scene

SOLID = {"linewidth": 6.0, "alpha": 0.55, "solid_capstyle": "butt", "zorder": 1.8}
EXACT = {"linewidth": 1.0}
BEAMS: tuple[dict[str, Any], ...] = (
    {"marker": "o", "markersize": 7.0, "markerfacecolor": "none"},
    {"marker": "s", "markersize": 4.0, "markerfacecolor": "none"},
    {"marker": ".", "markersize": 4.0},
    {"marker": "^", "markersize": 4.0},
)
CONTINUOUS = {"linewidth": 3.5, "zorder": 1.9}
"""Exact elements, which have no nodes to mark, below the others."""
FINE = 5
"""Points of an axis for each line of its grid, below which the lines are no elements but pieces of an exact one."""
SHOWN = (0.2, 0.4, 0.6, 0.8, 1.0)
"""Load parameters of the overlay over the scene's last; the nearest ones of the scene are drawn."""
LABELS = 0.06
"""Least distance of two labels of pins, over the size of the picture."""
WIDTH = 6.3
"""Width of a picture [inch]: 160 mm, so that letters have their size in points on paper, and are legible on a telephone."""
PIXELS, SHARP = 1400, 120.0
"""Least width of a picture in pixels, and pixels of an inch of it and of what is no line in an SVG."""


def figure(**options: Any) -> Any:
    """Return a matplotlib figure that needs no display."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    result = Figure(layout="constrained", **options)
    FigureCanvasAgg(result)
    return result


def save(fig: Any, *paths: Path) -> None:
    """Write the figure to `paths`, in the formats of their suffixes; it is laid out once. The letters of an SVG file are those of its page."""
    from matplotlib import rc_context

    fig.get_layout_engine().execute(fig)
    fig.set_layout_engine(None)  # with "none", each file would be drawn twice
    for path in paths:
        with replacing(path) as temporary, rc_context({"svg.fonttype": "none"}):
            vector = path.suffix == ".svg"
            fig.savefig(temporary, dpi=SHARP if vector else max(SHARP, PIXELS / fig.get_figwidth()))
            if vector:
                text = re.sub(r"'DejaVu Sans'[^;\"]*", "system-ui, sans-serif", temporary.read_text("utf-8"))
                temporary.write_text(text, encoding="utf-8")


def arrow(axes: Any, tail: Array, tip: Array, colour: str, width: float = 1.2) -> None:
    """Draw an arrow above all else; the axes reach to its ends."""
    style = {"arrowstyle": "-|>", "color": colour, "linewidth": width, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", tip, tail, arrowprops=style, zorder=6)
    axes.update_datalim([tail, tip])


def tag(axes: Any, words: str, place: Any, offset: tuple[float, float], **style: Any) -> None:
    """Write on a pale ground beside a place, by an offset [point]."""
    ground = {"facecolor": "white", "alpha": 0.75, "linewidth": 0.0, "pad": 0.5}
    axes.annotate(words, place, offset, textcoords="offset points", bbox=ground, **style)


def legend_below(fig: Any, entries: Mapping[str, Any], columns: int = 2) -> None:
    """Write a legend below all axes, the entries by their words."""
    style = {"loc": "outside lower center", "fontsize": "small", "frameon": False}
    fig.legend(entries.values(), entries.keys(), ncols=columns, **style)


class Line(NamedTuple):
    """A line of a panel."""

    label: str  #: Its words in the legend, which lines alike share; none after a leading underscore.
    points: ArrayLike  #: x and y, shape (2, n).
    style: Mapping[str, Any] = {}  #: Keywords of matplotlib.


def draw(
    panels: Sequence[Callable[[Any], None]],
    *paths: Path,
    tall: float,
    title: str = "",
    columns: int = 2,
    **shared: bool,
) -> None:
    """Draw panels beside each other, each `tall` inches high, with axes `shared` as `Figure.subplots` says; a label stands once in the legend below them."""
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    fig = figure(figsize=(WIDTH, 1.3 + tall * rows))
    grid = fig.subplots(rows, columns, squeeze=False, **shared)
    named: dict[str, Any] = {}
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    for axes, panel in zip(grid.flat, panels, strict=False):
        panel(axes)
        axes.title.set_fontsize("small")
        axes.grid(visible=True, linewidth=0.3)
        handles, labels = axes.get_legend_handles_labels()
        named = dict(zip(labels, handles, strict=True)) | named
    first = grid.flat[0]
    if shared.get("sharex") and first.get_xscale() == "log":
        low, high = np.log10(first.get_xlim())  # whole decades have labels that do not overlap
        first.set_xlim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
    legend_below(fig, named, 1 if max(map(len, named)) > 50 else 2)
    fig.suptitle(title, fontsize="medium")
    save(fig, *paths)


def draw_lines(
    panels: Mapping[str, Iterable[Line]],
    *paths: Path,
    tall: float,
    suptitle: str = "",
    columns: int = 2,
    **settings: Any,
) -> None:
    """Draw panels of lines by their titles, all with the same `settings` of their axes."""
    drawn = [partial(_plot, lines=lines, title=title, **settings) for title, lines in panels.items()]
    draw(drawn, *paths, tall=tall, title=suptitle, columns=columns)


def _plot(axes: Any, *, lines: Iterable[Line], **settings: Any) -> None:
    for label, points, style in lines:
        axes.plot(*np.asarray(points), label=label, **style)
    axes.set(**settings)


def nearest_steps(load_parameter: Array, last: float = 1.0) -> list[int]:
    """Return the numbers of the load parameters nearest to those of `SHOWN` on the way to `last`, each once."""
    return sorted({int(np.argmin(np.abs(load_parameter - part * last))) for part in SHOWN})


def plot_shapes(scene: Scene, responses: dict[str, Response], *paths: Path) -> None:
    """Draw axes by label over each other, as Fig. 8 of the paper, with the last tip enlarged."""
    fig = figure(figsize=(WIDTH, 7.4))
    places = fig.subplot_mosaic([["whole", "whole"], ["detail", "legend"]])
    whole, detail = places["whole"], places["detail"]
    reached = {label: response for label, response in responses.items() if len(response.load_parameter)}
    for axes in (whole, detail):
        _draw_shapes(axes, scene, reached)
        axes.set_aspect("equal", adjustable="box")
        axes.grid(visible=True, linewidth=0.3)
    last = next(reversed(reached.values()), None)
    symbols = {}
    if last is not None:
        lines = {beam.name: last.axis_line(beam.name, -1) for beam in scene.beams}
        symbols = draw_symbols(whole, scene, lines, SYMBOL * max(whole.dataLim.width, whole.dataLim.height))
        _zoom_on_tip(whole, detail, scene, last)
    length = unit_names(scene.units)["length"]
    whole.set(xlabel=f"x [{length}]", ylabel=f"y [{length}]", title=f"{scene.name}: deflected axes")
    whole.margins(0.06)
    tall = float(np.clip(0.85 * WIDTH * whole.dataLim.height / max(whole.dataLim.width, 1e-300), 1.2, 5.5))
    whole.get_gridspec().set_height_ratios((tall + 0.8, 2.8))
    fig.set_figheight(tall + 3.6)
    places["legend"].set_axis_off()
    handles, words = whole.get_legend_handles_labels()
    named = dict(zip(words, handles, strict=True)) | symbols  # a label stands once
    places["legend"].legend(named.values(), named, loc="center", fontsize="small", frameon=False)
    save(fig, *paths)


def _draw_shapes(axes: Any, scene: Scene, responses: dict[str, Response]) -> None:
    beam_styles = cycle(BEAMS)
    drawn: set[float] = set()
    for label, response in responses.items():
        style = {"color": palette.style(label).colour, **_style(response, scene, beam_styles)}
        for k in nearest_steps(response.load_parameter, scene.times[-1]):
            drawn.add(float(response.load_parameter[k]))
            for beam in scene.beams:
                _, line = response.axis_line(beam.name, k)
                if "marker" in style:
                    style["markevery"] = max(1, (len(line) - 1) // _elements(response, beam, k))
                axes.plot(*line.T, label=label, **{"linewidth": 0.8, **style})
    apart = LABELS * max(axes.dataLim.width, axes.dataLim.height)
    for pin in scene.pins:
        path = "path of a pin" if pin.moving else "_"
        axes.plot(*np.array(pin.points).T, color="0.5", linewidth=0.8, linestyle=":", label=path)
        places = {t: np.array(pin.position(t)) for t in sorted(drawn)}
        _draw_places(axes, places, apart)


def _draw_places(axes: Any, places: dict[float, Array], apart: float) -> None:
    """Mark the places of a pin by load parameter, and name those that lie apart."""
    mark = {"linestyle": "none", "marker": "*", "markersize": 9, "color": "0.2", "zorder": 5}
    axes.plot(*np.array(list(places.values())).reshape(-1, 2).T, label="pin", **mark)
    last = None
    for t, place in places.items():
        if last is None or np.hypot(*(place - last)) > apart:
            tag(axes, f"t = {t:.3g}", place, (6, -11), fontsize="small", clip_on=True, zorder=6)
            last = place


def _style(response: Response, scene: Scene, beam_styles: Iterator[dict[str, Any]]) -> dict[str, Any]:
    """Return the line of a model; beams with few elements take the next marker, which marks their nodes."""
    model = find(response.model)
    if not model.meshed:
        return EXACT
    if model.continuum:
        return SOLID
    first = scene.beams[0]
    points = len(response.axis_line(first.name, 0)[1])
    return CONTINUOUS if FINE * _elements(response, first, 0) > points else next(beam_styles)


def _elements(response: Response, beam: BeamSpec, k: int) -> int:
    return len(response.grid(beam.name, k).cells["line"])


def _zoom_on_tip(whole: Any, detail: Any, scene: Scene, exact: Response) -> None:
    """Show the surroundings of the last tip of a response: the models differ by a fraction of the line width."""
    beam = scene.beams[0]
    x, y = exact.tips[beam.name][-1]
    half = 0.02 * beam.length
    title = f"The framed tip, t = {exact.load_parameter[-1]:.3g}"
    detail.set(xlim=(x - half, x + half), ylim=(y - half, y + half), title=title)
    detail.ticklabel_format(useOffset=False)
    detail.locator_params(nbins=3)
    box = whole.indicate_inset(bounds=(x - half, y - half, 2.0 * half, 2.0 * half), edgecolor="0.3")
    box.rectangle.set_zorder(4)
