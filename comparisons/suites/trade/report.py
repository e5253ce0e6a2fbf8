"""The tables and diagrams of a trade-off: every setting, the cheapest for an accuracy, fronts, orders."""

from collections.abc import Sequence
from functools import partial
from itertools import pairwise, product
from math import isfinite
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer.quantities import KEPT, SCOPES
from comparisons.models import MODELS, ROD, SOLID, TSM
from comparisons.output import tabulated, write_numbers, write_rows
from comparisons.report import palette
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, picture, piece, table, write_page
from comparisons.scene import to_toml
from comparisons.suite import Row
from comparisons.suite.study import result_rows
from comparisons.suites.drawing import draw
from comparisons.suites.trade.trade import COSTS, MESHED, TARGETS, Line, Trade, cheapest, front, orders

SHOWN = "force"
"""The quantity of the diagrams, and of the tables for people; the files have all."""
SCOPE = "path"
"""The scope of the diagram."""
SECONDS = "processor seconds of one thread, from the scene to the checked answer"
APART = 0.045
"""Least distance of two labels, over the height of the diagram."""


def plot_work(trade: Trade, *paths: Path) -> None:
    """Draw the errors of all settings over their seconds, against the reference and against each model's limit."""
    title = f"{trade.scene.name}: what accuracy costs\n[n]: load steps; hollow: fewer than the scene's"
    panels = [partial(_draw, trade=trade, own=own) for own in (False, True)]
    draw(panels, *paths, tall=3.95, title=title, columns=1, sharex=True, sharey=True)


def _draw(axes: Any, trade: Trade, *, own: bool) -> None:
    """Draw the completed settings in the order of the legend, and fronts; what is uncertain bounds errors from below."""
    order = [words for model in MODELS.values() for words in model.styles()]
    rows = [
        (max(k for k, words in enumerate(order) if row.family.startswith(words)), row)
        for model in MODELS.values()
        if model.meshed or not model.rod
        for row in trade.of_model(model.name, SCOPE)
    ]
    for _, row in sorted(rows, key=itemgetter(0)):
        style, spent, error = palette.style(row.family), row.seconds, row.error(SCOPE, SHOWN, own=own)
        if not (np.isfinite(error) and spent > 0):
            continue
        floor = trade.uncertainty(row.case.model if own else ROD.name, SCOPE, SHOWN)
        full = row.case.scene.load_parameters == trade.scene.load_parameters
        axes.plot(
            spent, max(error, floor), color=style.colour, marker=style.marker, linestyle="none", label=row.family,
            markersize=9 if style.marker == "*" else 6, markerfacecolor=style.colour if full else "none", alpha=0.85,
        )  # fmt: skip
    title = "against what each model converges to, Pareto fronts" if own else "against the exact rod"
    axes.set(xscale="log", yscale="log", ylabel=f"largest error of {SHOWN}", title=title)
    axes.margins(x=0.3, y=0.06)
    low, high = np.log10(axes.get_xlim())  # whole decades have labels that do not overlap
    axes.set_xlim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
    if own:
        axes.set_xlabel(SECONDS)
        doubt = trade.uncertainty(SOLID.name, SCOPE, SHOWN)
        if np.isfinite(doubt) and doubt > 0.0:
            words = "the solid's limit is known to this"
            axes.axhline(doubt, color=SOLID.colour, linewidth=0.9, linestyle=":", label=words)
        for model in MESHED:
            _draw_front(axes, front(trade, model, SCOPE, SHOWN, COSTS[0]), model)


def _draw_front(axes: Any, points: Sequence[Line], model: str) -> None:
    """Draw a front, and name its points to their left where they lie apart."""
    spent, errors = ([one[name] for one in points] for name in ("spent", "own_error"))
    axes.plot(spent, errors, color=MODELS[model].colour, linewidth=1.6, drawstyle="steps-post", zorder=1)
    low, high = np.log(axes.get_ylim())
    words = {"va": "center", "ha": "right", "fontsize": "small", "textcoords": "offset points"}
    ground = {"facecolor": "white", "alpha": 0.7, "linewidth": 0.0, "pad": 0.5}
    last = np.inf
    for one in points:
        height = np.log(one["own_error"])
        if height < last - APART * (high - low):
            last = height
            axes.annotate(one["setting"], (one["spent"], one["own_error"]), (-7, 0), bbox=ground, **words)


SETTING = (
    "label", "scene.load_parameters", "status", "unknowns", "iterations", "seconds", "own_error_end_force", "own_error_path_force",
    "error_path_force",
)  # fmt: skip
"""Columns of all settings for people; the files have all."""
HIDDEN = ("scope", "quantity", "limit_uncertainty", "settings", "order_scatter", "cost_exponent_scatter")
"""Columns that the other tables for people leave out."""


def _shown(rows: Sequence[Line], columns: Sequence[str] = ()) -> list[Line]:
    """Return rows for people, of some columns or without `HIDDEN`, with blanks in the names."""
    kept = columns or [name for name in next(iter(rows), ()) if name not in HIDDEN]
    return [{name.replace("_", " "): row[name] for name in kept} for row in rows]


def write_trade(trade: Trade, folder: Path) -> list[Path]:
    """Write the tables, the diagrams and the page; return the files, the page first."""
    settings = _settings(trade.rows)
    uncertainty = trade.reference.uncertainty
    stated = [of for of in product(SCOPES, KEPT) if isfinite(uncertainty[of[0]][of[1]])]
    cheap = [cheapest(trade, *of, target) for of, target in product(stated, TARGETS)]
    fitted = {quantity: list(orders(trade, quantity)) for quantity in KEPT}
    references = {"error": trade.reference, "own_error of the solid": trade.limit}
    numbers = {
        "scene": trade.scene.name,
        "scene_file": to_toml(trade.scene),
        "references": {
            name: known and {"is": known.sentence, "end": known.end, "uncertainty": known.uncertainty}
            for name, known in references.items()
        },
        "cheapest": cheap,
        "orders": fitted,
        "pareto": [row for of in product(MESHED, SCOPES, KEPT, COSTS) for row in front(trade, *of)],
    }
    tables = {
        "trade.csv": settings,
        "cheapest.csv": cheap,
        "orders.csv": [{"quantity": name, **row} for name, rows in fitted.items() for row in rows],
    }
    files = [write_rows(folder / name, rows) for name, rows in tables.items() if rows]
    files.append(write_numbers(folder / "trade.json", numbers))
    drawn = folder / "path-seconds.png", folder / "path-seconds.svg"
    plot_work(trade, *drawn)
    files += drawn
    return [_write_page(trade, settings, files, folder), *files]


def _write_page(trade: Trade, settings: list[Line], files: Sequence[Path], folder: Path) -> Path:
    shown = {
        "Work and precision": picture(files[-1], f"Largest error of {SHOWN} over the path, against seconds."),
        "Cheapest settings": "\n".join(table(*rows) for rows in _cheapest(trade)),
        "Orders of convergence": table(*_orders(trade)),
        "All settings": piece("definitions", _references(trade))
        + table(f"Seconds: {SECONDS}", _shown(settings, SETTING)),
        "Settings without a solution": piece("definitions", stopped(trade)),
    }
    parts = [Section(name, markup) for name, markup in shown.items()]
    return write_page(
        folder, f"{trade.scene.name}: what accuracy costs", brief(trade), parts, [trade.scene], files
    )


def _settings(rows: Sequence[Row]) -> list[Line]:
    """Return what every setting is and cost, as a study does, and all its errors."""
    stated = result_rows(rows)
    return [
        line
        | {
            f"{'own_' * own}error_{scope}_{quantity}": row.error(scope, quantity, own=own)
            for own, scope, quantity in product((False, True), SCOPES, KEPT)
        }
        for line, row in zip(stated, rows, strict=True)
    ]


def _cheapest(trade: Trade) -> list[tuple[str, list[Line]]]:
    """Return a title and the cheapest settings of every scope."""
    places = {
        "end": f"at the load parameter {trade.reference.end:g}, any number of load steps",
        "path": f"the largest over all {trade.scene.load_parameters} load parameters",
    }
    rows = {scope: [cheapest(trade, scope, SHOWN, target) for target in TARGETS] for scope in SCOPES}
    return [(f"cheapest for an error of {SHOWN}, {places[of]}", _shown(rows[of])) for of in SCOPES]


def _orders(trade: Trade) -> tuple[str, list[Line]]:
    title = f"orders over elements and cost exponents over unknowns, error of {SHOWN} over the path"
    return title, _shown(list(orders(trade, SHOWN)))


def _references(trade: Trade) -> dict[str, str]:
    limit = trade.limit.sentence if trade.limit else "not known: a solid that it is extrapolated from stopped"
    return {"errors against": trade.reference.sentence, "the solid's own limit": limit}


def stopped(trade: Trade) -> dict[str, str]:
    """Return the settings without a completed and checked solution, and why."""
    return {
        f"{row.label} [{row.case.scene.load_parameters}]": f"{row.response.status}: {row.response.message}"
        for row in trade.rows
        if not row.response.completed
    }


def brief(trade: Trade) -> Brief:
    """Return what is found: what the solid costs beside beams of equal error, and what more time buys."""
    rows = [cheapest(trade, SCOPE, SHOWN, target) for target in TARGETS]
    ratios = [row["ratio"] for row in rows if row["ratio"]]
    dear = "No solid here is as near to its limit as beams are to theirs"
    if ratios:
        between = " to ".join(dict.fromkeys(f"{ratio:.2g}" for ratio in (min(ratios), max(ratios))))
        dear = f"At equal error the solid takes {between} times the seconds of beams"
    steps = front(trade, TSM.name, SCOPE, SHOWN, COSTS[0])
    best = max(pairwise(steps), key=lambda ab: _gain(*ab), default=None)
    more = ""
    if best is not None:
        a, b = best
        more = f"; {b['spent'] / a['spent'] - 1.0:.0%} more time buys an error of {b['own_error']:.0e} instead of {a['own_error']:.0e} ({b['setting']})"
    points = [f"{name[0].upper()}{name[1:]}: {what}." for name, what in _references(trade).items()]
    reasons = stopped(trade)
    points.append(
        f"{len(trade.rows)} settings, {len(reasons)} without a solution; [n]: n load steps; -: no setting does it."
    )
    keys = {
        "target": "error",
        TSM.name: "beams",
        f"{TSM.name}_seconds": "seconds",
        SOLID.name: SOLID.label,
        f"{SOLID.name}_seconds": "seconds ",
        "ratio": "ratio",
    }
    answer = [{words: row[key] for key, words in keys.items()} for row in rows]
    return Brief(
        f"{dear}{more}.",
        points,
        answer,
        f"The cheapest settings for an error of {SHOWN} over the path, and their seconds:",
    )


def _gain(a: Line, b: Line) -> float:
    """Return by how many decades the error falls over how many the seconds rise."""
    return float(np.log(a["own_error"] / b["own_error"]) / np.log(b["spent"] / a["spent"]))


def summary(trade: Trade) -> str:
    """Return the tables of a trade-off, and what stopped."""
    tables = [*_cheapest(trade), _orders(trade)]
    reasons = [f"  {name}: {why}" for name, why in stopped(trade).items()]
    ends = ["settings without a solution:", *reasons] if reasons else []
    return "\n\n".join(
        [*(f"{title}\n\n{tabulated(rows) if rows else 'none'}" for title, rows in tables), "\n".join(ends)]
    )
