"""The table of a comparison: one row per run."""

from collections.abc import Sequence

import numpy as np

from comparisons.cases import Row
from comparisons.output import aligned, csv_text
from comparisons.quantities import KEPT, PATH, SCOPES
from comparisons.response import Response

SHOWN = ("force", "arc", "moment", "tip", "friction")
"""The quantities of the table for people."""


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
    response = row.response
    errors = {name: row.error("path", name) for name in SHOWN}
    shown = {name: "-" if np.isnan(error) else f"{error:.1e}" for name, error in errors.items()}
    return {
        "model": row.label if response.completed else f"{row.label} ({response.status})",
        "unknowns": str(response.unknowns),
        **{name.replace("arc", "arc position"): text for name, text in shown.items()},
        "stable": stable(response),
        "iterations": str(response.iterations),
        "seconds": f"{response.wall_seconds:.3f}",
    }


def stable(response: Response) -> str:
    """Return yes, no, a dash where the model states no index, or that it states one at a part of the load parameters."""
    if response.index is None or not np.any(response.index >= 0):
        return "-"
    if np.any(response.index > 0):
        return "no"
    return "yes" if np.all(response.index >= 0) else "in part"


def table_csv(rows: Sequence[Row]) -> str:
    """Return the table as CSV text: errors over all load parameters and at the last, empty for the reference."""
    return csv_text(
        [
            {
                "label": row.label,
                "model": row.response.model,
                "status": row.response.status,
                "unknowns": row.response.unknowns,
                **{
                    f"error_{scope}_{name}": row.error(scope, name)
                    for scope in SCOPES
                    for name in (*KEPT, *PATH)
                },
                "stable": stable(row.response),
                "newton_iterations": row.response.iterations,
                "cutbacks": row.response.cutbacks,
                "wall_seconds": row.response.wall_seconds,
            }
            for row in rows
        ]
    )
