"""Fig. 8: the cantilever of section 4.2 by TSM, solid and exact rod, in the readings of the scene."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from comparisons.claims.paper.figure import Study, stops
from comparisons.compare import MIXED, PAPER, ROD, SOLID
from comparisons.errors import errors
from comparisons.models import solve
from comparisons.models.options import ModelError, Options
from comparisons.output import Report, Row
from comparisons.quantities import KEPT, SCOPES
from comparisons.response import Response
from comparisons.scene import Scene, load_scene
from comparisons.show.pages import Section, motion_section, tracks
from comparisons.show.plot import nearest_steps, plot_shapes

READINGS = {
    "ks-cantilever": "the pin slides along the beam, G from E and nu",
    "ks-printed-shear": "the pin slides along the beam, G as printed",
    "ks-tied-tip": "the point is tied to the tip",
}
"""What the paper's section 4.2 can mean, by scene."""
DRAWN = {"ks-cantilever": "fig8", "ks-tied-tip": "fig8-tied-tip"}
"""The pictures of the readings that look different; the printed G moves less than the width of a line."""
OTHER_BRANCH = 0.05
"""A shape that far from the exact rod's, in lengths of the beam, is another solution: a tied point can buckle the beam otherwise."""
STATIONS = 11
"""Equally spaced points of the beam that are nodes of every model; shapes are written there."""
Responses = dict[str, Response]
"""By label, in the order of drawing."""


def ks_shapes(*, quick: bool, report: Report) -> Study:
    """Solve the readings with all models that can state them; `quick` takes fewer load parameters and a coarse solid."""
    runs, points, stopped = list[Row](), list[Row](), list[str]()
    scenes, moving = list[Scene](), list[Section]()
    pictures: dict[str, Callable[..., None]] = {}
    for name, words in READINGS.items():
        report(f"{name}: {words}")
        scene = load_scene(name)
        scene = replace(scene, load_parameters=10) if quick else scene
        responses = _responses(scene, quick=quick)
        rows = [_compared(scene, label, responses) for label in responses]
        kept = {row["label"]: responses[row["label"]] for row in rows if row["follows_the_rod"]}
        runs += rows
        points += _shape_rows(scene, responses)
        scenes.append(scene)
        needed = responses.keys() - {run.label for run in PAPER}
        stopped += stops({f"{name}, {label}": one for label, one in responses.items() if label in needed})
        if ROD.label in kept:
            histories = tracks(kept, ROD.label, scene)
            moving.append(motion_section(f"{name}: {words}", scene, kept, histories, focus=ROD.label))
        if name in DRAWN:
            # a response without load parameters is not drawn and keeps its place among the styles
            unseen = {label: replace(one, load_parameter=np.zeros(0)) for label, one in responses.items()}
            pictures[DRAWN[name]] = partial(plot_shapes, scene, {**unseen, **kept})
    return Study(
        tables={"fig8": runs, "fig8-shapes": points},
        numbers={"readings": READINGS, "runs": runs, "stopped": stopped},
        pictures=pictures,
        scenes=tuple(scenes),
        moving=tuple(moving),
    )


def _responses(scene: Scene, *, quick: bool) -> Responses:
    """Responses in the order of drawing. Of a solid with the printed G, Poisson's ratio -1, nothing can be learnt."""
    solid = replace(SOLID, options=Options(mesh=(24, 2))) if quick else SOLID
    solids = (solid,) if scene.beams[0].poissons_ratio is not None else ()
    responses = {}
    for run in (*solids, *PAPER, MIXED, ROD):
        try:
            responses[run.label] = solve(scene, run.model, run.options)
        except ModelError:
            if run is not solid:
                raise
    return responses


def _compared(scene: Scene, label: str, responses: Responses) -> Row:
    """Status, cost and errors of a run: all of them against the exact rod, the shape also against the solid where there is one."""
    response, solid = responses[label], responses.get(SOLID.label)
    found = errors(response, responses[ROD.label], scene)
    apart = errors(response, solid, scene, quantities=["shape"])["path"]["shape"] if solid else np.nan
    return {
        "reading": scene.name,
        "label": label,
        "status": response.status,
        "unknowns": response.unknowns,
        "iterations": response.iterations,
        "seconds": response.wall_seconds,
        "shape_difference": apart,
        "follows_the_rod": response.status == "COMPLETED" and found["path"]["shape"] < OTHER_BRANCH,
        **{f"error_{scope}_{name}": found[scope][name] for scope in SCOPES for name in KEPT},
    }


def _shape_rows(scene: Scene, responses: Responses) -> Iterator[Row]:
    """Yield a row per point of the axes that are drawn."""
    beam = scene.beams[0]
    places = np.linspace(0.0, beam.length, STATIONS)
    for label, response in responses.items():
        for k in nearest_steps(response.load_parameter) if len(response.load_parameter) else []:
            of = {"reading": scene.name, "label": label, "load_parameter": response.load_parameter[k]}
            arc, line = response.axis_line(beam.name, k)
            axis = (np.interp(places, arc, values) for values in line.T)
            for number, (x, y) in enumerate(zip(*axis, strict=True)):
                yield {
                    **of,
                    "arc_position": number * beam.length / (STATIONS - 1),
                    "x": float(x),
                    "y": float(y),
                }
