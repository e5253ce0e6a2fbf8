"""The models that the manual puts to scenes, and what it reads from their responses."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from comparisons import models as registry
from comparisons.claims.claim import Allowance, StoppedError
from comparisons.claims.manual.record import Curve, Measured, Trial
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Array, Response
from comparisons.scene import Scene
from tsm import elements as kinds

FOURTH = "fourth order: half as many elements leave 16 times as much"
SECOND = "second order: half as many elements leave 4 times as much"
BREAK = np.full((1, 2), np.nan)
"""Row of nan that separates two pieces of a curve."""
ANSWER = "exact answer"
"""Style of curves of the exact answer, which no model computed."""


@dataclass(frozen=True, kw_only=True)
class Model:
    """A model at a resolution.

    Attributes
    ----------
    name, setting : str
        Model and setting of the `Trial`.
    key : str
        Key of `comparisons.models.MODELS`.
    options : Options
        For `comparisons.models.solve`.
    """

    name: str
    setting: str
    key: str
    options: Options = field(default_factory=Options)


EXACT = Model(
    name="tsm exact",
    setting="1 element a beam",
    key=registry.TSM.name,
    options=Options(element=kinds.EXACT.name),
)
ROD = Model(name=registry.ROD.name, setting="", key=registry.ROD.name)
ELASTICA = Model(name=registry.ELASTICA.name, setting="", key=registry.ELASTICA.name)


def mixed(elements: int) -> Model:
    """Return the element with the contact force as unknown."""
    return Model(
        name="tsm mixed",
        setting=f"{elements} elements a beam",
        key=registry.TSM.name,
        options=Options(elements=elements),
    )


def paper(elements: int) -> Model:
    """Return the paper's Timoshenko element."""
    return Model(
        name="tsm timoshenko",
        setting=f"{elements} elements a beam",
        key=registry.TSM.name,
        options=Options(elements=elements, element=kinds.TIMOSHENKO.name),
    )


def solid(nx: int, ny: int) -> Model:
    """Return the solid with a mesh."""
    return Model(
        name=registry.SOLID.name,
        setting=f"{nx}x{ny} elements",
        key=registry.SOLID.name,
        options=Options(mesh=(nx, ny)),
    )


def answered(scene: Scene, model: Model) -> Response:
    """Return the response of a model to a scene.

    Raises
    ------
    StoppedError
        If it is not complete and checked.
    """
    response = solve(scene, model.key, model.options)
    if not response.completed:
        raise StoppedError(f"{response.status}: {response.message}")
    return response


def on_scene(
    model: Model,
    tolerance: float,
    reason: str,
    read: Callable[[Response], Iterable[float]],
    shown: Sequence[float] = (1.0,),
) -> Trial:
    """Return a trial that solves the scene of its problem.

    Parameters
    ----------
    model, tolerance, reason
        Model, allowed error and its reason.
    read : callable
        From the response to the values.
    shown : sequence of float
        Load parameters whose deflected axes are drawn.
    """

    def measure(scene: Scene) -> Measured:
        response = answered(scene, model)
        values = tuple(float(value) for value in read(response))
        return Measured(values=values, curves=(deflected(scene, response, model.name, shown),))

    return trial(model, tolerance, reason, measure)


def trial(model: Model, tolerance: float, reason: str, measure: Callable[[Scene], Measured]) -> Trial:
    """Return the trial of a model with the given measurement."""
    allowance = Allowance(error=tolerance, why=reason)
    return Trial(model=model.name, setting=model.setting, allowance=allowance, measure=measure)


def step(response: Response, load_parameter: float) -> int:
    """Return the number of a load parameter of the scene."""
    k = int(np.argmin(np.abs(response.load_parameter - load_parameter)))
    assert abs(response.load_parameter[k] - load_parameter) < 1e-9, "must be one of the scene's"
    return k


def deflected(scene: Scene, response: Response, style: str, shown: Sequence[float] = (1.0,)) -> Curve:
    """Return the deflected axes of all beams at some load parameters as one curve."""
    return pieces(
        style,
        (response.axis_line(beam.name, step(response, t))[1] for beam in scene.beams for t in shown),
    )


def pieces(style: str, lines: Iterable[Array]) -> Curve:
    """Return lines that are not joined as one curve."""
    parted = [part for line in lines for part in (np.asarray(line, dtype=np.float64), BREAK)]
    return Curve(style=style, points=np.concatenate(parted[:-1]))


def undeformed(scene: Scene) -> tuple[Curve, ...]:
    """Return the undeformed axes and the paths of the pins."""
    axes = pieces("undeformed", (np.array([beam.start, beam.end]) for beam in scene.beams))
    if not scene.pins:
        return (axes,)
    return axes, pieces("path of the pin", (np.array(pin.points) for pin in scene.pins))
