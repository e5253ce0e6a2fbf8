"""What a figure of [P] leaves, rows, numbers and pictures, and the element formulations in it."""

import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

from comparisons.answer import Response
from comparisons.frozen import Frozen
from comparisons.models import find
from comparisons.output import Row
from comparisons.report import palette
from comparisons.report.pages import Section
from comparisons.report.plot import Line, draw_lines
from comparisons.scene import Scene
from tsm import elements

STATED: dict[str, Any] = tomllib.loads(Path(__file__).with_name("claims.toml").read_text(encoding="utf-8"))
"""The claims of the paper, the readings of its scenes, and the settings of pictures."""
Numbers = Mapping[str, Any]
"""What bounds and sentences of ``claims.toml`` name, much of it by formulation, division or event."""


class Study(Frozen):
    """What is found for a figure: its scenes, rows and numbers, pictures, and moving shapes for the page.

    `tables` and `pictures` go by the names of their files; a picture draws to the paths that it is given.
    ``numbers["stopped"]`` names the runs that the figure needs and that did not go through.
    """

    tables: Mapping[str, list[Row]]
    numbers: Numbers
    pictures: Mapping[str, Callable[..., None]]
    scenes: Sequence[Scene] = ()
    moving: Sequence[Section] = ()


def pictures(drawn: Mapping[str, Mapping[str, Iterable[Line]]]) -> dict[str, Callable[..., None]]:
    """Return what draws pictures, the panels of each by the name of its file."""
    return {name: partial(draw_lines, panels, **STATED["picture"][name]) for name, panels in drawn.items()}


def stops(runs: Mapping[str, Response]) -> list[str]:
    """Return the runs that did not complete, and why."""
    return [f"{name}: {one.ended}" for name, one in runs.items() if not one.completed]


TIMOSHENKO, SIMPLE, CANTILEVER, MIXED = (kind.name for kind in (*elements.PAPER, elements.MIXED))
LABELS = {
    SIMPLE: "Euler-Bernoulli, simple",
    CANTILEVER: "Euler-Bernoulli, cantilever",
    TIMOSHENKO: "Timoshenko",
    MIXED: MIXED,
}
"""What the elements are called, in the order of drawing."""
_DASHES = {CANTILEVER: (0, (5, 2)), MIXED: (0, (1, 1))}


def line(element: str) -> dict[str, Any]:
    """Return the keywords of a formulation's line in matplotlib."""
    style = palette.style(f"TSM {element}")
    return {"color": style.colour, "marker": style.marker, "linestyle": _DASHES.get(element, "-")}


def shapes(scene: Scene, runs: Mapping[str, Response], steps: Sequence[int]) -> Iterator[Line]:
    """Yield the axes of all beams by runs over each other, the first one widest, at those load parameters that they reached, and the pin."""
    for (above, (label, run)), beam, k in product(enumerate(runs.items()), scene.beams, steps):
        if k < len(run.load_parameter):
            axis = run.axis_line(beam.name, k)[1]
            nodes = {"marker": ".", "markevery": max(1, (len(axis) - 1) // beam.divisions)}
            wide = 3.6 / (1 + above)
            style = {"color": palette.style(label).colour, "linewidth": wide, "markersize": 3 * wide}
            yield Line(label, axis.T, style | (nodes if find(run.model).meshed else {"alpha": 0.25}))
    x, y = zip(*(scene.pins[0].position(scene.times[k]) for k in steps), strict=True)
    yield Line("pin", (x, y), {"color": palette.PIN, "marker": "^", "linestyle": "none"})
