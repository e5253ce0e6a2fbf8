"""A scene as tables and as TOML text, and the JSON Schema of scene files."""

from collections.abc import Collection
from dataclasses import fields
from typing import Any

from comparisons.scene.read import HEAD
from comparisons.scene.record import Record, lists_of, rule_of
from comparisons.scene.rules import MISSING, Records
from comparisons.scene.scene import Scene
from comparisons.scene.values import toml_value

Table = dict[str, Any]


def to_tables(scene: Scene) -> dict[str, Table | list[Table]]:
    """Return the tables of a scene file that states `scene`, every key written out: ``scene``, and a list for each kind of record."""
    tables = _table(scene)
    head = {name: tables.pop(name) for name in [*tables] if name in HEAD}
    return {"scene": head, **{name.removesuffix("s"): rows for name, rows in tables.items()}}


def _table(record: Record) -> Table:
    """Return the values of a record that are given; a file leaves out a list of tables that is empty."""
    table: Table = {item.name: getattr(record, item.name) for item in fields(record)}
    for name in lists_of(type(record)):
        table[name] = list(map(_table, table[name])) or None
    return {name: value for name, value in table.items() if value is not None}


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


def json_schema() -> Table:
    """Return the schema of scene files, for editors.

    A file that the schema refuses is refused by the reader too; rules between keys are checked by the reader only.

    Examples
    --------
    >>> json_schema()["properties"]["beam"]["items"]["properties"]["youngs_modulus"]["exclusiveMinimum"]
    0
    """
    lists = {
        name.removesuffix("s"): table for name, table in _schema(Scene, lists_of(Scene))["properties"].items()
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of tsm-crossval",
        "type": "object",
        "properties": {"scene": _schema(Scene, HEAD), **lists},
        "required": ["scene", "beam"],
        "additionalProperties": False,
    }


def _schema(kind: type[Record], known: Collection[str]) -> Table:
    """Return the schema of a table with some keys of a record."""
    properties, declared = {}, [item for item in fields(kind) if item.name in known]
    for item in declared:
        rule, meaning = rule_of(item), item.metadata["meaning"].replace("``", "`")
        properties[item.name] = {"description": meaning, **rule.schema}
        if isinstance(rule, Records):
            properties[item.name]["items"] = _schema(rule.kind, {item.name for item in fields(rule.kind)})
        elif item.default not in (MISSING, None):
            properties[item.name]["default"] = item.default
    return {
        "type": "object",
        "description": (kind.__doc__ or "").partition("\n")[0],
        "properties": properties,
        "required": [item.name for item in declared if item.default is MISSING],
        "additionalProperties": False,
    }
