"""Pictures as lists of lines: panels of one figure with one legend."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

from comparisons.show.plot import WIDTH, figure, save

Line = tuple[Any, Any, dict[str, Any]]
"""Abscissas, ordinates and style of a line; a label stands in the legend once, however many panels have it."""
SHAPE = {"aspect": "equal", "xlabel": "x [m]", "ylabel": "y [m]"}
"""Settings of a panel that shows shapes of beams."""


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One diagram: its title, its lines, settings of its axes, and words at places in the units of its data."""

    title: str
    lines: Sequence[Line]
    settings: Mapping[str, Any]
    notes: Sequence[tuple[str, tuple[float, float]]] = ()


def draw(panels: Sequence[Panel], *paths: Path, tall: float, title: str = "", columns: int = 2) -> None:
    """Draw panels beside each other, each `tall` inches high, with one legend below them."""
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    fig = figure(figsize=(WIDTH, 1.3 + tall * rows))
    grid = fig.subplots(rows, columns, squeeze=False)
    named: dict[str, Any] = {}
    for axes, panel in zip_longest(grid.flat, panels):
        if panel is None:
            axes.set_axis_off()
            continue
        for x, y, style in panel.lines:
            axes.plot(x, y, **style)
        for words, place in panel.notes:
            axes.annotate(words, place, fontsize="small", color="0.25")
        axes.set(**panel.settings)
        axes.set_title(panel.title, fontsize="small")
        axes.grid(visible=True, linewidth=0.3)
        handles, labels = axes.get_legend_handles_labels()
        named = dict(zip(labels, handles, strict=True)) | named
    place = {"loc": "outside lower center", "fontsize": "small", "frameon": False}
    fig.legend(named.values(), named.keys(), ncols=1 if max(map(len, named)) > 50 else 2, **place)
    fig.suptitle(title, fontsize="medium")
    save(fig, *paths)
