"""The models by name: each solves a scene and states its response."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING, Literal

from comparisons.models.options import ModelError, Options
from comparisons.models.progress import Watch, unwatched

if TYPE_CHECKING:
    from comparisons.models.base import Model
    from comparisons.response import Response
    from comparisons.scene import Scene

Certify = Literal["last", "all", "none"]
"""Load parameters to certify: the last and those beside events, every one, or none."""
COARSE = 5e-2
"""Distance from the exact equilibrium that a coarse mesh may leave: an answer further away is refused."""


FILES = ("tsm", "solid", "rod")
"""The modules of this package that state models, as ``MODELS``; a new model is one more."""
MODELS: dict[str, Model] = {
    model.name: model for file in FILES for model in import_module(f"comparisons.models.{file}").MODELS
}


def solve(scene: Scene, model: str, options: Options | None = None, watch: Watch = unwatched) -> Response:
    """Return the verified response of `model`, a key of `MODELS`, to `scene`; `watch` is told of every accepted step.

    Raises
    ------
    ModelError
        If the model cannot state the scene or an option does not belong to it.
    """
    from comparisons.models.verify import verified

    if model not in MODELS:
        raise ModelError(f"model = {model}: must be one of {', '.join(MODELS)}")
    given = options or Options()
    for option, value in vars(given).items():
        if value is not None and option not in MODELS[model].options:
            raise ModelError(f"{model}: {option} = {value}: not an option of this model")
    try:
        return verified(MODELS[model].solve(scene, given, watch), scene)
    except ValueError as error:
        raise ModelError(f"{model}: {error}") from error


def references(scene: Scene) -> tuple[tuple[Model, Options], ...]:
    """Return the models without an error of a mesh that can state `scene`, with the options for that, the independent rod first."""
    return tuple(
        (model, model.reference)
        for model in sorted(MODELS.values(), key=lambda model: model.meshed)
        if model.reference is not None and model.refusal(scene) is None
    )


def certified(
    response: Response, scene: Scene, which: Certify = "last", *, allowance: float = COARSE
) -> Response:
    """Return `response` with its certificate; one that is refused has the verdict for its status and is not completed.

    Parameters
    ----------
    response : Response
        The answer of a model; one that stopped keeps its status.
    scene : Scene
        What was asked.
    which : {"last", "all", "none"}
        Load parameters to certify.
    allowance : float
        Largest distance from the exact equilibrium, relative; a solid is allowed its height over its length besides.
    """
    from comparisons.referee import Verdict, certify, default_allowance
    from comparisons.referee.certify import ALLOWED

    if which == "none" or not len(response.load_parameter):
        return response
    every = range(len(response.load_parameter)) if which == "all" else None
    allowed = allowance + default_allowance(response, scene) - ALLOWED
    found = certify(response, scene, at=every, allowance=allowed)
    response = replace(response, certificate=found)
    if not response.completed or found.verdict in {Verdict.CERTIFIED, Verdict.NOT_JUDGED}:
        return response
    return replace(response, status=found.verdict.name, message=found.reason, completed=False)
