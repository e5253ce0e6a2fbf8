"""The numbers of a figure as files: CSV for rows, JSON for what was found."""

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
from comparisons.statement import versions

Row = dict[str, Any]
"""One line of a study's table."""
Report = Callable[[str], None]
"""Told of progress."""


def write_rows(path: Path, rows: Sequence[Mapping[str, Any]]) -> Path:
    """Write rows of equal keys as CSV; a number that is not finite is an empty cell."""
    text = io.StringIO()
    writer = csv.DictWriter(text, rows[0], lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: plain(value) for key, value in row.items()} for row in rows)
    write_text(path, text.getvalue())
    return path


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
