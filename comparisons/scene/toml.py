"""A scene as tables and as TOML text."""

from dataclasses import fields, is_dataclass
from typing import Any

from comparisons.scene.read import LISTS, STAGE_LISTS
from comparisons.scene.records import Scene
from comparisons.scene.stages import StageSpec
from comparisons.scene.values import toml_value

Table = dict[str, Any]


def _table(record: Any, leave: tuple[str, ...] = ()) -> Table:
    given = ((item.name, getattr(record, item.name)) for item in fields(record) if item.name not in leave)
    return {name: _value(value) for name, value in given if value is not None}


def _empty_lists(record: object) -> tuple[str, ...]:
    """Return the lists of tables in a record that are empty, which a file leaves out."""
    return tuple(name for name in STAGE_LISTS if isinstance(record, StageSpec) and not getattr(record, name))


def _value(value: object) -> object:
    """Return a value with the records in it as tables."""
    if isinstance(value, tuple) and any(is_dataclass(item) for item in value):
        return [_table(item, _empty_lists(item)) for item in value]
    return value


def to_tables(scene: Scene) -> dict[str, Table | list[Table]]:
    """Return the tables of a scene file that states `scene`, every key written out: ``scene``, and a list for each kind of record."""
    lists = {f"{kind}s": kind for kind in LISTS}
    tables: dict[str, Table | list[Table]] = {"scene": _table(scene, leave=tuple(lists))}
    for name, kind in lists.items():
        if records := getattr(scene, name):
            tables[kind] = [_table(record, _empty_lists(record)) for record in records]
    return tables


def to_toml(scene: Scene) -> str:
    """Return the TOML text of `scene`, every key written out; reading it gives an equal scene.

    Examples
    --------
    >>> from comparisons.scene import load_scene, read_scene
    >>> scene = load_scene("ks-cantilever")
    >>> read_scene(to_toml(scene), "copy") == scene
    True
    """
    texts = []
    for kind, tables in to_tables(scene).items():
        header, rows = (f"[[{kind}]]", tables) if isinstance(tables, list) else (f"[{kind}]", [tables])
        texts += [
            "\n".join([header, *(f"{key} = {toml_value(value)}" for key, value in row.items())])
            for row in rows
        ]
    return "\n\n".join(texts) + "\n"
