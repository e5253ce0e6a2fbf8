"""A scene as TOML text."""

from dataclasses import fields
from typing import Any

from comparisons.scene.records import Scene
from comparisons.scene.values import toml_value


def _table(header: str, record: Any, leave: tuple[str, ...] = ()) -> str:
    given = ((item.name, getattr(record, item.name)) for item in fields(record) if item.name not in leave)
    return "\n".join(
        [header, *(f"{name} = {toml_value(value)}" for name, value in given if value is not None)]
    )


def to_toml(scene: Scene) -> str:
    """Return the TOML text of `scene`, every key written out; reading it gives an equal scene.

    Examples
    --------
    >>> from comparisons.scene import load_scene, read_scene
    >>> scene = load_scene("ks-cantilever")
    >>> read_scene(to_toml(scene), "copy") == scene
    True
    """
    lists = {f"{kind}s": kind for kind in ("beam", "support", "load", "pin", "contact")}
    tables = [_table("[scene]", scene, leave=tuple(lists))]
    tables += [
        _table(f"[[{kind}]]", record) for name, kind in lists.items() for record in getattr(scene, name)
    ]
    return "\n\n".join(tables) + "\n"
