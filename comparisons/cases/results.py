"""Contents of a sweep's results file, as records and as a table."""

import sqlite3
import zlib
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from comparisons.cases.measure import Measurement
from comparisons.cases.schema import database_errors, open_for_reading
from comparisons.cases.settings import in_order, settings
from comparisons.files import OutputError
from comparisons.output import Row, tabulated
from comparisons.response import Array, Response

DETAILS = ("moment:", "tip_x:", "tip_y:")
"""Columns that a table for a reader leaves out."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Result:
    """One recorded case.

    Parameters
    ----------
    key : str
        `Case.key`.
    scene, model, label, version : str
        Names of scene, model and case, and the version of this package.
    settings : dict
        The options given and every key of the scene, by the names of study files.
    measurement : Measurement
        Answer and cost.
    """

    key: str
    scene: str
    model: str
    label: str
    version: str
    settings: dict[str, object]
    measurement: Measurement


def read_results(path: Path) -> list[Result]:
    """Return the results in the file `path`, sorted by scene, model and varied settings. Other processes may write the file meanwhile.

    Raises
    ------
    OutputError
        If there is no such file, or it is something else, or damaged.
    """
    with closing(open_for_reading(path)) as connection, database_errors(path, "cannot be read"):
        rows = connection.execute("SELECT * FROM result").fetchall()
    found = [_result(path, row) for row in rows]
    names = varied(found)
    return sorted(
        found,
        key=lambda result: (
            result.scene,
            result.model,
            in_order(result.settings.get(name) for name in names),
            result.version,
            result.key,
        ),
    )


def _result(path: Path, row: sqlite3.Row) -> Result:
    try:
        return Result(
            **{name: row[name] for name in ("key", "scene", "model", "label", "version")},
            settings=settings(row["definition"], row["options"]),
            measurement=Measurement.from_json(zlib.decompress(row["measurement"]).decode()),
        )
    except (zlib.error, ValueError, LookupError, TypeError, AttributeError):
        case = ascii(f"{row['scene']}, {row['label']}")
        raise OutputError(f"{path}: cannot be read: the result of {case} is damaged") from None


def varied(results: list[Result]) -> list[str]:
    """Return the settings that differ between results of the same scene, a model's options first."""
    names: set[str] = set()
    for scene in {result.scene for result in results}:
        tables = [result.settings for result in results if result.scene == scene]
        known = {name for table in tables for name in table}
        names |= {name for name in known if len({repr(table.get(name)) for table in tables}) > 1}
    return sorted(names, key=lambda name: ("." in name, name))


def result_rows(results: list[Result], *, timings: bool = True) -> list[Row]:
    """Return one table row for each of `results`, with settings, status, last state reached and cost.

    The columns of answers are ``force:PAIR``, ``arc_position:PAIR``, ``moment:BEAM``, ``tip_x:BEAM`` and ``tip_y:BEAM``. Without
    `timings` seconds and memory, which differ from run to run, are left out.
    """
    names = varied(results)
    answers = [_answers(result.measurement.response) for result in results]
    columns = list(dict.fromkeys(name for answer in answers for name in answer))
    rows = []
    for result, answer in zip(results, answers, strict=True):
        measurement = result.measurement
        row: Row = {
            "scene": result.scene,
            "model": result.model,
            **{name: _text(result.settings.get(name)) for name in names},
            "status": measurement.response.status,
            "verdict": measurement.verdict,
            **{name: answer.get(name) for name in columns},
            "iterations": measurement.response.iterations,
            "cutbacks": measurement.response.cutbacks,
            "unknowns": measurement.response.unknowns,
        }
        if timings:
            row |= {
                "seconds": measurement.seconds,
                "repeats": measurement.repeats,
                "peak_memory": measurement.peak_memory,
            }
        rows.append({**row, "version": result.version, "message": measurement.response.message})
    return rows


def result_table(results: list[Result], *, timings: bool = True) -> str:
    """Return a table for a reader, with the reasons of the stopped cases below it."""
    if not results:
        return "no results yet"
    hidden = {"load_parameter", "cutbacks", "repeats", "message"}
    hidden |= {"scene"} if len({result.scene for result in results}) == 1 else set()
    versions = sorted({result.version for result in results})
    hidden |= {"version"} if len(versions) == 1 else set()
    rows = [
        {name: value for name, value in row.items() if name not in hidden and not name.startswith(DETAILS)}
        for row in result_rows(results, timings=timings)
    ]
    stopped = [
        f"{result.scene}, {result.label}: {result.measurement.response.status}: {result.measurement.response.message}"
        for result in results
        if not result.measurement.response.completed
    ]
    return "\n".join(
        [tabulated(rows), f"\nversion {', '.join(versions)}", *([""] if stopped else []), *stopped]
    )


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
