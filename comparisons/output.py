"""The numbers of a study or figure as files: CSV for tables, JSON for nested results."""

import csv
import io
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.files import write_text
from comparisons.version import versions

Row = dict[str, Any]
"""One line of a study's table."""
Report = Callable[[str], None]
"""Receives one line about the progress."""


def csv_text(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return rows of equal keys as CSV; a number that is not finite is an empty cell."""
    text = io.StringIO()
    writer = csv.DictWriter(text, rows[0], lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: plain(value) for key, value in row.items()} for row in rows)
    return text.getvalue()


def write_rows(path: Path, rows: Sequence[Mapping[str, Any]]) -> Path:
    """Write rows as `csv_text`."""
    write_text(path, csv_text(rows))
    return path


def tabulated(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return rows of equal keys as aligned text: numbers with three digits, a dash for a missing value."""
    cells = [list(rows[0]), *([_cell(value) for value in row.values()] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return "\n".join(
        "  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip()
        for line in cells
    )


def _cell(value: Any) -> str:
    return "-" if value is None else f"{value:.3g}" if isinstance(value, float) else str(value)


def write_numbers(path: Path, numbers: Mapping[str, Any]) -> Path:
    """Write nested numbers with the versions behind them as JSON; a number that is not finite is null."""
    write_text(path, json.dumps(plain({**numbers, "versions": versions()}), allow_nan=False, indent=1) + "\n")
    return path


def plain(value: Any) -> Any:
    """Return `value` in JSON's own types: records as tables, arrays and tuples as lists."""
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if is_dataclass(value):
        return {item.name: plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
