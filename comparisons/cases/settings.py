"""The settings of a case by the names of a study file: ``elements``, ``scene.load_parameters``, ``beam.upper.height``."""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from typing import Any

from comparisons.cases.case import Case
from comparisons.output import plain
from comparisons.scene import LoadSpec, Scene, to_toml
from comparisons.scene.read import LISTS
from comparisons.scene.rules import FieldError, RecordError

Path = tuple[str, ...]
"""Where a setting stands: ``("scene", "load_parameters")``, ``("beam", "height")`` for every beam, ``("beam", "upper", "height")``."""

OWN = {item.name for item in fields(Scene)} - {f"{kind}s" for kind in LISTS}
"""The keys of the table ``[scene]``."""


def record_names(kind: str, records: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """Return the names by which a study addresses records of a kind.

    They are the `name` of a beam, pin or stage, the number of a stage without one, from 2 on, the pair of a contact, the place of a
    load, and the node of a support, hinge or spring.
    """
    return tuple(_record_name(kind, record, number) for number, record in enumerate(records, 2))


def _record_name(kind: str, record: Mapping[str, Any], number: int) -> str:
    if kind == "contact":
        return f"{record['node']}->{record['beam']}"
    if kind == "load":
        return LoadSpec(**record).node
    if "end" in record and "beam" in record:
        return f"{record['beam']}.{record['end']}"
    return str(record.get("name") or number)


def stated(record: Any) -> dict[str, Any]:
    """Return the fields of a record."""
    return {item.name: getattr(record, item.name) for item in fields(record)}


def changed(scene: Scene, changes: Mapping[Path, object]) -> Scene:
    """Return `scene` with changed settings. A change for a named record takes precedence over a change for all records of its kind.

    Raises
    ------
    FieldError
        With all rules of the scene that are broken; their keys are the settings'.
    """
    own: dict[str, Any] = {path[1]: value for path, value in changes.items() if path[0] == "scene"}
    mistakes: list[FieldError] = []
    for kind in LISTS:
        varied = {path: value for path, value in changes.items() if path[0] == kind}
        if varied:
            records = getattr(scene, f"{kind}s")
            names = record_names(kind, map(stated, records))
            own[f"{kind}s"] = tuple(
                _changed_record(kind, name, record, varied, mistakes)
                for name, record in zip(names, records, strict=True)
            )
    if mistakes:
        raise RecordError(mistakes)
    try:
        return replace(scene, **own)
    except FieldError as error:
        raise RecordError(
            [item.within("scene.") if item.key in OWN else item for item in error.mistakes]
        ) from None


def _changed_record(
    kind: str, name: str, record: Any, changes: Mapping[Path, object], mistakes: list[FieldError]
) -> Any:
    """Return a record with changed settings. Mistakes are added to `mistakes`, and the record is then left as it is."""
    own = {path: changes[path] for path in sorted(changes, key=len) if len(path) == 2 or path[1] == name}
    places = {path[-1]: ".".join(path[:-1]) for path in own}
    try:
        return replace(record, **{path[-1]: value for path, value in own.items()})
    except FieldError as error:
        mistakes += (item.within(f"{places.get(item.key, kind)}.") for item in error.mistakes)
        return record


def settings(case: Case) -> dict[str, object]:
    """Return the settings of a case by key; the key omits the record's name if the scene has only one of its kind."""
    tables = tomllib.loads(to_toml(case.scene))
    found = {name: plain(value) for name, value in vars(case.options).items() if value is not None}
    found |= {f"scene.{key}": value for key, value in tables["scene"].items() if key != "name"}
    for kind in LISTS:
        records = tables.get(kind, [])
        for name, record in zip(record_names(kind, records), records, strict=True):
            place = kind if len(records) == 1 else f"{kind}.{name}"
            found |= {f"{place}.{key}": value for key, value in record.items()}
    return found
