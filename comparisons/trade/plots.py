"""Work-precision diagrams: error against seconds, iterations and unknowns, with the Pareto fronts."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, ROD, SOLID
from comparisons.show import palette
from comparisons.show.plot import WIDTH, figure, save
from comparisons.show.work import draw_legend, logarithmic
from comparisons.trade.trade import MESHED, Line, Trade, front

SHOWN = "force"
"""The quantity of the diagrams, and of the tables for people; the files have all."""
AXES = {
    "seconds": "processor seconds of one thread, scene to checked answer",
    "iterations": "Newton iterations of the whole path",
    "unknowns": "unknowns",
}
APART = 0.045
"""Least distance of two labels, over the height of the diagram."""
ALIKE = 1.2
"""Ratio of two errors up to which they share one label, with the name of the cheaper setting."""


def plot_work(trade: Trade, scope: str, cost: str, folder: Path) -> list[Path]:
    """Draw the errors of all settings over a cost, against the reference and against each model's limit."""
    fig = figure(figsize=(WIDTH, 9.2))
    upper, lower = fig.subplots(2, 1, sharex=True, sharey=True)
    _draw(upper, trade, scope, cost, own=False)
    _draw(lower, trade, scope, cost, own=True)
    _mark_uncertainty(lower, trade.uncertainty(SOLID.name, scope, SHOWN))
    for axes in (upper, lower):
        logarithmic(axes)
        axes.margins(x=0.3, y=0.06)
    for model in MESHED:
        _draw_front(lower, front(trade, model, scope, SHOWN, cost), model)
    lower.set_xlabel(AXES[cost])
    state = f"at t = {trade.reference.end:g}" if scope == "end" else "largest over the load parameters"
    fig.supylabel(f"error of {SHOWN}, {state}", fontsize="medium")
    upper.set_title("against the exact rod", fontsize="medium")
    lower.set_title("against what each model converges to, Pareto fronts", fontsize="medium")
    draw_legend(fig, [upper], "outside lower center")
    fig.suptitle(
        f"{trade.scene.name}: what accuracy costs\n[n]: load steps; hollow: fewer than the scene's",
        fontsize="large",
    )
    paths = [folder / f"{scope}-{cost}{suffix}" for suffix in (".png", ".svg")]
    save(fig, *paths)
    return paths


def _draw(axes: Any, trade: Trade, scope: str, cost: str, *, own: bool) -> None:
    """Draw every completed setting, the families in the order of the legend; what is uncertain bounds errors from below."""
    shown = [
        row
        for model in MODELS.values()
        if model.meshed or not model.rod
        for row in trade.of_model(model.name, scope)
    ]
    order = [words for model in MODELS.values() for words in model.styles()]
    for row in sorted(
        shown, key=lambda row: max(k for k, words in enumerate(order) if row.family.startswith(words))
    ):
        style, spent, error = palette.style(row.family), row.spent(cost), row.error(scope, SHOWN, own=own)
        if not (np.isfinite(error) and spent > 0):
            continue
        floor = trade.uncertainty(row.case.model if own else ROD.name, scope, SHOWN)
        full = row.case.scene.load_parameters == trade.scene.load_parameters
        axes.plot(
            spent, max(error, floor), color=style.colour, marker=style.marker, linestyle="none", label=row.family,
            markersize=9 if style.marker == "*" else 6, markerfacecolor=style.colour if full else "none", alpha=0.85,
        )  # fmt: skip


def _mark_uncertainty(axes: Any, doubt: float) -> None:
    if np.isfinite(doubt) and doubt > 0.0:
        axes.axhline(doubt, color=SOLID.colour, linewidth=0.9, linestyle=":")
        axes.annotate(
            "the solid's limit is known to this", (1.0, doubt), (-4, -4), color="0.3", ha="right", va="top",
            xycoords=("axes fraction", "data"), textcoords="offset points", fontsize="x-small",
        )  # fmt: skip


def _draw_front(axes: Any, points: Sequence[Line], model: str) -> None:
    """Draw a front, and name its points to their left, of bodies at the right-hand edge."""
    spent, errors = ([one[name] for one in points] for name in ("spent", "own_error"))
    axes.plot(spent, errors, color=MODELS[model].colour, linewidth=1.6, drawstyle="steps-post", zorder=1)
    named: list[Line] = []
    for one in points:
        if not named or ALIKE * one["own_error"] < named[-1]["own_error"]:
            named.append(one)
    low, high = np.log(axes.get_ylim())
    last, edge = -np.inf, MODELS[model].continuum
    line = {"arrowstyle": "-", "color": "0.7", "linewidth": 0.6, "shrinkB": 4, "relpos": (0.0, 0.5)}
    ground = {"facecolor": "white", "alpha": 0.7, "linewidth": 0.0, "pad": 0.5}
    for one in reversed(named):
        place = (one["spent"], one["own_error"])
        height = float((np.log(place[1]) - low) / (high - low))
        if not edge and height <= last + APART:
            continue
        last = max(height, last + APART)
        where = (1.03, last) if edge else (-7, 0)
        how: dict[str, Any] = {"textcoords": "axes fraction", "arrowprops": line}
        if not edge:
            how = {"textcoords": "offset points", "ha": "right", "bbox": ground}
        axes.annotate(one["setting"], place, where, va="center", fontsize="small", **how)
