"""The table of a comparison: one row per run."""

from collections.abc import Sequence

import numpy as np

from comparisons.cases import Row
from comparisons.output import aligned, csv_text
from comparisons.quantities import SCOPES, names, table_columns
from comparisons.response import Response


def table_text(rows: Sequence[Row], reference: str) -> str:
    """Return the table as aligned text; errors are the largest over all load parameters."""
    lines = [cells(row) for row in rows]
    texts = [list(lines[0]), *(list(line.values()) for line in lines)]
    first, *rest = aligned(texts, [False] + [True] * (len(texts[0]) - 1))
    title = (
        f"Largest error over the load parameters reached, against the {reference}; forces and moments relative to their\n"
        "largest, positions to the length, friction to the contact forces; Newton iterations and seconds for the whole path"
    )
    return "\n".join([title, "", first, "-" * len(first), *rest])


def cells(row: Row) -> dict[str, str]:
    """Return a run as text by column, a dash where the run or the scene does not have the quantity."""
    response, errors = row.response, {}
    for name, quantity in table_columns().items():
        error = row.error("path", name)
        errors[quantity.words] = "-" if np.isnan(error) else f"{error:.1e}"
    return {
        "model": row.label if response.completed else f"{row.label} ({response.status})",
        "unknowns": str(response.unknowns),
        **errors,
        "stable": stable(response),
        "iterations": str(response.iterations),
        "seconds": f"{response.wall_seconds:.3f}",
    }


def stable(response: Response) -> str:
    """Return yes, no, a dash where the model states no index, or that it states one at a part of the load parameters."""
    index = response.index
    if index is None or not np.any(index >= 0):
        return "-"
    return "no" if np.any(index > 0) else "yes" if np.all(index >= 0) else "in part"


def table_csv(rows: Sequence[Row]) -> str:
    """Return the table as CSV text: errors over all load parameters and at the last, empty for the reference."""
    records = []
    for row in rows:
        response = row.response
        found = {
            f"error_{scope}_{name}": row.error(scope, name) for scope in SCOPES for name in names(mesh=False)
        }
        first = {"label": row.label, "model": response.model, "status": response.status}
        spent = {"newton_iterations": response.iterations, "cutbacks": response.cutbacks}
        last = {"stable": stable(response), **spent, "wall_seconds": response.wall_seconds}
        records.append({**first, "unknowns": response.unknowns, **found, **last})
    return csv_text(records)
