"""The files of a trade-off: tables, diagrams, numbers, and a page with all of them."""

from collections.abc import Sequence
from itertools import product
from pathlib import Path

from comparisons.output import write_numbers, write_rows
from comparisons.quantities import KEPT, SCOPES
from comparisons.scene import to_toml
from comparisons.show.pages import definitions, folded, picture
from comparisons.show.work import rows_table, write_report
from comparisons.trade.plots import plot_work
from comparisons.trade.tables import (
    SHOWN,
    cheapest_lines,
    cheapest_rows,
    order_lines,
    setting_rows,
    stopped,
)
from comparisons.trade.trade import COSTS, MESHED, Line, Trade, front, orders

SETTING = (
    "label", "load_steps", "status", "unknowns", "iterations", "seconds", "own_error_end_force", "own_error_path_force",
    "error_path_force",
)  # fmt: skip
"""Columns of the table of all settings; ``trade.csv`` has all."""
STATES = {"end": "at the end", "path": "largest over the path"}


def write_trade(trade: Trade, folder: Path) -> list[Path]:
    """Write the tables, the diagrams and the page; return the files, the page first."""
    settings, cheap = setting_rows(trade), cheapest_rows(trade)
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
        "Cheapest settings": [rows_table(*cheapest_lines(trade, scope)) for scope in SCOPES],
        "Work and precision": [
            picture(folder / f"{scope}-{cost}.svg", f"Error of {SHOWN}, {STATES[scope]}, against {cost}.")
            for scope, cost in product(SCOPES, COSTS)
        ],
        "Orders of convergence": [rows_table(f"error of {SHOWN} over the path", order_lines(trade))],
        "All settings": [
            definitions(references),
            folded("table of all settings", rows_table(caption, shown)),
            folded("settings without a solution", definitions(stopped(trade))),
        ],
    }
    lead = f"{len(trade.rows)} settings of beams and solid; {len(trade.stopped)} without a solution."
    title = f"{trade.scene.name}: what accuracy costs"
    return write_report(folder, title, lead, sections, [trade.scene], files)
