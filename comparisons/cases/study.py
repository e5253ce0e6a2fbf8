"""Study files: a scene, and what is varied in it, as TOML."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from itertools import product
from math import isclose, prod
from pathlib import Path
from typing import Any

from comparisons.cases import settings
from comparisons.cases.case import Case
from comparisons.models import TSM, find
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
Tree = dict[str, "Tree | None"]
"""The keys of a table, each with those of the table that it is, or None."""

LARGEST, LARGEST_COUNT = 100_000, 10_000
"""Cases of a study, and values of a range."""


RANGE: dict[str, Rule] = {
    "from": rules.number,
    "to": rules.number,
    "count": rules.whole(LARGEST_COUNT),
    "spacing": rules.choice("linear", "log"),
}
"""The keys of a range with the rules of their values."""


class StudyError(InputError):
    """A study that cannot be read."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """A sweep: its cases, each once, in the order of the file, and the number of runs timed for each."""

    name: str
    repeats: int
    cases: tuple[Case, ...]


def read_study(path: Path) -> Study:
    """Return the study that the TOML file `path` states.

    The cases of a table ``[[run]]`` are all combinations of its values, the first key varying slowest. A `StudyError` or `SceneError`
    has all mistakes in the order of the file, each in one line: file, key, value and rule.
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
        raise StudyError(source, RecordError(in_order(mistakes, tables)))
    return Study(name=head["name"], repeats=head.get("repeats", 3), cases=tuple(dict.fromkeys(cases)))


@contextmanager
def _noting(mistakes: list[FieldError], place: str = "") -> Iterator[list[FieldError]]:
    """Give a list of mistakes; add these, and what is raised, to `mistakes` as mistakes within `place`."""
    own: list[FieldError] = []
    try:
        yield own
    except FieldError as error:
        own += error.mistakes
    mistakes += (item.within(place) for item in own)


def _cases(scene: Scene, runs: list[dict[str, Any]], folder: Path, mistakes: list[FieldError]) -> list[Case]:
    """Return the cases of the runs; what is wrong is added to `mistakes`."""
    axes: list[Axes] = []
    for i, run in enumerate(runs):
        with _noting(mistakes, f"run[{i}].") as wrong:
            varied = _axes(scene, run, wrong)
        axes.append({} if wrong else varied)
    total = sum(prod(map(len, varied.values())) for varied in axes)
    if total > LARGEST:
        mistakes.append(FieldError("run", total, f"must be at most {LARGEST} cases"))
        return []
    cases: list[Case] = []
    for i, varied in enumerate(axes):
        for chosen in product(*varied.values()) if varied else ():
            with _noting(mistakes, f"run[{i}]."):
                cases.append(_case(scene, dict(zip(varied, chosen, strict=True)), folder))
    return cases


def _axes(scene: Scene, run: dict[str, Any], mistakes: list[FieldError]) -> Axes:
    """Return what a run varies: the values of every setting by its place."""
    known: Tree = dict.fromkeys(("model", *OPTION_RULES)) | {"scene": dict.fromkeys(settings.OWN)}
    for kind, record in LISTS.items():
        keys: Tree = dict.fromkeys(item.name for item in fields(record))
        records = getattr(scene, f"{kind}s")
        named = settings.record_names(kind, map(settings.stated, records))
        known[kind] = {**dict.fromkeys(named, keys), **keys} if records else {}
    axes: Axes = {}
    for place, value in _places((), run, known, mistakes):
        with _noting(mistakes):
            axes[place] = values(".".join(place), value)
    return axes


def _places(
    place: settings.Path, given: object, known: Tree, mistakes: list[FieldError]
) -> Iterator[tuple[settings.Path, object]]:
    """Yield the values of the table at a place and of the tables in it by their places; keys that are not `known` are mistakes."""
    name = ".".join(place)
    if not isinstance(given, dict):
        mistakes.append(FieldError(name, given, f"must be followed by a key, {name}.KEY"))
    elif not known:
        mistakes.append(FieldError(name, given, f"the scene has no {name}"))
    else:
        required = () if place else ("model",)
        mistakes += (item.within(f"{name}.".lstrip(".")) for item in check_keys(given, known, required))
        for key in (key for key in given if key in known):
            if (below := known[key]) is None:
                yield (*place, key), given[key]
            else:
                yield from _places((*place, key), given[key], below, mistakes)


def _model(value: object, folder: Path) -> str:
    """Accept a model's name, or a program file ``NAME.toml`` in `folder`, as its path."""
    name: str = rules.text(value)
    try:
        if name.endswith(".toml"):
            name = str((folder / name).resolve())
        find(name)
    except ModelError as error:
        raise RuleError(str(error).partition(": ")[2]) from None
    return name


def _element(value: object) -> str:
    name = rules.text(value)
    try:
        return TSM.element(Options(element=name)).name
    except ModelError as error:
        raise RuleError(str(error).partition(": ")[2]) from None


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


def _case(scene: Scene, chosen: dict[settings.Path, object], folder: Path) -> Case:
    """Return the case of the chosen settings; raise all mistakes in them."""
    given = {place[0]: value for place, value in chosen.items() if len(place) == 1}
    own, wrong = table_values(given, {"model": lambda value: _model(value, folder), **OPTION_RULES}, ())
    mistakes: list[FieldError] = []
    if "model" in own:
        model = find(own["model"])
        none = f'is no option of model = "{model.name}"'
        mistakes += (FieldError(key, given[key], none) for key in given.keys() - {"model", *model.options})
    with _noting(mistakes):
        scene = settings.changed(scene, {place: chosen[place] for place in chosen if len(place) > 1})
    if mistakes or wrong:
        raise RecordError([*mistakes, *wrong])
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

    def between(part: float) -> float:
        value: float = first * (last / first) ** part if logarithmic else first + (last - first) * part
        whole = isinstance(first, int) and isinstance(last, int)
        return round(value) if whole and isclose(value, round(value), rel_tol=1e-12) else value

    return (first, *(between(k / (count - 1)) for k in range(1, count - 1)), last)
