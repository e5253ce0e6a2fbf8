"""Scene files: TOML to a `Scene`, or to an error with all mistakes; a `Scene` to TOML; and their JSON Schema."""

import os
from collections.abc import Collection
from dataclasses import fields
from pathlib import Path
from typing import Any

from comparisons.scene.record import Record, lists_of
from comparisons.scene.rules import MISSING, UNREADABLE, RecordError, toml_value
from comparisons.scene.scene import Scene
from comparisons.scene.tables import (
    InputError,
    check_keys,
    check_table,
    read_tables,
    read_text,
    refuse,
    stated,
)

Table = dict[str, Any]
FOLDER = Path(__file__).parent / "scenes"
"""The built-in scenes."""
LISTS = {field.removesuffix("s"): kind for field, kind in lists_of(Scene).items()}
"""The tables of a file, each a list, as ``beam``."""
HEAD = {item.name for item in fields(Scene)} - lists_of(Scene).keys()
"""The keys of the table ``[scene]``."""


def built_in_scenes() -> dict[str, str]:
    """Return the TOML text of the scenes that come with the package, by name."""
    files = sorted(FOLDER.glob("*.toml"), key=lambda path: path.stem)
    return {path.stem: path.read_text(encoding="utf-8") for path in files}


def load_scene(scene: str) -> Scene:
    """Return the scene called `scene`: a built-in name or the path of a TOML file.

    Raises
    ------
    InputError
        All mistakes in the order of the file, each in one line: file, key, value and rule.

    Examples
    --------
    >>> load_scene("ks-cantilever").beams[0].height
    0.02
    """
    if not scene:
        raise InputError('""', "must name a scene")
    names = [path.stem for path in FOLDER.glob("*.toml")]
    if scene in names:
        return read_scene((FOLDER / f"{scene}.toml").read_text(encoding="utf-8"), scene)
    from comparisons.scene.words import meant

    name = None if os.path.lexists(scene) else meant(scene, names)
    near = f" (did you mean {name}?)" if name else ""
    absent = f"no such file or built-in scene{near}; crossval scenes lists them"
    return read_scene(read_text(scene, absent), scene)


def read_scene(text: str, source: str) -> Scene:
    """Return the scene that the TOML `text` states; `source` names it in errors.

    Raises
    ------
    InputError
        All mistakes in the order of the text, each in one line: file, key, value and rule.
    """
    tables, known = read_tables(text, source), ("scene", *LISTS)
    head = tables.get("scene")
    if not isinstance(head, dict):
        head = dict.fromkeys(HEAD, UNREADABLE)
    mistakes = [*check_keys(tables, known, required=("scene", "beam")), *check_table(tables, "scene")]
    mistakes += (mistake.within("scene.") for mistake in check_keys(head, HEAD))
    given = {name: head.get(name, UNREADABLE) for name in HEAD & stated(head, HEAD)}
    kinds = LISTS.keys() & {"beam", *stated(tables, known)}
    given |= {f"{kind}s": tables.get(kind, UNREADABLE) for kind in kinds}
    try:
        scene = Scene(**given)
    except RecordError as error:
        mistakes += (item.within("scene.") if item.key in HEAD else item for item in error.mistakes)
    refuse(source, mistakes, tables)
    return scene


def to_tables(scene: Scene) -> dict[str, Table | list[Table]]:
    """Return the tables of a file that states `scene`, every key written out: ``scene``, and lists of records."""
    tables = _table(scene)
    head = {name: tables.pop(name) for name in [*tables] if name in HEAD}
    return {"scene": head, **{name.removesuffix("s"): rows for name, rows in tables.items()}}


def _table(record: Record) -> Table:
    """Return the values of a record that are given; a file leaves out a list of tables that is empty."""
    table: Table = {item.name: getattr(record, item.name) for item in fields(record)}
    table |= {name: [*map(_table, table[name])] or None for name in lists_of(type(record))}
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
    texts: list[str] = []
    for kind, tables in to_tables(scene).items():
        header, rows = (f"[[{kind}]]", tables) if isinstance(tables, list) else (f"[{kind}]", [tables])
        lines = ([header, *(f"{key} = {toml_value(value)}" for key, value in row.items())] for row in rows)
        texts += map("\n".join, lines)
    return "\n\n".join(texts) + "\n"


def json_schema() -> Table:
    """Return the schema of scene files, for editors.

    A file that the schema refuses is refused by the reader too; rules between keys are checked by the reader only.

    Examples
    --------
    >>> json_schema()["properties"]["beam"]["items"]["properties"]["youngs_modulus"]["minimum"]
    1e-100
    """
    lists = _schema(Scene, lists_of(Scene))["properties"].items()
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of tsm-crossval",
        "type": "object",
        "properties": {"scene": _schema(Scene, HEAD), **{name.removesuffix("s"): one for name, one in lists}},
        "required": ["scene", "beam"],
        "additionalProperties": False,
    }


def _schema(kind: type[Record], known: Collection[str]) -> Table:
    """Return the schema of a table with some keys of a record."""
    properties, declared = {}, [item for item in fields(kind) if item.name in known]
    for item in declared:
        meaning = item.metadata["meaning"].replace("``", "`")
        properties[item.name] = {"description": meaning, **kind.rules[item.name].schema}
        if listed := lists_of(kind).get(item.name):
            properties[item.name]["items"] = _schema(listed, listed.rules)
        elif item.default not in (MISSING, None):
            properties[item.name]["default"] = item.default
    return {
        "type": "object",
        "description": (kind.__doc__ or "").partition("\n")[0],
        "properties": properties,
        "required": [item.name for item in declared if item.default is MISSING],
        "additionalProperties": False,
    }
