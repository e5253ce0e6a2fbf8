"""The tables and diagrams of a trade-off: every setting, the cheapest for an accuracy, fronts, orders."""

from collections.abc import Sequence
from functools import partial
from itertools import product
from math import isfinite
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer.quantities import KEPT, SCOPES
from comparisons.models import MODELS, ROD, SOLID
from comparisons.output import tabulated, write_numbers, write_rows
from comparisons.report import palette
from comparisons.report.pages import Section, folded, picture, piece, table, write_page
from comparisons.scene import to_toml
from comparisons.suite import Row
from comparisons.suite.study import result_rows
from comparisons.suites.drawing import draw
from comparisons.suites.trade.trade import COSTS, MESHED, TARGETS, Line, Trade, cheapest, front, orders

SHOWN = "force"
"""The quantity of the diagrams, and of the tables for people; the files have all."""
AXES = {
    "seconds": "processor seconds of one thread, scene to checked answer",
    "iterations": "Newton iterations of the whole path",
    "unknowns": "unknowns",
}
APART = 0.045
"""Least distance of two labels, over the height of the diagram."""


def plot_work(trade: Trade, scope: str, cost: str, folder: Path) -> list[Path]:
    """Draw the errors of all settings over a cost, against the reference and against each model's limit."""
    paths = [folder / f"{scope}-{cost}{suffix}" for suffix in (".png", ".svg")]
    title = f"{trade.scene.name}: what accuracy costs\n[n]: load steps; hollow: fewer than the scene's"
    panels = [partial(_draw, trade=trade, scope=scope, cost=cost, own=own) for own in (False, True)]
    draw(panels, *paths, tall=3.95, title=title, columns=1, sharex=True, sharey=True)
    return paths


def _draw(axes: Any, trade: Trade, scope: str, cost: str, *, own: bool) -> None:
    """Draw the completed settings in the order of the legend, and fronts; what is uncertain bounds errors from below."""
    order = [words for model in MODELS.values() for words in model.styles()]
    rows = [
        (max(k for k, words in enumerate(order) if row.family.startswith(words)), row)
        for model in MODELS.values()
        if model.meshed or not model.rod
        for row in trade.of_model(model.name, scope)
    ]
    for _, row in sorted(rows, key=itemgetter(0)):
        style, spent, error = palette.style(row.family), row.spent(cost), row.error(scope, SHOWN, own=own)
        if not (np.isfinite(error) and spent > 0):
            continue
        floor = trade.uncertainty(row.case.model if own else ROD.name, scope, SHOWN)
        full = row.case.scene.load_parameters == trade.scene.load_parameters
        axes.plot(
            spent, max(error, floor), color=style.colour, marker=style.marker, linestyle="none", label=row.family,
            markersize=9 if style.marker == "*" else 6, markerfacecolor=style.colour if full else "none", alpha=0.85,
        )  # fmt: skip
    state = f"at t = {trade.reference.end:g}" if scope == "end" else "largest over the load parameters"
    title = "against what each model converges to, Pareto fronts" if own else "against the exact rod"
    axes.set(xscale="log", yscale="log", ylabel=f"error of {SHOWN}, {state}", title=title)
    axes.margins(x=0.3, y=0.06)
    low, high = np.log10(axes.get_xlim())  # whole decades have labels that do not overlap
    axes.set_xlim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
    if own:
        axes.set_xlabel(AXES[cost])
        doubt = trade.uncertainty(SOLID.name, scope, SHOWN)
        if np.isfinite(doubt) and doubt > 0.0:
            words = "the solid's limit is known to this"
            axes.axhline(doubt, color=SOLID.colour, linewidth=0.9, linestyle=":", label=words)
        for model in MESHED:
            _draw_front(axes, front(trade, model, scope, SHOWN, cost), model)


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
STATES = {"end": "at the end", "path": "largest over the path"}
SECONDS = "processor time of one thread from the scene to the checked answer, median of repeats"


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
    for scope, cost in product(SCOPES, COSTS):
        files += plot_work(trade, scope, cost, folder)
    return [_write_page(trade, settings, files, folder), *files]


def _write_page(trade: Trade, settings: list[Line], files: Sequence[Path], folder: Path) -> Path:
    reasons = stopped(trade)
    sections = {
        "Cheapest settings": [table(*rows) for rows in _cheapest(trade)],
        "Work and precision": [
            picture(folder / f"{scope}-{cost}.svg", f"Error of {SHOWN}, {STATES[scope]}, against {cost}.")
            for scope, cost in product(SCOPES, COSTS)
        ],
        "Orders of convergence": [table(*_orders(trade))],
        "All settings": [
            piece("definitions", _references(trade)),
            folded("table of all settings", table(f"Seconds: {SECONDS}.", _shown(settings, SETTING))),
            folded("settings without a solution", piece("definitions", reasons)),
        ],
    }
    lead = f"{len(trade.rows)} settings of beams and solid; {len(reasons)} without a solution."
    title = f"{trade.scene.name}: what accuracy costs"
    parts = [Section(name, "\n".join(markup)) for name, markup in sections.items()]
    return write_page(folder, title, lead, parts, [trade.scene], files)


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


def summary(trade: Trade) -> str:
    """Return what a person reads of a trade-off: references, cheapest settings, orders, and what stopped."""
    reasons = stopped(trade)
    head = [
        f"{trade.scene.name}: {len(trade.rows)} settings",
        *(f"{name}: {what}" for name, what in _references(trade).items()),
        f"seconds: {SECONDS} after a warm-up",
        "-: no setting does it, or the solid's own limit is known less well than that; [n]: n load steps",
    ]
    tables = [
        f"{title}\n\n{tabulated(rows) if rows else 'none'}"
        for title, rows in [*_cheapest(trade), _orders(trade)]
    ]
    ends = [
        f"{len(reasons)} of {len(trade.rows)} settings without a solution:",
        *(f"  {name}: {why}" for name, why in reasons.items()),
    ]
    return "\n\n".join(["\n".join(head), *tables, "\n".join(ends)])
