"""The manual: judgements on the answers, a picture for each problem, and what is found as a page, Markdown, numbers and JUnit checks."""

from collections.abc import Sequence
from functools import partial
from itertools import chain
from math import inf, nan
from pathlib import Path
from time import perf_counter
from typing import Any

from comparisons.answer.table import unit_names
from comparisons.frozen import Frozen
from comparisons.models import find
from comparisons.models.shared import kept
from comparisons.output import Report, Row, markdown
from comparisons.report import palette
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, picture, piece, table
from comparisons.report.plot import Line, draw_lines
from comparisons.suites.finding import Finding, junit_text
from comparisons.suites.formula import sentence
from comparisons.suites.found import Found
from comparisons.suites.manual.measures import MEASURES, Answers, StoppedError, exact_lines
from comparisons.suites.manual.problem import Problem, Trial, read_problem
from comparisons.version import versions

PAGE = Path(__file__).with_name("page.md.jinja")


class Judgement(Frozen):
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
    def verdict(self) -> str:
        """The verdict in a word."""
        return "passed" if self.passed else "FAILED"

    @property
    def reason(self) -> str:
        """The reason of the tolerance, and why there is no answer."""
        return f"{self.trial.why}.{f' Stopped: {self.stopped}.' if self.stopped else ''}"

    @property
    def worst(self) -> Finding:
        """The finding with the largest error, the first that is not a number if one is not."""
        return max(self.findings, key=lambda one: one.share)

    @property
    def failure(self) -> str | None:
        """Why the answer fails, with its numbers; None if it is right."""
        return self.stopped or self.worst.failure


def judged(problem: Problem) -> list[Judgement]:
    """Return the judgements on all models of a problem; a measure without a value for every quantity is a `ValueError`."""
    return [_judged(Answers(problem=problem, trial=trial)) for trial in problem.trials]


def _judged(answers: Answers) -> Judgement:
    asked, trial, began, stopped = answers.problem.quantities, answers.trial, perf_counter(), ""
    try:
        values = list(MEASURES[answers.problem.measure](answers))
    except StoppedError as error:
        stopped, values = str(error), [nan] * len(asked)
    seconds = perf_counter() - began

    bound = kept(trial, "allowed why")
    findings = tuple(
        Finding(error=inf if stopped else one.error(value), value=value, **kept(one, "name exact"), **bound)
        for one, value in zip(asked, values, strict=True)
    )
    return Judgement(**vars(answers), findings=findings, seconds=seconds, stopped=stopped)


def draw_case(case: Sequence[Judgement], *paths: Path) -> None:
    """Draw what is exact and what the models found on a problem."""
    problem, picture, lines = case[0].problem, case[0].problem.picture, list[Line]()
    length = unit_names(problem.scene.units)["length"]
    x, y = picture.axes or (f"x [{length}]", f"y [{length}]")
    # the first model on top, each line wider than those above it, so that those that agree are all seen
    for number, one in reversed(list(enumerate(case))):
        trial = one.trial
        colour = palette.style(find(trial.model.split()[0]).family(trial.scene, trial.options)).colour
        size = {"marker": "o", "markersize": 10.0} if picture.guide else {"linewidth": 1.5 + 2.0 * number}
        own = {"color": colour, **size}
        lines += (drawn._replace(style=drawn.style or own) for drawn in one.lines)
    lines += exact_lines(problem, case[0].lines)
    scales: dict[str, Any] = {} if picture.axes else {"aspect": "equal", "adjustable": "datalim"}
    scales |= {"xscale": "log", "yscale": "log"} if picture.guide else {}
    draw_lines({problem.title: lines}, *paths, tall=3.6, xlabel=x, ylabel=y, **scales)


def _answer(item: Judgement) -> Row:
    """Return the row of an answer in the table of all."""
    worst = item.worst
    return {
        "case": item.problem.title,
        "model": item.trial.label,
        "quantity of the largest error": worst.name,
        "exact": f"{worst.exact:.9g}",
        "computed": item.stopped or f"{worst.value:.9g}",
        "error": f"{worst.error:.1e}",
        "tolerance": f"{worst.allowed:.2g}",
        "verdict": item.verdict,
    }


def _answers(case: Sequence[Judgement]) -> list[Row]:
    """Return the rows of a problem: each quantity by each model, tolerances, verdicts and seconds."""
    rows = [
        (of[0].name, f"{of[0].exact:.12g}", *(f"{one.value:.9g} ({one.error:.1e})" for one in of))
        for of in zip(*(item.findings for item in case), strict=True)
    ]
    rows += [
        ("tolerance", "", *(f"{item.trial.allowed:.2g}" for item in case)),
        ("verdict", "", *(item.verdict for item in case)),
        ("seconds", "", *(f"{item.seconds:.2f}" for item in case)),
    ]
    columns = ("quantity", "exact", *(item.trial.label for item in case))
    return [dict(zip(columns, row, strict=True)) for row in rows]


def _section(case: Sequence[Judgement], folder: Path) -> Section:
    """Return a problem on the page."""
    problem = case[0].problem
    about = {"Problem": problem.statement, "Purpose": problem.purpose, "Exact value": problem.source}
    reasons = {item.trial.label: item.reason for item in case}
    parts = (
        picture(folder / f"{problem.name}.svg", problem.title),
        piece("definitions", about),
        table("Answers, their errors in brackets", _answers(case)),
        piece("definitions", reasons),
    )
    return Section(problem.title, "\n".join(parts))


def _numbers(case: Sequence[Judgement]) -> dict[str, Any]:
    """Return everything but the picture as nested numbers."""
    problem = case[0].problem
    runs = [
        {
            **kept(item.trial, "model setting"),
            "tolerance": item.trial.allowed,
            "reason": item.trial.why,
            **{f"{name}s": [getattr(one, name) for one in item.findings] for name in ("value", "error")},
            **kept(item, "seconds stopped passed"),
        }
        for item in case
    ]
    return {
        **kept(problem, "name title purpose statement source uncertainty quantities"),
        "runs": runs,
        "picture": f"{problem.name}.svg",
        "passed": all(item.passed for item in case),
        "seconds": sum(item.seconds for item in case),
    }


def manual(files: Sequence[Path], report: Report) -> Found:
    """Solve problems, the files of `comparisons.suites.manual.problem.problems`, and judge the answers; `report` takes a line for each problem."""
    cases, wrong = list[list[Judgement]](), list[str]()
    for problem in map(read_problem, files):
        case = judged(problem)
        cases.append(case)
        failed = [f"{item.trial.label}: {item.failure}" for item in case if not item.passed]
        spent = sum(item.seconds for item in case)
        report(f"{problem.name}: {'FAILED' if failed else 'passed'}, {spent:.1f} s")
        for line in failed:
            report(f"  {line}")
        wrong += (f"{problem.name}, {line}" for line in failed)
    judgements = list(chain.from_iterable(cases))
    every = [_answer(item) for item in judgements]
    links = ({"case": f"[{item.problem.title}](#{item.problem.name})"} for item in judgements)
    linked = [row | link for row, link in zip(every, links, strict=True)]
    checks = (
        (f"manual.{item.problem.name}", item.trial.label, item.seconds, item.failure, item.findings)
        for item in judgements
    )
    words: dict[str, Any] = {"cases": cases, "judgements": judgements, "versions": versions()}
    words |= {"every": markdown(linked), "answers": lambda case: markdown(_answers(case))}
    text = sentence(PAGE.read_text(encoding="utf-8"), **words)
    said = f"{len(cases)} cases, {len(judgements)} answers, {len(wrong)} beyond their tolerance."
    return Found(
        title="Verification manual",
        brief=Brief(said, wrong),
        files={
            "index.md": text.replace(" FAILED ", " **FAILED** "),
            "manual.json": {"passed": not wrong, "cases": list(map(_numbers, cases))},
            "junit.xml": junit_text("crossval run manual", checks),
        },
        sections=lambda folder: [
            Section("Answers", table("Of every answer the quantity with the largest error", every)),
            *(_section(case, folder) for case in cases),
        ],
        pictures={f"{case[0].problem.name}.svg": partial(draw_case, case) for case in cases},
        wrong=wrong,
    )
