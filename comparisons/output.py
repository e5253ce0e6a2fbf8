"""The numbers of a study or figure as files: CSV for tables, JSON for nested results."""

import csv
import io
import json
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from itertools import zip_longest
from pathlib import Path
from shutil import get_terminal_size
from typing import Any

import numpy as np

from comparisons.files import filled, write_text

Row = dict[str, Any]
"""One line of a study's table."""
Report = Callable[[str], None]
"""Receives one line about the progress."""


_NO_BREAK, _UNIT = "\N{NO-BREAK SPACE}", re.compile(r"(?<=\d) (?=(?:%|k?N|mm?|rad|m?s)(?!\w))")
NO_VALUE = "no value"
"""In place of an infinite error: one of the two that are compared has no value."""


def keys(rows: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return the keys of all rows, each once."""
    return list(dict.fromkeys(key for row in rows for key in row))


def csv_text(rows: Sequence[Mapping[str, Any]], columns: Iterable[str] = ()) -> str:
    """Return rows as CSV with their keys as columns; what is not there, or a number that is not finite, is an empty cell."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(columns) or keys(rows), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: plain(value) for key, value in row.items()} for row in rows)
    return text.getvalue()


def write_rows(path: Path, rows: Sequence[Mapping[str, Any]]) -> Path:
    """Write rows as `csv_text`."""
    write_text(path, csv_text(rows))
    return path


def tabulated(rows: Sequence[Mapping[str, Any]], *, folded: bool = False) -> str:
    """Return rows as aligned text, numbers to the right; columns beyond the width of the terminal follow below, after the first one.

    If `folded`, cells go on below in their columns instead.
    """
    names = keys(rows)
    cells = [names, *([cell(row.get(name)) for name in names] for row in rows)]
    columns = list(zip(*cells, strict=True))
    right = [all(one == NO_VALUE or one[:1] in "-0123456789" for one in column[1:]) for column in columns]
    room = math.inf if folded else get_terminal_size().columns
    widths, parts = [2 + max(map(len, column)) for column in columns], [[0]]
    for k in range(1, len(columns)):
        if len(parts[-1]) > 1 and sum(widths[j] for j in (*parts[-1], k)) - 2 > room:
            parts.append([0])
        parts[-1].append(k)
    tables = (aligned([[row[k] for k in ks] for row in cells], [right[k] for k in ks]) for ks in parts)
    return "\n\n".join(map("\n".join, tables))


def aligned(rows: Sequence[Sequence[str]], right: Sequence[bool], indent: int = 0) -> list[str]:
    """Return rows of cells as lines with columns of equal width, to the left or to the `right`.

    As few cells as can be go on below, so that lines fit the terminal behind an indentation; no word is broken, and no number from its unit.
    """
    columns = list(zip(*rows, strict=True))
    widths = [max(map(len, column)) for column in columns]
    whole = (
        [head.split(), *([cell] if one else _joined(cell).split(" ") for cell in rest)]
        for (head, *rest), one in zip(columns, right, strict=True)
    )
    words = [max(len(word) for cell in column for word in cell or [""]) for column in whole]
    while sum(widths) + 2 * len(widths) - 2 > get_terminal_size().columns - indent:
        folded = {
            (sum(len(cell) >= width for cell in columns[k]), -width): k
            for k, width in enumerate(widths)
            if width > words[k]
        }
        if not folded:
            break
        widths[folded[min(folded)]] -= 1
    sides = [str.rjust if one else str.ljust for one in right]
    lines = []
    for row in rows:
        cells = (
            filled(_joined(text), width=width) if len(text) > width else [text]
            for text, width in zip(row, widths, strict=True)
        )
        for line in zip_longest(*cells, fillvalue=""):
            parts = zip(sides, line, widths, strict=True)
            text = "  ".join(side(text, width) for side, text, width in parts).rstrip()
            lines.append(text.replace(_NO_BREAK, " "))
    return lines


def _joined(text: str) -> str:
    """Text whose numbers do not part from their units when it is folded."""
    return _UNIT.sub(_NO_BREAK, text)


def markdown(rows: Sequence[Mapping[str, str]]) -> str:
    """Return rows of equal keys as a table in Markdown."""
    cells = [list(rows[0]), *(row.values() for row in rows)]
    lines = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in cells]
    return "".join([lines[0], "|" + "---|" * len(rows[0]) + "\n", *lines[1:]])


def cell(value: Any) -> str:
    """Return a value as text: a number in three digits, what is not there as a dash."""
    if not isinstance(value, float):
        return "-" if value is None else str(value)
    return "-" if math.isnan(value) else NO_VALUE if math.isinf(value) else f"{value:.3g}"


def json_text(value: Any) -> str:
    """Return nested numbers as JSON text: one key a line, and a list or a table of numbers on one line; a number that is not finite is null."""
    return "".join(_lines(plain(value), "\n")) + "\n"


def _lines(value: Any, line: str) -> Iterator[str]:
    """Yield the parts of the text of JSON's own types; `line` ends a line and indents the next one."""
    if not value or not isinstance(value, dict | list) or _flat(value):
        yield json.dumps(value, allow_nan=False)  # without indentation this is several times faster
        return
    begin, end = "{}" if isinstance(value, dict) else "[]"
    for key, item in value.items() if isinstance(value, dict) else enumerate(value):
        yield f"{begin}{line} " + (f"{json.dumps(key)}: " if end == "}" else "")
        yield from _lines(item, f"{line} ")
        begin = ","
    yield line + end


def _flat(value: Any) -> bool:
    """Whether `value` is a list of values, or of rows of values."""
    if not isinstance(value, list):
        return False
    rows = value if all(isinstance(item, list) for item in value) else [value]
    return not any(isinstance(item, dict | list) for row in rows for item in row)


def plain(value: Any) -> Any:
    """Return `value` in JSON's own types: records as tables, arrays and tuples as lists."""
    if isinstance(value, np.ndarray):
        return _listed(value)
    if isinstance(value, np.generic):
        return plain(value.tolist())
    if is_dataclass(value):
        return {item.name: plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _listed(array: np.ndarray) -> Any:
    """Return an array as nested lists; one without infinite values and nan needs no look at every number."""
    if array.dtype.kind != "f":
        return plain(array.tolist())
    finite = np.isfinite(array)
    if not finite.all():
        array = array.astype(object)
        array[~finite] = None
    return array.tolist()
