"""The results of a sweep as a table."""

from collections.abc import Collection, Mapping

import numpy as np

from comparisons.cases.measure import Measurement
from comparisons.cases.run import COMPLETED, Results
from comparisons.cases.settings import settings
from comparisons.output import Row, tabulated
from comparisons.response import Array, Response
from comparisons.version import version

DETAILS = ("moment:", "tip_x:", "tip_y:")
"""Columns that a table for a reader leaves out, by their beginnings."""
HIDDEN = {"label", "load_parameter", "cutbacks", "seconds", "repeats", "peak_memory", "version", "message"}
"""Columns that a table for a reader leaves out; without times it is the same in every run."""


def result_rows(results: Results) -> list[Row]:
    """Return a row for each result, with settings that differ, status, last state reached and cost.

    The columns of answers are ``force:PAIR``, ``arc_position:PAIR``, ``moment:BEAM``, ``tip_x:BEAM`` and ``tip_y:BEAM``.
    """
    stated = {case: settings(case) for case in results}
    names = _varied(stated.values())
    answers = {case: _answers(found.response) for case, found in results.items()}
    columns = list(dict.fromkeys(name for answer in answers.values() for name in answer))
    return [
        {
            "scene": case.scene.name,
            "model": case.found.name,
            "label": case.label,
            **{name: _text(stated[case].get(name)) for name in names},
            "status": results[case].response.status,
            "verdict": results[case].verdict,
            **{name: answers[case].get(name) for name in columns},
            **_cost(results[case]),
            "version": version(),
            "message": results[case].response.message,
        }
        for case in results
    ]


def result_table(rows: list[Row]) -> str:
    """Return `result_rows` as a table for a reader, with the reasons of the stopped cases below it."""
    hidden = HIDDEN | ({"scene"} if len({row["scene"] for row in rows}) == 1 else set())
    shown = [
        {name: row[name] for name in row if name not in hidden and not name.startswith(DETAILS)}
        for row in rows
    ]
    stopped = [
        f"{row['scene']}, {row['label']}: {row['status']}: {row['message']}"
        for row in rows
        if row["status"] != COMPLETED
    ]
    return "\n".join([tabulated(shown), f"\nversion {version()}", *([""] if stopped else []), *stopped])


def _varied(tables: Collection[Mapping[str, object]]) -> list[str]:
    """Return the settings that differ between cases, a model's options first."""
    known = {name for table in tables for name in table}
    differ = (name for name in known if len({repr(table.get(name)) for table in tables}) > 1)
    return sorted(differ, key=lambda name: ("." in name, name))


def _cost(found: Measurement) -> Row:
    own = {name: getattr(found.response, name) for name in ("iterations", "cutbacks", "unknowns")}
    return own | {name: getattr(found, name) for name in ("seconds", "repeats", "peak_memory")}


def _answers(response: Response) -> dict[str, float]:
    """Return the last state reached."""
    if not len(response.load_parameter):
        return {}
    tables: dict[str, dict[str, Array]] = {
        "force": {pair: contact.force for pair, contact in response.contacts.items()},
        "arc_position": {pair: contact.arc_position for pair, contact in response.contacts.items()},
        "moment": {node: support.moment for node, support in response.supports.items()},
        "tip_x": {beam: tip[:, 0] for beam, tip in response.tips.items()},
        "tip_y": {beam: tip[:, 1] for beam, tip in response.tips.items()},
    }
    last = {f"{name}:{of}": values[-1] for name, table in tables.items() for of, values in table.items()}
    return {"load_parameter": float(response.load_parameter[-1])} | {
        name: float(value) for name, value in last.items() if np.isfinite(value)
    }


def _text(value: object) -> object:
    """Return a setting for one cell: ``50x2`` for a mesh, the other lists as text."""
    if not isinstance(value, list):
        return value
    whole = all(isinstance(item, int) for item in value)
    return ("x" if whole else " ").join(str(item) for item in value)
