"""What a figure of [P] leaves: rows and numbers, by which its claims are judged, and pictures; one way to write and to lay them out."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.output import Row, write_numbers, write_rows
from comparisons.response import Array
from comparisons.scene import Scene
from comparisons.show.pages import Section
from comparisons.show.plot import WIDTH, figure

COLUMNS = 2
"""Panels beside each other."""


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
        for stem, draw in self.pictures.items():
            paths = [folder / f"{stem}.png", folder / f"{stem}.svg"]
            draw(*paths)
            files += paths
        files += [write_rows(folder / f"{stem}.csv", rows) for stem, rows in self.tables.items()]
        return [*files, write_numbers(folder / f"{name}.json", self.numbers)]


def column(rows: list[Row], name: str) -> Array:
    """Return a column of a table."""
    return np.array([row[name] for row in rows])


def panels(count: int, tall: float, rest: float = 0.0, **options: Any) -> tuple[Any, Any]:
    """Return a figure and its grid of `count` panels, each `tall` inches high, with `rest` inches for all else."""
    rows = -(-count // COLUMNS)
    fig = figure(figsize=(WIDTH, rest + tall * rows))
    grid = fig.subplots(rows, min(count, COLUMNS), sharey=True, squeeze=False, **options)
    for axes in grid.flat[:count]:
        axes.grid(visible=True, linewidth=0.3)
    for axes in grid.flat[count:]:
        axes.set_axis_off()
    return fig, grid


def shape_panels(count: int, tall: float, rest: float = 0.0) -> tuple[Any, Any]:
    """Return `panels` for the shapes of beams."""
    fig, grid = panels(count, tall, rest, sharex=True)
    for axes in grid.flat[:count]:
        axes.set_aspect("equal", adjustable="box")
    for axes in grid[-1]:
        axes.set_xlabel("x [m]")
    for axes in grid[:, 0]:
        axes.set_ylabel("y [m]")
    return fig, grid


def legend(fig: Any, grid: Any, columns: int) -> None:
    """Name the lines of all panels below them, each once."""
    found: dict[str, Any] = {}
    for axes in grid.flat:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    place = {"loc": "outside lower center", "fontsize": "small", "frameon": False}
    fig.legend(found.values(), found.keys(), ncols=columns, **place)
