"""Studies: a scene and what is varied in it, as a TOML file, and the table of what is found."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import fields
from functools import partial
from itertools import product
from math import isclose, prod
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.answer.table import table
from comparisons.frozen import Frozen
from comparisons.models import TSM, find
from comparisons.models.model import BRANCHES, ModelError, Options
from comparisons.output import keys, tabulated
from comparisons.scene import Scene, built_in_scenes, load_scene, rules
from comparisons.scene.read import LISTS
from comparisons.scene.rules import FieldError, RecordError, Rule
from comparisons.scene.tables import (
    check_keys,
    check_tables,
    head_values,
    read_tables,
    read_text,
    refuse,
    table_values,
)
from comparisons.suite import settings
from comparisons.suite.case import Case
from comparisons.suite.measure import Row
from comparisons.version import version

Axes = dict[str, tuple[object, ...]]
"""The values of every setting that a run varies."""

LARGEST, LARGEST_COUNT = 100_000, 10_000
"""Cases of a study, and values of a range."""
ANSWERED = ("load_parameter", "force", "arc_position", "moment", "tip_x", "tip_y")
"""Quantities whose values at the end are columns."""
DETAILS = ("moment:", "tip_x:", "tip_y:")
"""Columns that a table for a reader leaves out, by their beginnings."""
HIDDEN = {
    "family", "label", "outcome", "load_parameter", "load_parameters_reached", "cutbacks", "seconds", "repeats", "peak_memory",
    "process_seconds", "version", "message",
}  # fmt: skip
"""Columns that a table for a reader leaves out; without times it is the same in every run."""
RANGE: dict[str, Rule] = {
    "from": rules.number,
    "to": rules.number,
    "count": rules.whole(LARGEST_COUNT),
    "spacing": rules.choice("linear", "log"),
}
"""The keys of a range with the rules of their values."""


class Study(Frozen):
    """A sweep: its cases, each once, in the order of the file, and the number of runs timed for each."""

    name: str
    repeats: int
    cases: tuple[Case, ...]


def read_study(path: Path) -> Study:
    """Return the study that the TOML file `path` states.

    The cases of a table ``[[run]]`` are all combinations of its values, the first key varying slowest. An `InputError`
    has all mistakes in the order of the file, each in one line: file, key, value and rule.
    """
    source = str(path)
    tables = read_tables(read_text(source), source)
    head_rules: dict[str, Rule] = {"name": rules.name, "scene": rules.text, "repeats": rules.whole_number}
    head, mistakes = head_values(tables, "study", head_rules, required=("name", "scene"))
    mistakes += check_keys(tables, ("study", "run"), required=("study", "run"))
    wrong, cases = list(check_tables(tables, "run")), list[Case]()
    mistakes += wrong
    if "scene" in head and not wrong:
        name = head["scene"] if head["scene"] in built_in_scenes() else str(path.parent / head["scene"])
        cases = _cases(load_scene(name), tables.get("run", []), path.parent, mistakes)
    refuse(source, mistakes, tables)
    return Study(name=head["name"], repeats=head.get("repeats", 3), cases=tuple(dict.fromkeys(cases)))


def _cases(scene: Scene, runs: list[dict[str, Any]], folder: Path, mistakes: list[FieldError]) -> list[Case]:
    """Return the cases of the runs; what is wrong is added to `mistakes`."""
    cases, total = list[Case](), 0
    for i, run in enumerate(runs):
        wrong = list[FieldError]()
        axes = _axes(run, wrong)
        total += prod(map(len, axes.values()))
        if total > LARGEST:
            mistakes.append(FieldError("run", total, f"must be at most {LARGEST} cases"))
            return []
        for chosen in () if wrong else product(*axes.values()):
            try:
                cases.append(_case(scene, dict(zip(axes, chosen, strict=True)), folder))
            except FieldError as error:
                wrong += error.mistakes
        mistakes += (item.within(f"run[{i}].") for item in wrong)
    return cases


def _axes(run: dict[str, Any], mistakes: list[FieldError], place: str = "") -> Axes:
    """Return what a run, or a table in it, varies: the values of every setting by its place."""
    axes: Axes = {}
    for key, given in run.items():
        at = f"{place}{key}"
        if isinstance(given, dict) and not RANGE.keys() & given.keys():
            axes |= _axes(given, mistakes, f"{at}.")
            continue
        try:
            axes[at] = values(at, given)
        except FieldError as error:
            mistakes += error.mistakes
    return axes


def _known(value: object, find_it: Callable[[str], str]) -> str:
    """Return the name of what is found by its name."""
    try:
        return find_it(rules.text(value))
    except ModelError as error:
        raise FieldError("", value, str(error).partition(": ")[2]) from None


def _model(name: str, folder: Path) -> str:
    """Return a model's name, of a program file ``NAME.toml`` in `folder` its path."""
    name = str((folder / name).resolve()) if name.endswith(".toml") else name
    find(name)
    return name


OPTION_RULES: dict[str, Rule] = {
    "elements": rules.whole_number,
    "element": partial(_known, find_it=lambda name: TSM.element(Options(element=name)).name),
    "integration_tolerance": rules.fraction,
    "mesh": rules.mesh_text,
    "branch": rules.choice(*BRANCHES),
}
"""What the options of a case must obey."""
assert OPTION_RULES.keys() == {item.name for item in fields(Options)}


def _case(scene: Scene, chosen: dict[str, object], folder: Path) -> Case:
    """Return the case of the chosen settings; raise all mistakes in them."""
    given = {key: value for key, value in chosen.items() if "." not in key}
    rules_of: dict[str, Rule] = {
        "model": partial(_known, find_it=partial(_model, folder=folder)),
        **OPTION_RULES,
    }
    own, mistakes = table_values(given, rules_of, ("model",))
    if "model" in own:
        model = find(own["model"])
        none = f'is no option of model = "{model.name}"'
        mistakes += (FieldError(key, given[key], none) for key in own.keys() - {"model", *model.options})
    changes = {key: value for key, value in chosen.items() if "." in key}
    for place, value in changes.items():
        kind, *_, key = place.split(".")
        if kind in LISTS and not getattr(scene, f"{kind}s"):
            mistakes.append(FieldError(kind, {key: value}, f"the scene has no {kind}"))
    try:
        scene = settings.changed(scene, changes)
    except FieldError as error:
        mistakes += error.mistakes
    if mistakes:
        raise RecordError(mistakes)
    return Case(scene=scene, model=own.pop("model"), options=Options(**own))


def values(key: str, given: object) -> tuple[object, ...]:
    """Return the values that `given` states for `key`: itself, the items of a list, or a range.

    A range has both ends; ``"linear"`` is the default spacing. Between whole ends, a value that is whole but for round-off is made so.

    >>> values("elements", {"from": 5, "to": 40, "count": 4, "spacing": "log"})
    (5, 10, 20, 40)
    """
    if isinstance(given, dict):
        try:
            return _range(given)
        except FieldError as error:
            raise error.within(f"{key}.") from None
    if given == []:
        raise FieldError(key, given, "must not be empty")
    return tuple(given) if isinstance(given, list) else (given,)


def _range(given: dict[str, Any]) -> tuple[float, ...]:
    mistakes = table_values(given, RANGE, required=("from", "to", "count"))[1]
    if mistakes:
        raise RecordError(mistakes)
    first, last, count = given["from"], given["to"], given["count"]
    logarithmic = given.get("spacing") == "log"
    if count < 2:
        raise FieldError("count", count, "must be at least 2, a range has two ends")
    if first == last:
        raise FieldError("to", last, "must differ from the range's start")
    for name in ("from", "to"):
        if logarithmic and given[name] <= 0:
            raise FieldError(name, given[name], 'must be positive in a range of spacing = "log"')

    found = (np.geomspace if logarithmic else np.linspace)(first, last, count).tolist()
    whole = isinstance(first, int) and isinstance(last, int)
    return tuple(
        round(value) if whole and isclose(value, round(value), rel_tol=1e-12) else value for value in found
    )


def result_rows(rows: Collection[Row]) -> list[dict[str, Any]]:
    """Return a line for each row: settings that differ, how it ended, last state reached, cost, and errors."""
    stated, known = [settings.settings(row.case) for row in rows], [row.columns() for row in rows]
    answers = [_answers(row.response) for row in rows]
    varied, found = _varied(stated), keys(answers)
    return [
        {
            **{name: line[name] for name in ("scene", "model", "label")},
            **{name: _text(own.get(name)) for name in varied},
            **{name: line[name] for name in ("status", "verdict")},
            **{name: answer.get(name) for name in found},
            **line,
            "version": version(),
        }
        for line, own, answer in zip(known, stated, answers, strict=True)
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
    differ = (name for name in keys(tables) if len({repr(table.get(name)) for table in tables}) > 1)
    return sorted(differ, key=lambda name: ("." in name, name))


def _answers(response: Response) -> dict[str, float]:
    """Return the last state reached."""
    told = {}
    for name, values in table(response, along=False).items():
        of, _, what = name.rpartition(".")
        if what in ANSWERED and np.isfinite(values[-1:]).any():
            told[f"{what}:{of}".rstrip(":")] = float(values[-1])
    return told


def _text(value: object) -> object:
    """Return a setting for one cell: ``50x2`` for a mesh, the other lists as text."""
    if not isinstance(value, list):
        return value
    whole = all(isinstance(item, int) for item in value)
    return ("x" if whole else " ").join(map(str, value))
