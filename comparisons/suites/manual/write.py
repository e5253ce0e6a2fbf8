"""The manual as a folder: ``index.md``, a picture for each problem, ``manual.json``; and as JUnit checks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from math import inf, nan
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from comparisons import models as registry
from comparisons.files import writable_folder, write_text
from comparisons.output import Report, write_numbers
from comparisons.report import palette
from comparisons.suites.drawing import Line, draw_lines
from comparisons.suites.finding import Finding, junit_text
from comparisons.suites.formula import sentence
from comparisons.suites.manual.measures import (
    ANSWER,
    MEASURES,
    Answers,
    StoppedError,
    answered,
    deflected,
    undeformed,
)
from comparisons.suites.manual.problem import Problem, Trial, read_problem
from comparisons.version import versions

FILES = ("index.md", "manual.json", "junit.xml")
PAGE = Path(__file__).with_name("page.md.jinja")
GUIDE = "exact order"
EXACT = {"color": palette.GREY, "linewidth": 0.8, "linestyle": (0, (4, 3)), "zorder": 3}
STYLES: dict[str, dict[str, Any]] = {
    "undeformed": {"color": "0.6", "linewidth": 1.0, "linestyle": "--", "zorder": 1},
    "path of the pin": {"color": "0.6", "linewidth": 0.8, "linestyle": ":", "zorder": 1},
    ANSWER: EXACT,
    GUIDE: EXACT,
}
"""Styles of the lines that no model computed."""


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The answer of a model to a problem: its findings, one for each quantity."""

    problem: Problem
    trial: Trial
    lines: list[Line]  #: What it adds to the picture.
    findings: tuple[Finding, ...]
    seconds: float  #: Wall time.
    stopped: str = ""  #: Why there is no answer.

    @property
    def passed(self) -> bool:
        """Whether every error is within what is allowed."""
        return all(one.holds for one in self.findings)

    @property
    def worst(self) -> Finding:
        """The finding with the largest error, the first that is not a number if one is not."""
        return max(self.findings, key=lambda one: one.share)

    @property
    def failure(self) -> str | None:
        """Why the answer fails, with its numbers; None if it is right."""
        return self.stopped or (None if self.passed else self.worst.failure)


def judged(problem: Problem) -> list[Judgement]:
    """Return the judgements on all models of a problem; a measure without a value for every quantity is a `ValueError`."""
    return [_judged(Answers(problem, trial)) for trial in problem.trials]


def _judged(answers: Answers) -> Judgement:
    asked, trial, began, stopped = answers.problem.quantities, answers.trial, perf_counter(), ""
    try:
        values = list(MEASURES[answers.problem.measure](answers))
    except StoppedError as error:
        stopped, values = str(error), [nan] * len(asked)
    seconds = perf_counter() - began
    findings = tuple(
        Finding(
            name=one.name,
            error=inf if stopped else abs(value - one.exact) / one.size,
            allowed=trial.allowed,
            why=trial.why,
            value=value,
            exact=one.exact,
        )
        for one, value in zip(asked, values, strict=True)
    )
    return Judgement(**vars(answers), findings=findings, seconds=seconds, stopped=stopped)


def draw_case(case: Sequence[Judgement], path: Path) -> None:
    """Draw what is exact and what the models found on a problem, in the format of the path's suffix."""
    problem, picture, lines = case[0].problem, case[0].problem.picture, list[Line]()
    length = problem.scene.units.split(",")[1].strip()
    x, y = picture.axes or (f"x [{length}]", f"y [{length}]")
    # the first model on top, each line wider than those above it, so that those that agree are all seen
    for number, one in reversed(list(enumerate(case))):
        key, _, element = one.trial.model.partition(" ")
        colour = palette.colour(f"{registry.find(key).label} {element}".strip())
        size = {"marker": "o", "markersize": 10.0} if picture.guide else {"linewidth": 1.5 + 2.0 * number}
        own = {"color": colour, **size}
        lines += (drawn._replace(style=STYLES.get(drawn.label, own)) for drawn in one.lines)
    lines += (drawn._replace(style=STYLES[drawn.label]) for drawn in _exact(problem, case[0].lines))
    scales: dict[str, Any] = {} if picture.axes else {"aspect": "equal", "adjustable": "datalim"}
    scales |= {"xscale": "log", "yscale": "log"} if picture.guide else {}
    draw_lines({problem.title: lines}, path, tall=3.6, xlabel=x, ylabel=y, **scales)


def _exact(problem: Problem, found: Sequence[Line]) -> Iterator[Line]:
    """Yield what a picture has whatever the models answer: undeformed axes, the exact answer, a line for the eye."""
    picture, scene = problem.picture, problem.scene
    if picture.guide:
        order, first = picture.guide
        ends = np.sort(np.asarray(found[0].points)[0, [0, -1]])
        yield Line(GUIDE, (ends, first * (ends / ends[0]) ** order))
    elif not picture.axes:
        yield from undeformed(scene)
    if picture.exact:
        yield from deflected(scene, answered(scene, picture.exact), ANSWER, picture.shown)


def page(cases: Sequence[Sequence[Judgement]]) -> str:
    """Return the manual as Markdown: a table of all answers, then a section for each problem."""
    template, judgements = PAGE.read_text(encoding="utf-8"), list(chain.from_iterable(cases))
    return sentence(template, cases=cases, judgements=judgements, versions=versions())


def _numbers(case: Sequence[Judgement]) -> dict[str, Any]:
    """Return everything but the picture as nested numbers."""
    problem = case[0].problem
    stated = ("name", "title", "purpose", "statement", "source", "uncertainty")
    return {
        **{name: getattr(problem, name) for name in stated},
        "quantities": problem.quantities,
        "runs": [
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
            for item in case
        ],
        "picture": f"{problem.name}.svg",
        "passed": all(item.passed for item in case),
        "seconds": sum(item.seconds for item in case),
    }


def _check(item: Judgement) -> tuple[str, str, float, str | None, str]:
    """Return the check of `junit_text` for an answer."""
    measured = "\n".join(one.measured for one in item.findings)
    return f"manual.{item.problem.name}", item.trial.label, item.seconds, item.failure, measured


def write_manual(folder: Path, report: Report, files: Sequence[Path]) -> tuple[list[Judgement], list[Path]]:
    """Solve problems, judge the answers and write the manual; return the judgements and the files, the text first.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    report : callable
        Takes a line for each problem.
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
        pictures.append(folder / f"{problem.name}.svg")
        draw_case(case, pictures[-1])
        cases.append(case)
        failed = [item for item in case if not item.passed]
        report(
            f"{problem.name}: {'FAILED' if failed else 'passed'}, {sum(item.seconds for item in case):.1f} s"
        )
        for item in failed:
            report(f"  {item.trial.label}: {item.failure}")
    write_text(folder / "index.md", page(cases))
    judgements = list(chain.from_iterable(cases))
    write_text(folder / "junit.xml", junit_text("crossval run manual", map(_check, judgements)))
    numbers = {"passed": all(item.passed for item in judgements), "cases": list(map(_numbers, cases))}
    write_numbers(folder / "manual.json", numbers)
    return judgements, [*(folder / name for name in FILES[:2]), *pictures, folder / FILES[2]]
