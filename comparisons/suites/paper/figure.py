"""What a figure of [P] leaves, rows, numbers and pictures, and the element formulations in it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer import Array, Response
from comparisons.output import Row, write_numbers, write_rows
from comparisons.report import palette
from comparisons.report.pages import Section
from comparisons.scene import Scene
from tsm.elements import EULER_BERNOULLI_CANTILEVER, EULER_BERNOULLI_SIMPLE
from tsm.elements import MIXED as MIXED_ELEMENT
from tsm.elements import TIMOSHENKO as TIMOSHENKO_ELEMENT


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


Facts = Mapping[str, Any]
"""Numbers that bounds and sentences of ``claims.toml`` name, many of them by formulation, division or event."""


def column(rows: Sequence[Row], name: str, **of: object) -> Array:
    """Return a column of a table, in the rows with some values."""
    return np.array([row[name] for row in rows if all(row[key] == value for key, value in of.items())])


def stops(runs: Mapping[str, Response]) -> list[str]:
    """Return the runs that did not complete, and why."""
    return [f"{name}: {one.status}: {one.message}" for name, one in runs.items() if not one.completed]


def reached(response: Response) -> float:
    """Return the last load parameter reached."""
    return float(max(response.load_parameter, default=0.0))


def percent(value: float) -> str:
    """Return a ratio in percent, with three digits."""
    return f"{100.0 * value:.3g} %" if value >= 1e-6 else f"{100.0 * value:.0e} %"


SIMPLE, CANTILEVER = EULER_BERNOULLI_SIMPLE.name, EULER_BERNOULLI_CANTILEVER.name
TIMOSHENKO, MIXED = TIMOSHENKO_ELEMENT.name, MIXED_ELEMENT.name
LABELS = {
    SIMPLE: "Euler-Bernoulli, simple",
    CANTILEVER: "Euler-Bernoulli, cantilever",
    TIMOSHENKO: "Timoshenko",
    MIXED: MIXED,
}
"""What they are called, in the order of drawing."""
_DASHES = {CANTILEVER: (0, (5, 2)), MIXED: (0, (1, 1))}


def line(element: str) -> dict[str, Any]:
    """Return the keywords of a formulation's line in matplotlib."""
    style = palette.style(f"TSM {element}")
    return {"color": style.colour, "marker": style.marker, "linestyle": _DASHES.get(element, "-")}
