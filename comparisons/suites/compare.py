"""One scene through every model: table, pictures and files."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from comparisons import models
from comparisons.answer import Response
from comparisons.answer.file import as_dict
from comparisons.answer.quantities import event_differences, names, table_columns
from comparisons.files import filled, writable_folder
from comparisons.models import Model, certified, find, solve
from comparisons.models.model import Count, ModelError, Options, Watch, unwatched
from comparisons.models.theory import bending
from comparisons.output import NO_VALUE, Report, tabulated
from comparisons.report.brief import at_largest
from comparisons.report.export import check_series
from comparisons.report.findings import BUDGET, findings
from comparisons.report.motion import motion_section, states_section, tracks
from comparisons.report.pages import Section, picture, table
from comparisons.report.palette import style
from comparisons.report.panel import mises_panels
from comparisons.report.parts import budget_numbers, budget_section, plot_budget
from comparisons.report.plot import plot_shapes
from comparisons.report.render import write_stress
from comparisons.scene import Scene, to_toml
from comparisons.scene.keys import special_keys
from comparisons.suite import Case, Row
from comparisons.suite.budget import Budget, error_budget
from comparisons.suite.measure import verdict
from comparisons.suites.found import Found
from tsm.elements import MIXED as MIXED_KIND
from tsm.elements import TIMOSHENKO

Watching = Callable[[str], AbstractContextManager[Watch]]
Staging = Callable[[str], AbstractContextManager[Count]]


class Run(NamedTuple):
    """One model with its options, whatever the scene."""

    label: str
    model: str
    options: Options


def run_of(model: Model, options: Options) -> Run:
    """Return the run of a model with its label."""
    return Run(label=model.run_label(options), model=model.name, options=options)


RUNS = tuple(
    run_of(model, options)
    for model in sorted(models.MODELS.values(), key=lambda model: (not model.meshed) * (1 + model.rod))
    for options in model.compared()
)
"""The runs of a comparison, by the settings that each model states: models with a mesh first, the exact rod last."""
PAPER = tuple(run_of(models.TSM, Options(element=TIMOSHENKO.name, elements=n)) for n in (10, 20, 50))
"""The paper's element."""
MIXED = run_of(models.TSM, Options(element=MIXED_KIND.name, elements=20))
SOLID, ROD, ELASTICA = (run_of(model, Options()) for model in (models.SOLID, models.ROD, models.ELASTICA))
EXPORTED = (MIXED, SOLID)
"""The beams and the solid that are exported and rendered."""
DRAWN = tuple(
    sorted((run for run in RUNS if run not in (MIXED, ELASTICA)), key=lambda run: -style(run.label).width)
)
"""The runs whose deflected axes are drawn over each other: the widest line first, the exact rod on top."""
OTHER_BRANCH = "OTHER_BRANCH"
BRANCH = ("force", "moment", "tip")
NAMES = ("report.html", "summary.json", "table.csv", "shapes.png", "stress.svg", "budget.svg", "budget.json")
"""The files beside those of ParaView."""
MISES = "Von Mises stress of beams from section forces, of the solid from Cauchy's, and the difference."
CAPTION = (
    f"Largest error over the load parameters reached, against the {ROD.label}; forces and moments relative to their "
    "largest, positions to the length, friction to the contact forces; Newton iterations and seconds for the whole path"
)
APART = 0.5
"""Error of one of these quantities beyond which two answers are different equilibria."""


def compare(
    scene: Scene,
    folder: Path,
    report: Report,
    watching: Watching = lambda _: nullcontext(unwatched),
    staging: Staging = lambda _: nullcontext(unwatched),
    more: Sequence[Run] = (),
) -> Found:
    """Solve `scene` with every model that can state it, and with `more` runs; `folder` is tried out for the results.

    Errors are measured against the exact rods. `report` receives lines about the progress. ``watching(label)`` gives a context with the
    `Watch` of a run, ``staging(label)`` one with the `Count` of a stage of the work after the runs.

    Raises
    ------
    ModelError
        If the exact rods cannot state the scene; nothing is computed.
    OutputError
        If `folder` cannot be written; nothing is computed.
    """
    refused = find(ROD.model).refusal(scene)
    if refused is not None:
        raise ModelError(f"compare: errors are measured against the {ROD.label}; {refused}")
    folder = writable_folder(folder, *NAMES)
    for run in EXPORTED:
        check_series(folder / run.model, run.model, scene)
    left_out: dict[str, str] = {}
    answers: dict[Run, Response] = {}
    runs = dict.fromkeys((*more, *RUNS))
    for number, run in enumerate(runs, 1):
        head = f"[{number}/{len(runs)}] {run.label}"
        try:
            with watching(head) as watch:
                answers[run] = one = certified(solve(scene, run.model, run.options, watch), scene)
            end = f"{one.wall_seconds:.2f} s" if one.completed else one.ended
        except ModelError as error:
            why = str(error).removeprefix(f"{run.model}: ")
            left_out[find(run.model).family(scene, run.options)] = why
            end = f"left out, {why}"
        report(f"{head}: {end}")
    rows = {run: row_of(scene, run, response, answers[ROD]) for run, response in answers.items()}
    with staging("measuring the error budget") as count:
        budget, lack = None, "it takes the solid"
        if SOLID in answers and answers[SOLID].completed:
            try:
                budget = error_budget(scene, count)
            except ModelError as error:
                lack = str(error)
        if budget is None:
            left_out[BUDGET] = lack
            report(f"budget.json: left out, {lack}")
    report("drawing and writing files")
    return _found(scene, rows, budget, left_out, report)


def row_of(scene: Scene, run: Run, response: Response, reference: Response) -> Row:
    """Return the row of a run with its errors and their cause."""
    case = Case(scene=scene, model=run.model, options=run.options)
    judged, cause = verdict(response), _cause(case, reference)
    row = Row(case=case, response=response, verdict=judged, name=run.label, cause=cause)
    return row if response is reference else row.against(reference, names("mesh"))


def _cause(case: Case, reference: Response) -> str:
    """Return the largest part of the error that theory allows; empty but for a uniform cantilever along x."""
    scene = case.scene
    (beam, *others), ends = scene.beams, [support.node for support in scene.all_supports]
    straight = not others and not any(special_keys(scene)) and beam.direction == (1.0, 0.0)
    if not straight or ends != [f"{beam.name}.start"] or not len(reference.load_parameter):
        return ""
    parts = case.found.error_parts(scene, case.options, bending(beam, reference))
    return max(parts, key=parts.__getitem__).partition(":")[0]


def line(row: Row) -> dict[str, str]:
    """Return a run for people; a dash stands where the run or the scene does not have a quantity."""
    response = row.response
    return {
        "model": row.label if response.completed else f"{row.label} ({response.status})",
        "unknowns": str(response.unknowns),
        **{one.words: _error(row.error("path", name)) for name, one in table_columns().items()},
        "stable": row.stable,
        "iterations": str(response.iterations),
        "seconds": f"{response.wall_seconds:.3f}",
    }


def _error(value: float) -> str:
    return "-" if np.isnan(value) else NO_VALUE if np.isinf(value) else f"{value:.1e}"


def _found(
    scene: Scene, of: Mapping[Run, Row], budget: Budget | None, left_out: Mapping[str, str], report: Report
) -> Found:
    """Return what the rows of runs show, with the files and the page."""
    rows, responses = list(of.values()), {run.label: row.response for run, row in of.items()}
    shown, exported = [line(row) for row in rows], {run: of[run].response for run in EXPORTED if run in of}
    bodies = of[MIXED].against(of[SOLID].response, names("mesh")) if len(exported) == 2 else None
    drawn = {run.label: of[run].response for run in DRAWN if run in of}
    pictures: dict[str, Callable[..., None]] = {"shapes.png": partial(plot_shapes, scene, drawn)}
    reached = [len(one.load_parameter) for one in exported.values()]
    if len(reached) == 2 and all(reached):
        beams, body = exported.values()
        t = float(beams.load_parameter[min(at_largest(beams), reached[1] - 1)])
        pictures["stress.svg"] = partial(write_stress, *mises_panels(beams, body, scene, t), scene, t)
    else:
        report("stress.svg: left out, it takes beams and solid")
    if budget is not None:
        pictures["budget.svg"] = partial(plot_budget, budget)
    files: dict[str, Any] = {
        "table.csv": [
            row.columns() | {"seconds": row.response.wall_seconds, "stable": row.stable} for row in rows
        ],
        **({} if budget is None else {"budget.json": budget_numbers(budget)}),
        **{f"{run.model}/{run.model}.pvd": (one, scene) for run, one in exported.items()},
    }
    files["summary.json"] = {
        "scene": scene.name,
        "scene_file": to_toml(scene),
        "reference": ROD.label,
        "files": ["report.html", "summary.json", *files, *pictures],
        "runs": [{"label": row.label, **as_dict(row.response), "errors": row.errors} for row in rows],
    }

    def sections(folder: Path) -> Iterator[Section]:
        vtu = {run.label: f"{run.model}/{run.model}-{{}}.vtm" for run in exported}
        acting, first = tracks(responses, ROD.label, scene), {MIXED.label, SOLID.label, ROD.label}
        yield motion_section("Shapes", scene, responses, acting, focus=ROD.label, first=first, vtu=vtu)
        yield Section("Errors", table(CAPTION, shown))
        yield from states_section(responses)
        if budget is not None:
            yield budget_section(budget, folder / "budget.svg")
        if "stress.svg" in pictures:
            yield Section("Stress", picture(folder / "stress.svg", MISES))

    remarks, stopped = list[str](), list[str]()
    for row in (row for row in rows if not row.response.completed):
        needed = row.wrong or row.label == ROD.label
        (stopped if needed else remarks).append(f"{row.label}: {row.response.stop(scene)}")
    return Found(
        title=f"{scene.name}: beams, solid and exact answers",
        brief=findings(rows, ROD.label, bodies, budget, left_out),
        files=files,
        sections=sections,
        pictures=pictures,
        scenes=[scene],
        text="\n".join([*filled(CAPTION), "", tabulated(shown), *_other_events(rows)]),
        remarks=remarks,
        stopped=[*stopped, *_apart(rows)],
    )


def _apart(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a line for each completed run on another branch than the reference, without the elastica, another rod."""
    for row in rows:
        judged = row.label != ELASTICA.label and row.response.completed
        if judged and any(row.error("path", name) > APART for name in BRANCH):
            yield f"{row.label}: {OTHER_BRANCH}: ends in another equilibrium than the {ROD.label}"


def _other_events(rows: Sequence[Row]) -> list[str]:
    """Return a line for each completed run about the first event that it or the reference does not have, and a blank one before."""
    exact = next(row.response for row in rows if row.label == ROD.label)
    apart = {row.label: event_differences(row.response, exact) for row in rows if row.response.completed}
    alone = ((label, [one for one in events if one.apart == np.inf]) for label, events in apart.items())
    found = [events[0].line(label, ROD.label) for label, events in alone if events]
    return ["", *found] if found else []
