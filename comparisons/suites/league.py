"""The league: every program at several of its resolutions on several scenes, as a table, a diagram and a page."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby, product
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, ROD, Model, find
from comparisons.models.outside.programs import used
from comparisons.report import palette
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, picture, table
from comparisons.report.plot import draw
from comparisons.scene import Scene
from comparisons.suite import Case, Row, case
from comparisons.suite.progress import Runner
from comparisons.suites.found import Found

MOST, SCENES = 5, 6
"""Largest numbers of resolutions of a program, and of scenes that a brief names."""
QUANTITIES = ("force", "arc", "moment", "tip", "friction")
"""The quantities whose errors are stated."""
SHOWN = {
    "label": "setting", "outcome": "outcome", **{f"error_path_{name}": f"error {name}" for name in QUANTITIES},
    "seconds": "seconds", "process_seconds": "process",
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


def league(scenes: Sequence[Scene], programs: Sequence[str], run: Runner, *, quick: bool = False) -> Found:
    """Measure every program on every scene that it can state; errors are the largest ones over the load parameters that the exact rods reached, too.

    `programs` are names of models beside those of this package; if there is none, it is a `ModelError`. If quick, every program has at
    most two resolutions.
    """
    models = [(name, find(name)) for name in (*MODELS, *programs) if name != ROD.name]
    references = {scene.name: case(scene, ROD) for scene in scenes}
    cases, left_out = list[Case](), list[tuple[str, str, str]]()
    for scene, (name, model) in product(scenes, models):
        reason = model.refusal(scene)
        if reason is None:
            cases += _cases(scene, name, model, 2 if quick else MOST)
        else:
            left_out.append((scene.name, model.label, reason))
    results = run([*references.values(), *cases])
    exact = {name: results[one].response for name, one in references.items()}
    rows = [results[one].against(exact[one.scene.name], QUANTITIES) for one in cases]
    stopped = {name: one.message for name, one in exact.items() if not one.completed}
    entries = [row.columns() for row in rows]

    def sections(folder: Path) -> Iterator[Section]:
        yield Section("Work and precision", picture(folder / "league.svg", DIAGRAM))
        for scene in scenes:
            own = [row for row in entries if row["scene"] == scene.name]
            reasons = [{"program": who, "reason": why} for name, who, why in left_out if name == scene.name]
            html = table(CAPTION, [{words: row[name] for name, words in SHOWN.items()} for row in own])
            more = [table("Who cannot state it, and why", reasons)] if reasons else []
            yield Section(scene.name, "\n".join([html, *more]))

    return Found(
        title="League",
        brief=_brief(scenes, rows, stopped),
        files={
            "league.csv": entries,
            "league.json": {"entries": entries, "left_out": left_out, "reference_stopped": stopped},
        },
        sections=sections,
        pictures={"league": partial(_plot, scenes, rows)},
        scenes=scenes,
        text="\n".join(f"{name}: {who}: left out, {why}" for name, who, why in left_out),
    )


def _cases(scene: Scene, name: str, model: Model, most: int) -> Iterator[Case]:
    """Yield the cases of a model, at most so many resolutions of each family, coarse to fine."""
    for _, family in groupby(model.resolutions(quick=False), key=partial(model.family, scene)):
        settings = list(family)
        chosen = np.linspace(0, len(settings) - 1, min(most, len(settings))).round().astype(int)
        for k in dict.fromkeys(chosen):
            yield Case(scene=scene, model=name, options=settings[k])


def _cheapest(scene: Scene, rows: Sequence[Row]) -> Row | None:
    """Return the certified row of a scene with an error up to `ASKED` that takes the least seconds."""
    # statics fix the forces of a scene without contact
    names = ("force", "arc", "moment", "tip") if scene.contacts else ("moment", "tip")
    own = [row for row in rows if row.case.scene == scene and row.outcome == "certified"]
    good = [row for row in own if np.nanmax([row.error("path", name) for name in names]) <= ASKED]
    return min(good, key=_seconds, default=None)


def _brief(scenes: Sequence[Scene], rows: Sequence[Row], stopped: Mapping[str, str]) -> Brief:
    """Return what is found: how the runs ended, the cheapest program for 1 % on every scene, and who was wrong."""
    wrong = Counter(row.family for row in rows if row.wrong)
    certified, points = sum(row.outcome == "certified" for row in rows), list[str]()
    false = f"{wrong.total()} said success and {'was' if wrong.total() == 1 else 'were'} wrong"
    if wrong:
        points.append(f"Success that was wrong: {', '.join(f'{who} ({n})' for who, n in wrong.items())}.")
    best = {scene.name: row for scene in scenes if (row := _cheapest(scene, rows)) is not None}
    found, cheap = [f"{name}: {row.label}, {_seconds(row):.2g} s" for name, row in best.items()], ""
    if found:
        more = f"; and {len(found) - SCENES} more scenes below" if len(found) > SCENES else ""
        points.append(f"Cheapest for {100 * ASKED:g} % of the exact rods: {'; '.join(found[:SCENES])}{more}.")
        ((first, times),) = Counter(row.family for row in best.values()).most_common(1)
        cheap = f"; {first} is the cheapest for {100 * ASKED:g} % on {times} of {len(scenes)} scenes"
    points += [f"The exact rods of {name} stop: {why}." for name, why in stopped.items()]
    if others := [model.label for model in used()]:
        points.append(f"Programs of others: {', '.join(others)}.")
    about = "How the runs of each program ended; wrong: said success and was wrong."
    said = f"{certified} of {len(rows)} runs are certified, {false}{cheap}."
    return Brief(said, points, list(_ends(rows)), about)


def _plot(scenes: Sequence[Scene], rows: Sequence[Row], *paths: Path) -> None:
    """Draw the error over the processor seconds of the whole process, a panel for each scene and a line for each program.

    A filled marker is a certified answer, a hollow one is a stop by name, and a cross is an answer that the program reported as a
    success and the referee refused.
    """

    def panel(axes: Any, scene: Scene) -> None:
        quantity = "force" if scene.contacts else "tip"
        seen = (row for row in rows if row.case.scene == scene)
        for program, own in groupby(seen, key=lambda row: row.family):
            _draw(axes, program, list(own), quantity)
        words = {"title": scene.name, "xlabel": SECONDS, "ylabel": f"largest error of the {quantity}"}
        axes.set(xscale="log", yscale="log", **words)

    draw([partial(panel, scene=scene) for scene in scenes], *paths, tall=2.6, sharex=True, sharey=True)


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


def _ends(rows: Sequence[Row]) -> Iterator[dict[str, object]]:
    """Yield a row for each program: on how many scenes it runs, and how its runs ended."""
    for program in dict.fromkeys(row.family for row in rows):
        own = [row for row in rows if row.family == program]
        ends = Counter("stopped" if row.outcome.isupper() else row.outcome for row in own)
        scenes = len({row.case.scene.name for row in own})
        how = {name: ends[name] for name in ("certified", "stopped", "wrong")}
        yield {"program": program, "scenes": scenes, "runs": len(own), **how}
