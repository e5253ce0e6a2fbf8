"""Fig. 8: the cantilever of section 4.2 by TSM, solid and exact rod, in the readings of the scene."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.answer.errors import errors
from comparisons.answer.quantities import KEPT, SCOPES
from comparisons.models import solve
from comparisons.models.options import ModelError, Options
from comparisons.output import Report, Row
from comparisons.report.motion import motion_section, tracks
from comparisons.report.pages import Section
from comparisons.report.plot import nearest_steps, plot_shapes
from comparisons.scene import Scene, load_scene
from comparisons.suites.compare import MIXED, PAPER, ROD, SOLID
from comparisons.suites.paper.figure import Facts, Study, percent, stops

KS = "ks-cantilever"
WHY_NOT = {
    KS: "The contact node meets a beam node.",
    "ks-printed-shear": "With the printed G the beam is rigid in shear, and a pin that starts on the tip node is in the critical area.",
    "ks-tied-tip": "A tied tip makes the beam buckle, and a step may lead to another solution.",
}
"""What stands in the way of the paper's element in a reading."""
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


def of_shapes(found: Study) -> Facts:
    """Errors of the paper's element with 10, 20 and 50 elements, and of the solid, in the main reading."""
    runs: dict[Any, Row] = {run["label"]: run for run in found.numbers["runs"] if run["reading"] == KS}
    runs |= {one.options.elements: runs[one.label] for one in PAPER}
    divisions, asked = [one.options.elements for one in PAPER], ("shape", "force", "moment")
    errors = {
        of: {name: float(runs[of][f"error_path_{name}"]) for name in (*asked, "arc")}
        for of in (*divisions, SOLID.label)
    }
    all_runs = [run for run in found.numbers["runs"] if run["label"] in {one.label for one in PAPER}]
    failed = [run for run in all_runs if not run["follows_the_rod"]]
    ends = (
        f"{run['label']} on {run['reading']} ({'another branch' if run['status'] == 'COMPLETED' else run['status']})"
        for run in failed
    )
    each = (f"{n} elements {', '.join(percent(errors[n][name]) for name in asked)}" for n in divisions)
    return {
        "follow": (len(all_runs) - len(failed), len(all_runs)),
        "refuted": [False if failed else None],
        "not": f"; not: {', '.join(ends)}" if failed else "",
        "reasons": "".join(f" {one}" for one in dict.fromkeys(WHY_NOT[run["reading"]] for run in failed)),
        "apart": {n: runs[n]["shape_difference"] for n in divisions},
        "error": errors,
        "errors": [errors[n][name] for n in divisions for name in asked],
        "each": "; ".join(each),
        "worst": [
            max(errors[of][name] for name in names)
            for of, names in ((20, ("force", "arc", "shape")), (SOLID.label, ("force", "shape")))
        ],
        "run": runs,
        "cost": [runs[20][name] / runs[SOLID.label][name] for name in ("unknowns", "seconds")],
    }
