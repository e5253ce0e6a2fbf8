"""Study files: a scene, and what is varied in it, as TOML."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

from comparisons.cases import settings
from comparisons.cases.case import Case
from comparisons.cases.ranges import values
from comparisons.models import find
from comparisons.models.options import BRANCHES, ModelError, Options
from comparisons.scene import Scene, built_in_scenes, load_scene, rules
from comparisons.scene.read import LISTS
from comparisons.scene.rules import FieldError, Rule, RuleError
from comparisons.scene.tables import InputError, check_keys, read_tables, read_text

LARGEST = 100_000
"""Cases of a study."""


class StudyError(InputError):
    """A study that cannot be read."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """A sweep: its cases in the order of the file.

    Parameters
    ----------
    name : str
        Letters, digits, ``-`` and ``_``.
    repeats : int
        Runs timed for each case.
    cases : tuple of Case
        Every combination of every run, each once.
    """

    name: str
    repeats: int
    cases: tuple[Case, ...]


def read_study(path: Path) -> Study:
    """Return the study that the TOML file `path` states.

    The table ``[study]`` has ``name``, ``scene`` (a built-in one, or a file beside the study) and ``repeats`` (3). Every table
    ``[[run]]`` has ``model`` (a name, or a program file beside the study), and may have the model's options and any key of the scene's records, each with one value, a list of
    values or a range; its cases are all combinations, the first key varying slowest.

    Raises
    ------
    StudyError, SceneError
        One line: file, key, value and rule. Nothing has been computed.
    """
    source = str(path)
    tables = read_tables(read_text(source, "no such file", StudyError), source, StudyError)
    try:
        head = _head(tables)
    except FieldError as error:
        raise StudyError(source, str(error)) from None
    scene = load_scene(
        head["scene"] if head["scene"] in built_in_scenes() else str(path.parent / head["scene"])
    )
    try:
        cases = tuple(dict.fromkeys(_cases(scene, tables["run"], path.parent)))
    except FieldError as error:
        raise StudyError(source, str(error)) from None
    return Study(name=head["name"], repeats=head["repeats"], cases=cases)


def _head(tables: dict[str, Any]) -> dict[str, Any]:
    check_keys(tables, ("study", "run"), required=("study", "run"))
    if not isinstance(tables["study"], dict):
        raise FieldError("study", tables["study"], "must be a table, [study]")
    runs = tables["run"]
    if not isinstance(runs, list) or not runs or not all(isinstance(run, dict) for run in runs):
        raise FieldError("run", runs, "must be a list of tables, [[run]]")
    checks: dict[str, Rule] = {"name": rules.name, "scene": rules.text, "repeats": rules.whole_number}
    try:
        check_keys(tables["study"], checks, required=("name", "scene"))
        return {"repeats": 3} | {
            key: _checked(key, value, checks[key]) for key, value in tables["study"].items()
        }
    except FieldError as error:
        raise error.within("study.") from None


def _checked(key: str, value: object, rule: Rule) -> Any:
    try:
        return rule(value)
    except RuleError as error:
        raise FieldError(key, value, str(error)) from None


def _cases(scene: Scene, runs: list[dict[str, Any]], folder: Path) -> Iterator[Case]:
    axes: list[dict[settings.Path, tuple[object, ...]]] = []
    for i, run in enumerate(runs):
        try:
            axes.append(dict(_axes(scene, run)))
        except FieldError as error:
            raise error.within(f"run[{i}].") from None
    total = sum(prod(map(len, varied.values())) for varied in axes)
    if total > LARGEST:
        raise FieldError("run", total, f"must be at most {LARGEST} cases")
    for i, varied in enumerate(axes):
        for chosen in product(*varied.values()):
            try:
                yield _case(scene, dict(zip(varied, chosen, strict=True)), folder)
            except FieldError as error:
                raise error.within(f"run[{i}].") from None


def _axes(scene: Scene, run: dict[str, Any]) -> Iterator[tuple[settings.Path, tuple[object, ...]]]:
    """Yield what a run varies: where a setting stands, and its values."""
    check_keys(run, ("model", *OPTION_RULES, "scene", *LISTS), required=("model",))
    for key, given in run.items():
        if key in LISTS or key == "scene":
            yield from _scene_axes(scene, key, given)
        else:
            yield (key,), values(key, given)


def _scene_axes(scene: Scene, kind: str, given: object) -> Iterator[tuple[settings.Path, tuple[object, ...]]]:
    """Yield what a run varies in the records of one kind: of all of them, or of one by its name."""
    if not isinstance(given, dict):
        raise FieldError(kind, given, f"must be followed by a key, {kind}.KEY")
    if kind == "scene":
        known, named = settings.OWN, set[str]()
    else:
        known = {item.name for item in fields(LISTS[kind])}
        named = {settings.record_name(kind, vars(record)) for record in getattr(scene, f"{kind}s")}
        if not named:
            raise FieldError(kind, given, f"the scene has no {kind}")
    try:
        check_keys(given, known | named)
    except FieldError as error:
        raise error.within(f"{kind}.") from None
    for key, value in given.items():
        if key in known:
            yield (kind, key), values(f"{kind}.{key}", value)
        else:
            yield from _named_axes(kind, key, value, known)


def _named_axes(
    kind: str, name: str, given: object, known: set[str]
) -> Iterator[tuple[settings.Path, tuple[object, ...]]]:
    place = f"{kind}.{name}"
    if not isinstance(given, dict):
        raise FieldError(place, given, f"must be followed by a key, {place}.KEY")
    try:
        check_keys(given, known)
    except FieldError as error:
        raise error.within(f"{place}.") from None
    for key, value in given.items():
        yield (kind, name, key), values(f"{place}.{key}", value)


def _model(value: object, folder: Path) -> str:
    """Accept a model's name, or a program file ``NAME.toml`` in `folder`, as its path."""
    name = rules.text(value)
    try:
        if name.endswith(".toml"):
            name = str((folder / name).resolve())
        find(name)
    except ModelError as error:
        raise RuleError(str(error).partition(": ")[2]) from None
    return name


def _element(value: object) -> str:
    from tsm import ELEMENTS

    return str(rules.choice(*ELEMENTS)(value))


OPTION_RULES: dict[str, Rule] = {
    "elements": rules.whole_number,
    "element": _element,
    "integration_tolerance": rules.fraction,
    "mesh": rules.mesh_text,
    "branch": rules.choice(*BRANCHES),
}
"""What the options of a case must obey."""
assert OPTION_RULES.keys() == {item.name for item in fields(Options)}


def _case(scene: Scene, chosen: dict[settings.Path, object], folder: Path) -> Case:
    model = _checked("model", chosen[("model",)], lambda value: _model(value, folder))
    options = {}
    for key, rule in OPTION_RULES.items():
        if (key,) in chosen:
            value = chosen[(key,)]
            if key not in find(model).options:
                raise FieldError(key, value, f'is no option of model = "{find(model).name}"')
            options[key] = _checked(key, value, rule)
    changes = {path: value for path, value in chosen.items() if len(path) > 1}
    return Case(scene=settings.changed(scene, changes), model=model, options=Options(**options))
