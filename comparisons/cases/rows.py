"""The table of a study."""

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from comparisons.cases.measure import Row
from comparisons.cases.settings import settings
from comparisons.output import tabulated
from comparisons.response import Response
from comparisons.version import version

DETAILS = ("moment:", "tip_x:", "tip_y:")
"""Columns that a table for a reader leaves out, by their beginnings."""
HIDDEN = {"label", "load_parameter", "cutbacks", "seconds", "repeats", "peak_memory", "version", "message"}
"""Columns that a table for a reader leaves out; without times it is the same in every run."""


def result_rows(rows: Collection[Row]) -> list[dict[str, Any]]:
    """Return a line for each row: settings that differ, status, last state reached, and cost."""
    stated = [settings(row.case) for row in rows]
    answers = [_answers(row.response) for row in rows]
    varied = _varied(stated)
    columns = list(dict.fromkeys(name for answer in answers for name in answer))
    return [
        {
            "scene": row.case.scene.name,
            "model": row.case.found.name,
            "label": row.label,
            **{name: _text(own.get(name)) for name in varied},
            "status": row.response.status,
            "verdict": row.verdict,
            **{name: answer.get(name) for name in columns},
            **row.cost(),
            "version": version(),
            "message": row.response.message,
        }
        for row, own, answer in zip(rows, stated, answers, strict=True)
    ]


def result_table(rows: list[dict[str, Any]]) -> str:
    """Return `result_rows` as a table for a reader, with the reasons of the stopped cases below it."""
    hidden = HIDDEN | ({"scene"} if len({row["scene"] for row in rows}) == 1 else set())
    names = [name for name in rows[0] if name not in hidden and not name.startswith(DETAILS)]
    shown = tabulated([{name: row[name] for name in names} for row in rows])
    stopped = [
        f"{row['scene']}, {row['label']}: {row['status']}: {row['message']}"
        for row in rows
        if row["status"] != "COMPLETED"
    ]
    return "\n".join([shown, f"\nversion {version()}", *([""] if stopped else []), *stopped])


def _varied(tables: Collection[Mapping[str, object]]) -> list[str]:
    """Return the settings that differ between cases, a model's options first."""
    known = {name for table in tables for name in table}
    differ = (name for name in known if len({repr(table.get(name)) for table in tables}) > 1)
    return sorted(differ, key=lambda name: ("." in name, name))


def _answers(response: Response) -> dict[str, float]:
    """Return the last state reached."""
    if not len(response.load_parameter):
        return {}
    contacts, tips = response.contacts.items(), response.tips.items()
    last = {
        "load_parameter": response.load_parameter[-1],
        **{f"force:{pair}": one.force[-1] for pair, one in contacts},
        **{f"arc_position:{pair}": one.arc_position[-1] for pair, one in contacts},
        **{f"moment:{node}": one.moment[-1] for node, one in response.supports.items()},
        **{f"tip_x:{beam}": tip[-1, 0] for beam, tip in tips},
        **{f"tip_y:{beam}": tip[-1, 1] for beam, tip in tips},
    }
    return {name: float(value) for name, value in last.items() if np.isfinite(value)}


def _text(value: object) -> object:
    """Return a setting for one cell: ``50x2`` for a mesh, the other lists as text."""
    if not isinstance(value, list):
        return value
    whole = all(isinstance(item, int) for item in value)
    return ("x" if whole else " ").join(str(item) for item in value)
