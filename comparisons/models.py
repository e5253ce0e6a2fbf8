"""The models by name: each solves a scene and states its response."""

from collections.abc import Callable

from comparisons.discrete_models import solve_solid, solve_tsm
from comparisons.exact_models import solve_elastica, solve_rod
from comparisons.options import OPTIONS, ModelError, Options
from comparisons.progress import Watch, unwatched
from comparisons.response import Response
from comparisons.scene import Scene
from comparisons.verify import verified

MODELS: dict[str, Callable[[Scene, Options, Watch], Response]] = {
    "tsm": solve_tsm,
    "solid": solve_solid,
    "rod": solve_rod,
    "elastica": solve_elastica,
}


def solve(scene: Scene, model: str, options: Options | None = None, watch: Watch = unwatched) -> Response:
    """Return the verified response of `model`, a key of `MODELS`, to `scene`; `watch` is told of every accepted step.

    Raises
    ------
    ModelError
        If the model cannot state the scene or an option does not belong to it.
    """
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
