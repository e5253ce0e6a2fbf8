"""A scene as tables and as TOML text."""

from dataclasses import fields
from typing import Any

from comparisons.scene.records import Scene
from comparisons.scene.values import toml_value

Table = dict[str, Any]


def _table(record: Any, leave: tuple[str, ...] = ()) -> Table:
    given = ((item.name, getattr(record, item.name)) for item in fields(record) if item.name not in leave)
    return {name: value for name, value in given if value is not None}


def to_tables(scene: Scene) -> dict[str, Table | list[Table]]:
    """Return the tables of a scene file that states `scene`, every key written out: ``scene``, and a list for each kind of record."""
    lists = {f"{kind}s": kind for kind in ("beam", "support", "load", "pin", "contact")}
    tables: dict[str, Table | list[Table]] = {"scene": _table(scene, leave=tuple(lists))}
    for name, kind in lists.items():
        if records := getattr(scene, name):
            tables[kind] = [_table(record) for record in records]
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
