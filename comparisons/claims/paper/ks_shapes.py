"""Fig. 8: the cantilever of section 4.2 by TSM and by solid elements, with the exact rod, in the readings of the scene."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.compare import MIXED, PAPER, ROD, SOLID, Run
from comparisons.errors import Errors, errors
from comparisons.models import solve
from comparisons.models.options import ModelError, Options
from comparisons.quantities import KEPT, SCOPES
from comparisons.response import Array, Response
from comparisons.scene import Scene, load_scene
from comparisons.show.plot import nearest_steps, plot_shapes

Report = Callable[[str], None]

READINGS = {
    "ks-cantilever": "the pin slides along the beam, G from E and nu",
    "ks-printed-shear": "the pin slides along the beam, G as printed",
    "ks-tied-tip": "the point is tied to the tip",
}
"""What the paper's section 4.2 can mean, by scene."""
DRAWN = ("ks-cantilever", "ks-tied-tip")
"""The readings that look different; the printed G moves less than the width of a line."""
OTHER_BRANCH = 0.05
"""A shape that far from the exact rod's, in lengths of the beam, is another solution: a tied point can buckle the beam otherwise."""
STATIONS = 11
"""Equally spaced points of the beam that are nodes of every model; shapes are written there."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Run8:
    """One model in one reading.

    Attributes
    ----------
    reading, label : str
        Scene and model.
    status : str
        How it ended.
    unknowns, iterations : int
        Size of the system; Newton iterations of the whole path.
    seconds : float
        Wall time.
    errors : Errors
        Against the exact rod.
    shape_difference : float
        Error of the shape against the solid, nan where there is none.
    """

    reading: str
    label: str
    status: str
    unknowns: int
    iterations: int
    seconds: float
    errors: Errors
    shape_difference: float

    def error(self, quantity: str) -> float:
        """Return the largest error of a quantity over the load parameters."""
        return self.errors["path"][quantity]

    @property
    def follows(self) -> bool:
        """Whether the run went through on the exact rod's branch."""
        return self.status == "COMPLETED" and self.error("shape") < OTHER_BRANCH


@dataclass(frozen=True, kw_only=True, eq=False)
class Shapes:
    """What Fig. 8 shows; the responses are there to be drawn."""

    runs: tuple[Run8, ...]
    stopped: tuple[str, ...]
    drawn: dict[str, tuple[Scene, dict[str, Response]]]

    def run(self, reading: str, label: str) -> Run8:
        """Return the run of a model in a reading."""
        return next(run for run in self.runs if (run.reading, run.label) == (reading, label))


def ks_shapes(*, quick: bool, report: Report, readings: Iterable[str] = READINGS) -> Shapes:
    """Solve the readings with all models that can state them; `quick` takes fewer load parameters and a coarse solid."""
    runs: list[Run8] = []
    drawn: dict[str, tuple[Scene, dict[str, Response]]] = {}
    for name in readings:
        scene = load_scene(name)
        if quick:
            scene = replace(scene, load_parameters=10)
        report(f"{name}: {READINGS.get(name, name)}")
        responses = _responses(scene, quick=quick)
        drawn[name] = scene, responses
        runs += [_compared(scene, label, responses) for label in responses]
    needed = [run for run in runs if run.label not in {one.label for one in PAPER}]
    stopped = tuple(
        f"{run.reading}, {run.label}: {run.status}" for run in needed if run.status != "COMPLETED"
    )
    return Shapes(runs=tuple(runs), stopped=stopped, drawn=drawn)


def _responses(scene: Scene, *, quick: bool) -> dict[str, Response]:
    """Responses in the order of drawing. Of a solid with the printed G, Poisson's ratio -1, nothing can be learnt."""
    solid = replace(SOLID, options=Options(mesh=(24, 2))) if quick else SOLID
    models: tuple[Run, ...] = (*PAPER, MIXED, ROD)
    if scene.beams[0].poissons_ratio is not None:
        models = (solid, *models)
    responses = {}
    for run in models:
        try:
            responses[run.label] = solve(scene, run.model, run.options)
        except ModelError:
            if run is not solid:
                raise
    return responses


def _compared(scene: Scene, label: str, responses: dict[str, Response]) -> Run8:
    response, rod = responses[label], responses[ROD.label]
    solid = responses.get(SOLID.label)
    against_rod = errors(response, rod, scene)
    against_solid = None if solid is None else errors(response, solid, scene, quantities=["shape"])
    return Run8(
        reading=scene.name,
        label=label,
        status=response.status,
        unknowns=response.unknowns,
        iterations=response.iterations,
        seconds=response.wall_seconds,
        errors=against_rod,
        shape_difference=np.nan if against_solid is None else against_solid["path"]["shape"],
    )


def stations(scene: Scene, response: Response, k: int) -> Array:
    """Positions (STATIONS, 2) of equally spaced points of the axis at load parameter k."""
    arc, line = response.axis_line(scene.beams[0].name, k)
    wanted = np.linspace(0.0, scene.beams[0].length, STATIONS)
    return np.stack([np.interp(wanted, arc, line[:, 0]), np.interp(wanted, arc, line[:, 1])], axis=1)


def rows(found: Shapes) -> list[dict[str, Any]]:
    """One row per reading and model."""
    return [
        {
            **{key: value for key, value in vars(run).items() if key != "errors"},
            "follows_the_rod": run.follows,
            **{f"error_{scope}_{name}": run.errors[scope][name] for scope in SCOPES for name in KEPT},
        }
        for run in found.runs
    ]


def shape_rows(found: Shapes) -> list[dict[str, Any]]:
    """One row per point of the axes that are drawn."""
    return [
        {
            "reading": name,
            "label": label,
            "load_parameter": response.load_parameter[k],
            "arc_position": number * scene.beams[0].length / (STATIONS - 1),
            "x": x,
            "y": y,
        }
        for name, (scene, responses) in found.drawn.items()
        for label, response in responses.items()
        for k in (nearest_steps(response.load_parameter) if len(response.load_parameter) else [])
        for number, (x, y) in enumerate(stations(scene, response, k))
    ]


def plot_readings(found: Shapes, folder: Path) -> list[Path]:
    """Draw one picture per reading that looks different, with the runs that followed the exact rod."""
    paths: list[Path] = []
    for name in (name for name in DRAWN if name in found.drawn):
        stem = "fig8" if name == DRAWN[0] else f"fig8-{name.removeprefix('ks-')}"
        files = [folder / f"{stem}.png", folder / f"{stem}.svg"]
        scene, responses = found.drawn[name]
        # a response without load parameters is not drawn and keeps its place among the styles
        shown = {
            label: response
            if found.run(name, label).follows
            else replace(response, load_parameter=np.zeros(0))
            for label, response in responses.items()
        }
        plot_shapes(scene, shown, *files)
        paths += files
    return paths
