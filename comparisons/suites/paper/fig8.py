"""Fig. 8: the cantilever of section 4.2 by TSM, solid and exact rod, in the readings of the scene."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

from comparisons.answer import Response
from comparisons.answer.axis import STATIONS, axes_at_stations
from comparisons.models import find, solve
from comparisons.models.model import Options
from comparisons.output import Report, Row
from comparisons.report.motion import motion_section, tracks
from comparisons.report.pages import Section
from comparisons.report.plot import nearest_steps, plot_shapes
from comparisons.scene import Scene, load_scene
from comparisons.suites.compare import MIXED, PAPER, ROD, SOLID, Run, row_of
from comparisons.suites.paper.figure import STATED, Study, stops

KS = "ks-cantilever"
READINGS = STATED["reading"]
"""What the paper's section 4.2 can mean, and what stands in the way of its element, by scene; the picture of those that look different."""
OTHER_BRANCH = 0.05
"""A shape that far from the exact rod's, in lengths of the beam, is another solution: a tied point can buckle the beam otherwise."""


def ks_shapes(*, quick: bool, report: Report) -> Study:
    """Solve the readings with all models that can state them; `quick` takes fewer load parameters and a coarse solid."""
    runs, points, stopped = list[Row](), list[Row](), list[str]()
    scenes, moving, pictures = list[Scene](), list[Section](), dict[str, Callable[..., None]]()
    for name, reading in READINGS.items():
        report(title := f"{name}: {reading['words']}")
        scene = load_scene(name)
        scene = replace(scene, load_parameters=10) if quick else scene
        solid = SOLID._replace(options=Options(mesh=(24, 2))) if quick else SOLID
        # of a solid with the printed G, Poisson's ratio -1, nothing can be learnt
        stated = scene.beams[0].poissons_ratio is not None and find(SOLID.model).refusal(scene) is None
        asked = (*((solid,) if stated else ()), *PAPER, MIXED, ROD)
        responses = {run.label: solve(scene, run.model, run.options) for run in asked}
        rows = [_compared(scene, run, responses) for run in asked]
        kept = {row["label"]: responses[row["label"]] for row in rows if row["follows_the_rod"]}
        runs += rows
        points += _shape_rows(scene, responses)
        scenes.append(scene)
        stopped += stops({f"{name}, {run.label}": responses[run.label] for run in asked if run not in PAPER})
        if ROD.label in kept:
            histories = tracks(kept, ROD.label, scene)
            moving.append(motion_section(title, scene, kept, histories, focus=ROD.label))
        if "picture" in reading:
            pictures[reading["picture"]] = partial(plot_shapes, scene, kept)
    return Study(
        tables={"fig8": runs, "fig8-shapes": points},
        numbers={"readings": READINGS, "runs": runs, **of_shapes(runs), "stopped": stopped},
        pictures=pictures,
        scenes=scenes,
        moving=moving,
    )


def _compared(scene: Scene, run: Run, responses: Mapping[str, Response]) -> Row:
    """Return the row of a run against the exact rod, and the distance of its shape from the solid's where there is one."""
    row, solid = row_of(scene, run, responses[run.label], responses[ROD.label]), responses.get(SOLID.label)
    apart = row.against(solid, ["shape"]).error("path", "shape") if solid else float("nan")
    near = run is ROD or row.error("path", "shape") < OTHER_BRANCH
    return {
        "reading": scene.name,
        **row.columns(),
        "seconds": row.response.wall_seconds,
        "shape_difference": apart,
        "follows_the_rod": row.response.completed and near,
    }


def _shape_rows(scene: Scene, responses: Mapping[str, Response]) -> Iterator[Row]:
    """Yield a row per point of the axes that are drawn, at every tenth station, a node of every model."""
    beam = scene.beams[0]
    for label, response in responses.items():
        t = response.load_parameter
        steps = nearest_steps(t) if len(t) else []
        for k, axis in zip(steps, axes_at_stations(response, beam.name, steps), strict=True):
            of = {"reading": scene.name, "label": label, "load_parameter": t[k]}
            for part, (x, y) in zip(STATIONS[::10], axis[::10].tolist(), strict=True):
                yield {**of, "arc_position": part * beam.length, "x": x, "y": y}


def of_shapes(rows: Sequence[Row]) -> Row:
    """Return the runs of the main reading by elements of the paper's element, and of the solid, and which runs leave the exact rod."""
    main = {row["label"]: row for row in rows if row["reading"] == KS}
    paper = [row for row in rows if row["label"] in {one.label for one in PAPER}]
    return {
        "run": {**{one.options.elements: main[one.label] for one in PAPER}, SOLID.label: main[SOLID.label]},
        "paper_runs": len(paper),
        "failed": [
            {name: row[name] for name in ("reading", "label", "status")}
            for row in paper
            if not row["follows_the_rod"]
        ],
    }
