"""Pictures of panels with one legend."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from comparisons.report.plot import WIDTH, figure, save


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
    place = {"loc": "outside lower center", "fontsize": "small", "frameon": False}
    fig.legend(named.values(), named.keys(), ncols=1 if max(map(len, named)) > 50 else 2, **place)
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
