"""What a figure of [P] leaves: rows and numbers, by which its claims are judged, and pictures."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.output import Row, write_numbers, write_rows
from comparisons.response import Array, Response
from comparisons.scene import Scene
from comparisons.show.pages import Section


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


def column(rows: Sequence[Row], name: str, **of: object) -> Array:
    """Return a column of a table, in the rows with some values."""
    return np.array([row[name] for row in rows if all(row[key] == value for key, value in of.items())])


def stops(runs: Mapping[str, Response]) -> list[str]:
    """Return the runs that did not complete, and why."""
    return [f"{name}: {one.status}: {one.message}" for name, one in runs.items() if not one.completed]


def reached(response: Response) -> float:
    """Return the last load parameter reached."""
    return float(max(response.load_parameter, default=0.0))
