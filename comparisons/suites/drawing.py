"""Pictures of panels with one legend: a panel is its title with its lines."""

from collections.abc import Iterable, Mapping
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
    panels: Mapping[str, Iterable[Line]],
    *paths: Path,
    tall: float,
    suptitle: str = "",
    columns: int = 2,
    **settings: Any,
) -> None:
    """Draw panels with some settings in columns, each `tall` inches high; a label stands once in the legend below them."""
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    fig = figure(figsize=(WIDTH, 1.3 + tall * rows))
    named: dict[str, Any] = {}
    for number, (title, lines) in enumerate(panels.items(), 1):
        axes = fig.add_subplot(rows, columns, number, **settings)
        for label, points, style in lines:
            axes.plot(*np.asarray(points), label=label, **style)
        axes.set_title(title, fontsize="small")
        axes.grid(visible=True, linewidth=0.3)
        handles, labels = axes.get_legend_handles_labels()
        named = dict(zip(labels, handles, strict=True)) | named
    place = {"loc": "outside lower center", "fontsize": "small", "frameon": False}
    fig.legend(named.values(), named.keys(), ncols=1 if max(map(len, named)) > 50 else 2, **place)
    fig.suptitle(suptitle, fontsize="medium")
    save(fig, *paths)
