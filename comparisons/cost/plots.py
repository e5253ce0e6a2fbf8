"""Work-precision diagrams: error against seconds, iterations and unknowns, with the Pareto fronts."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.cost.cases import family, meshed
from comparisons.cost.points import COSTS, OnFront, Point, Trade, front
from comparisons.cost.tables import short
from comparisons.models import MODELS, ROD, SOLID
from comparisons.show import palette
from comparisons.show.plot import WIDTH, figure, save

AXES = {
    "seconds": "processor seconds of one thread, scene to checked answer",
    "iterations": "Newton iterations of the whole path",
    "unknowns": "unknowns",
}
APART = 0.045
"""Least distance of two labels, over the height of the diagram."""
ALIKE = 1.2
"""Ratio of two errors up to which they share one label, with the name of the cheaper setting."""


def plot_work(trade: Trade, quantity: str, scope: str, cost: str, *paths: Path) -> None:
    """Draw the errors of all settings over a cost, in two panels, one above the other: errors against the reference, and errors against each model's limit.

    Parameters
    ----------
    trade : Trade
        The sweep.
    quantity, scope, cost : str
        Names in `comparisons.quantities` and `COSTS`.
    paths : Path
        Files, in the formats of their suffixes.
    """
    fig = figure(figsize=(WIDTH, 9.2))
    upper, lower = fig.subplots(2, 1, sharex=True, sharey=True)
    _draw(upper, trade, quantity, scope, cost, own=False)
    _draw(lower, trade, quantity, scope, cost, own=True)
    _mark_uncertainty(lower, trade, quantity, scope)
    for axes in (upper, lower):
        axes.set(xscale="log", yscale="log")
        axes.margins(x=0.3, y=0.06)
        axes.grid(visible=True, linewidth=0.3)
    for model in meshed():
        _draw_front(lower, trade, model, quantity, scope, cost)
    lower.set_xlabel(AXES[cost])
    fig.supylabel(_title(trade, quantity, scope), fontsize="medium")
    upper.set_title(f"against the {trade.reference.name}", fontsize="medium")
    lower.set_title("against what each model converges to, Pareto fronts", fontsize="medium")
    fig.legend(*_legend(upper), loc="outside lower center", ncols=3, fontsize="small", frameon=False)
    fig.suptitle(
        f"{trade.scene.name}: what accuracy costs\n[n]: load steps; hollow: fewer than the scene's",
        fontsize="large",
    )
    save(fig, *paths)


def _title(trade: Trade, quantity: str, scope: str) -> str:
    state = f"at t = {trade.reference.end:g}" if scope == "end" else "largest over the load parameters"
    return f"error of {quantity.replace('_', ' ')}, {state}"


def _draw(axes: Any, trade: Trade, quantity: str, scope: str, cost: str, *, own: bool) -> None:
    """Draw every completed setting, the families in the order of the legend; what is uncertain bounds errors from below."""
    shown = [point for model in _drawn() for point in trade.of_model(model, scope)]
    for name in _families(shown):
        style = palette.style(name)
        color, marker = style.colour, style.marker
        for point in (one for one in shown if family(one.case) == name):
            error = (point.own_errors if own else point.errors)[scope][quantity]
            floor = trade.uncertainty(point.case.model if own else ROD.name, scope, quantity)
            spent = point.spent(cost)
            if not (np.isfinite(error) and spent > 0):
                continue
            full = point.case.scene.load_parameters == trade.scene.load_parameters
            axes.plot(
                spent, max(error, floor), color=color, marker=marker, linestyle="none", label=name,
                markersize=9 if marker == "*" else 6, markerfacecolor=color if full else "none", alpha=0.85,
            )  # fmt: skip


def _families(points: Sequence[Point]) -> list[str]:
    """Return the families in the order of the styles of their models."""
    order = [words for model in MODELS.values() for words in model.styles()]
    return sorted(
        {family(point.case) for point in points},
        key=lambda name: max(k for k, words in enumerate(order) if name.startswith(words)),
    )


def _legend(axes: Any) -> tuple[list[Any], list[str]]:
    """One entry for each family, a filled marker where it has one."""
    handles, labels = axes.get_legend_handles_labels()
    entries: dict[str, Any] = {}
    for handle, label in zip(handles, labels, strict=True):
        if label not in entries or entries[label].get_markerfacecolor() == "none":
            entries[label] = handle
    return list(entries.values()), list(entries)


def _mark_uncertainty(axes: Any, trade: Trade, quantity: str, scope: str) -> None:
    doubt = trade.uncertainty(SOLID.name, scope, quantity)
    if np.isfinite(doubt) and doubt > 0.0:
        axes.axhline(doubt, color=SOLID.colour, linewidth=0.9, linestyle=":")
        axes.annotate(
            "the solid's limit is known to this", (1.0, doubt), (-4, -4), color="0.3", ha="right", va="top",
            xycoords=("axes fraction", "data"), textcoords="offset points", fontsize="x-small",
        )  # fmt: skip


def _drawn() -> list[str]:
    """Return the models whose settings have an error: all but the exact rod."""
    return [model.name for model in MODELS.values() if model.meshed or not model.rod]


def _draw_front(axes: Any, trade: Trade, model: str, quantity: str, scope: str, cost: str) -> None:
    points = front(trade, model, scope, quantity, cost)
    axes.plot(
        *([getattr(point, name) for point in points] for name in ("cost", "error")),
        color=MODELS[model].colour, linewidth=1.6, drawstyle="steps-post", zorder=1,
    )  # fmt: skip
    low, high = np.log(axes.get_ylim())
    last = -np.inf
    for one in reversed(_distinct(points)):
        height = float((np.log(one.error) - low) / (high - low))
        if MODELS[model].continuum:
            last = max(height, last + APART)
            _label_at_edge(axes, one, last)
        elif height > last + APART:
            last = height
            _label_beside(axes, one)


def _distinct(points: Sequence[OnFront]) -> list[OnFront]:
    """Return the points of a front without those that are hardly better than a cheaper one."""
    kept: list[OnFront] = []
    for one in points:
        if not kept or ALIKE * one.error < kept[-1].error:
            kept.append(one)
    return kept


def _label_beside(axes: Any, one: OnFront) -> None:
    """Name a point to its left, where a front leaves nothing of its model."""
    axes.annotate(
        short(one.point), (one.cost, one.error), (-7, 0), textcoords="offset points", ha="right", va="center",
        fontsize="small", bbox={"facecolor": "white", "alpha": 0.7, "linewidth": 0.0, "pad": 0.5},
    )  # fmt: skip


def _label_at_edge(axes: Any, one: OnFront, height: float) -> None:
    """Name a point that has others around it at the right-hand edge, at a part `height` of that."""
    axes.annotate(
        short(one.point), (one.cost, one.error), (1.03, height), textcoords="axes fraction", va="center",
        fontsize="small", arrowprops={"arrowstyle": "-", "color": "0.7", "linewidth": 0.6, "shrinkB": 4, "relpos": (0.0, 0.5)},
    )  # fmt: skip


def plot_all(trade: Trade, quantity: str, folder: Path, scopes: Sequence[str]) -> list[Path]:
    """Draw the diagrams of all costs and the given scopes to `folder`, as PNG and SVG; return the files."""
    files = []
    for scope in scopes:
        for cost in COSTS:
            paths = [folder / f"{scope}-{cost}{suffix}" for suffix in (".png", ".svg")]
            plot_work(trade, quantity, scope, cost, *paths)
            files += paths
    return files
