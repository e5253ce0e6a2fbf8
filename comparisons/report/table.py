"""The tables of a comparison: one row per run, and the error budget."""

from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer.quantities import table_columns
from comparisons.output import NO_VALUE
from comparisons.report.pages import Section, picture, piece, table
from comparisons.suite import Row
from comparisons.suite.budget import PARTS, STEPS, Budget, budget_rows


def caption(reference: str) -> str:
    """Return what the table shows."""
    return (
        f"Largest error over the load parameters reached, against the {reference}; forces and moments relative to their "
        "largest, positions to the length, friction to the contact forces; Newton iterations and seconds for the whole path"
    )


def line(row: Row) -> dict[str, str]:
    """Return a run for people; a dash stands where the run or the scene does not have a quantity."""
    response = row.response
    errors = {one.words: row.error("path", name) for name, one in table_columns().items()}
    return {
        "model": row.label if response.completed else f"{row.label} ({response.status})",
        "unknowns": str(response.unknowns),
        **{words: _error(value) for words, value in errors.items()},
        "stable": row.stable,
        "iterations": str(response.iterations),
        "seconds": f"{response.wall_seconds:.3f}",
    }


def _error(value: float) -> str:
    return "-" if np.isnan(value) else NO_VALUE if np.isinf(value) else f"{value:.1e}"


def budget_section(budget: Budget, drawn: Path) -> Section:
    """Return the figure `drawn`, the numbers, and what each part measures."""
    rows = [
        {name.replace("_", " "): value for name, value in {**row, **row["parts"]}.items() if name != "parts"}
        for row in budget_rows(budget)
    ]
    caption = "(TSM - solid) / exact rod; parts are measured by themselves, the rest is over the difference"
    numbers = table(caption, rows)
    shown = picture(drawn, "What the difference of TSM and solid is made of.")
    return Section("Error budget", f"{shown}\n{numbers}\n{piece('definitions', PARTS)}")


def budget_numbers(budget: Budget) -> dict[str, Any]:
    """Return the budget's numbers and what each part measures."""
    return {
        "scene": budget.scene,
        "difference": "(q_TSM - q_solid) / q_rod",
        "load_parameters_of_the_runs": STEPS,
        "parts": PARTS,
        "rows": list(budget_rows(budget)),
        "largest_rest_over_total": max(np.nanmax(np.abs(budget.rest(quantity))) for quantity in budget.total),
    }
