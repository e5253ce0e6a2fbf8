"""The page of a trade-off."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from comparisons.cost.points import COSTS, Trade
from comparisons.cost.tables import cheapest_lines, order_lines, setting_rows
from comparisons.output import Row
from comparisons.quantities import KEPT, SCOPES
from comparisons.show.pages import Section, definitions, folded, picture, provenance, table, write_page

SETTING = (
    "label", "load_steps", "status", "unknowns", "iterations", "seconds", "own_error_end_force", "own_error_path_force",
    "error_path_force",
)  # fmt: skip
"""Columns of the table of all settings; ``trade.csv`` has all."""


def write_trade_page(
    trade: Trade, fitted: Sequence[Row], quantity: str, files: Sequence[Path], folder: Path
) -> Path:
    """Write ``report.html`` to `folder`, with what is in `files` there; return its path.

    Parameters
    ----------
    fitted : sequence of dict
        Orders of convergence and cost exponents of `quantity`.
    quantity : str
        Quantity to show, a name in `comparisons.quantities.KEPT`.
    """
    assert quantity in KEPT, "only what was measured can be shown"
    name = quantity.replace("_", " ")
    sections = [
        Section(
            title="Cheapest settings", html="\n".join(_cheapest(trade, quantity, scope) for scope in SCOPES)
        ),
        Section(title="Work and precision", html="\n".join(_diagrams(name, folder))),
        Section(
            title="Orders of convergence", html=_rows(f"error of {name} over the path", order_lines(fitted))
        ),
        Section(title="All settings", html=_settings(trade)),
    ]
    sections += provenance([trade.scene], files, folder)
    lead = f"{len(trade.points)} settings of beams and solid; {len(trade.stopped)} without a solution."
    return write_page(folder, f"{trade.scene.name}: what accuracy costs", lead, sections)


def _cheapest(trade: Trade, quantity: str, scope: str) -> str:
    title, rows = cheapest_lines(trade, quantity, scope)
    return _rows(title, rows)


def _rows(caption: str, rows: Sequence[Mapping[str, object]]) -> str:
    """Return rows of equal keys as a table."""
    return table(caption, list(rows[0]), (list(row.values()) for row in rows)) if rows else "<p>None.</p>"


def _diagrams(name: str, folder: Path) -> list[str]:
    return [
        picture(folder / f"{scope}-{cost}.svg", f"Error of {name}, {title}, against {cost}.")
        for scope, title in zip(SCOPES, ("at the end", "largest over the path"), strict=True)
        for cost in COSTS
    ]


def _settings(trade: Trade) -> str:
    rows = [{name.replace("_", " "): row[name] for name in SETTING} for row in setting_rows(trade)]
    references = {"errors against": trade.reference.sentence}
    if trade.limit is not None:
        references["own errors of the solid against"] = trade.limit.sentence
    stopped = {
        f"{point.case.label} [{point.case.scene.load_parameters}]": f"{point.measured.response.status}: {point.measured.response.message}"
        for point in trade.stopped
    }
    caption = "Seconds: processor time of one thread from the scene to the checked answer, median of repeats."
    return "\n".join(
        (
            definitions(references),
            folded("table of all settings", _rows(caption, rows)),
            folded("settings without a solution", definitions(stopped)),
        )
    )
