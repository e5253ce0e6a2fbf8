"""The table of a comparison: one row per run."""

from collections.abc import Sequence

import numpy as np

from comparisons.answer.quantities import SCOPES, names, table_columns
from comparisons.output import NO_VALUE, csv_text
from comparisons.suite import Row


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


def table_csv(rows: Sequence[Row]) -> str:
    """Return the table as CSV text: errors over all load parameters and at the last, empty for the reference."""
    records = []
    for row in rows:
        response, errors = row.response, row.errors
        found = {
            f"error_{scope}_{name}": errors and errors[scope].get(name)
            for scope in SCOPES
            for name in names(mesh=False)
        }
        first = {"label": row.label, "model": response.model, "status": response.status}
        spent = {"newton_iterations": response.iterations, "cutbacks": response.cutbacks}
        last = {"stable": row.stable, **spent, "wall_seconds": response.wall_seconds}
        records.append({**first, "unknowns": response.unknowns, **found, **last})
    return csv_text(records)
