"""Pictures of panels with one legend: of lines, and of the error budget as stacked bars."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from comparisons.report import palette
from comparisons.report.plot import WIDTH, figure, legend_below, save
from comparisons.suite.budget import TIMES, Budget

COLOURS = (
    palette.ORANGE, palette.YELLOW, palette.SKY, palette.VERMILION, palette.GREEN, palette.PURPLE, palette.GREY,
)  # fmt: skip
HATCHES = ("", "////", "||||", "", "xxx", "\\\\\\\\", "+++")
"""Colours and hatches of the parts of a budget, in their order; hatches distinguish neighbours in grey print."""


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


def plot_budget(budget: Budget, path: Path) -> None:
    """Draw every quantity's parts stacked at the load parameters of the budget, and the total as a mark."""
    panels = [partial(_stack, budget=budget, quantity=quantity) for quantity in budget.total]
    title = f"{budget.scene}: what the difference is made of, (TSM - solid) / exact rod [%]"
    draw(panels, path, tall=2.6, title=title, columns=3)


def _stack(axes: Any, *, budget: Budget, quantity: str) -> None:
    places = np.arange(len(TIMES))
    above, below = np.zeros(len(TIMES)), np.zeros(len(TIMES))
    for (name, values), colour, hatch in zip(budget.parts[quantity].items(), COLOURS, HATCHES, strict=True):
        height = 100.0 * np.nan_to_num(values)
        bottom = np.where(height >= 0.0, above, below)
        style = {"color": colour, "hatch": hatch, "edgecolor": "0.25", "linewidth": 0.0, "width": 0.6}
        axes.bar(places, height, bottom=bottom, label=name, zorder=3, **style)
        above, below = above + np.maximum(height, 0.0), below + np.minimum(height, 0.0)
    total = 100.0 * budget.total[quantity]
    mark = {"colors": "black", "linewidth": 1.8, "zorder": 4}
    axes.hlines(total, places - 0.4, places + 0.4, label="difference", **mark)
    axes.axhline(0.0, color="0.3", linewidth=0.6)
    axes.set_xticks(places, [f"{t:g}" for t in TIMES])
    # the limits would lie on the edge of a thin part, and cut the parts beyond it
    axes.use_sticky_edges = False
    axes.margins(y=0.08)
    kind, _, column = quantity.partition(" ")
    axes.set(title=f"{kind.replace('_', ' ')}\n{column}".strip(), xlabel="load parameter")
