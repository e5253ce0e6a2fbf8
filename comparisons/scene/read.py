"""Reader of scene files: it turns TOML into a `Scene`, or raises an error with all mistakes."""

from collections.abc import Collection, Mapping
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar

from comparisons.scene.record import UNREADABLE, Record, keys_of, lists_of
from comparisons.scene.rules import FieldError, RecordError
from comparisons.scene.scene import Scene
from comparisons.scene.tables import (
    MOST,
    SceneError,
    check_keys,
    check_table,
    check_tables,
    in_order,
    misnamed_keys,
    read_tables,
    read_text,
)

R = TypeVar("R", bound=Record)
LISTS = {field.removesuffix("s"): kind for field, kind in lists_of(Scene).items()}
"""The tables of a file, each a list, as ``beam``."""


def built_in_scenes() -> dict[str, str]:
    """Return the TOML text of the scenes that come with the package, by name."""
    folder = resources.files("comparisons.scene") / "scenes"
    files = {
        item.name.removesuffix(".toml"): item for item in folder.iterdir() if item.name.endswith(".toml")
    }
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
    built_in = built_in_scenes()
    if scene in built_in:
        return read_scene(built_in[scene], scene)
    if not scene:
        raise SceneError('""', "must name a scene")
    near = "" if Path(scene).exists() else _near(scene, built_in)
    absent = f"no such file or built-in scene{near}; crossval scenes lists them"
    return read_scene(read_text(scene, absent, SceneError), scene)


def _near(scene: str, built_in: Collection[str]) -> str:
    """Return the question whether another scene is meant; empty if no name is near."""
    from comparisons.scene.words import meant

    name = meant(scene, built_in)
    return f" (did you mean {name}?)" if name else ""


def read_scene(text: str, source: str) -> Scene:
    """Return the scene that the TOML `text` states; `source` names it in errors.

    Raises
    ------
    SceneError
        All mistakes in the order of the text, each in one line: file, key, value and rule.
    """
    tables = read_tables(text, source, SceneError)
    mistakes = [*check_keys(tables, ("scene", *LISTS), required=("scene", "beam"))]
    mistakes += check_table(tables, "scene")
    wrong = {*misnamed_keys(tables, ("scene", *LISTS)), *({"beam"} - tables.keys())} - {"scene"}
    lists = {**dict.fromkeys(wrong, UNREADABLE), **_lists(LISTS, tables, mistakes)}
    given = {f"{kind}s": records for kind, records in lists.items()}
    head = tables.get("scene")
    if not isinstance(head, dict):
        head, given = {}, {**dict.fromkeys(keys_of(Scene) - lists_of(Scene).keys(), UNREADABLE), **given}
    scene = _record(Scene, head, given, "scene.", mistakes)
    if mistakes:
        raise SceneError(source, RecordError(in_order(mistakes, text, tables)))
    return scene


def _lists(
    kinds: Mapping[str, type[Record]], tables: dict[str, Any], mistakes: list[FieldError]
) -> dict[str, Any]:
    """Return the lists of records by kind, `UNREADABLE` for a list that is wrong as a whole; mistakes are added to `mistakes`."""
    lists: dict[str, Any] = {}
    for kind in (kind for kind in kinds if kind in tables):
        wrong = list(check_tables(tables, kind))
        mistakes += wrong
        records: list[Record] = []
        for i, table in enumerate(() if wrong else tables[kind]):
            own: list[FieldError] = []
            inner = lists_of(kinds[kind])
            records.append(_record(kinds[kind], table, _lists(inner, table, own), "", own))
            mistakes += (mistake.within(f"{kind}[{i}].") for mistake in own)
            if len(mistakes) > MOST:
                break
        lists[kind] = UNREADABLE if wrong or len(mistakes) > MOST else tuple(records)
    return lists


def _record(
    kind: type[R], table: dict[str, Any], lists: Mapping[str, Any], place: str, mistakes: list[FieldError]
) -> R:
    """Return the record of a table and of `lists` of records, without its values that are wrong.

    Mistakes are added to `mistakes`, with `place` before the keys of the record.
    """
    own = keys_of(kind) - (lists_of(kind).keys() if kind is Scene else set())
    mistakes += (mistake.within(place) for mistake in check_keys(table, own))
    given = {name: table[name] for name in own if name in table}
    misnamed = dict.fromkeys(misnamed_keys(table, own), UNREADABLE)
    try:
        return kind(**{**given, **misnamed, **lists})
    except RecordError as error:
        mistakes += (item.within(place) if item.key in own else item for item in error.mistakes)
        record: R = error.record
        return record
