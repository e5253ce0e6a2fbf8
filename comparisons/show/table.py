"""The table of a comparison: one row per run."""

from collections.abc import Sequence

import numpy as np

from comparisons.cases import Row
from comparisons.output import aligned, csv_text
from comparisons.quantities import SCOPES, names, table_columns


def table_text(rows: Sequence[Row], reference: str) -> str:
    """Return the table as aligned text; errors are the largest over all load parameters."""
    head = header()
    first, *rest = aligned([head, *map(cells, rows)], [False] + [True] * (len(head) - 1))
    title = (
        f"Largest error over the load parameters reached, against the {reference}; forces and moments relative to their\n"
        "largest, positions to the length, friction to the contact forces; Newton iterations and seconds for the whole path"
    )
    return "\n".join([title, "", first, "-" * len(first), *rest])


def header() -> tuple[str, ...]:
    """Return the names of the columns, the quantities that have one in the middle."""
    middle = (row.words for row in table_columns().values())
    return "model", "unknowns", *middle, "stable", "iterations", "seconds"


def cells(row: Row) -> tuple[str, ...]:
    """Return a run as text under `header`."""
    # a dash where the run or the scene does not have the quantity
    errors = [np.nan if row.errors is None else row.errors["path"][name] for name in table_columns()]
    shown = ["-" if np.isnan(value) else f"{value:.1e}" for value in errors]
    response = row.response
    label = row.label if response.completed else f"{row.label} ({response.status})"
    iterations, seconds = str(response.iterations), f"{response.wall_seconds:.3f}"
    return label, str(response.unknowns), *shown, row.stable, iterations, seconds


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
