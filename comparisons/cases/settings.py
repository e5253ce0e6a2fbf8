"""The settings of a case by the names of a study file: ``elements``, ``scene.load_parameters``, ``beam.upper.height``."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, replace
from typing import Any

from comparisons.cases.case import Case
from comparisons.output import plain
from comparisons.scene import LoadSpec, Scene, to_tables
from comparisons.scene.read import LISTS
from comparisons.scene.rules import FieldError, RecordError

Path = tuple[str, ...]
"""Where a setting stands: ``("scene", "load_parameters")``, ``("beam", "height")`` for every beam, ``("beam", "upper", "height")``."""
Changes = Mapping[Path, object]
"""New values of settings."""

OWN = {item.name for item in fields(Scene)} - {f"{kind}s" for kind in LISTS}
"""The keys of the table ``[scene]``."""


def record_names(kind: str, records: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return the names by which a study addresses records of a kind.

    They are the `name` of a beam, pin or stage, the number of a stage without one, from 2 on, the pair of a contact, the place of a
    load, and the node of a support, hinge or spring.
    """
    name_of: dict[str, Callable[[Mapping[str, Any]], str]] = {
        "contact": lambda record: f"{record['node']}->{record['beam']}",
        "load": lambda record: LoadSpec(**record).node,
        **dict.fromkeys(("support", "hinge", "spring"), lambda record: f"{record['beam']}.{record['end']}"),
    }
    if kind in name_of:
        return [name_of[kind](record) for record in records]
    return [str(record.get("name") or number) for number, record in enumerate(records, 2)]


def stated(record: Any) -> dict[str, Any]:
    """Return the fields of a record."""
    return {item.name: getattr(record, item.name) for item in fields(record)}


def changed(scene: Scene, changes: Changes) -> Scene:
    """Return `scene` with changed settings. A change for a named record takes precedence over a change for all records of its kind.

    All rules that are broken are raised as one `FieldError`; their keys are the settings'.
    """
    own: dict[str, Any] = {path[1]: value for path, value in changes.items() if path[0] == "scene"}
    mistakes: list[FieldError] = []
    for kind in {path[0] for path in changes} & LISTS.keys():
        records = list(getattr(scene, f"{kind}s"))
        for i, name in enumerate(record_names(kind, map(stated, records))):
            # the named ones come last
            paths = sorted(
                (path for path in changes if path[0] == kind and path[1:-1] in ((), (name,))), key=len
            )
            places = {path[-1]: ".".join(path[:-1]) for path in paths}
            try:
                records[i] = replace(records[i], **{path[-1]: changes[path] for path in paths})
            except FieldError as error:
                mistakes += (item.within(f"{places.get(item.key, kind)}.") for item in error.mistakes)
        own[f"{kind}s"] = tuple(records)
    if mistakes:
        raise RecordError(mistakes)
    try:
        return replace(scene, **own)
    except FieldError as error:
        found = (item.within("scene.") if item.key in OWN else item for item in error.mistakes)
        raise RecordError(list(found)) from None


def settings(case: Case) -> dict[str, object]:
    """Return the settings of a case by key; the key omits the record's name if the scene has only one of its kind."""
    tables = plain(to_tables(case.scene))
    found = {name: plain(value) for name, value in vars(case.options).items() if value is not None}
    found |= {f"scene.{key}": value for key, value in tables["scene"].items() if key != "name"}
    for kind in LISTS:
        records = tables.get(kind, [])
        for name, record in zip(record_names(kind, records), records, strict=True):
            place = kind if len(records) == 1 else f"{kind}.{name}"
            found |= {f"{place}.{key}": value for key, value in record.items()}
    return found
