"""The picture of a case: what the models found over what is exact, one colour for a model in the whole manual."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from comparisons import models as registry
from comparisons.claims.drawing import Line, Panel, draw
from comparisons.claims.manual.answers import ANSWER, Curve
from comparisons.claims.manual.problem import Problem
from comparisons.show import palette
from comparisons.show.plot import SOLID

GUIDE = "exact order"
EXACT = {"color": palette.GREY, "linewidth": 0.8, "linestyle": (0, (4, 3))}
STYLES: dict[str, dict[str, Any]] = {
    "undeformed": {"color": "0.6", "linewidth": 1.0, "linestyle": "--"},
    "path of the pin": {"color": "0.6", "linewidth": 0.8, "linestyle": ":"},
    registry.SOLID.name: {**SOLID, "color": palette.colour(registry.SOLID.name), "linewidth": 9.0},
    "tsm timoshenko": {"color": palette.colour("TSM timoshenko"), "linewidth": 6.0},
    "tsm mixed": {"color": palette.colour("TSM mixed"), "linewidth": 4.0},
    "tsm exact": {"color": palette.colour("TSM exact"), "linewidth": 2.2},
    registry.ROD.name: {"color": palette.colour("exact rod"), "linewidth": 1.2},
    registry.ELASTICA.name: {"color": palette.colour(registry.ELASTICA.name), "linewidth": 1.2},
    ANSWER: EXACT,
    GUIDE: EXACT,
}
"""Drawn in this order, each line narrower than those below it, so that those that agree are all seen."""


def draw_problem(problem: Problem, curves: Iterable[Curve], *paths: Path) -> None:
    """Draw curves as the picture of a problem to `paths`, in the formats of their suffixes."""
    picture, length = problem.picture, problem.scene.units.split(",")[1].strip()
    x, y = picture.axes or (f"x [{length}]", f"y [{length}]")
    scales = {"xscale": "log", "yscale": "log"} if picture.guide else {}
    shape = {} if picture.axes else {"aspect": "equal", "adjustable": "datalim"}
    settings = {"xlabel": x, "ylabel": y, **scales, **shape}
    order, lines = list(STYLES), list[Line]()
    for curve in sorted(curves, key=lambda one: order.index(one.style)):
        found = picture.guide and curve.style != GUIDE
        marks = {"marker": "o", "markersize": 10, "linewidth": 1.5} if found else {}
        lines.append((*curve.points.T, {**STYLES[curve.style], **marks, "label": curve.style}))
    draw([Panel(title=problem.title, lines=lines, settings=settings)], *paths, tall=3.6, columns=1)
