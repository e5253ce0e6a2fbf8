"""The picture of a case: what the models found over what is exact, one colour for a model in the whole manual."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from comparisons import models as registry
from comparisons.claims.manual.answers import Curve
from comparisons.claims.manual.problem import Problem
from comparisons.show import palette
from comparisons.show.plot import SOLID, figure, save

STYLES: dict[str, dict[str, Any]] = {
    "undeformed": {"color": "0.6", "linewidth": 1.0, "linestyle": "--"},
    "path of the pin": {"color": "0.6", "linewidth": 0.8, "linestyle": ":"},
    registry.SOLID.name: {**SOLID, "color": palette.colour(registry.SOLID.name), "linewidth": 9.0},
    "tsm timoshenko": {"color": palette.colour("TSM timoshenko"), "linewidth": 6.0},
    "tsm mixed": {"color": palette.colour("TSM mixed"), "linewidth": 4.0},
    "tsm exact": {"color": palette.colour("TSM exact"), "linewidth": 2.2},
    registry.ROD.name: {"color": palette.colour("exact rod"), "linewidth": 1.2},
    registry.ELASTICA.name: {"color": palette.colour(registry.ELASTICA.name), "linewidth": 1.2},
    "exact answer": {"color": palette.GREY, "linewidth": 0.8, "linestyle": (0, (4, 3))},
    "exact order": {"color": palette.GREY, "linewidth": 0.8, "linestyle": (0, (4, 3))},
}
"""Drawn in this order, each line narrower than those below it, so that those that agree are all seen."""


def draw(problem: Problem, curves: Iterable[Curve], *paths: Path) -> None:
    """Draw curves as the picture of a problem to `paths`, in the formats of their suffixes."""
    picture, length = problem.picture, problem.scene.units.split(",")[1].strip()
    fig = figure(figsize=(6.4, 4.4))
    axes = fig.subplots()
    named: set[str] = set()
    order = list(STYLES)
    for curve in sorted(curves, key=lambda one: order.index(one.style)):
        label = None if curve.style in named else curve.style
        found = picture.logarithmic and curve.style != "exact order"
        marks = {"marker": "o", "markersize": 10, "linewidth": 1.5} if found else {}
        axes.plot(*curve.points.T, label=label, **{**STYLES[curve.style], **marks})
        named.add(curve.style)
    x, y = picture.axes or (f"x [{length}]", f"y [{length}]")
    axes.set(xlabel=x, ylabel=y, title=problem.title)
    if picture.shape:
        axes.set_aspect("equal", adjustable="datalim")
    if picture.logarithmic:
        axes.set(xscale="log", yscale="log")
    axes.grid(visible=True, linewidth=0.3)
    axes.legend(loc="best", fontsize="small")
    save(fig, *paths)
