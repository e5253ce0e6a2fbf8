"""Reader of a response in a JSON file."""

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.response import (
    ContactEvent,
    ContactHistory,
    CriticalPoint,
    FrictionHistory,
    Response,
    SupportHistory,
)
from comparisons.response.axis import SampledAxes, no_grid
from comparisons.scene.rules import MISSING, FieldError
from comparisons.scene.tables import InputError, read_text

Array = NDArray[np.float64]

LARGEST_WHOLE = 1e15
"""Largest magnitude of a whole number in a list."""


class ResponseError(InputError):
    """A JSON file that does not hold a response."""


def read_response(path: str) -> Response:
    """Return the response that the JSON file `path` states, as ``crossval solve --json`` writes it.

    The response has no grid.

    Raises
    ------
    ResponseError
        One line: file, key and rule.
    """
    text = read_text(path, "no such file", ResponseError)
    try:
        return restated(json.loads(text))
    except FieldError as error:
        raise ResponseError(path, str(error)) from None
    except (ValueError, RecursionError) as error:
        raise ResponseError(path, f"must be valid JSON: {error}") from None


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
        message=str(data.get("message", "read back")),
        completed=data["status"] == "COMPLETED",
        reported_success=data.get("reported_success") is True,
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
        wall_seconds=float(_numbers({"wall_seconds": 0.0, **data}, "wall_seconds", ())),
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


def _given(data: dict[str, Any], key: str, shape: tuple[int]) -> NDArray[np.int64] | None:
    """Return a list of whole numbers; None where the file does not have it."""
    if data.get(key) is None:
        return None
    found = _numbers(data, key, shape)
    if not np.all(np.abs(found) <= LARGEST_WHOLE):
        raise FieldError(key, data[key], "must be a list of whole numbers")
    return found.astype(np.int64)


def _whole(data: dict[str, Any], key: str) -> int:
    """Return a whole number, 0 where the file does not have it."""
    found = data.get(key, 0)
    if isinstance(found, bool) or not isinstance(found, int):
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
        rule = "must be a table, as `crossval solve --json` writes it"
        raise FieldError(prefix + key or "file", found, rule)
    return found


def _tables(data: dict[str, Any], key: str) -> dict[str, dict[str, Any]]:
    found = _table(data, key)
    return {name: _table(found, name, f"{key}.") for name in found}


def _text(data: dict[str, Any], key: str) -> str:
    found = data.get(key, MISSING)
    if not isinstance(found, str):
        raise FieldError(key, found, "must be a name")
    return found


def _numbers(data: dict[str, Any], key: str, shape: tuple[int | None, ...], prefix: str = "") -> Array:
    """Return a list of numbers, null as nan."""
    value = data.get(key, MISSING)
    try:
        found = np.array(None if value is MISSING else value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise FieldError(prefix + key, value, _rule(shape)) from None
    if found.size == 0 and 0 in shape:
        return np.zeros([size or 0 for size in shape])
    if found.ndim != len(shape) or any(
        size not in (None, own) for size, own in zip(shape, found.shape, strict=True)
    ):
        has = f", has {_sizes(found.shape)}" if found.ndim else ""
        raise FieldError(prefix + key, value, _rule(shape) + has)
    return found


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
    force, arc, gap = (_numbers(data, key, (steps,), prefix) for key in ("force", "arc_position", "gap"))
    vector = None if data.get("vector") is None else _numbers(data, "vector", (steps, 2), prefix)
    slip = data.get("slip_off")
    slip_off = float(slip) if isinstance(slip, int | float) else np.nan
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
        key: float(_numbers(event, key, (), "events."))
        for key in ("load_parameter", "arc_position", "force", "released")
    }
    return ContactEvent(
        kind=_text(event, "kind"),
        pair=_text(event, "pair"),
        element=_whole(event, "element"),
        stage=_whole({"stage": 1, **event}, "stage"),
        **numbers,
    )
