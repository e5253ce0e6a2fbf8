"""Reader of a response in a JSON file."""

import json
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.files import one_line
from comparisons.response import (
    ContactEvent,
    ContactHistory,
    CriticalPoint,
    FrictionHistory,
    Response,
    SupportHistory,
)
from comparisons.response.axis import SampledAxes, no_grid
from comparisons.response.material import clamped
from comparisons.scene import Scene, load_scene
from comparisons.scene.rules import MISSING, FieldError
from comparisons.scene.tables import InputError, check_keys, read_text

Array = NDArray[np.float64]

LARGEST_WHOLE = 1e15
"""Largest magnitude of a whole number."""
SAME_LOAD = 1e-6
"""Largest difference between a load parameter of the scene and of the answer, which may be printed with few digits."""
KEYS = {
    "status", "message", "reported_success", "model", "continuum", "outside", "scene", "load_parameter", "stage", "contacts", "supports",
    "springs", "material_force", "tips", "axes", "events", "work", "index", "critical", "certificate", "newton_iterations", "cutbacks",
    "unknowns", "wall_seconds", "versions", "accuracy",
}  # fmt: skip
"""Keys of a response in JSON."""
CONTACT = ("force", "vector", "arc_position", "gap", "slip_off", "friction")
"""Keys of a contact."""


class ResponseError(InputError):
    """A JSON file that does not hold a response to its scene."""


class NotFiniteError(FieldError):
    """A number that is infinite, or missing where there must be one."""


def read_response(path: str, scene: str | None = None) -> tuple[Response, Scene]:
    """Return the response that the JSON file `path` states, as ``crossval solve --out`` writes it, and its scene.

    The response has no grid. The scene is the one that the response names, unless another one is given.

    Raises
    ------
    InputError
        One line: file, key, value and rule.
    """
    text = read_text(path, "no such file", ResponseError)
    try:
        data = json.loads(text, object_pairs_hook=once)
        for mistake in check_keys(_table({"": data}, ""), KEYS, required=("status",)):
            raise mistake
        response = restated(data)
    except FieldError as error:
        raise ResponseError(path, one_line(error)) from None
    except (ValueError, RecursionError) as error:
        raise ResponseError(path, one_line(f"must be valid JSON: {error}")) from None
    found = load_scene(scene or response.scene)
    for wrong in contradictions(response, found):
        raise ResponseError(path, one_line(wrong))
    return response, found


def once(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return a table of JSON, none of whose keys stands there twice."""
    table: dict[str, Any] = {}
    for key, value in pairs:
        if key in table:
            raise FieldError(key, value, "must stand once in its table")
        table[key] = value
    return table


def restated(data: Any) -> Response:
    """Return the response that the tables of `comparisons.response.to_json.as_dict` state.

    Raises
    ------
    FieldError
        If a table, a list of numbers or a name is missing or of another shape.
    """
    data = _table({"": data}, "")
    load_parameter = _numbers(data, "load_parameter", (None,))
    steps = len(load_parameter)
    axes = {beam: _axis(item, f"axes.{beam}.", steps) for beam, item in _tables(data, "axes").items()}
    contacts = {
        pair: _contact(item, f"contacts.{pair}.", steps) for pair, item in _tables(data, "contacts").items()
    }
    supports = {node: _support(node, item, steps) for node, item in _tables(data, "supports").items()}
    springs = {
        end: _support(end, item, steps, "springs")
        for end, item in _tables({"springs": {}, **data}, "springs").items()
    }
    tips = _table(data, "tips")
    material = _table({"material_force": {}, **data}, "material_force")
    iterations = _given(data, "newton_iterations", (steps,))
    return Response(
        model=_text(data, "model"),
        scene=_text(data, "scene"),
        status=_text(data, "status"),
        message=one_line(data.get("message", "read back")),
        completed=data["status"] == "COMPLETED",
        reported_success=data.get("reported_success", data["status"] == "COMPLETED") is True,
        continuum=data.get("continuum") is True,
        outside=data.get("outside") is True,
        load_parameter=load_parameter,
        contacts=contacts,
        supports=supports,
        springs=springs,
        material_force={beam: _numbers(material, beam, (steps,), "material_force.") for beam in material},
        tips={beam: _numbers(tips, beam, (steps, 2), "tips.") for beam in tips},
        newton_iterations=np.zeros(steps, dtype=np.int64) if iterations is None else iterations,
        cutbacks=_whole(data, "cutbacks"),
        unknowns=_whole(data, "unknowns"),
        wall_seconds=float(_numbers({"wall_seconds": 0.0, **data}, "wall_seconds", (), gaps=True)),
        axis_line=SampledAxes(
            arc_length={beam: arc for beam, (arc, _) in axes.items()},
            position={beam: position for beam, (_, position) in axes.items()},
        ),
        grid=no_grid,
        events=_events(data),
        work=None if data.get("work") is None else _numbers(data, "work", (steps,)),
        index=_given(data, "index", (steps,)),
        critical=tuple(_critical(point) for point in _list(data, "critical")),
    )


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
    axes = response.axis_line
    assert isinstance(axes, SampledAxes), "a response that was read has sampled axes"
    beams = {beam.name for beam in scene.beams}
    driven = response.material_force.keys()
    for what, own, wanted in (
        ("contacts", response.contacts.keys(), {spec.pair for spec in scene.contacts}),
        ("supports", response.supports.keys(), {spec.node for spec in scene.all_supports}),
        ("springs", response.springs.keys(), {spec.node for spec in scene.springs}),
        ("tips", response.tips.keys(), beams),
        ("material_force", driven, driven & clamped(scene).keys()),
        ("axes", axes.arc_length.keys(), beams),
    ):
        if own != wanted:
            names = ", ".join(sorted(wanted)) or "none"
            yield f"{what}: must have {names}, has {', '.join(sorted(own)) or 'none'}"
    for name, arc in axes.arc_length.items():
        length = scene.beam(name).length
        if len(arc) and not (
            abs(arc[0]) <= SAME_LOAD * length and abs(arc[-1] - length) <= SAME_LOAD * length
        ):
            yield f"axes.{name}.arc_length: must run from 0 to the length {length:g}"


def _given(data: dict[str, Any], key: str, shape: tuple[int]) -> NDArray[np.int64] | None:
    """Return a list of whole numbers; None where the file does not have it."""
    if data.get(key) is None:
        return None
    found = _numbers(data, key, shape)
    if np.any(np.abs(found) > LARGEST_WHOLE) or np.any(found % 1.0):
        raise FieldError(key, data[key], "must be a list of whole numbers")
    return found.astype(np.int64)


def _whole(data: dict[str, Any], key: str) -> int:
    """Return a whole number, 0 where the file does not have it."""
    found = data.get(key, 0)
    if type(found) is not int or abs(found) > LARGEST_WHOLE:
        raise FieldError(key, found, "must be a whole number")
    return found


def _list(data: dict[str, Any], key: str) -> list[Any]:
    """Return a list, an empty one where the file does not have it."""
    found = data.get(key, [])
    if not isinstance(found, list):
        raise FieldError(key, found, "must be a list")
    return found


def _critical(data: Any) -> CriticalPoint:
    point = _table({"critical": data}, "critical")
    mode = _table(point, "mode")
    return CriticalPoint(
        kind=_text(point, "kind"),
        load_parameter=float(_numbers(point, "load_parameter", ())),
        mode={beam: _numbers(mode, beam, (None, 2), "critical.mode.") for beam in mode},
    )


def _table(data: dict[str, Any], key: str, prefix: str = "") -> dict[str, Any]:
    found = data.get(key, MISSING)
    if not isinstance(found, dict):
        rule = "must be a table, as `crossval solve --out` writes it"
        raise FieldError(prefix + key or "file", found, rule)
    return found


def _tables(data: dict[str, Any], key: str) -> dict[str, dict[str, Any]]:
    found = _table(data, key)
    return {name: _table(found, name, f"{key}.") for name in found}


def _text(data: dict[str, Any], key: str) -> str:
    found = data.get(key, MISSING)
    if not isinstance(found, str):
        raise FieldError(key, found, "must be a name")
    return one_line(found)


def _plain(value: object, depth: int) -> bool:
    """Whether a value is a number or null, or a list of these that is so deep at most; a text or truth value is no number."""
    if isinstance(value, list) and depth:
        return all(_plain(item, depth - 1) for item in value)
    return value is None or type(value) in (int, float)


def _numbers(
    data: dict[str, Any], key: str, shape: tuple[int | None, ...], prefix: str = "", *, gaps: bool = False
) -> Array:
    """Return a list of finite numbers; with `gaps`, null is nan."""
    value = data.get(key, MISSING)
    if value is MISSING or not _plain(value, len(shape)):
        raise FieldError(prefix + key, value, _rule(shape))
    try:
        found = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise FieldError(prefix + key, value, _rule(shape)) from None
    if found.size == 0 and 0 in shape:
        return np.zeros([size or 0 for size in shape])
    if found.ndim != len(shape) or any(
        size not in (None, own) for size, own in zip(shape, found.shape, strict=True)
    ):
        has = f", has {_sizes(found.shape)}" if found.ndim else ""
        raise FieldError(prefix + key, value, _rule(shape) + has)
    _check_finite(found, prefix + key, ~(np.isnan(found) & gaps))
    return found


def _check_finite(numbers: Array, key: str, needed: NDArray[np.bool_]) -> None:
    """Refuse a number that is not finite where, along the first axis, one is needed."""
    wrong = np.argwhere((~np.isfinite(numbers.T) & needed.T).T)
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


def _axis(data: dict[str, Any], prefix: str, steps: int) -> tuple[Array, Array]:
    arc = _numbers(data, "arc_length", (None,), prefix)
    if steps and (len(arc) < 2 or not np.all(np.diff(arc) > 0.0)):
        rule = "must be two or more increasing numbers"
        raise FieldError(f"{prefix}arc_length", data["arc_length"], rule)
    return arc, _numbers(data, "position", (steps, len(arc), 2), prefix)


def _contact(data: dict[str, Any], prefix: str, steps: int) -> ContactHistory:
    for mistake in check_keys(data, CONTACT):
        raise mistake.within(prefix)
    force = _numbers(data, "force", (steps,), prefix)
    arc, gap = (_numbers(data, key, (steps,), prefix, gaps=True) for key in ("arc_position", "gap"))
    vector = None if data.get("vector") is None else _numbers(data, "vector", (steps, 2), prefix, gaps=True)
    for key, values in (("arc_position", arc), ("gap", gap), ("vector", vector)):
        if values is not None:
            _check_finite(values, prefix + key, force != 0.0)
    slip_off = float(_numbers({"slip_off": None, **data}, "slip_off", (), prefix, gaps=True))
    friction = _friction(data["friction"], f"{prefix}friction.", steps) if data.get("friction") else None
    return ContactHistory(
        force=force, arc_position=arc, gap=gap, vector=vector, slip_off=slip_off, friction=friction
    )


def _friction(data: Any, prefix: str, steps: int) -> FrictionHistory:
    table = _table({prefix: data}, prefix)
    tangential, normal, dissipated = (
        _numbers(table, key, (steps,), prefix) for key in ("tangential", "normal", "dissipated")
    )
    slip = _numbers(table, "slip", (steps,), prefix)
    if not np.isin(slip, (-1, 0, 1)).all():
        raise FieldError(f"{prefix}slip", MISSING, "must be a list of -1, 0 and 1")
    return FrictionHistory(
        tangential=tangential, normal=normal, slip=slip.astype(np.int64), dissipated=dissipated
    )


def _support(node: str, data: dict[str, Any], steps: int, table: str = "supports") -> SupportHistory:
    if "." not in node:
        rule = (
            f"must be by the supported end, as {node}.start; versions up to 0.5 wrote the beam: solve again"
        )
        raise FieldError(f"{table}.{node}", MISSING, rule)
    prefix = f"{table}.{node}."
    force, moment = _numbers(data, "force", (steps, 2), prefix), _numbers(data, "moment", (steps,), prefix)
    return SupportHistory(force=force, moment=moment)


def _events(data: dict[str, Any]) -> tuple[ContactEvent, ...] | None:
    if data.get("events") is None:
        return None
    return tuple(_event(event) for event in _list(data, "events"))


def _event(data: Any) -> ContactEvent:
    event = _table({"events": data}, "events")
    numbers = {
        key: float(_numbers(event, key, (), "events.", gaps=key == "arc_position" and not event.get("pair")))
        for key in ("load_parameter", "arc_position", "force", "released")
    }
    return ContactEvent(
        kind=_text(event, "kind"),
        pair=_text(event, "pair"),
        element=_whole(event, "element"),
        stage=_whole({"stage": 1, **event}, "stage"),
        **numbers,
    )
