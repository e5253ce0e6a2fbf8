"""The registry of models, and the solution of a scene by one of them, with checks and certificate."""

from dataclasses import replace
from functools import partial
from importlib import import_module
from math import isnan
from time import perf_counter
from typing import Any, Literal

from comparisons.answer import Response
from comparisons.answer.axis import axis_grid
from comparisons.answer.material import material_forces
from comparisons.answer.record import not_kept
from comparisons.models.model import Model, ModelError, Options, Watch, unwatched
from comparisons.models.verify import CHECK_FAILED, verified
from comparisons.referee import Certificate, Verdict, certify, default_allowance
from comparisons.referee.certify import ALLOWED
from comparisons.scene import Scene

FILES = ("tsm", "solid", "rod")
"""The modules of this package with a tuple ``MODELS``; a new model adds its module here."""
MODELS: dict[str, Model] = {
    model.name: model for file in FILES for model in import_module(f"comparisons.models.{file}").MODELS
}


def find(name: str) -> Model:
    """Return a model by its name: a key of `MODELS`, a program of others by its name, or a program file ``NAME.toml``.

    A `ModelError` says that there is none, an `InputError` why the file cannot be read.
    """
    if name in MODELS:
        return MODELS[name]
    from comparisons.models.outside.programs import outside

    return outside(name, MODELS)


def solve(scene: Scene, model: str, options: Options | None = None, watch: Watch = unwatched) -> Response:
    """Return the verified response of `model`, a name for `find`, to `scene`; `watch` receives every accepted step.

    Raises
    ------
    ModelError
        If the model cannot state the scene, or an option does not belong to it.
    """
    chosen, given = find(model), options or Options()
    for option, value in vars(given).items():
        if value is not None and option not in chosen.options:
            raise ModelError(f"{chosen.name}: {option} = {value}: not an option of this model")
    if (unknown := chosen.unstated(scene)) is not None:
        raise ModelError(unknown)
    try:
        began = perf_counter()
        found = chosen.solve(scene, given, watch)
        more: dict[str, Any] = {"model": chosen.name, "scene": scene.name, "definition": scene}
        if isnan(found.wall_seconds):
            more["wall_seconds"] = perf_counter() - began
        if found.grid is not_kept:
            more["grid"] = partial(axis_grid, scene, found.axis_line)
        if not chosen.continuum:
            more["material_force"] = material_forces(found, scene, strains=chosen.rod)
        more |= {"setting": chosen.setting(scene, given), **_kind(found, chosen)}
        success = found.completed or found.reported_success
        return verified(replace(found, **more, reported_success=success), scene)
    except ValueError as error:
        raise ModelError(f"{chosen.name}: {error}") from error


def _kind(response: Response, model: Model | None) -> dict[str, Any]:
    """Return of what kind an answer is by its model, whatever it says of itself; without a model it is a program's, which says its kind."""
    continuum = response.continuum if model is None else model.continuum
    round_off = response.round_off if continuum and model is not None else 0.0
    return {"continuum": continuum, "outside": model not in MODELS.values(), "round_off": round_off}


def restored(response: Response, scene: Scene) -> Response:
    """Return a response from a file with the kind that its model is registered with, and checked as when it was solved."""
    from comparisons.models.outside.programs import known

    response = replace(response, **_kind(response, MODELS.get(response.model) or known(response.model)))
    if response.completed and not response.reported_success:
        contradiction = f"the status is {response.status}, and reported_success is false"
        return replace(response, status=CHECK_FAILED, message=contradiction)
    return verified(response, scene)


def certified(
    response: Response,
    scene: Scene,
    which: Literal["last", "all", "none"] = "last",
    *,
    allowance: float | None = None,
) -> Response:
    """Return `response` with its certificate. The verdict becomes the status of a refused answer, which is not completed.

    An answer that stopped keeps its status, and its certificate says no more than how far off it is there. One that is made of the
    referee's own equilibria is not judged.

    Parameters
    ----------
    response, scene : Response, Scene
        The answer of a model, and the scene that was solved.
    which : {"last", "all", "none"}
        Load parameters to certify. With ``last`` they are the last one, the neighbours of events, and the one with the largest
        contact force; a program of others, which does not state its events, is judged at all.
    allowance : float, optional
        Largest relative distance from the exact equilibrium, by default `comparisons.referee.certify.ALLOWED`. What the model's theory
        has besides is added.
    """
    if which == "none" or not len(response.load_parameter):
        return response
    model = MODELS.get(response.model)
    every = range(len(response.load_parameter)) if which == "all" or response.outside else None
    allowed = default_allowance(response, scene) + (0.0 if model is None else model.apart(scene))
    allowed += 0.0 if allowance is None else allowance - ALLOWED
    if model is not None and model.by_referee(scene):
        reason = f"{model.setting(scene, Options())}, found by the referee itself"
        found = Certificate(
            verdict=Verdict.NOT_JUDGED, reason=reason, allowance=allowed, judged=(), path=(), seconds=0.0
        )
    else:
        found = certify(response, scene, at=every, allowance=allowed)
    if not response.completed and found.certified:
        verdict, reason = Verdict.INADMISSIBLE, response.message
        if response.status != CHECK_FAILED:
            verdict, judged = Verdict.NOT_JUDGED, found.reason.partition(",")[0]
            reason = f"the answer stopped: {response.status}, {judged} where it was judged"
        found = replace(found, verdict=verdict, reason=reason)
    response = replace(response, certificate=found)
    if not response.completed or found.verdict in {Verdict.CERTIFIED, Verdict.NOT_JUDGED}:
        return response
    return replace(response, status=found.verdict.name, message=found.reason)
