"""The settings of a case by the names of a study file: ``elements``, ``scene.load_parameters``, ``beam.upper.height``."""

from collections.abc import Iterator, Mapping
from typing import Any

from comparisons.output import plain
from comparisons.scene import Scene, to_tables
from comparisons.scene.read import HEAD, LISTS
from comparisons.scene.rules import FieldError, RecordError
from comparisons.scene.tables import check_keys
from comparisons.suite.case import Case

Changes = Mapping[str, object]
"""New values of settings: ``scene.load_parameters``, ``beam.height`` of every beam, ``beam.upper.height``; None takes a key away."""
Table = dict[str, Any]


NAMES = {"contact": "pair", **dict.fromkeys(("support", "hinge", "spring", "load"), "node")}
"""The attributes by which records without a name are named in a study file."""


def _named(scene: Scene, kind: str, tables: Table) -> dict[str, Table]:
    """Return the tables of a scene's records by their names; the number from 2 on of a stage without one."""
    records = enumerate(getattr(scene, f"{kind}s"), 2)
    names = (str(getattr(one, NAMES.get(kind, "name")) or number) for number, one in records)
    return dict(zip(names, tables.get(kind, []), strict=True))


def _places(scene: Scene, tables: Table, path: str, value: object) -> Iterator[tuple[str, Table]]:
    """Yield the tables that a setting changes with their places in a scene file; `FieldError` for none."""
    kind, _, rest = path.partition(".")
    name, _, key = rest.rpartition(".")
    given: Table = {name: {key: value}} if name else {key: value}
    records = _named(scene, kind, tables) if kind in LISTS else {"": tables["scene"]}
    mistakes = list(check_keys({kind: given}, ("scene", *LISTS)))
    if records and (kind == "scene" or name):
        known = records if kind in LISTS else () if name else HEAD
        mistakes += (item.within(f"{kind}.") for item in check_keys(given, known))
    if mistakes:
        raise RecordError(mistakes)
    for number, (own, record) in enumerate(records.items()):
        if not name or own == name:
            yield kind if kind == "scene" else f"{kind}[{number}]", record


def changed(scene: Scene, changes: Changes) -> Scene:
    """Return a scene with changed settings, named records last; one `FieldError` for all mistakes.

    A setting of all records of a kind changes nothing where the scene has none.
    """
    tables: Table = to_tables(scene)
    stated, mistakes = dict[str, str](), list[FieldError]()
    for path, value in sorted(changes.items(), key=lambda item: item[0].count(".")):
        try:
            for place, record in _places(scene, tables, path, value):
                key = path.rpartition(".")[2]
                record[key] = value
                stated[f"{place}.{key}"] = path
                if value is None:
                    del record[key]
        except FieldError as error:
            mistakes += error.mistakes
    lists = {f"{kind}s": tables[kind] for kind in LISTS if kind in tables}
    try:
        if not mistakes:
            return Scene(**tables["scene"], **lists)
    except FieldError as error:
        for item in error.mistakes:
            at = f"scene.{item.key}" if item.key in HEAD else item.key
            mistakes.append(FieldError(stated.get(at, at), item.value, item.rule))
    raise RecordError(mistakes)


def settings(case: Case) -> dict[str, object]:
    """Return the settings of a case by key; the key omits the record's name if the scene has only one of its kind."""
    tables = plain(to_tables(case.scene))
    found: Table = plain(case.given)
    found |= {f"scene.{key}": value for key, value in tables["scene"].items() if key != "name"}
    for kind in LISTS:
        for name, record in _named(case.scene, kind, tables).items():
            place = kind if len(tables[kind]) == 1 else f"{kind}.{name}"
            found |= {f"{place}.{key}": value for key, value in record.items()}
    return found
