"""The files of a trade-off: tables, diagrams, numbers, and a page with all of them."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from comparisons.output import write_numbers, write_rows
from comparisons.quantities import KEPT, SCOPES
from comparisons.scene import to_toml
from comparisons.show.pages import Section, definitions, folded, picture, provenance, write_page
from comparisons.show.work import rows_table
from comparisons.trade.plots import plot_work
from comparisons.trade.tables import (
    SHOWN,
    Table,
    cheapest_lines,
    cheapest_rows,
    front_rows,
    order_lines,
    order_rows,
    setting_rows,
    stopped,
)
from comparisons.trade.trade import COSTS, Trade

SETTING = (
    "label", "load_steps", "status", "unknowns", "iterations", "seconds", "own_error_end_force", "own_error_path_force",
    "error_path_force",
)  # fmt: skip
"""Columns of the table of all settings; ``trade.csv`` has all."""


def write_trade(trade: Trade, folder: Path) -> list[Path]:
    """Write the tables, the diagrams and the page; return the files."""
    settings, cheap, fitted = setting_rows(trade), cheapest_rows(trade), order_rows(trade)
    references = {"error": trade.reference, "own_error of the solid": trade.limit}
    numbers: dict[str, Any] = {
        "scene": trade.scene.name,
        "scene_file": to_toml(trade.scene),
        "references": {
            name: known and {"is": known.sentence, "end": known.end, "uncertainty": known.uncertainty}
            for name, known in references.items()
        },
        "cheapest": cheap,
        "orders": {
            name: [_without(row, "quantity") for row in fitted if row["quantity"] == name] for name in KEPT
        },
        "pareto": front_rows(trade),
    }
    tables = {"trade.csv": settings, "cheapest.csv": cheap, "orders.csv": fitted}
    files = [write_rows(folder / name, rows) for name, rows in tables.items() if rows]
    files.append(write_numbers(folder / "trade.json", numbers))
    for scope in SCOPES:
        for cost in COSTS:
            files += plot_work(trade, scope, cost, folder)
    return [_write_page(trade, settings, files, folder), *files]


def _without(row: dict[str, Any], key: str) -> dict[str, Any]:
    return {name: value for name, value in row.items() if name != key}


def _write_page(trade: Trade, settings: Table, files: Sequence[Path], folder: Path) -> Path:
    references = {"errors against": trade.reference.sentence}
    if trade.limit is not None:
        references["own errors of the solid against"] = trade.limit.sentence
    shown = [{name.replace("_", " "): row[name] for name in SETTING} for row in settings]
    caption = "Seconds: processor time of one thread from the scene to the checked answer, median of repeats."
    parts = {
        "Cheapest settings": [rows_table(*cheapest_lines(trade, scope)) for scope in SCOPES],
        "Work and precision": [
            picture(folder / f"{scope}-{cost}.svg", f"Error of {SHOWN}, {title}, against {cost}.")
            for scope, title in zip(SCOPES, ("at the end", "largest over the path"), strict=True)
            for cost in COSTS
        ],
        "Orders of convergence": [rows_table(f"error of {SHOWN} over the path", order_lines(trade))],
        "All settings": [
            definitions(references),
            folded("table of all settings", rows_table(caption, shown)),
            folded("settings without a solution", definitions(stopped(trade))),
        ],
    }
    sections = [Section(title=title, html="\n".join(html)) for title, html in parts.items()]
    sections += provenance([trade.scene], files, folder)
    lead = f"{len(trade.rows)} settings of beams and solid; {len(trade.stopped)} without a solution."
    return write_page(folder, f"{trade.scene.name}: what accuracy costs", lead, sections)
