"""Pictures of panels with one legend: a panel is a function that draws on axes."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from comparisons.report.plot import WIDTH, figure, save

SHAPE = {"aspect": "equal", "xlabel": "x [m]", "ylabel": "y [m]"}
"""Settings of a panel that shows shapes of beams."""
NOTE = {"fontsize": "small", "color": "0.25"}
"""Style of words in a panel."""


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
    place = {"loc": "outside lower center", "fontsize": "small", "frameon": False}
    fig.legend(named.values(), named.keys(), ncols=1 if max(map(len, named)) > 50 else 2, **place)
    fig.suptitle(title, fontsize="medium")
    save(fig, *paths)
