"""One scene through every model: table, pictures and files."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import tsm
from comparisons import models
from comparisons.budget import Budget, error_budget
from comparisons.errors import Errors, error_histories, errors, largest
from comparisons.files import alone_in, writable_folder, write_text
from comparisons.models import Model, certified, find, solve
from comparisons.models.options import ModelError, Options
from comparisons.models.progress import Count, Watch, uncounted, unwatched
from comparisons.models.theory import bending
from comparisons.models.verify import CHECK_FAILED
from comparisons.output import json_text
from comparisons.quantities import event_differences, names
from comparisons.referee import Verdict
from comparisons.response import Response
from comparisons.response.file import as_dict
from comparisons.scene import Scene, to_toml
from comparisons.scene.keys import special_keys
from comparisons.show.budget_plot import plot_budget, write_budget
from comparisons.show.compare_report import write_comparison_page
from comparisons.show.export import check_series, write_series
from comparisons.show.findings import BUDGET
from comparisons.show.panel import mises_panel
from comparisons.show.plot import nearest_steps, plot_shapes
from comparisons.show.render import render_panels
from comparisons.show.table import Row, table_csv
from comparisons.version import versions
from tsm.elements import TIMOSHENKO, ElementType

Report = Callable[[str], None]
Watching = Callable[[str], AbstractContextManager[Watch]]
Staging = Callable[[str], AbstractContextManager[Count]]


@dataclass(frozen=True, kw_only=True)
class Run:
    """One model with its options."""

    label: str
    model: str
    options: Options


def run_of(model: Model, options: Options) -> Run:
    """Return the run of a model with its label."""
    return Run(label=model.run_label(options), model=model.name, options=options)


def _beams(kind: ElementType, elements: int) -> Run:
    return run_of(models.TSM, Options(element=kind.name, elements=elements))


RUNS = tuple(
    run_of(model, options)
    for model in sorted(models.MODELS.values(), key=lambda model: (not model.meshed) * (1 + model.rod))
    for options in model.compared()
)
"""The runs of a comparison, by the settings that each model states: models with a mesh first, the exact rod last."""
PAPER = tuple(_beams(TIMOSHENKO, elements) for elements in (10, 20, 50))
"""The paper's element."""
MIXED = _beams(tsm.elements.MIXED, 20)
"""The beams that are exported and rendered."""
SOLID, ROD, ELASTICA = (run_of(model, Options()) for model in (models.SOLID, models.ROD, models.ELASTICA))


def _layer(run: Run) -> int:
    """Layer of a run in a figure, from below: the solid, beams without nodes, beams, exact answers."""
    model = models.MODELS[run.model]
    if model.continuum or not model.meshed:
        return 0 if model.continuum else 3
    return 1 if model.reference is not None and run.options.element == model.reference.element else 2


DRAWN = tuple(sorted((run for run in RUNS if run not in (MIXED, ELASTICA)), key=_layer))
"""The runs whose deflected axes are drawn over each other: the widest line first, the exact rod on top."""

BRANCH = ("force", "moment", "tip")
WRITTEN = 5
"""Parts of the files: shapes, stress, budget, VTU files, tables and page."""
NAMES = ("report.html", "summary.json", "table.csv", "shapes.png", "shapes.svg", "side-by-side.png", "budget.png", "budget.svg", "budget.json")  # fmt: skip
"""The files beside those of ParaView."""
APART = 0.5
"""Error of one of these quantities beyond which two answers are different equilibria."""


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Result of a comparison: one row for each run, and the files written."""

    rows: list[Row]
    files: list[Path]

    @property
    def apart(self) -> list[Row]:
        """The completed runs on another branch than the reference. The elastica has no stretch and no shear, so it is not judged."""
        return [
            row for row in self.rows if row.label != ELASTICA.label and row.response.completed and _apart(row)
        ]

    @property
    def other_events(self) -> list[str]:
        """A sentence for each completed run about the first event that it or the reference does not have."""
        found = []
        for exact in (row.response for row in self.rows if row.label == ROD.label):
            for row in self.rows:
                events = event_differences(row.response, exact) if row.response.completed else []
                missing = [item for item in events if item.apart == np.inf]
                found += [item.line(row.label, ROD.label) for item in missing[:1]]
        return found

    @property
    def wrong(self) -> list[Row]:
        """The runs whose answers were refused by the checks or the referee, and the reference if it stopped."""
        refused = {CHECK_FAILED, *Verdict.__members__}
        return [
            row
            for row in self.rows
            if not row.response.completed and (row.response.status in refused or row.label == ROD.label)
        ]


def _apart(row: Row) -> bool:
    """Whether a run differs from the reference by more than its discretisation can explain."""
    return row.errors is not None and max(row.errors["path"][name] for name in BRANCH) > APART


def _silent(_: str) -> AbstractContextManager[Watch]:
    return nullcontext(unwatched)


def _unsaid(_: str) -> AbstractContextManager[Count]:
    return nullcontext(uncounted)


def compare(
    scene: Scene,
    folder: Path,
    report: Report,
    watching: Watching = _silent,
    staging: Staging = _unsaid,
    more: Sequence[Run] = (),
) -> Comparison:
    """Solve `scene` with every model that can state it and write the results to `folder`.

    Parameters
    ----------
    scene : Scene
        Any scene; the exact rods are the reference of the comparison.
    folder : Path
        Output folder; it is created if it does not exist.
    report : callable
        Receives lines about the progress.
    watching : callable
        ``watching(label)`` gives a context with the `Watch` of a run.
    staging : callable
        ``staging(label)`` gives a context with the `Count` of a stage of the work after the runs.
    more : sequence of Run
        Runs beside those of every comparison, such as programs of others.

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
    for run in (MIXED, SOLID):
        check_series(folder / run.model, run.model, scene)
    left_out: dict[str, str] = {}

    def leave_out(name: str, reason: str) -> None:
        left_out[name] = reason

    runs = [*more, *(run for run in RUNS if run not in more)]
    responses = _solve_all(scene, runs, report, watching, leave_out)
    rows = [_row(run, responses, scene) for run in runs if run.label in responses]
    with staging("measuring the error budget") as count:
        try:
            budget = _budget(scene, rows, count)
        except ModelError as error:
            budget = None
            leave_out(BUDGET, str(error))
            report(f"budget.json: left out, {error}")
    with staging("drawing and writing files") as count, alone_in(folder):
        files = _write_all(scene, rows, budget, left_out, folder, report, count)
    return Comparison(rows=rows, files=files)


def _row(run: Run, responses: Mapping[str, Response], scene: Scene) -> Row:
    """Return the row of a run with its errors and their cause."""
    model, response, reference = find(run.model), responses[run.label], responses[ROD.label]
    return Row(
        label=run.label,
        response=response,
        errors=None if response is reference else _errors(response, reference, scene),
        family=model.family(scene, run.options),
        resolution=model.resolution(run.options),
        cause=_cause(model, run.options, scene, reference),
    )


def _cause(model: Model, options: Options, scene: Scene, reference: Response) -> str:
    """Return the largest part of the error that theory allows, without its formula; empty but for a straight, uniform cantilever along x."""
    (beam, *others), ends = scene.beams, [support.node for support in scene.all_supports]
    if (
        others
        or any(special_keys(scene))
        or beam.direction != (1.0, 0.0)
        or ends != [f"{beam.name}.start"]
        or not len(reference.load_parameter)
    ):
        return ""
    parts = model.error_parts(scene, options, bending(beam, reference))
    return max(parts, key=lambda why: parts[why]).partition(":")[0]


def _errors(response: Response, reference: Response, scene: Scene) -> Errors:
    """Return the errors of a run; over the path as far as the run came."""
    compared = names(mesh=False)
    found = errors(response, reference, scene, quantities=compared)
    if response.completed:
        return found
    _, reached = error_histories(response, reference, scene, quantities=compared)
    return {**found, "path": {name: largest(values) for name, values in reached.items()}}


def _solve_all(
    scene: Scene,
    runs: Sequence[Run],
    report: Report,
    watching: Watching,
    leave_out: Callable[[str, str], None],
) -> dict[str, Response]:
    responses: dict[str, Response] = {}
    for number, run in enumerate(runs, 1):
        try:
            with watching(f"[{number}/{len(runs)}] {run.label}") as watch:
                response = certified(solve(scene, run.model, run.options, watch), scene)
        except ModelError as error:
            report(f"[{number}/{len(runs)}] {run.label}: left out, {error}")
            leave_out(find(run.model).family(scene, run.options), str(error).removeprefix(f"{run.model}: "))
            continue
        responses[run.label] = response
        outcome = (
            f"{response.wall_seconds:.2f} s"
            if response.completed
            else f"{response.status}: {response.message}"
        )
        report(f"[{number}/{len(runs)}] {run.label}: {outcome}")
    return responses


def _budget(scene: Scene, rows: list[Row], count: Count) -> Budget:
    """Return the error budget.

    Raises
    ------
    ModelError
        If there is no complete answer of the solid, or no budget of the scene.
    """
    solid = next((row.response for row in rows if row.label == SOLID.label), None)
    if solid is None or not solid.completed:
        raise ModelError("it takes the solid")
    return error_budget(scene, count)


def _write_all(
    scene: Scene,
    rows: list[Row],
    budget: Budget | None,
    left_out: Mapping[str, str],
    folder: Path,
    report: Report,
    count: Count,
) -> list[Path]:
    responses = {row.label: row.response for row in rows}
    names = [run.label for run in DRAWN]
    shapes = [folder / "shapes.png", folder / "shapes.svg"]
    plot_shapes(scene, {name: responses[name] for name in names if name in responses}, *shapes)
    count(1, WRITTEN)
    files = [*shapes, *_write_picture(scene, responses, folder, report)]
    count(2, WRITTEN)
    if budget is not None:
        files += [folder / name for name in NAMES[-3:]]
        plot_budget(budget, *files[-3:-1])
        write_budget(budget, files[-1])
    count(3, WRITTEN)
    series = {}
    for run in (MIXED, SOLID):
        if run.label in responses:
            write_series(writable_folder(folder / run.model), responses[run.label], scene)
            series[run.label] = folder / run.model / f"{run.model}.pvd"
    count(4, WRITTEN)
    write_text(folder / "table.csv", table_csv(rows))
    files = [folder / "summary.json", folder / "table.csv", *files, *series.values()]
    page = write_comparison_page(scene, rows, budget, files, series, folder, left_out)
    files = [page, *files]
    write_text(folder / "summary.json", _summary(scene, rows, [path.relative_to(folder) for path in files]))
    return files


def _write_picture(scene: Scene, responses: dict[str, Response], folder: Path, report: Report) -> list[Path]:
    """Write the side-by-side picture of the beams and the solid at load parameters that both reached."""
    both = [responses[run.label] for run in (MIXED, SOLID) if run.label in responses]
    reached = min(len(response.load_parameter) for response in both)
    if len(both) < 2 or reached == 0:
        report("side-by-side.png: left out, it takes beams and solid")
        return []
    ks = nearest_steps(both[0].load_parameter[:reached], scene.times[-1])
    times = ", ".join(f"{both[0].load_parameter[k]:.3g}" for k in ks)
    panels = [
        mises_panel(both[0], scene, ks, f"{MIXED.label}\nt = {times}"),
        mises_panel(both[1], scene, ks, f"{SOLID.label}\nt = {times}"),
    ]
    force, length = (unit.strip() for unit in scene.units.split(","))
    path = folder / "side-by-side.png"
    sentence = render_panels(panels, f"von Mises stress [{force}/{length}^2]", path)
    if sentence is not None:
        report(f"{path.name}: {sentence}")
    return [path]


def _summary(scene: Scene, rows: list[Row], files: list[Path]) -> str:
    runs = [{"label": row.label, **as_dict(row.response), "errors": row.errors} for row in rows]
    summary = {
        "scene": scene.name,
        "scene_file": to_toml(scene),
        "reference": ROD.label,
        "versions": versions(),
        "files": [str(path) for path in files],
        "runs": runs,
    }
    return json_text(summary)
