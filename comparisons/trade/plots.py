"""Work-precision diagrams: error against seconds, iterations and unknowns, with the Pareto fronts."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, ROD, SOLID
from comparisons.show import palette
from comparisons.show.plot import WIDTH, draw_legend, figure, logarithmic, save
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
    """Draw the errors of all settings over a cost, as PNG and SVG; return the files.

    The upper panel has errors against the reference, the lower one errors against each model's limit.
    """
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
    models = [model.name for model in MODELS.values() if model.meshed or not model.rod]
    shown = [row for model in models for row in trade.of_model(model, scope)]
    order = [words for model in MODELS.values() for words in model.styles()]
    for row in sorted(
        shown, key=lambda row: max(k for k, words in enumerate(order) if row.family.startswith(words))
    ):
        style, spent = palette.style(row.family), row.spent(cost)
        error = row.error(scope, SHOWN, own=own)
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
    """Draw a front, and name its points: to their left, or at the right-hand edge where others of the model are around."""
    axes.plot(
        [one["spent"] for one in points], [one["own_error"] for one in points],
        color=MODELS[model].colour, linewidth=1.6, drawstyle="steps-post", zorder=1,
    )  # fmt: skip
    low, high = np.log(axes.get_ylim())
    last = -np.inf
    for one in reversed(_distinct(points)):
        height = float((np.log(one["own_error"]) - low) / (high - low))
        place, words = (one["spent"], one["own_error"]), {"va": "center", "fontsize": "small"}
        if MODELS[model].continuum:
            last = max(height, last + APART)
            line = {"arrowstyle": "-", "color": "0.7", "linewidth": 0.6, "shrinkB": 4, "relpos": (0.0, 0.5)}
            axes.annotate(
                short(one), place, (1.03, last), textcoords="axes fraction", arrowprops=line, **words
            )
        elif height > last + APART:
            last = height
            ground = {"facecolor": "white", "alpha": 0.7, "linewidth": 0.0, "pad": 0.5}
            axes.annotate(
                short(one), place, (-7, 0), textcoords="offset points", ha="right", bbox=ground, **words
            )


def _distinct(points: Sequence[Line]) -> list[Line]:
    """Return the points of a front without those that are hardly better than a cheaper one."""
    kept: list[Line] = []
    for one in points:
        if not kept or ALIKE * one["own_error"] < kept[-1]["own_error"]:
            kept.append(one)
    return kept


def short(row: Line, name: str = "") -> str | None:
    """Return a setting of a row in a few words, its load steps in brackets; None if there is none."""
    label, steps = (row[f"{name}_{key}".strip("_")] for key in ("" if name else "label", "load_steps"))
    if label is None:
        return None
    setting = label.partition(" ")[2] or label
    return f"{setting.replace('tolerance', 'tol')} [{steps}]"
