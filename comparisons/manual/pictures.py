"""The picture of a case: what the models found over what is exact, one colour for a model in the whole manual."""

from collections.abc import Iterable
from itertools import chain
from pathlib import Path
from typing import Any

from comparisons.manual.record import Curve, Picture
from comparisons.plot import BEAMS, EXACT, SOLID, figure, save

STYLES: dict[str, dict[str, Any]] = {
    "undeformed": {"color": "0.6", "linewidth": 1.0, "linestyle": "--"},
    "path of the pin": {"color": "0.6", "linewidth": 0.8, "linestyle": ":"},
    "solid": {**SOLID, "linewidth": 9.0},
    "tsm timoshenko": {"color": BEAMS[3]["color"], "linewidth": 6.0},
    "tsm mixed": {"color": BEAMS[1]["color"], "linewidth": 4.0},
    "tsm exact": {"color": BEAMS[0]["color"], "linewidth": 2.2},
    "rod": {"color": "#0072B2", "linewidth": 1.2},
    "elastica": {"color": BEAMS[2]["color"], "linewidth": 1.2},
    "exact answer": {**EXACT, "linewidth": 0.8, "linestyle": (0, (4, 3))},
    "exact order": {**EXACT, "linewidth": 0.8, "linestyle": (0, (4, 3))},
}
"""Drawn in this order, each line narrower than those below it, so that those that agree are all seen."""


def draw(title: str, picture: Picture, curves: Iterable[Curve], *paths: Path) -> None:
    """Draw a case to `paths`, in the formats of their suffixes."""
    fig = figure(figsize=(6.4, 4.4))
    axes = fig.subplots()
    named: set[str] = set()
    order = list(STYLES)
    for curve in sorted(chain(picture.curves, curves), key=lambda one: order.index(one.style)):
        label = None if curve.style in named else curve.style
        found = picture.logarithmic and curve.style != "exact order"
        marks = {"marker": "o", "markersize": 10, "linewidth": 1.5} if found else {}
        axes.plot(*curve.points.T, label=label, **{**STYLES[curve.style], **marks})
        named.add(curve.style)
    axes.set(xlabel=picture.axes[0], ylabel=picture.axes[1], title=title)
    if picture.shape:
        axes.set_aspect("equal", adjustable="datalim")
    if picture.logarithmic:
        axes.set(xscale="log", yscale="log")
    axes.grid(visible=True, linewidth=0.3)
    axes.legend(loc="best", fontsize="small")
    save(fig, *paths)
