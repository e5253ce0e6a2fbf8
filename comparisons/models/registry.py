"""The models by name: each solves a scene and states its response."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from comparisons.models.options import OPTIONS, ModelError, Options
from comparisons.models.progress import Watch, unwatched

if TYPE_CHECKING:
    from collections.abc import Callable

    from comparisons.response import Response
    from comparisons.scene import Scene

Certify = Literal["last", "all", "none"]
"""Load parameters to certify: the last and those beside events, every one, or none."""
COARSE = 5e-2
"""Distance from the exact equilibrium that a coarse mesh may leave: an answer further away is refused."""


def _tsm(scene: Scene, options: Options, watch: Watch) -> Response:
    from comparisons.models.discrete import solve_tsm

    return solve_tsm(scene, options, watch)


def _solid(scene: Scene, options: Options, watch: Watch) -> Response:
    from comparisons.models.discrete import solve_solid

    return solve_solid(scene, options, watch)


def _rod(scene: Scene, options: Options, watch: Watch) -> Response:
    from comparisons.models.exact import solve_rod

    return solve_rod(scene, options, watch)


def _elastica(scene: Scene, options: Options, watch: Watch) -> Response:
    from comparisons.models.exact import solve_elastica

    return solve_elastica(scene, options, watch)


MODELS: dict[str, Callable[[Scene, Options, Watch], Response]] = {
    "tsm": _tsm,
    "solid": _solid,
    "rod": _rod,
    "elastica": _elastica,
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
        if value is not None and option not in OPTIONS[model]:
            raise ModelError(f"{model}: {option} = {value}: not an option of this model")
    try:
        return verified(MODELS[model](scene, given, watch), scene)
    except ValueError as error:
        raise ModelError(f"{model}: {error}") from error


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
