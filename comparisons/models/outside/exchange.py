"""The texts that a program of others reads and writes: the resolved scene, and the response that is held against the scene."""

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.answer.axis import sampled_axes
from comparisons.answer.file import NotFiniteError, contradictions, parsed, require, restated
from comparisons.files import one_line
from comparisons.models.model import ModelError, Options
from comparisons.models.outside.adapters.exchange import Histories
from comparisons.models.outside.child import ProgramError, ProgramStatus
from comparisons.models.shared import joints, kept
from comparisons.models.verify import CHECK_FAILED
from comparisons.referee.certificate import Verdict
from comparisons.scene import BeamSpec, Scene
from comparisons.scene.keys import unstated
from comparisons.scene.rules import MISSING, FieldError

COMPLETED, REFUSED = "COMPLETED", "REFUSED"
SHOWN = 60
"""Bytes that are shown of an output that is not JSON."""
WORD = re.compile(r"[A-Z][A-Z0-9_]{,39}")
"""How a program names what stopped it."""
VERDICTS = {*Verdict.__members__, CHECK_FAILED}
"""Words that this program alone says of an answer."""


def request(scene: Scene, options: Options, load_parameters: Sequence[float]) -> str:
    """Return the resolved scene as JSON text; ``docs/reference/resolved-scene.schema.json`` is its schema.

    All derived quantities are stated: stiffnesses, load parameters, offsets of contacts, positions of pins. The options may have a number
    of elements in place of the scene's. No load parameters ask only whether the program can state the scene. A `ModelError` names a key
    that the resolved scene does not state.
    """
    if (unknown := unstated(scene, "the resolved scene")) is not None:
        raise ModelError(unknown)
    data = {
        "name": scene.name,
        "units": scene.units,
        "load_parameters": list(load_parameters),
        "beams": [_beam(scene, beam, options) for beam in scene.beams],
        "joints": joints(scene),
        "supports": [kept(item, "node beam end motion") for item in scene.all_supports],
        "loads": [kept(item, "node beam end force moment") for item in scene.loads],
        "pins": [
            {
                "name": pin.name,
                "radius": pin.radius or 0.0,
                "path": pin.points if pin.moving else pin.points * 2,
                "corners": pin.corners,
                "positions": [pin.position(t) for t in load_parameters],
            }
            for pin in scene.pins
        ],
        "contacts": [
            kept(item, "pair node beam side keep friction") | {"offset": scene.offset(item)}
            for item in scene.contacts
        ],
    }
    return json.dumps(data, allow_nan=False, indent=1) + "\n"


def _beam(scene: Scene, beam: BeamSpec, options: Options) -> dict[str, Any]:
    area, second_moment, shear_area = beam.section()
    own = "name start end length direction EA GA EI youngs_modulus width height"
    return kept(beam, own) | {
        "tip": scene.tip(beam.name),
        "shear_modulus": beam.GA / shear_area,
        "area": area,
        "second_moment": second_moment,
        "shear_area": shear_area,
        "elements": options.elements or beam.divisions,
    }


def refusal(output: bytes) -> str | None:
    """Return why the program cannot state the scene, None if it can; raise `ProgramError` if it gave no answer."""
    return _reason(_parsed(output))


def _reason(data: dict[str, Any]) -> str | None:
    return one_line(data.get("message") or "no reason given") if data.get("status") == REFUSED else None


def answer(output: bytes, scene: Scene, model: str) -> Response:
    """Return the response that a program wrote, JSON by `comparisons.answer.file.SCHEMA`.

    The program states its status, and may leave out what follows from the rest: names of model and scene, message, tips, numbers of
    iterations, wall time. An answer that is not COMPLETED may leave out all histories. A scene that the program refuses is a `ModelError`,
    an output that is no response to the scene a `ProgramError`.
    """
    data = _parsed(output)
    if (reason := _reason(data)) is not None:
        raise ModelError(reason)
    given: dict[str, Any] = {"message": "as the program reports", "wall_seconds": None}
    status = data.get("status", MISSING)
    reported = status == COMPLETED
    if not reported and "load_parameter" not in data:
        given |= _nothing(scene)
    try:
        # no misspelt success, and no word that only this program says of an answer
        right = isinstance(status, str) and WORD.fullmatch(status) and status not in VERDICTS
        rule = f"must be {COMPLETED}, in capitals, {REFUSED}, or another word in capitals"
        require(right, "status", status, f"{rule} that is no verdict of this program")
        response = restated({"scene": scene.name, **given, **data, "model": model})
        t = np.array(scene.times[: len(response.load_parameter)])
        if "tips" not in data and t.size:
            lines = sampled_axes(response).position
            tips = {beam: line[:, 0 if scene.tip(beam) == "start" else -1] for beam, line in lines.items()}
            response = replace(response, tips=tips)
        wrong = next(contradictions(response, scene), "")
    except NotFiniteError as error:
        raise ProgramError(ProgramStatus.NOT_FINITE, str(error), reported_success=reported) from None
    except FieldError as error:
        wrong = str(error)
    if wrong:
        raise ProgramError(ProgramStatus.INVALID_RESPONSE, wrong, reported_success=reported)
    return replace(response, load_parameter=t)


def unanswered(scene: Scene, model: str, error: ProgramError) -> Response:
    """Return the response without any load parameter which says why there is none."""
    said = {"status": error.status.name, "message": error, "reported_success": error.reported_success}
    return restated({**_nothing(scene), **said, "scene": scene.name, "model": model, "wall_seconds": 0.0})


def _nothing(scene: Scene) -> dict[str, Any]:
    """Return the histories of an answer without any load parameter."""
    histories = Histories(json.loads(request(scene, Options(), ())))
    return {**vars(histories), "tips": {beam.name: [] for beam in scene.beams}}


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
