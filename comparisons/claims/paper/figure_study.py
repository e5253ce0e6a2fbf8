"""What a figure of [P] leaves: rows and numbers, by which its claims are judged, and pictures, which are lists of lines."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.output import Row, write_numbers, write_rows
from comparisons.response import Array
from comparisons.scene import Scene
from comparisons.show.pages import Section
from comparisons.show.plot import WIDTH, figure, save

Line = tuple[Any, Any, dict[str, Any]]
"""Abscissas, ordinates and style of a line; a label stands in the legend once, however many panels have it."""
SHAPE = {"aspect": "equal", "xlabel": "x [m]", "ylabel": "y [m]"}
"""Settings of a panel that shows shapes of beams."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """What is found for a figure: its scenes, rows and numbers, pictures, and moving shapes for the page.

    `tables` and `pictures` go by the names of their files; a picture draws to the paths that it is given. ``numbers["stopped"]`` names
    the runs that the figure needs and that did not go through.
    """

    tables: dict[str, list[Row]]
    numbers: dict[str, Any]
    pictures: dict[str, Callable[..., None]] = field(default_factory=dict)
    scenes: tuple[Scene, ...] = ()
    moving: tuple[Section, ...] = ()

    def write(self, name: str, folder: Path) -> list[Path]:
        """Draw the pictures and write the numbers, those of the JSON file under a name; return the files."""
        files = []
        for stem, draw_to in self.pictures.items():
            paths = [folder / f"{stem}.png", folder / f"{stem}.svg"]
            draw_to(*paths)
            files += paths
        files += [write_rows(folder / f"{stem}.csv", rows) for stem, rows in self.tables.items()]
        return [*files, write_numbers(folder / f"{name}.json", self.numbers)]


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One diagram: its title, its lines, settings of its axes, and words at places in the units of its data."""

    title: str
    lines: Sequence[Line]
    settings: Mapping[str, Any]
    notes: Sequence[tuple[str, tuple[float, float]]] = ()


def draw(panels: Sequence[Panel], *paths: Path, tall: float, title: str = "", columns: int = 2) -> None:
    """Draw panels beside each other, each `tall` inches high, with one legend below them."""
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
    fig.legend(named.values(), named.keys(), ncols=columns, **place)
    fig.suptitle(title, fontsize="medium")
    save(fig, *paths)


def column(rows: list[Row], name: str) -> Array:
    """Return a column of a table."""
    return np.array([row[name] for row in rows])
