"""A response as JSON, written and read by one table of fields: ``response.schema.json``.

Beside the keywords of JSON Schema, a field has its ``shape``, with the number of load parameters s and of points m, and ``gaps``: where a
number may be missing, which is null in the file and nan here. Such a number is needed where the field that ``gaps`` names acts. A table
has the ``record`` of `comparisons.answer.record` that is made of it.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer import record
from comparisons.answer.axis import SampledAxes, sampled_axes
from comparisons.answer.material import clamped
from comparisons.answer.record import Array
from comparisons.answer.response import Response
from comparisons.files import one_line
from comparisons.output import json_text
from comparisons.scene import Scene, load_scene
from comparisons.scene.rules import MISSING, FieldError
from comparisons.scene.tables import InputError, check_keys, read_text
from comparisons.version import versions

SCHEMA: dict[str, Any] = json.loads(
    Path(__file__).with_name("response.schema.json").read_text(encoding="utf-8")
)
"""Every field of a response in JSON."""
LARGEST_WHOLE = 1e15
"""Largest magnitude of a whole number."""
SAME_LOAD = 1e-6
"""Largest difference between a load parameter of the scene and of the answer, which may be printed with few digits."""
Field = dict[str, Any]
"""A schema."""
Sizes = dict[str, int]
"""Numbers of load parameters and points that are known, by their letters in a shape."""


class NotFiniteError(FieldError):
    """A number that is infinite, or missing where there must be one."""


def as_json(response: Response, **more: Any) -> str:
    """Return the response and the tables `more` as JSON text; a value that is not a number is null."""
    return json_text({**as_dict(response), "versions": versions(), **more})


def as_dict(response: Response) -> dict[str, Any]:
    """Return what a response states, by the names of the JSON file; `restated` reads all of it but the certificate."""
    axes = vars(sampled_axes(response))
    found = {beam: {key: one[beam] for key, one in axes.items()} for beam in axes["arc_length"]}
    judged = response.certificate and response.certificate.as_dict()
    values = {**vars(response), "stage": response.stage, "axes": found, "certificate": judged}
    stated: dict[str, Any] = _stated(SCHEMA, values)
    return stated


def _stated(field: Field, value: Any) -> Any:
    """Return the fields of a record, without those that may be left out and have nothing to say."""
    field = resolved(field)
    if value is None or "readOnly" in field:
        return value
    if "properties" in field:
        values = value if isinstance(value, dict) else vars(value)
        silent = {key for key, one in values.items() if one is None or (isinstance(one, dict) and not one)}
        return {
            key: _stated(one, values[key])
            for key, one in field["properties"].items()
            if key in values and (key in field["required"] or key not in silent)
        }
    if isinstance(value, Mapping):
        named = field.get("additionalProperties", {})
        return {name: _stated(named, one) for name, one in value.items()}
    return [_stated(field["items"], one) for one in value] if isinstance(value, tuple) else value


def read_response(path: str, scene: str | None = None) -> tuple[Response, Scene]:
    """Return the response that the JSON file `path` states, as ``crossval solve --out`` writes it, and its scene.

    The response has no grid. The scene is the one that the response names, unless another one is given.

    Raises InputError, in one line: file, key, value and rule.
    """
    text = read_text(path)
    try:
        response = restated(parsed(text))
    except FieldError as error:
        raise InputError(path, one_line(error)) from None
    except (ValueError, RecursionError) as error:
        raise InputError(path, one_line(f"must be valid JSON: {error}")) from None
    found = load_scene(scene or response.scene)
    for wrong in contradictions(response, found):
        raise InputError(path, one_line(wrong))
    return response, found


def parsed(text: str) -> Any:
    """Return what a text in JSON states; a key that stands twice in its table is a `FieldError`."""

    def once(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
        table: dict[str, Any] = {}
        for key, value in pairs:
            if key in table:
                raise FieldError(key, value, "must stand once in its table")
            table[key] = value
        return table

    return json.loads(text, object_pairs_hook=once)


def restated(data: Any) -> Response:
    """Return the response that the tables of `as_dict` state.

    Raises FieldError if a table, a list of numbers or a name is missing or of another shape.
    """
    found = _read(SCHEMA, data, "", {})
    axes = found.pop("axes")
    if found["reported_success"] is None:
        found["reported_success"] = found["status"] == "COMPLETED"
    if found["newton_iterations"] is None:
        found["newton_iterations"] = np.zeros(len(found["load_parameter"]), dtype=np.int64)
    line = {key: {beam: axis[key] for beam, axis in axes.items()} for key in ("arc_length", "position")}
    return Response(**found, axis_line=SampledAxes(**line))


def resolved(field: Field) -> Field:
    """Return a field with what the schema defines for it by name, its ``record`` too."""
    name = field.get("$ref", "").rpartition("/")[2]
    return {**SCHEMA["$defs"].get(name, {}), **field}


def require(right: object, key: str, value: object, rule: str) -> None:
    """Raise FieldError unless a value is right."""
    if not right:
        raise FieldError(key, value, rule)


def _read(field: Field, value: Any, key: str, sizes: Sizes) -> Any:
    """Return a value that its field allows; the sizes that it has first are added to those known."""
    field = resolved(field)
    kinds = field.get("type", "string")
    single = "number" in kinds and "shape" not in field
    if value is None and not single and ("null" in kinds or field.get("default", MISSING) is None):
        return None
    if single or "shape" in field:
        return _numbers(field, value, key, sizes)
    if "object" in kinds:
        return _table(field, value, key, sizes)
    if "array" in kinds:
        require(isinstance(value, list), key, value, "must be a list")
        return tuple(_read(field["items"], item, key, sizes) for item in value)
    if kinds == "integer":
        require(type(value) is int and abs(value) <= LARGEST_WHOLE, key, value, "must be a whole number")
    if kinds == "string":
        require(key == "message" or isinstance(value, str), key, value, "must be a name")
        return one_line(value)
    return value is True if kinds == "boolean" else value


def _table(field: Field, value: Any, key: str, sizes: Sizes) -> Any:
    """Return a table by name, or the record of a table with fields."""
    rule = "must be a table, as `crossval solve --out` writes it"
    require(isinstance(value, dict), key or "file", value, rule)
    prefix = f"{key}." if key else ""
    if "properties" not in field:
        named = field["additionalProperties"]
        return {name: _read(named, one, prefix + name, sizes) for name, one in value.items()}
    for mistake in check_keys(value, field["properties"], () if key else ("status",)):
        raise mistake.within(prefix)
    found, sizes = {}, dict(sizes)
    for name, one in field["properties"].items():
        if "readOnly" not in one:
            found[name] = _read(one, value.get(name, one.get("default", MISSING)), prefix + name, sizes)
    for name, one in field["properties"].items():
        if one.get("gaps") and found[name] is not None:
            acts = found[one["gaps"]]
            needed = bool(acts) if isinstance(acts, str) else acts != 0.0
            _check_finite(np.asarray(found[name]), prefix + name, needed)
    return getattr(record, field["record"])(**found) if "record" in field else found


def _numbers(field: Field, value: Any, key: str, sizes: Sizes) -> Any:
    """Return a number or an array of numbers."""
    names = field.get("shape", [])
    shape = tuple(sizes.get(size) if isinstance(size, str) else size for size in names)
    found = _array(value)
    if found is not None and found.size == 0 and 0 in shape:
        found = np.zeros([size or 0 for size in shape])
    if (
        found is None
        or found.ndim != len(shape)
        or any(size not in (None, own) for size, own in zip(shape, found.shape, strict=True))
    ):
        has = f", has {_sizes(found.shape)}" if found is not None and found.ndim else ""
        raise FieldError(key, value, _rule(shape) + has)
    _check_finite(found, key, ~np.isnan(found) if "gaps" in field else np.True_)
    if not shape:
        return float(found)
    if names == ["m"] and sizes["s"]:
        rises = len(found) > 1 and np.all(np.diff(found) > 0.0)
        require(rises, key, value, "must be two or more increasing numbers")
    sizes |= {name: own for name, own in zip(names, found.shape, strict=True) if isinstance(name, str)}
    item = field["items"]
    if "enum" in item:
        rule = f"must be a list of {', '.join(map(str, item['enum']))}"
        require(np.isin(found, item["enum"]).all(), key, value, rule)
    elif item.get("type") != "integer":
        return found
    whole = np.all(np.abs(found) <= LARGEST_WHOLE) and not np.any(found % 1.0)
    require(whole, key, value, "must be a list of whole numbers")
    return found.astype(np.int64)


def _array(value: object) -> Array | None:
    """Return a number, or lists of numbers, as an array; None for anything else, as a text or truth value."""
    cells = np.array(value, dtype=object)
    if not {*map(type, cells.ravel())} <= {int, float, type(None)}:
        return None
    try:
        return cells.astype(np.float64)
    except OverflowError:
        return None


def _check_finite(numbers: Array, key: str, needed: Any) -> None:
    """Refuse a number that is not finite where, along the first axis, one is needed."""
    wrong = np.argwhere((~np.isfinite(numbers.T) & np.transpose(needed)).T)
    if len(wrong):
        place = tuple(wrong[0].tolist())
        name = key + "".join(f"[{number}]" for number in place)
        raise NotFiniteError(name, float(numbers[place]), "must be a finite number")


def _rule(shape: tuple[int | None, ...]) -> str:
    """Return the rule of a shape in words, as ``must be a list of 5 x 2 numbers, x and y for each load parameter``."""
    if not shape:
        return "must be a number"
    if shape == (None,):
        return "must be a list of numbers"
    each = ("one ", "x and y ", "x and y of each point ")[len(shape) - 1]
    legend = "" if shape[0] is None else f", {each}for each load parameter"
    return f"must be a list of {_sizes(shape)} numbers{legend}"


def _sizes(shape: tuple[int | None, ...]) -> str:
    return " x ".join("any number" if size is None else str(size) for size in shape)


def contradictions(response: Response, scene: Scene) -> Iterator[str]:
    """Yield differences between the names and numbers of load parameters of an answer and those of the scene."""
    if response.scene != scene.name:
        yield f"scene = {response.scene}: the scene was {scene.name}"
    t = response.load_parameter
    times = np.array(scene.times[: len(t)])
    if len(t) > len(scene.times) or not np.all(np.abs(t - times) <= min(SAME_LOAD, scene.times[0] / 4)):
        yield "load_parameter: must be those of the scene, from the first on"
    if response.completed and len(t) < len(scene.times):
        yield f"load_parameter: has {len(t)} of {len(scene.times)} load parameters, and the status is COMPLETED"
    if not len(t):
        return
    arcs = sampled_axes(response).arc_length
    beams, own = {beam.name for beam in scene.beams}, vars(response) | {"axes": arcs}
    for what, wanted in {
        "contacts": {spec.pair for spec in scene.contacts},
        "supports": {spec.node for spec in scene.all_supports},
        "springs": {spec.node for spec in scene.springs},
        "material_force": response.material_force.keys() & clamped(scene).keys(),
        "axes": beams,
        "tips": beams,
    }.items():
        if own[what].keys() != wanted:
            names = ", ".join(sorted(wanted)) or "none"
            yield f"{what}: must have {names}, has {', '.join(sorted(own[what])) or 'none'}"
    for name, arc in arcs.items():
        length = scene.beam(name).length
        if not np.all(np.abs(arc[[0, -1]] - [0.0, length]) <= SAME_LOAD * length):
            yield f"axes.{name}.arc_length: must run from 0 to the length {length:g}"
