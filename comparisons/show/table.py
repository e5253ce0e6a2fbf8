"""The table of a comparison: one row per run."""

import numpy as np

from comparisons.cases import Row
from comparisons.output import aligned, csv_text
from comparisons.quantities import KEPT, PATH, SCOPES

HEADER = (
    "model",
    "unknowns",
    "force",
    "arc position",
    "moment",
    "tip",
    "friction",
    "stable",
    "iterations",
    "seconds",
)
SHOWN = ("force", "arc", "moment", "tip", "friction")
"""The quantities of the middle columns."""


def table_text(rows: list[Row], reference: str) -> str:
    """Return the table as aligned text; errors are the largest over all load parameters."""
    first, *rest = aligned([HEADER, *map(cells, rows)], [False] + [True] * (len(HEADER) - 1))
    title = (
        f"Largest error over the load parameters reached, against the {reference}; forces and moments relative to their\n"
        "largest, positions to the length, friction to the contact forces; Newton iterations and seconds for the whole path"
    )
    return "\n".join([title, "", first, "-" * len(first), *rest])


def cells(row: Row) -> tuple[str, ...]:
    """Return a run as text under `HEADER`."""
    # a dash where the run or the scene does not have the quantity
    errors = [np.nan if row.errors is None else row.errors["path"][name] for name in SHOWN]
    shown = ["-" if np.isnan(value) else f"{value:.1e}" for value in errors]
    response = row.response
    label = row.label if response.completed else f"{row.label} ({response.status})"
    iterations, seconds = str(response.iterations), f"{response.wall_seconds:.3f}"
    return label, str(response.unknowns), *shown, row.stable, iterations, seconds


def table_csv(rows: list[Row]) -> str:
    """Return the table as CSV text: errors over all load parameters and at the last, empty for the reference."""
    records = [
        {
            "label": row.label,
            "model": row.response.model,
            "status": row.response.status,
            "unknowns": row.response.unknowns,
            **{
                f"error_{scope}_{name}": row.errors and row.errors[scope].get(name)
                for scope in SCOPES
                for name in (*KEPT, *PATH)
            },
            "stable": row.stable,
            "newton_iterations": row.response.iterations,
            "cutbacks": row.response.cutbacks,
            "wall_seconds": row.response.wall_seconds,
        }
        for row in rows
    ]
    return csv_text(records)
