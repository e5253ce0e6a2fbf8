"""The tables of a trade-off: every setting, the cheapest for an accuracy, the orders; as files, for people, and on a page."""

from collections.abc import Sequence
from itertools import product
from math import isfinite
from pathlib import Path

from comparisons.cases import Row
from comparisons.models import SOLID, TSM
from comparisons.output import tabulated, write_numbers, write_rows
from comparisons.quantities import KEPT, SCOPES
from comparisons.scene import to_toml
from comparisons.show.pages import Section, definitions, folded, picture, table, write_page
from comparisons.trade.plots import SHOWN, plot_work, short
from comparisons.trade.trade import COSTS, MESHED, TARGETS, Line, Trade, cheapest, front, orders

SETTING = (
    "label", "load_steps", "status", "unknowns", "iterations", "seconds", "own_error_end_force", "own_error_path_force",
    "error_path_force",
)  # fmt: skip
"""Columns of the table of all settings; ``trade.csv`` has all."""
STATES = {"end": "at the end", "path": "largest over the path"}


def write_trade(trade: Trade, folder: Path) -> list[Path]:
    """Write the tables, the diagrams and the page; return the files, the page first."""
    settings = [_setting(row) for row in trade.rows]
    uncertainty = trade.reference.uncertainty
    told = ((scope, name) for scope, name in product(SCOPES, KEPT) if isfinite(uncertainty[scope][name]))
    cheap = [cheapest(trade, *of, target) for of in told for target in TARGETS]
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
    references = {"errors against": trade.reference.sentence}
    if trade.limit is not None:
        references["own errors of the solid against"] = trade.limit.sentence
    shown = [{name.replace("_", " "): row[name] for name in SETTING} for row in settings]
    caption = "Seconds: processor time of one thread from the scene to the checked answer, median of repeats."
    sections = {
        "Cheapest settings": [table(*cheapest_lines(trade, scope)) for scope in SCOPES],
        "Work and precision": [
            picture(folder / f"{scope}-{cost}.svg", f"Error of {SHOWN}, {STATES[scope]}, against {cost}.")
            for scope, cost in product(SCOPES, COSTS)
        ],
        "Orders of convergence": [table(f"error of {SHOWN} over the path", order_lines(trade))],
        "All settings": [
            definitions(references),
            folded("table of all settings", table(caption, shown)),
            folded("settings without a solution", definitions(stopped(trade))),
        ],
    }
    lead = f"{len(trade.rows)} settings of beams and solid; {len(stopped(trade))} without a solution."
    title = f"{trade.scene.name}: what accuracy costs"
    parts = [Section(name, "\n".join(markup)) for name, markup in sections.items()]
    return write_page(folder, title, lead, parts, [trade.scene], files)


def _setting(row: Row) -> Line:
    """Return what a setting is, what it cost, and all its errors."""
    case, response = row.case, row.response
    contact = case.scene.contacts[0] if case.scene.contacts and case.found.continuum else None
    return {
        "label": row.label,
        "family": row.family,
        "model": case.model,
        "elements": case.options.elements,
        "mesh": case.options.mesh and "x".join(map(str, case.options.mesh)),
        "integration_tolerance": case.options.integration_tolerance,
        "penalty": contact and contact.penalty,
        "penetration": contact and contact.penetration,
        "load_steps": case.scene.load_parameters,
        "load_parameters_reached": len(response.load_parameter),
        "status": response.status,
        "message": response.message,
        **row.cost(),
        **{
            f"{'own_' * own}error_{scope}_{quantity}": row.error(scope, quantity, own=own)
            for own in (False, True)
            for scope in SCOPES
            for quantity in KEPT
        },
    }


def cheapest_lines(trade: Trade, scope: str) -> tuple[str, list[Line]]:
    """Return a title, and the cheapest settings of one scope as rows for people."""
    titles = {
        "end": f"at the load parameter {trade.reference.end:g}, any number of load steps",
        "path": f"the largest over all {trade.scene.load_parameters} load parameters",
    }
    title = f"cheapest for an error of {SHOWN}, {titles[scope]}"
    return title, [_line(cheapest(trade, scope, SHOWN, target)) for target in TARGETS]


def _line(row: Line) -> Line:
    told = row["limit_uncertainty"] <= row["target"]
    beams, solid, there = TSM.name, SOLID.name, "solid_against_reference"
    return {
        "error": row["target"],
        "TSM": short(row, beams),
        "seconds": row[f"{beams}_seconds"],
        "solid, its own limit": short(row, solid) if told else "not told",
        "its seconds": row[f"{solid}_seconds"],
        "ratio": row["ratio"],
        "solid, the reference": short(row, there),
        "and its seconds": row[f"{there}_seconds"],
        "ratio there": row["ratio_against_reference"],
    }


def order_lines(trade: Trade) -> list[Line]:
    """Return the orders and cost exponents with what they are fitted to as rows for people."""
    return [
        {
            "family": row["family"],
            "order": row["order"],
            "points": row["order_points"],
            "elements": _range(row, "order"),
            "cost exponent": row["cost_exponent"],
            "its points": row["cost_exponent_points"],
            "unknowns": _range(row, "cost_exponent"),
        }
        for row in orders(trade, SHOWN)
    ]


def _range(row: Line, name: str) -> str | None:
    return None if row[name] is None else f"{row[f'{name}_from']:g} to {row[f'{name}_to']:g}"


def stopped(trade: Trade) -> dict[str, str]:
    """Return the settings without a completed and checked solution, and why."""
    return {
        f"{row.label} [{row.case.scene.load_parameters}]": f"{row.response.status}: {row.response.message}"
        for row in trade.rows
        if not row.response.completed
    }


def summary(trade: Trade) -> str:
    """Return what a person reads of a trade-off: references, cheapest settings, orders, and what stopped."""
    limit = trade.limit.sentence if trade.limit else "not known: a solid that it is extrapolated from stopped"
    lines = order_lines(trade)
    reasons = stopped(trade)
    return "\n\n".join(
        [
            f"""{trade.scene.name}: {len(trade.rows)} settings
errors against: {trade.reference.sentence}
the solid's own limit: {limit}
seconds: processor time of one thread from the scene to the checked answer, median of repeats after a warm-up
-: no setting does it; not told: the limit is known less well than that; [n]: n load steps""",
            *(
                f"{title}\n\n{tabulated(rows)}"
                for title, rows in (cheapest_lines(trade, scope) for scope in SCOPES)
            ),
            f"orders of convergence and cost exponents, error of {SHOWN} over the path",
            tabulated(lines) if lines else "no family has three settings",
            "\n".join(
                [
                    f"{len(reasons)} of {len(trade.rows)} settings without a solution:",
                    *(f"  {name}: {reason}" for name, reason in reasons.items()),
                ]
            ),
        ]
    )
