"""The manual as a folder: ``index.md``, a picture for each case, ``manual.json``; and as JUnit checks."""

from collections.abc import Iterator, Sequence
from math import inf, nan
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from comparisons import models as registry
from comparisons.files import writable_folder, write_text
from comparisons.output import Report, markdown, write_numbers
from comparisons.report import palette
from comparisons.report.plot import SOLID
from comparisons.suites.drawing import draw
from comparisons.suites.finding import Finding
from comparisons.suites.manual.measures import (
    ANSWER,
    MEASURES,
    Answers,
    StoppedError,
    answered,
    deflected,
    undeformed,
)
from comparisons.suites.manual.problem import Case, Judgement, Line, Problem, read_problem
from comparisons.version import versions

GUIDE = "exact order"
EXACT = {"color": palette.GREY, "linewidth": 0.8, "linestyle": (0, (4, 3))}
STYLES: dict[str, dict[str, Any]] = {
    "undeformed": {"color": "0.6", "linewidth": 1.0, "linestyle": "--"},
    "path of the pin": {"color": "0.6", "linewidth": 0.8, "linestyle": ":"},
    registry.SOLID.name: {**SOLID, "color": palette.colour(registry.SOLID.name), "linewidth": 9.0},
    "tsm timoshenko": {"color": palette.colour("TSM timoshenko"), "linewidth": 6.0},
    "tsm mixed": {"color": palette.colour("TSM mixed"), "linewidth": 4.0},
    "tsm exact": {"color": palette.colour("TSM exact"), "linewidth": 2.2},
    registry.ROD.name: {"color": palette.colour("exact rod"), "linewidth": 1.2},
    registry.ELASTICA.name: {"color": palette.colour(registry.ELASTICA.name), "linewidth": 1.2},
    ANSWER: EXACT,
    GUIDE: EXACT,
}
"""Drawn in this order, each line narrower than those below it, so that those that agree are all seen."""


def draw_case(case: Case, path: Path) -> None:
    """Draw what is exact and what the models found, in the format of the path's suffix."""
    picture, length = case.problem.picture, case.problem.scene.units.split(",")[1].strip()
    x, y = picture.axes or (f"x [{length}]", f"y [{length}]")
    order = list(STYLES)

    def panel(axes: Any) -> None:
        for style, points in sorted([*_exact(case), *case.lines], key=lambda line: order.index(line[0])):
            found = picture.guide and style != GUIDE
            marks = {"marker": "o", "markersize": 10, "linewidth": 1.5} if found else {}
            axes.plot(*points.T, label=style, **{**STYLES[style], **marks})
        axes.set(xlabel=x, ylabel=y, title=case.problem.title)
        if picture.guide:
            axes.set(xscale="log", yscale="log")
        if not picture.axes:
            axes.set_aspect("equal", adjustable="datalim")

    draw([panel], path, tall=3.6)


def _exact(case: Case) -> Iterator[Line]:
    """Yield what a picture has whatever the models answer: undeformed axes, the exact answer, a line for the eye."""
    picture, scene = case.problem.picture, case.problem.scene
    if picture.guide:
        order, first = picture.guide
        ends = np.sort(case.lines[0][1][[0, -1], 0])
        yield GUIDE, np.stack([ends, first * (ends / ends[0]) ** order], axis=1)
        return
    if not picture.axes:
        yield from undeformed(scene)
    if picture.exact:
        yield from deflected(scene, answered(scene, picture.exact), ANSWER, picture.shown)


HEAD = """# Verification manual

{cases} problems with exact answers, put to every model that can state them: {passed} of {runs} answers within their tolerances.
An error is that of the worst quantity, relative to its exact value, or to the length where it is a position. `crossval run manual` writes
this page, its pictures and `manual.json`; it took {seconds:.0f} s with {versions}.

"""
SECTION = """<a id="{case.problem.name}"></a>

## {case.problem.title}

{case.problem.statement}

Purpose: {case.problem.purpose}

Exact value: {case.problem.source}.

![{case.problem.title}]({case.picture})

"""
COLUMNS = (
    "case",
    "model",
    "quantity of the largest error",
    "exact",
    "computed",
    "error",
    "tolerance",
    "verdict",
)
STATED = ("name", "title", "purpose", "statement", "source", "uncertainty")


def page(cases: Sequence[Case]) -> str:
    """Return the manual as Markdown: a table of all answers, then a section for each case."""
    answers = [_answer(case.problem, item) for case in cases for item in case.judgements]
    head = HEAD.format(
        cases=len(cases),
        passed=sum(item.passed for case in cases for item in case.judgements),
        runs=len(answers),
        seconds=sum(case.seconds for case in cases),
        versions=", ".join(f"{name} {number}" for name, number in versions().items()),
    )
    return head + markdown([COLUMNS, *answers]) + "\n" + "\n".join(map(_section, cases))


def _answer(problem: Problem, item: Judgement) -> list[str]:
    """The answer of a model: its quantity of the largest error."""
    worst, named = item.worst, f"[{problem.title}](#{problem.name})"
    computed, error = item.stopped or f"{worst.value:.9g}", f"{worst.error:.1e}"
    stated = (item.trial.label, worst.name, f"{worst.exact:.9g}", computed, error, f"{worst.allowed:.2g}")
    return [named, *stated, _verdict(item)]


def _verdict(item: Judgement) -> str:
    return "passed" if item.passed else "**FAILED**"


def _section(case: Case) -> str:
    items = case.judgements
    rows = [["quantity", "exact", *(item.trial.label for item in items)]]
    for found in zip(*(item.findings for item in items), strict=True):
        computed = (f"{one.value:.9g} ({one.error:.1e})" for one in found)
        rows.append([found[0].name, f"{found[0].exact:.12g}", *computed])
    rows += [
        ["tolerance", "", *(f"{item.trial.allowed:.2g}" for item in items)],
        ["verdict", "", *map(_verdict, items)],
        ["seconds", "", *(f"{item.seconds:.2f}" for item in items)],
    ]
    reasons = (
        f"- {item.trial.label}: {item.trial.why}.{f' Stopped: {item.stopped}.' * bool(item.stopped)}\n"
        for item in items
    )
    return SECTION.format(case=case) + markdown(rows) + "\n" + "".join(reasons)


def _numbers(case: Case) -> dict[str, Any]:
    """Return everything but the picture as nested numbers."""
    runs = [
        {
            "model": item.trial.model,
            "setting": item.trial.setting,
            "tolerance": item.trial.allowed,
            "reason": item.trial.why,
            "values": [one.value for one in item.findings],
            "errors": [one.error for one in item.findings],
            "seconds": item.seconds,
            "stopped": item.stopped,
            "passed": item.passed,
        }
        for item in case.judgements
    ]
    stated = {name: getattr(case.problem, name) for name in STATED}
    quantities = [
        {name: getattr(one, name) for name in ("name", "exact", "scale")} for one in case.problem.quantities
    ]
    found = {name: getattr(case, name) for name in ("picture", "passed", "seconds")}
    return {**stated, "quantities": quantities, "runs": runs, **found}


def checks(cases: Sequence[Case]) -> Iterator[tuple[str, str, float, str | None, str]]:
    """Yield a check of `comparisons.suites.finding.junit_text` for every problem and model."""
    for case in cases:
        for item in case.judgements:
            measured = "\n".join(one.measured for one in item.findings)
            yield f"manual.{case.problem.name}", item.trial.label, item.seconds, item.failure, measured


def judged(problem: Problem) -> Case:
    """Return a problem with the judgements on all its models; a measure without a value for every quantity is a `ValueError`."""
    answers = [Answers(problem, trial) for trial in problem.trials]
    judgements = tuple(_judged(problem, one) for one in answers)
    lines = tuple(line for one in answers for line in one.lines)
    return Case(problem=problem, judgements=judgements, lines=lines)


def _judged(problem: Problem, answers: Answers) -> Judgement:
    trial, began, stopped, values = answers.trial, perf_counter(), "", list[float]()
    try:
        values = list(MEASURES[problem.measure](problem, answers))
    except StoppedError as error:
        stopped, values = str(error), [inf] * len(problem.quantities)
    seconds = perf_counter() - began
    findings = tuple(
        Finding(
            name=one.name,
            error=abs(value - one.exact) / one.size,
            allowed=trial.allowed,
            why=trial.why,
            value=nan if stopped else value,
            exact=one.exact,
        )
        for one, value in zip(problem.quantities, values, strict=True)
    )
    return Judgement(trial=trial, findings=findings, seconds=seconds, stopped=stopped)


def write_manual(folder: Path, report: Report, files: Sequence[Path]) -> tuple[list[Case], list[Path]]:
    """Solve problems, judge the answers and write the manual; return the cases and the files, the text first.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    report : callable
        Takes a line for each case.
    files : sequence of Path
        The problems, of `comparisons.suites.manual.problem.problems`.

    Raises
    ------
    OutputError
        If the folder cannot be written in.
    """
    writable_folder(folder)
    cases, pictures = [], []
    for problem in map(read_problem, files):
        case = judged(problem)
        pictures.append(folder / case.picture)
        draw_case(case, pictures[-1])
        cases.append(case)
        report(f"{problem.name}: {'passed' if case.passed else 'FAILED'}, {case.seconds:.1f} s")
        for item in case.judgements:
            if item.failure:
                report(f"  {item.trial.label}: {item.failure}")
    text = folder / "index.md"
    write_text(text, page(cases))
    numbers = {"passed": all(case.passed for case in cases), "cases": list(map(_numbers, cases))}
    return cases, [text, write_numbers(folder / "manual.json", numbers), *pictures]
