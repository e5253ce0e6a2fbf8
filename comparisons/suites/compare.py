"""One scene through every model: table, pictures and files."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from comparisons import models
from comparisons.answer import Response
from comparisons.answer.file import as_dict
from comparisons.answer.quantities import event_differences, names
from comparisons.files import alone_in, writable_folder, write_text
from comparisons.frozen import Frozen
from comparisons.models import Model, certified, find, solve
from comparisons.models.model import Count, ModelError, Options, Watch, unwatched
from comparisons.models.theory import bending
from comparisons.output import Report, json_text
from comparisons.report.brief import Brief, at_largest
from comparisons.report.export import check_series, write_series
from comparisons.report.findings import BUDGET, findings
from comparisons.report.motion import motion_section, states_section, tracks
from comparisons.report.pages import Section, picture, table, write_page
from comparisons.report.palette import style
from comparisons.report.panel import mises_panels
from comparisons.report.plot import plot_shapes
from comparisons.report.render import write_stress
from comparisons.report.table import budget_section, caption, line, table_csv, write_budget
from comparisons.scene import Scene, to_toml
from comparisons.scene.keys import special_keys
from comparisons.suite import Case, Row
from comparisons.suite.budget import Budget, error_budget
from comparisons.suite.measure import verdict
from comparisons.suites.drawing import plot_budget
from comparisons.version import versions
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
BRANCH = ("force", "moment", "tip")
NAMES = ("report.html", "summary.json", "table.csv", "shapes.png", "stress.svg", "budget.svg", "budget.json")
"""The files beside those of ParaView."""
MISES = "Von Mises stress of beams from section forces, of the solid from Cauchy's, and the difference."
APART = 0.5
"""Error of one of these quantities beyond which two answers are different equilibria."""


class Comparison(Frozen):
    """Result of a comparison: rows, the budget, who is left out and why by family, and the files written."""

    scene: Scene
    rows: list[Row]
    budget: Budget | None
    left_out: Mapping[str, str]
    files: list[Path] = field(default_factory=list)

    @property
    def responses(self) -> dict[str, Response]:
        """The answers by label."""
        return {row.label: row.response for row in self.rows}

    @property
    def exported(self) -> list[tuple[Run, Response]]:
        """The answers of beams and solid that are exported and rendered."""
        return [(run, self.responses[run.label]) for run in EXPORTED if run.label in self.responses]

    @property
    def brief(self) -> Brief:
        """What is found."""
        rows = {row.label: row for row in self.rows}
        beam, solid = rows.get(MIXED.label), rows.get(SOLID.label)
        bodies = None if beam is None or solid is None else beam.against(solid.response, names(mesh=False))
        return findings(self.scene, self.rows, ROD.label, bodies, self.budget, self.left_out)

    @property
    def apart(self) -> list[Row]:
        """The completed runs on another branch than the reference, without the elastica, another rod."""
        judged = (row for row in self.rows if row.label != ELASTICA.label and row.response.completed)
        return [row for row in judged if any(row.error("path", name) > APART for name in BRANCH)]

    @property
    def other_events(self) -> list[str]:
        """A sentence for each completed run about the first event that it or the reference does not have."""
        found = []
        exact = next(row.response for row in self.rows if row.label == ROD.label)
        for row in self.rows:
            events = event_differences(row.response, exact) if row.response.completed else []
            missing = [item for item in events if item.apart == np.inf]
            found += [item.line(row.label, ROD.label) for item in missing[:1]]
        return found

    @property
    def wrong(self) -> list[Row]:
        """The runs that were refused by the checks or the referee, and the reference if it stopped."""
        return [
            row for row in self.rows if row.wrong or (row.label == ROD.label and not row.response.completed)
        ]


def compare(
    scene: Scene,
    folder: Path,
    report: Report,
    watching: Watching = lambda _: nullcontext(unwatched),
    staging: Staging = lambda _: nullcontext(unwatched),
    more: Sequence[Run] = (),
) -> Comparison:
    """Solve `scene` with every model that can state it, and with `more` runs, and write the results to `folder`.

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
    runs = [*more, *(run for run in RUNS if run not in more)]
    for number, run in enumerate(runs, 1):
        head = f"[{number}/{len(runs)}] {run.label}"
        try:
            with watching(head) as watch:
                answers[run] = one = certified(solve(scene, run.model, run.options, watch), scene)
            end = f"{one.wall_seconds:.2f} s" if one.completed else f"{one.status}: {one.message}"
            report(f"{head}: {end}")
        except ModelError as error:
            left_out[find(run.model).family(scene, run.options)] = why = str(error).removeprefix(
                f"{run.model}: "
            )
            report(f"{head}: left out, {why}")
    rows = [_row(scene, run, response, answers[ROD]) for run, response in answers.items()]
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
    found = Comparison(scene=scene, rows=rows, budget=budget, left_out=left_out)
    with staging("drawing and writing files"), alone_in(folder):
        found.files.extend(_write(found, folder, report))
    return found


def _row(scene: Scene, run: Run, response: Response, reference: Response) -> Row:
    """Return the row of a run with its errors and their cause."""
    case = Case(scene=scene, model=run.model, options=run.options)
    judged, cause = verdict(response), _cause(case, reference)
    row = Row(case=case, response=response, verdict=judged, name=run.label, cause=cause)
    return row if response is reference else row.against(reference, names(mesh=False))


def _cause(case: Case, reference: Response) -> str:
    """Return the largest part of the error that theory allows; empty but for a uniform cantilever along x."""
    scene = case.scene
    (beam, *others), ends = scene.beams, [support.node for support in scene.all_supports]
    straight = not others and not any(special_keys(scene)) and beam.direction == (1.0, 0.0)
    if not straight or ends != [f"{beam.name}.start"] or not len(reference.load_parameter):
        return ""
    parts = case.found.error_parts(scene, case.options, bending(beam, reference))
    return max(parts, key=lambda why: parts[why]).partition(":")[0]


def _write(found: Comparison, folder: Path, report: Report) -> list[Path]:
    """Write all files; return them, the page first."""
    scene, responses = found.scene, found.responses
    page, summary, csv, shapes, stress, budget, numbers = (folder / name for name in NAMES)
    write_text(csv, table_csv(found.rows))
    plot_shapes(scene, {run.label: responses[run.label] for run in DRAWN if run.label in responses}, shapes)
    files, reached = [summary, csv, shapes], [len(one.load_parameter) for _, one in found.exported]
    if len(reached) == 2 and all(reached):
        (_, beams), (_, solid) = found.exported
        t = float(beams.load_parameter[min(at_largest(beams), reached[1] - 1)])
        write_stress(*mises_panels(beams, solid, scene, t), scene, t, stress)
        files.append(stress)
    else:
        report(f"{stress.name}: left out, it takes beams and solid")
    if found.budget is not None:
        plot_budget(found.budget, budget)
        write_budget(found.budget, numbers)
        files += budget, numbers
    for run, response in found.exported:
        write_series(writable_folder(folder / run.model), response, scene)
        files.append(folder / run.model / f"{run.model}.pvd")
    _write_page(found, files, stress, budget)
    files.insert(0, page)
    told = {
        "scene": scene.name,
        "scene_file": to_toml(scene),
        "reference": ROD.label,
        "versions": versions(),
        "files": [str(path.relative_to(folder)) for path in files],
        "runs": [{"label": row.label, **as_dict(row.response), "errors": row.errors} for row in found.rows],
    }
    write_text(summary, json_text(told))
    return files


def _write_page(found: Comparison, files: list[Path], stress: Path, budget: Path) -> None:
    scene, responses = found.scene, found.responses
    vtu = {run.label: f"{run.model}/{run.model}-{{}}.vtm" for run, _ in found.exported}
    shown, states = tracks(responses, ROD.label, scene), states_section(responses)
    first = {MIXED.label, SOLID.label, ROD.label}
    sections = [
        motion_section("Shapes", scene, responses, shown, focus=ROD.label, first=first, vtu=vtu),
        Section("Errors", table(caption(ROD.label), [line(row) for row in found.rows])),
        *([] if states is None else [states]),
        *([] if found.budget is None else [budget_section(found.budget, budget)]),
    ]
    if stress in files:
        sections.append(Section("Stress", picture(stress, MISES)))
    title = f"{scene.name}: beams, solid and exact answers"
    write_page(stress.parent, title, found.brief, sections, [scene], files)
