"""The league: every program at several of its resolutions on several scenes, as a table, a diagram and a page."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import ceil, isfinite
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, ROD, Model, find
from comparisons.models.options import Options
from comparisons.models.outside.programs import used
from comparisons.output import write_numbers, write_rows
from comparisons.report import palette
from comparisons.report.pages import Section, folded, picture, table, write_page
from comparisons.report.plot import WIDTH, draw_legend, figure, logarithmic, save
from comparisons.scene import Scene
from comparisons.suite import Case, Row
from comparisons.suite.progress import Runner

MOST = 5
"""Largest number of resolutions of a program."""
QUANTITIES = ("force", "arc", "moment", "tip", "friction")
"""The quantities whose errors are stated."""
SHOWN = {
    "setting": "setting", "outcome": "outcome", **{f"error_{name}": name for name in QUANTITIES}, "seconds": "seconds",
    "process_seconds": "process",
}  # fmt: skip
"""The columns that the page shows, and how it calls them."""
COLUMNS = 2
"""Panels of the diagram beside each other."""
FLOOR = 1e-14
"""Errors below are drawn here: they are round-off."""
FILES = ("league.csv", "league.json", "league.svg", "league.png", "report.html")
CAPTION = (
    "Largest errors over the load parameters: forces and moments over their largest, positions over the length. Friction: the tangential "
    "contact forces that the material force at a clamp shows, over the contact forces; infinite where a program does not state it. "
    "Seconds: processor time of the solution, and of a whole process of crossval solve."
)
DIAGRAM = (
    "Largest error of the force over processor seconds of a whole process. Filled: certified. Hollow: stopped by name. Cross: said success "
    "and was wrong."
)


@dataclass(frozen=True, kw_only=True)
class League:
    """The rows of all scenes, in the order of scenes, programs and resolutions; the program is the family of a row, as ``TSM mixed``.

    Errors are the largest ones against the exact rods over the load parameters that both reached. `left_out` has scene, program, and the
    reason why the program cannot state the scene; `stopped` has the reason why the exact rods did not complete, by scene.
    """

    scenes: tuple[Scene, ...]
    rows: list[Row]
    left_out: list[tuple[str, str, str]] = field(default_factory=list)
    stopped: dict[str, str] = field(default_factory=dict)

    @property
    def programs(self) -> list[str]:
        """The programs in the order of the models."""
        return list(dict.fromkeys(row.family for row in self.rows))

    def of(self, scene: str, program: str) -> list[Row]:
        """Return the rows of one program on one scene, coarse to fine."""
        return [row for row in self.rows if (row.case.scene.name, row.family) == (scene, program)]


def measure_league(
    scenes: Sequence[Scene],
    programs: Sequence[str],
    run: Runner,
    *,
    quick: bool = False,
) -> League:
    """Measure every program on every scene that it can state.

    `programs` are names of models beside those of this package; if there is none, it is a `ModelError`. If quick, every program has at
    most two resolutions.
    """
    models = [(name, find(name)) for name in (*MODELS, *programs) if name != ROD.name]
    references = {scene.name: Case(scene=scene, model=ROD.name) for scene in scenes}
    cases: list[Case] = []
    left_out: list[tuple[str, str, str]] = []
    for scene in scenes:
        for name, model in models:
            reason = model.refusal(scene)
            if reason is None:
                cases += _cases(scene, name, model, 2 if quick else MOST)
            else:
                left_out.append((scene.name, model.label, reason))
    found = run([*references.values(), *cases])
    exact = {name: found[case].response for name, case in references.items()}
    return League(
        scenes=tuple(scenes),
        rows=[found[case].against(exact[case.scene.name], QUANTITIES) for case in cases],
        left_out=left_out,
        stopped={name: response.message for name, response in exact.items() if not response.completed},
    )


def _cases(scene: Scene, name: str, model: Model, most: int) -> Iterator[Case]:
    """Yield the cases of a model, at most so many resolutions of each family, coarse to fine."""
    families: dict[str, list[Options]] = {}
    for options in model.resolutions(quick=False):
        families.setdefault(model.family(scene, options), []).append(options)
    for settings in families.values():
        chosen = np.linspace(0, len(settings) - 1, min(most, len(settings))).round().astype(int)
        for k in dict.fromkeys(chosen):
            yield Case(scene=scene, model=name, options=settings[k])


def league_row(row: Row) -> dict[str, Any]:
    """Return a row of the table."""
    response = row.response
    return {
        "scene": row.case.scene.name,
        "program": row.family,
        "setting": row.label,
        "outcome": row.outcome,
        **{f"error_{name}": row.error("path", name) for name in QUANTITIES},
        "seconds": row.seconds,
        "process_seconds": row.process_seconds,
        "unknowns": response.unknowns,
        "load_parameters_reached": len(response.load_parameter),
        "status": response.status,
        "verdict": row.verdict,
        "said_success_and_was_wrong": row.wrong,
        "message": response.message,
    }


def write_league(league: League, folder: Path) -> list[Path]:
    """Write `FILES` to `folder`; return them, the page first."""
    rows = [league_row(row) for row in league.rows]
    table, numbers, *drawn, _ = (folder / name for name in FILES)
    files = [write_rows(table, rows)] if rows else []
    stated = {"entries": rows, "left_out": league.left_out, "reference_stopped": league.stopped}
    files += [write_numbers(numbers, stated), *drawn]
    plot_league(league, *drawn)
    return [_write_page(league, files, folder), *files]


def plot_league(league: League, *paths: Path) -> None:
    """Draw the error of the force over the processor seconds of the whole process, a panel for each scene and a line for each program.

    A filled marker is a certified answer, a hollow one is a stop by name, and a cross is an answer that the program reported as a
    success and the referee refused.
    """
    rows = ceil(len(league.scenes) / COLUMNS)
    fig = figure(figsize=(WIDTH, 2.4 * rows + 1.4))
    panels = fig.subplots(rows, COLUMNS, squeeze=False, sharex=True, sharey=True).ravel()
    for axes, scene in zip(panels, league.scenes, strict=False):
        for program in league.programs:
            _draw(axes, program, league.of(scene.name, program))
        logarithmic(axes)
        axes.set_title(scene.name, fontsize="medium")
        axes.tick_params(labelbottom=True, labelleft=True, labelsize="small")
    # whole decades have labels that do not overlap
    low, high = np.log10(panels[0].get_xlim())
    panels[0].set_xlim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
    for axes in panels[len(league.scenes) :]:
        axes.set_axis_off()
    fig.supxlabel("processor seconds of the whole process")
    fig.supylabel("largest error of the force (reactions without contact)")
    draw_legend(fig, panels, "outside upper center")
    save(fig, *paths)


def _draw(axes: Any, program: str, rows: Sequence[Row]) -> None:
    # the seconds of the solution where the system does not count processes
    seconds = (row.process_seconds if isfinite(row.process_seconds) else row.seconds for row in rows)
    places = [(x, max(row.error("path", "force"), FLOOR)) for x, row in zip(seconds, rows, strict=True)]
    seen = [place for place in places if np.isfinite(place).all()]
    style = palette.style(program)
    own: dict[str, Any] = {"color": style.colour, "marker": style.marker}
    if seen:
        axes.plot(*zip(*seen, strict=True), linewidth=1.2, label=program, **own)
    for place, row in zip(places, rows, strict=True):
        if row.wrong:
            axes.plot(*place, "x", color="black", markersize=10, zorder=4)
        elif not row.response.completed:
            axes.plot(*place, linestyle="none", markerfacecolor="white", zorder=4, **own)


def summary(league: League) -> list[dict[str, object]]:
    """Return a row for each program: on how many scenes it runs, and how its runs ended."""
    rows: list[dict[str, object]] = []
    for program in league.programs:
        own = [row for row in league.rows if row.family == program]
        ends = Counter(row.outcome for row in own)
        rows.append(
            {
                "program": program,
                "scenes": len({row.case.scene.name for row in own}),
                "runs": len(own),
                "certified": ends["certified"],
                "stopped by name": sum(n for end, n in ends.items() if end.isupper()),
                "said success and was wrong": ends["wrong"],
            }
        )
    return rows


def _write_page(league: League, files: Sequence[Path], folder: Path) -> Path:
    sections = [
        Section("Programs", table("How the runs of each program ended", summary(league))),
        Section("Work and precision", picture(folder / "league.svg", DIAGRAM)),
    ]
    for scene in league.scenes:
        rows = [league_row(row) for program in league.programs for row in league.of(scene.name, program)]
        lines = [{words: row[name] for name, words in SHOWN.items()} for row in rows]
        reasons = [
            {"program": who, "reason": why} for name, who, why in league.left_out if name == scene.name
        ]
        html = folded("all runs", table(CAPTION, lines))
        if scene.name in league.stopped:
            end = f"The exact rods end here: {league.stopped[scene.name]}"
            html = f"<p>{end}. Errors are measured as far as they came.</p>\n{html}"
        if reasons:
            html += "\n" + folded("who cannot state it", table("Reasons", reasons))
        sections.append(Section(scene.name, html))
    others = ", ".join(model.label for model in used())
    lead = (
        f"{len(league.rows)} runs of {len(league.programs)} programs on {len(league.scenes)} scenes, each against the exact rods"
        f"{f'; programs of others: {others}' if others else ''}. Seconds belong to the machine named below. There is no single score."
    )
    return write_page(folder, "League", lead, sections, league.scenes, files)
