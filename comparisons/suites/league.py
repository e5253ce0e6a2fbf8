"""The league: every program at several of its resolutions on several scenes, as a table, a diagram and a page."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, ROD, Model, find
from comparisons.models.model import Options
from comparisons.models.outside.programs import used
from comparisons.output import write_numbers, write_rows
from comparisons.report import palette
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, picture, table, write_page
from comparisons.scene import Scene
from comparisons.suite import Case, Row
from comparisons.suite.progress import Runner
from comparisons.suites.drawing import draw

MOST, SCENES = 5, 6
"""Largest numbers of resolutions of a program, and of scenes that a brief names."""
QUANTITIES = ("force", "arc", "moment", "tip", "friction")
"""The quantities whose errors are stated."""
SHOWN = {
    "setting": "setting", "outcome": "outcome", **{f"error_{name}": name for name in QUANTITIES}, "seconds": "seconds",
    "process_seconds": "process",
}  # fmt: skip
"""The columns that the page shows, and how it calls them."""
SECONDS = "seconds of the whole process"
"""What the diagram shows errors over."""
ASKED = 0.01
"""The error for which it is said which program is cheapest."""
FLOOR = 1e-14
"""Errors below are drawn here: they are round-off."""
FILES = ("league.csv", "league.json", "league.svg", "league.png", "report.html")
CAPTION = (
    "Largest errors over the load parameters: forces and moments over their largest, positions over the length. Friction: the tangential "
    "contact forces that the material force at a clamp shows, over the contact forces; infinite where a program does not state it. "
    "Seconds: processor time of the solution, and of a whole process of crossval solve."
)
DIAGRAM = (
    "Largest error of the contact force, without contact of the tip, over processor seconds of a whole process. Filled: certified. "
    "Hollow: stopped by name. Cross: said success and was wrong."
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


def ranked(scene: Scene) -> tuple[str, ...]:
    """Return the quantities by which programs are ranked; statics fix the forces of a scene without contact."""
    return ("force", "arc", "moment", "tip") if scene.contacts else ("moment", "tip")


def _cheapest(league: League, scene: Scene) -> Row | None:
    """Return the certified row with an error up to `ASKED` that takes the least seconds."""
    own = [row for row in league.rows if row.case.scene.name == scene.name and row.outcome == "certified"]
    good = [row for row in own if np.nanmax([row.error("path", name) for name in ranked(scene)]) <= ASKED]
    return min(good, key=_seconds, default=None)


def brief(league: League) -> Brief:
    """Return what is found: how the runs ended, the cheapest program for 1 % on every scene, and who was wrong."""
    wrong = Counter(row.family for row in league.rows if row.wrong)
    ends = Counter(row.outcome for row in league.rows)
    said = f"{ends['certified']} of {len(league.rows)} runs are certified"
    false = f"{wrong.total()} said success and {'was' if wrong.total() == 1 else 'were'} wrong"
    points = [f"Success that was wrong: {', '.join(f'{who} ({n})' for who, n in wrong.items())}."] * bool(
        wrong
    )
    best = {scene.name: _cheapest(league, scene) for scene in league.scenes}
    found = [f"{name}: {row.label}, {_seconds(row):.2g} s" for name, row in best.items() if row is not None]
    if found:
        more = f"; and {len(found) - SCENES} more scenes below" if len(found) > SCENES else ""
        points.append(f"Cheapest for {100 * ASKED:g} % of the exact rods: {'; '.join(found[:SCENES])}{more}.")
    points += [f"The exact rods of {name} stop: {why}." for name, why in league.stopped.items()]
    if others := [model.label for model in used()]:
        points.append(f"Programs of others: {', '.join(others)}.")
    first = Counter(row.family for row in best.values() if row is not None).most_common(1)
    cheap = (
        f"; {first[0][0]} is the cheapest for {100 * ASKED:g} % on {first[0][1]} of {len(best)} scenes"
        if first
        else ""
    )
    return Brief(
        f"{said}, {false}{cheap}.",
        points,
        summary(league),
        "How the runs of each program ended; wrong: said success and was wrong.",
    )


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
    """Draw the error over the processor seconds of the whole process, a panel for each scene and a line for each program.

    A filled marker is a certified answer, a hollow one is a stop by name, and a cross is an answer that the program reported as a
    success and the referee refused.
    """
    # whole decades have labels that do not overlap
    spent = np.log10([seconds for row in league.rows if isfinite(seconds := _seconds(row))] or [1.0])
    decades = 10.0 ** np.floor(spent.min() - 0.05), 10.0 ** np.ceil(spent.max() + 0.05)

    def panel(axes: Any, scene: Scene) -> None:
        quantity = "force" if scene.contacts else "tip"
        for program in league.programs:
            _draw(axes, program, league.of(scene.name, program), quantity)
        axes.set(xscale="log", yscale="log", xlim=decades, title=scene.name, xlabel=SECONDS)
        axes.set_ylabel(f"largest error of the {quantity}")

    panels = [partial(panel, scene=scene) for scene in league.scenes]
    draw(panels, *paths, tall=2.6, sharex=True, sharey=True)


def _seconds(row: Row) -> float:
    """Return the seconds of the whole process, of the solution where the system does not count processes."""
    return row.process_seconds if isfinite(row.process_seconds) else row.seconds


def _draw(axes: Any, program: str, rows: Sequence[Row], quantity: str) -> None:
    style = palette.style(program)
    own: dict[str, Any] = {"color": style.colour, "marker": style.marker}
    places = [(_seconds(row), max(row.error("path", quantity), FLOOR)) for row in rows]
    seen = [place for place in places if np.isfinite(place).all()]
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
        ends = Counter("stopped by name" if row.outcome.isupper() else row.outcome for row in own)
        scenes = {row.case.scene.name for row in own}
        told = {"certified": ends["certified"], "stopped": ends["stopped by name"], "wrong": ends["wrong"]}
        rows.append({"program": program, "scenes": len(scenes), "runs": len(own), **told})
    return rows


def _write_page(league: League, files: Sequence[Path], folder: Path) -> Path:
    sections = [Section("Work and precision", picture(folder / "league.svg", DIAGRAM))]
    for scene in league.scenes:
        rows = [league_row(row) for program in league.programs for row in league.of(scene.name, program)]
        lines = [{words: row[name] for name, words in SHOWN.items()} for row in rows]
        reasons = [
            {"program": who, "reason": why} for name, who, why in league.left_out if name == scene.name
        ]
        html = table(CAPTION, lines)
        if reasons:
            html += "\n" + table("Who cannot state it, and why", reasons)
        sections.append(Section(scene.name, html))
    return write_page(folder, "League", brief(league), sections, league.scenes, files)
