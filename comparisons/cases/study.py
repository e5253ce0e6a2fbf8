"""Study files: a scene, and what is varied in it, as TOML."""

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
from comparisons.scene.rules import FieldError, RecordError, Rule, RuleError
from comparisons.scene.tables import (
    InputError,
    check_keys,
    check_tables,
    head_values,
    in_order,
    read_tables,
    read_text,
    table_values,
)

Axes = dict[settings.Path, tuple[object, ...]]
"""The values of every setting that a run varies, by its place."""

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
        All mistakes in the order of the file, each in one line: file, key, value and rule. Nothing has been computed.
    """
    source = str(path)
    text = read_text(source, "no such file", StudyError)
    tables = read_tables(text, source, StudyError)
    head, mistakes = head_values(tables, "study", HEAD_RULES, required=("name", "scene"))
    mistakes += check_keys(tables, ("study", "run"), required=("study", "run"))
    mistakes += check_tables(tables, "run")
    cases = list[Case]()
    if "scene" in head and not list(check_tables(tables, "run")):
        name = head["scene"] if head["scene"] in built_in_scenes() else str(path.parent / head["scene"])
        cases = _cases(load_scene(name), tables.get("run", []), path.parent, mistakes)
    if mistakes:
        raise StudyError(source, RecordError(in_order(mistakes, text, tables)))
    return Study(name=head["name"], repeats=head.get("repeats", 3), cases=tuple(dict.fromkeys(cases)))


def _checked(key: str, value: object, rule: Rule) -> Any:
    try:
        return rule(value)
    except RuleError as error:
        raise FieldError(key, value, str(error)) from None


def _cases(scene: Scene, runs: list[dict[str, Any]], folder: Path, mistakes: list[FieldError]) -> list[Case]:
    """Return the cases of the runs; what is wrong is added to `mistakes`."""
    axes: list[Axes] = []
    for i, run in enumerate(runs):
        varied, wrong = _axes(scene, run)
        mistakes += (mistake.within(f"run[{i}].") for mistake in wrong)
        axes.append({} if wrong else varied)
    total = sum(prod(map(len, varied.values())) for varied in axes)
    if total > LARGEST:
        mistakes.append(FieldError("run", total, f"must be at most {LARGEST} cases"))
        return []
    cases: list[Case] = []
    for i, varied in enumerate(axes):
        for chosen in product(*varied.values()) if varied else ():
            try:
                cases.append(_case(scene, dict(zip(varied, chosen, strict=True)), folder))
            except FieldError as error:
                mistakes += error.within(f"run[{i}].").mistakes
    return cases


def _axes(scene: Scene, run: dict[str, Any]) -> tuple[Axes, list[FieldError]]:
    """Return what a run varies, the values of every setting by its place, and the mistakes in it."""
    axes: Axes = {}
    mistakes = list(check_keys(run, RUN_KEYS, required=("model",)))
    for key, given in ((key, given) for key, given in run.items() if key in RUN_KEYS):
        places = _places(scene, key, given, mistakes) if key in LISTS or key == "scene" else {(key,): given}
        for place, value in places.items():
            try:
                axes[place] = values(".".join(place), value)
            except FieldError as error:
                mistakes += error.mistakes
    return axes, mistakes


def _places(
    scene: Scene, kind: str, given: object, mistakes: list[FieldError]
) -> dict[settings.Path, object]:
    """Return what a run states for the records of one kind: for all of them, or for one by its name."""
    if not isinstance(given, dict):
        mistakes.append(FieldError(kind, given, f"must be followed by a key, {kind}.KEY"))
        return {}
    if kind == "scene":
        known, named = settings.OWN, set[str]()
    else:
        known = {item.name for item in fields(LISTS[kind])}  # type: ignore[arg-type]  # every record is a dataclass
        named = set(settings.record_names(kind, map(settings.stated, getattr(scene, f"{kind}s"))))
        if not named:
            mistakes.append(FieldError(kind, given, f"the scene has no {kind}"))
            return {}
    mistakes += (mistake.within(f"{kind}.") for mistake in check_keys(given, known | named))
    places: dict[settings.Path, object] = {(kind, key): given[key] for key in given if key in known}
    for name in (name for name in given if name in named - known):
        places |= _named_places((kind, name), given[name], known, mistakes)
    return places


def _named_places(
    record: settings.Path, given: object, known: set[str], mistakes: list[FieldError]
) -> dict[settings.Path, object]:
    place = ".".join(record)
    if not isinstance(given, dict):
        mistakes.append(FieldError(place, given, f"must be followed by a key, {place}.KEY"))
        return {}
    mistakes += (mistake.within(f"{place}.") for mistake in check_keys(given, known))
    return {(*record, key): value for key, value in given.items() if key in known}


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


HEAD_RULES: dict[str, Rule] = {"name": rules.name, "scene": rules.text, "repeats": rules.whole_number}
"""The keys of the table ``[study]`` with the rules of their values."""
RUN_KEYS = ("model", *OPTION_RULES, "scene", *LISTS)
"""The keys of a table ``[[run]]``."""


def _case(scene: Scene, chosen: dict[settings.Path, object], folder: Path) -> Case:
    """Return the case of the chosen settings; raise all mistakes in them."""
    mistakes: list[FieldError] = []
    options = {}
    model = ""
    try:
        model = _checked("model", chosen[("model",)], lambda value: _model(value, folder))
        options = _options(model, chosen)
    except FieldError as error:
        mistakes += error.mistakes
    changes = {path: value for path, value in chosen.items() if len(path) > 1}
    try:
        scene = settings.changed(scene, changes)
    except FieldError as error:
        mistakes += error.mistakes
    if mistakes:
        raise RecordError(mistakes)
    return Case(scene=scene, model=model, options=Options(**options))


def _options(model: str, chosen: dict[settings.Path, object]) -> dict[str, Any]:
    """Return the options among the chosen settings; raise all mistakes in them."""
    given = {key: chosen[key,] for key in OPTION_RULES if (key,) in chosen}
    mistakes = [
        FieldError(key, value, f'is no option of model = "{find(model).name}"')
        for key, value in given.items()
        if key not in find(model).options
    ]
    options, wrong = table_values(given, OPTION_RULES, ())
    if mistakes or wrong:
        raise RecordError([*mistakes, *wrong])
    return options
