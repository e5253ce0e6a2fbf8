"""The output of another program, read as a response and held against the scene."""

import re
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.files import one_line
from comparisons.models.options import ModelError
from comparisons.models.outside.child import ProgramError, ProgramStatus
from comparisons.models.verify import CHECK_FAILED
from comparisons.referee.certificate import Verdict
from comparisons.response import Array, ContactHistory, Response, SupportHistory
from comparisons.response.axis import SampledAxes, axis_grid, sampled_axes
from comparisons.response.file import SCHEMA, NotFiniteError, contradictions, parsed, restated
from comparisons.scene import Scene
from comparisons.scene.rules import FieldError
from comparisons.scene.tables import check_keys

COMPLETED, REFUSED = "COMPLETED", "REFUSED"
SHOWN = 60
"""Bytes that are shown of an output that is not JSON."""
WORD = re.compile(r"[A-Z][A-Z0-9_]{,39}")
"""How a program names what stopped it."""
VERDICTS = {*Verdict.__members__, CHECK_FAILED}
"""Words that this program alone says of an answer."""


def refusal(output: bytes) -> str | None:
    """Return why the program cannot state the scene; None if it can."""
    try:
        data = _parsed(output)
    except ProgramError:
        return None
    return _reason(data) if data.get("status") == REFUSED else None


def _reason(data: dict[str, Any]) -> str:
    return one_line(data.get("message") or "no reason given")


def answer(output: bytes, scene: Scene, model: str, seconds: float) -> Response:
    """Return the response that a program wrote, JSON by `comparisons.response.file.SCHEMA`; it took `seconds` if it states no time itself.

    The program states its status, and may leave out what follows from the rest: names of model and scene, message, tips, numbers of
    iterations, wall time. An answer that is not COMPLETED may leave out all histories. A scene that the program refuses is a `ModelError`,
    an output that is no response to the scene a `ProgramError`.
    """
    data = _parsed(output)
    status = data.get("status")
    if status == REFUSED:
        raise ModelError(_reason(data))
    reported = status == COMPLETED
    known = {"scene": scene.name, "message": "as the program reports", "wall_seconds": seconds}
    try:
        for mistake in check_keys(data, SCHEMA["properties"], required=("status",)):
            raise mistake
        _check_status(status)
        if not reported and "load_parameter" not in data:
            return silent(scene, model, str(status), data.get("message", known["message"]))
        response = restated({**known, **data, "model": model})
        lines = sampled_axes(response).position
        if "tips" not in data:
            response = replace(response, tips=_tips(scene, lines))
        wrong = next(contradictions(response, scene), "")
    except NotFiniteError as error:
        raise ProgramError(ProgramStatus.NOT_FINITE, str(error), reported_success=reported) from None
    except FieldError as error:
        wrong = str(error)
    if wrong:
        raise ProgramError(ProgramStatus.INVALID_RESPONSE, wrong, reported_success=reported)
    return replace(
        response,
        outside=True,
        load_parameter=np.array(scene.times[: len(response.load_parameter)]),
        contacts={pair: penetrating(item) for pair, item in response.contacts.items()},
        grid=lambda k: axis_grid(scene, response.axis_line, k),
    )


def _tips(scene: Scene, lines: dict[str, Array]) -> dict[str, Array]:
    """Return the positions of the tips, the ends of the axes that are stated."""
    ends = {beam.name: -1 if scene.tip(beam.name) == "end" else 0 for beam in scene.beams}
    return {
        name: line[:, ends[name]] if line.size else np.empty((0, 2))
        for name, line in lines.items()
        if name in ends
    }


def silent(
    scene: Scene, model: str, status: str, message: object, *, reported_success: bool = False
) -> Response:
    """Return a response without any load parameter, which states why there is none."""
    none, pairs = np.empty(0), np.empty((0, 2))
    return Response(
        status=status,
        message=one_line(message),
        model=model,
        scene=scene.name,
        outside=True,
        reported_success=reported_success,
        contacts={
            spec.pair: ContactHistory(force=none, arc_position=none, gap=none) for spec in scene.contacts
        },
        supports={spec.node: SupportHistory(force=pairs, moment=none) for spec in scene.all_supports},
        tips={beam.name: pairs for beam in scene.beams},
        wall_seconds=0.0,
        axis_line=SampledAxes(arc_length={}, position={}),
    )


def _parsed(output: bytes) -> dict[str, Any]:
    try:
        data = parsed(output.decode("utf-8"))
    except FieldError as error:
        raise ProgramError(ProgramStatus.INVALID_RESPONSE, str(error)) from None
    except (ValueError, RecursionError) as error:
        begin = one_line(output[:SHOWN].decode("utf-8", errors="replace"))
        words = f"{len(output)} bytes written" + (f", they begin with: {begin}" if begin else "")
        raise ProgramError(ProgramStatus.INVALID_JSON, f"{error}; {words}") from None
    if not isinstance(data, dict):
        raise ProgramError(ProgramStatus.INVALID_RESPONSE, "the output must be a table")
    return data


def _check_status(status: object) -> None:
    """Refuse what is no name of a stop, as a misspelt success, and the words that only this program says of an answer."""
    if not isinstance(status, str) or not WORD.fullmatch(status) or status in VERDICTS:
        rule = f"must be {COMPLETED}, in capitals, {REFUSED}, or another word in capitals"
        raise FieldError("status", status, f"{rule} that is no verdict of this program")


def penetrating(contact: ContactHistory) -> ContactHistory:
    """Return a contact whose negative gaps are the penetration of a penalty."""
    pressing = contact.force if contact.friction is None else contact.friction.normal
    deep = (contact.force > 0.0) & (contact.gap < 0.0) & (pressing > 0.0)
    per_force = np.divide(-contact.gap, pressing, out=np.zeros_like(contact.force), where=deep)
    return replace(contact, compliance=per_force)
