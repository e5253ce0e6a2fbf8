"""The output of another program, read as a response and held against the scene."""

import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.files import printable
from comparisons.models.options import ModelError
from comparisons.models.outside.status import ProgramError, ProgramStatus
from comparisons.response import ContactHistory, Grid, Response, SupportHistory
from comparisons.response.axis import SampledAxes
from comparisons.response.from_json import restated
from comparisons.response.material import clamped
from comparisons.response.to_json import as_dict
from comparisons.scene import Scene
from comparisons.scene.rules import FieldError
from comparisons.scene.tables import check_keys

Array = NDArray[np.float64]

COMPLETED, REFUSED = "COMPLETED", "REFUSED"
SHOWN = 60
"""Bytes that are shown of an output that is not JSON."""
SAME_LOAD = 1e-6
"""Largest difference between a load parameter of the scene and of the answer, which may be printed with few digits."""


def refusal(output: bytes) -> str | None:
    """Return why the program cannot state the scene; None if it can."""
    try:
        data = _parsed(output)
    except ProgramError:
        return None
    if data.get("status") != REFUSED:
        return None
    return " ".join(str(data.get("message") or "no reason given").split())


def answer(output: bytes, scene: Scene, model: str, seconds: float) -> Response:
    """Return the response that a program wrote.

    The program states its status, and may leave out what follows from the rest: names of model and scene, message, tips, numbers of
    iterations, wall time. An answer that is not COMPLETED may leave out all histories.

    Parameters
    ----------
    output : bytes
        Standard output of the program, JSON by ``docs/reference/response.schema.json``.
    scene : Scene
        The scene that was solved.
    model : str
        Name of the program.
    seconds : float
        Wall time of the process, where the program does not state the time of its solution [s].

    Raises
    ------
    ModelError
        If the program states that it cannot state the scene.
    ProgramError
        If the output is no response to the scene.
    """
    reason = refusal(output)
    if reason is not None:
        raise ModelError(reason)
    data = _parsed(output)
    reported = data.get("status") == COMPLETED
    if not reported and isinstance(data.get("status"), str) and "load_parameter" not in data:
        return silent(scene, model, str(data["status"]), str(data.get("message", "as the program reports")))
    try:
        known = {*as_dict(silent(scene, model, "", "")), "versions"}
        for mistake in check_keys(data, known, required=("status",)):
            raise mistake
        _check_status(data["status"])
        response = restated({**_defaults(data, scene, seconds), "model": model})
        wrong = next(_contradictions(response, scene), "")
    except FieldError as error:
        wrong = str(error)
    if wrong:
        raise ProgramError(ProgramStatus.INVALID_RESPONSE, wrong, reported_success=reported)
    unknown = next(_not_finite(response), "")
    if unknown:
        raise ProgramError(ProgramStatus.NOT_FINITE, f"{unknown} is not finite", reported_success=reported)
    axes = response.axis_line
    assert isinstance(axes, SampledAxes), "a response that was read has sampled axes"
    return replace(
        response,
        outside=True,
        load_parameter=np.array(scene.times[: len(response.load_parameter)]),
        contacts={pair: _penetrating(item) for pair, item in response.contacts.items()},
        grid=lambda k: axis_grid(scene, axes, k),
    )


def silent(
    scene: Scene, model: str, status: str, message: str, *, reported_success: bool = False
) -> Response:
    """Return a response without any load parameter, which states why there is none."""
    none, pairs = np.empty(0), np.empty((0, 2))
    return Response(
        model=model,
        scene=scene.name,
        status=status,
        message=message,
        completed=False,
        outside=True,
        reported_success=reported_success,
        load_parameter=none,
        contacts={
            spec.pair: ContactHistory(force=none, arc_position=none, gap=none) for spec in scene.contacts
        },
        supports={spec.node: SupportHistory(force=pairs, moment=none) for spec in scene.all_supports},
        tips={beam.name: pairs for beam in scene.beams},
        newton_iterations=np.empty(0, dtype=np.int64),
        cutbacks=0,
        unknowns=0,
        wall_seconds=0.0,
        axis_line=SampledAxes(arc_length={}, position={}),
        grid=lambda k: axis_grid(scene, SampledAxes(arc_length={}, position={}), k),
    )


def axis_grid(scene: Scene, axes: SampledAxes, k: int) -> Grid:
    """Return the axes of all beams as lines, with their displacements."""
    points, deformed, lines, numbers, count = [], [], [], [], 0
    for name, arc in axes.arc_length.items():
        beam = scene.beam(name)
        numbers.append(np.full(len(arc), scene.beams.index(beam)))
        points.append(np.array(beam.start) + np.outer(arc, beam.direction))
        deformed.append(axes.position[name][k])
        number = count + np.arange(len(arc) - 1)
        lines.append(np.stack([number, number + 1], axis=1))
        count += len(arc)
    there, line = np.concatenate(points), np.concatenate(deformed)
    return Grid(
        points=there,
        cells={"line": np.concatenate(lines)},
        point_data={"displacement": line - there, "deformed": line, "beam": np.concatenate(numbers)},
    )


def _parsed(output: bytes) -> dict[str, Any]:
    try:
        data = json.loads(output.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        begin = printable(" ".join(output[:SHOWN].decode("utf-8", errors="replace").split()))
        words = f"{len(output)} bytes written" + (f", they begin with: {begin}" if begin else "")
        raise ProgramError(ProgramStatus.INVALID_JSON, f"{error}; {words}") from None
    if not isinstance(data, dict):
        raise ProgramError(ProgramStatus.INVALID_RESPONSE, "the output must be a table")
    return data


def _check_status(status: object) -> None:
    """Refuse a misspelt success or refusal, which would pass for the name of what stopped the program."""
    word = str(status).strip().upper()
    if status != word and word in {COMPLETED, REFUSED}:
        raise FieldError("status", status, f"must be {word}, in capitals")


def _defaults(data: dict[str, Any], scene: Scene, seconds: float) -> dict[str, Any]:
    """Return the tables of the program with the items that follow from them or from the scene."""
    more: dict[str, Any] = {
        "scene": scene.name,
        "message": "as the program reports",
        "contacts": {},
        "wall_seconds": seconds,
    }
    axes = data.get("axes")
    if isinstance(axes, dict) and "tips" not in data:
        more["tips"] = {
            beam.name: _ends(axes.get(beam.name), -1 if scene.tip(beam.name) == "end" else 0)
            for beam in scene.beams
        }
    return {**more, **data}


def _ends(axis: Any, end: int) -> Any:
    """Return the first or last point of an axis at each load parameter; None if it has no such points."""
    try:
        return [line[end] for line in axis["position"]]
    except (TypeError, KeyError, IndexError):
        return None


def _contradictions(response: Response, scene: Scene) -> Iterator[str]:
    """Yield differences between the names and numbers of load parameters of an answer and those of the scene."""
    if response.scene != scene.name:
        yield f"scene = {response.scene}: the scene was {scene.name}"
    t = response.load_parameter
    times = np.array(scene.times[: len(t)])
    if len(t) > len(scene.times) or not np.all(np.abs(t - times) <= min(SAME_LOAD, scene.times[0] / 4)):
        yield "load_parameter: must be those of the scene, from the first on"
    if response.completed and len(t) < len(scene.times):
        yield f"load_parameter: has {len(t)} of {len(scene.times)} load parameters, and the status is {COMPLETED}"
    axes = response.axis_line
    assert isinstance(axes, SampledAxes), "a response that was read has sampled axes"
    beams = {beam.name for beam in scene.beams}
    driven = response.material_force.keys()
    for what, own, wanted in (
        ("contacts", response.contacts.keys(), {spec.pair for spec in scene.contacts}),
        ("supports", response.supports.keys(), {spec.node for spec in scene.all_supports}),
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


def _not_finite(response: Response) -> Iterator[str]:
    """Yield the names of items with a number that is not finite; arc position and gap are free where a contact is open."""
    axes = response.axis_line
    assert isinstance(axes, SampledAxes), "a response that was read has sampled axes"
    items: list[tuple[str, Array]] = []
    for pair, contact in response.contacts.items():
        closed = contact.force != 0.0
        items += [(f"the force of {pair}", contact.force)]
        items += [(f"the arc position of {pair}", contact.arc_position[closed])]
        items += [(f"the gap of {pair}", contact.gap[closed])]
        if contact.vector is not None:
            items += [(f"the force vector of {pair}", contact.vector[closed])]
    for node, support in response.supports.items():
        items += [(f"the support force of {node}", support.force)]
        items += [(f"the support moment of {node}", support.moment)]
    items += [(f"the tip of {beam}", tip) for beam, tip in response.tips.items()]
    items += [(f"the axis of {beam}", line) for beam, line in axes.position.items()]
    yield from (name for name, numbers in items if not np.all(np.isfinite(numbers)))


def _penetrating(contact: ContactHistory) -> ContactHistory:
    """Return a contact whose negative gaps are the penetration of a penalty."""
    deep = (contact.force > 0.0) & (contact.gap < 0.0)
    per_force = np.divide(-contact.gap, contact.force, out=np.zeros_like(contact.force), where=deep)
    return replace(contact, compliance=per_force)
