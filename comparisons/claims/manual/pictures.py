"""The picture of a case: what the models found over what is exact, one colour for a model in the whole manual."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from comparisons import models as registry
from comparisons.claims.drawing import Line as Drawn
from comparisons.claims.drawing import Panel, draw
from comparisons.claims.manual.answers import ANSWER, answered, deflected, undeformed
from comparisons.claims.manual.problem import Case, Line
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


def draw_case(case: Case, path: Path) -> None:
    """Draw what is exact and what the models found, in the format of the path's suffix."""
    problem = case.problem
    picture, length = problem.picture, problem.scene.units.split(",")[1].strip()
    x, y = picture.axes or (f"x [{length}]", f"y [{length}]")
    scales = {"xscale": "log", "yscale": "log"} if picture.guide else {}
    shape = {} if picture.axes else {"aspect": "equal", "adjustable": "datalim"}
    order, lines = list(STYLES), list[Drawn]()
    for style, points in sorted([*_exact(case), *case.lines], key=lambda line: order.index(line[0])):
        found = picture.guide and style != GUIDE
        marks = {"marker": "o", "markersize": 10, "linewidth": 1.5} if found else {}
        lines.append((*points.T, {**STYLES[style], **marks, "label": style}))
    panel = Panel(title=problem.title, lines=lines, settings={"xlabel": x, "ylabel": y, **scales, **shape})
    draw([panel], path, tall=3.6)


def _exact(case: Case) -> Iterator[Line]:
    """Yield what a picture has whatever the models answer: undeformed axes, the exact answer, a line for the eye."""
    picture, scene = case.problem.picture, case.problem.scene
    if picture.guide:
        order, first = picture.guide
        ends = np.sort(case.lines[0][1][[0, -1], 0])
        yield GUIDE, np.stack([ends, first * (ends / ends[0]) ** order], axis=1)
        return
    if not picture.axes:
        yield from undeformed(scene)
    if picture.exact:
        yield from deflected(scene, answered(scene, picture.exact), ANSWER, picture.shown)
