"""Reader of scene files: it turns TOML into a `Scene`, or raises an error with all mistakes."""

from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import MISSING as NO_DEFAULT
from dataclasses import fields
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar

from comparisons.scene.beam import BeamSpec
from comparisons.scene.conditions import HingeSpec, LoadSpec, SpringSpec, SupportSpec
from comparisons.scene.contact import ContactSpec, PinSpec
from comparisons.scene.record import Record, examined
from comparisons.scene.records import Scene
from comparisons.scene.rules import MISSING, FieldError, RecordError
from comparisons.scene.stages import PinMove, StageSpec, SupportMove
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
LISTS: dict[str, type[Record]] = {
    "beam": BeamSpec,
    "support": SupportSpec,
    "load": LoadSpec,
    "pin": PinSpec,
    "contact": ContactSpec,
    "hinge": HingeSpec,
    "spring": SpringSpec,
    "stage": StageSpec,
}
"""The tables of a file, each a list."""
LIST_FIELDS = {f"{kind}s" for kind in LISTS}
"""Fields of a scene that are lists of records."""
STAGE_LISTS: dict[str, type[Record]] = {"pin": PinMove, "support": SupportMove, "load": LoadSpec}
"""The lists of tables in a ``[[stage]]``."""


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
    scene, mistakes = _scene(tables)
    if mistakes:
        raise SceneError(source, RecordError(in_order(mistakes, text, tables)))
    return scene


def _scene(tables: dict[str, Any]) -> tuple[Scene, list[FieldError]]:
    """Return the scene of the tables, and its mistakes in no order; a scene with mistakes is not whole."""
    kinds = ("scene", *LISTS)
    mistakes = list(check_keys(tables, kinds, required=("scene", "beam")))
    lists, wrong = _lists(LISTS, tables, mistakes)
    wrong |= {*misnamed_keys(tables, kinds), *({"beam"} - tables.keys())}
    mistakes += check_table(tables, "scene")
    own = {item.name for item in fields(Scene)} - LIST_FIELDS
    head = tables.get("scene")
    unknown = set() if isinstance(head, dict) else own
    scene, found = _whole_or_partial(
        Scene,
        head if isinstance(head, dict) else {},
        "scene.",
        {f"{kind}s": records for kind, records in lists.items()},
        {*unknown, *(f"{kind}s" for kind in wrong)},
        whole=not mistakes,
    )
    return scene, [*mistakes, *found]


def _lists(
    kinds: Mapping[str, type[Record]], tables: dict[str, Any], mistakes: list[FieldError]
) -> tuple[dict[str, tuple[Record, ...]], set[str]]:
    """Return the lists of records by kind, and the kinds whose list is wrong; mistakes are added to `mistakes`."""
    lists: dict[str, tuple[Record, ...]] = {}
    wrong = set()
    for kind in (kind for kind in kinds if kind in tables):
        before = len(mistakes)
        mistakes += check_tables(tables, kind)
        unreadable = len(mistakes) > before
        records = []
        for i, table in enumerate(() if unreadable else tables[kind]):
            if len(mistakes) > MOST:
                unreadable = True
                break
            record, own = _record(kinds[kind], table)
            records.append(record)
            mistakes += (mistake.within(f"{kind}[{i}].") for mistake in own)
        if unreadable:
            wrong.add(kind)
        else:
            lists[kind] = tuple(records)
    return lists, wrong


def _record(kind: type[R], table: dict[str, Any]) -> tuple[R, list[FieldError]]:
    """Return the record of a table and its mistakes; a record with mistakes is not whole."""
    mistakes: list[FieldError] = []
    lists, wrong = _lists(STAGE_LISTS if kind is StageSpec else {}, table, mistakes)
    record, found = _whole_or_partial(kind, table, "", lists, wrong, whole=not mistakes)
    return record, [*mistakes, *found]


def _whole_or_partial(
    kind: type[R],
    table: dict[str, Any],
    prefix: str,
    lists: Mapping[str, Any],
    wrong: Collection[str],
    *,
    whole: bool,
) -> tuple[R, list[FieldError]]:
    """Return the record of a table, `prefix` before its keys, and of `lists` of records; and the mistakes.

    The lists are `whole` if they have no mistakes. The fields in `wrong` are known to be wrong.
    """
    defaults = {item.name: item.default for item in fields(kind)}  # type: ignore[arg-type]  # every kind is a dataclass
    own = [name for name in defaults if name not in LIST_FIELDS]
    required = [name for name in own if defaults[name] is NO_DEFAULT and name not in wrong]
    mistakes = [mistake.within(prefix) for mistake in check_keys(table, own, required)]
    given = {**{name: table[name] for name in own if name in table}, **lists}
    if whole and not mistakes:
        with suppress(FieldError):
            return kind(**given), []
    misnamed = dict.fromkeys(misnamed_keys(table, own), MISSING)
    missing = {name for name in required if name not in table}
    record, found = examined(kind, {**defaults, **misnamed, **given}, {*wrong, *misnamed, *missing})
    return record, [*mistakes, *(item.within(prefix) if item.key in own else item for item in found)]
