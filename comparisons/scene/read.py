"""Reader of scene files: it turns TOML into a `Scene`, or raises an error with all mistakes."""

import os
from dataclasses import fields
from pathlib import Path

from comparisons.scene.record import lists_of
from comparisons.scene.rules import UNREADABLE, RecordError
from comparisons.scene.scene import Scene
from comparisons.scene.tables import (
    SceneError,
    check_keys,
    check_table,
    in_order,
    misnamed_keys,
    read_tables,
    read_text,
)

FOLDER = Path(__file__).parent / "scenes"
"""The built-in scenes."""
LISTS = {field.removesuffix("s"): kind for field, kind in lists_of(Scene).items()}
"""The tables of a file, each a list, as ``beam``."""
HEAD = {item.name for item in fields(Scene)} - lists_of(Scene).keys()
"""The keys of the table ``[scene]``."""


def built_in_scenes() -> dict[str, str]:
    """Return the TOML text of the scenes that come with the package, by name."""
    files = {path.stem: path for path in FOLDER.glob("*.toml")}
    return {name: files[name].read_text(encoding="utf-8") for name in sorted(files)}


def load_scene(scene: str) -> Scene:
    """Return the scene called `scene`: a built-in name or the path of a TOML file.

    Raises
    ------
    SceneError
        All mistakes in the order of the file, each in one line: file, key, value and rule.

    Examples
    --------
    >>> load_scene("ks-cantilever").beams[0].height
    0.02
    """
    built_in = {path.stem: path for path in FOLDER.glob("*.toml")}
    if scene in built_in:
        return read_scene(built_in[scene].read_text(encoding="utf-8"), scene)
    if not scene:
        raise SceneError('""', "must name a scene")
    near = ""
    if not os.path.lexists(scene):
        from comparisons.scene.words import meant

        name = meant(scene, built_in)
        near = f" (did you mean {name}?)" if name else ""
    absent = f"no such file or built-in scene{near}; crossval scenes lists them"
    return read_scene(read_text(scene, absent, SceneError), scene)


def read_scene(text: str, source: str) -> Scene:
    """Return the scene that the TOML `text` states; `source` names it in errors.

    Raises
    ------
    SceneError
        All mistakes in the order of the text, each in one line: file, key, value and rule.
    """
    tables, known = read_tables(text, source, SceneError), ("scene", *LISTS)
    mistakes = [*check_keys(tables, known, required=("scene", "beam")), *check_table(tables, "scene")]
    head = tables.get("scene")
    if not isinstance(head, dict):
        head = dict.fromkeys(HEAD, UNREADABLE)
    mistakes += (mistake.within("scene.") for mistake in check_keys(head, HEAD))
    misnamed = misnamed_keys(head, HEAD) | {
        f"{kind}s" for kind in (misnamed_keys(tables, known) | {"beam"}) - {"scene", *tables}
    }
    lists = {f"{kind}s": tables[kind] for kind in LISTS if kind in tables}
    own = {name: head[name] for name in HEAD if name in head}
    try:
        scene = Scene(**own, **lists, **dict.fromkeys(misnamed, UNREADABLE))
    except RecordError as error:
        mistakes += (item.within("scene.") if item.key in HEAD else item for item in error.mistakes)
    if mistakes:
        raise SceneError(source, RecordError(in_order(mistakes, tables)))
    return scene
