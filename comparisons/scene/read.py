"""Reader of scene files: it turns TOML into a `Scene`, or raises an error of one line."""

from dataclasses import MISSING as NO_DEFAULT
from dataclasses import fields
from importlib import resources
from typing import Any, TypeVar

from comparisons.scene.conditions import HingeSpec, LoadSpec, SpringSpec, SupportSpec
from comparisons.scene.contact import ContactSpec, PinSpec
from comparisons.scene.records import BeamSpec, Scene
from comparisons.scene.rules import FieldError
from comparisons.scene.stages import PinMove, StageSpec, SupportMove
from comparisons.scene.tables import SceneError, check_keys, read_tables, read_text

Record = TypeVar("Record")
LISTS: dict[str, type] = {
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
STAGE_LISTS: dict[str, type] = {"pin": PinMove, "support": SupportMove, "load": LoadSpec}
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
        One line: file, key, value and rule.

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
    absent = f"no such file or built-in scene ({', '.join(built_in)})"
    return read_scene(read_text(scene, absent, SceneError), scene)


def read_scene(text: str, source: str) -> Scene:
    """Return the scene that the TOML `text` states; `source` names it in errors.

    Raises
    ------
    SceneError
        One line: file, key, value and rule.
    """
    tables = read_tables(text, source, SceneError)
    try:
        return _scene(tables)
    except FieldError as error:
        raise SceneError(source, str(error)) from None


def _scene(tables: dict[str, Any]) -> Scene:
    check_keys(tables, {"scene", *LISTS}, required=("scene", "beam"))
    if not isinstance(tables["scene"], dict):
        raise FieldError("scene", tables["scene"], "must be a table, [scene]")
    lists: dict[str, Any] = {
        f"{kind}s": _records(LISTS[kind], tables[kind], kind) for kind in LISTS if kind in tables
    }
    own = {item.name for item in fields(Scene)} - {f"{kind}s" for kind in LISTS}
    try:
        check_keys(tables["scene"], own, required=("name", "load_parameters"))
    except FieldError as error:
        raise error.within("scene.") from None
    try:
        return Scene(**tables["scene"], **lists)
    except FieldError as error:
        raise (error.within("scene.") if error.key in own else error) from None


def _records(kind: type, tables: object, key: str) -> tuple[object, ...]:
    if not isinstance(tables, list) or not tables or not all(isinstance(table, dict) for table in tables):
        raise FieldError(key, tables, f"must be a list of tables, [[{key}]]")
    return tuple(_record(kind, table, f"{key}[{i}].") for i, table in enumerate(tables))


def _record(kind: type[Record], table: dict[str, Any], prefix: str) -> Record:
    known = fields(kind)  # type: ignore[arg-type]  # every kind is a dataclass
    try:
        required = tuple(item.name for item in known if item.default is NO_DEFAULT)
        check_keys(table, {item.name for item in known}, required)
        inner = STAGE_LISTS if kind is StageSpec else {}
        lists = {name: _records(inner[name], value, name) for name, value in table.items() if name in inner}
        return kind(**{**table, **lists})
    except FieldError as error:
        raise error.within(prefix) from None
