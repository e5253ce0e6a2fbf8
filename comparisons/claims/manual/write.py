"""The manual as a folder: ``index.md``, a picture for each case, ``manual.json``; and as JUnit checks."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from comparisons.claims.claim import Claim, Judgement, judge
from comparisons.claims.junit import JUnitCase
from comparisons.claims.manual.answers import ANSWER, Answers, Curve, answered, deflected, undeformed
from comparisons.claims.manual.measures import MEASURES
from comparisons.claims.manual.pictures import GUIDE, draw_problem
from comparisons.claims.manual.problem import Case, Problem, Trial, read_problem
from comparisons.files import writable_folder, write_text
from comparisons.output import Report, write_numbers
from comparisons.version import versions

HEAD = """# Verification manual

{cases} problems with exact answers, put to every model that can state them: {passed} of {runs} answers within their tolerances.
An error is that of the worst quantity, relative to its exact value, or to the length where it is a position. `crossval run manual` writes
this page, its pictures and `manual.json`; it took {seconds:.0f} s with {versions}.

"""
SECTION = """<a id="{problem.name}"></a>

## {problem.title}

{problem.statement}

Purpose: {problem.purpose}

Exact value: {problem.source}.

![{problem.title}]({picture})

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
STATED = ("name", "title", "purpose", "statement", "source", "uncertainty", "quantities")


def markdown(cases: Sequence[Case]) -> str:
    """Return the manual as Markdown: a table of all answers, then a section for each case."""
    judgements = [item for case in cases for item in case.judgements]
    head = HEAD.format(
        cases=len(cases),
        passed=sum(item.passed for item in judgements),
        runs=len(judgements),
        seconds=sum(item.seconds for item in judgements),
        versions=", ".join(f"{name} {number}" for name, number in versions().items()),
    )
    answers = [_answer(case, item) for case in cases for item in case.judgements]
    return head + table([COLUMNS, *answers]) + "\n" + "\n".join(map(_section, cases))


def table(rows: Sequence[Sequence[str]]) -> str:
    """Return rows, the header first, as a table in Markdown."""
    lines = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in rows]
    return "".join([lines[0], "|" + "---|" * len(rows[0]) + "\n", *lines[1:]])


def _answer(case: Case, item: Judgement) -> list[str]:
    """The answer of a model: its quantity of the largest error."""
    k = item.worst
    quantity = case.problem.quantities[k]
    return [
        f"[{case.problem.title}](#{case.problem.name})",
        item.claim.name,
        quantity.name,
        f"{quantity.exact:.9g}",
        item.stopped or f"{item.values[k]:.9g}",
        f"{item.findings[k].error:.1e}",
        f"{item.claim.allowance.error:.2g}",
        _verdict(item),
    ]


def _verdict(item: Judgement) -> str:
    return "passed" if item.passed else "**FAILED**"


def _section(case: Case) -> str:
    problem, items = case.problem, case.judgements
    rows = [["quantity", "exact", *(item.claim.name for item in items)]]
    for k, quantity in enumerate(problem.quantities):
        computed = (f"{item.values[k]:.9g} ({item.findings[k].error:.1e})" for item in items)
        rows.append([quantity.name, f"{quantity.exact:.12g}", *computed])
    rows += [
        ["tolerance", "", *(f"{item.claim.allowance.error:.2g}" for item in items)],
        ["verdict", "", *map(_verdict, items)],
        ["seconds", "", *(f"{item.seconds:.2f}" for item in items)],
    ]
    reasons = (
        f"- {item.claim.name}: {item.claim.allowance.why}.{f' Stopped: {item.stopped}.' * bool(item.stopped)}\n"
        for item in items
    )
    return SECTION.format(problem=problem, picture=case.picture) + table(rows) + "\n" + "".join(reasons)


def numbers(cases: Sequence[Case]) -> dict[str, Any]:
    """Return everything but the pictures as nested numbers."""
    return {"passed": all(case.passed for case in cases), "cases": [_case(case) for case in cases]}


def _case(case: Case) -> dict[str, Any]:
    runs = [
        {
            "model": trial.model,
            "setting": trial.setting,
            "tolerance": trial.allowance.error,
            "reason": trial.allowance.why,
            "values": item.values,
            "errors": [finding.error for finding in item.findings],
            "seconds": item.seconds,
            "stopped": item.stopped,
            "passed": item.passed,
        }
        for trial, item in zip(case.problem.trials, case.judgements, strict=True)
    ]
    stated = {name: getattr(case.problem, name) for name in STATED}
    found = {name: getattr(case, name) for name in ("picture", "passed", "seconds")}
    return {**stated, "runs": runs, **found}


def junit_cases(cases: Sequence[Case]) -> Iterator[JUnitCase]:
    """Yield a check for every case and model."""
    for case in cases:
        yield from (item.junit(f"manual.{case.problem.name}") for item in case.judgements)


class Manual(NamedTuple):
    """The cases of the manual, and what was written, the text first."""

    cases: tuple[Case, ...]
    files: tuple[Path, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every case passed."""
        return all(case.passed for case in self.cases)


def judged(problem: Problem) -> tuple[Case, list[Curve]]:
    """Return a problem with the judgements on all its models, and the curves that they add to its picture."""
    answers = [Answers(problem, trial) for trial in problem.trials]
    claims = (_claim(problem, trial, one) for trial, one in zip(problem.trials, answers, strict=True))
    case = Case(problem=problem, judgements=tuple(map(judge, claims)))
    return case, [curve for one in answers for curve in one.curves]


def _claim(problem: Problem, trial: Trial, answers: Answers) -> Claim:
    return Claim(
        name=trial.label,
        quantities=problem.quantities,
        allowance=trial.allowance,
        measure=lambda: MEASURES[problem.measure](problem, answers),
    )


def _exact(problem: Problem, curves: Sequence[Curve]) -> tuple[Curve, ...]:
    """Return what a picture has whatever the models answer: undeformed axes, the exact answer, a line for the eye."""
    picture, scene = problem.picture, problem.scene
    if picture.guide:
        order, first = picture.guide
        ends = np.sort(curves[0].points[[0, -1], 0])
        return (Curve(GUIDE, np.stack([ends, first * (ends / ends[0]) ** order], axis=1)),)
    drawn = () if picture.axes else undeformed(scene)
    if picture.exact:
        drawn += (deflected(scene, answered(scene, picture.exact), ANSWER, picture.shown),)
    return drawn


def write_manual(folder: Path, report: Report, files: Sequence[Path]) -> Manual:
    """Solve problems, judge the answers and write the manual.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    report : callable
        Takes a line for each case.
    files : sequence of Path
        The problems, of `comparisons.claims.manual.problem.problems`.

    Returns
    -------
    Manual

    Raises
    ------
    OutputError
        If the folder cannot be written in.
    """
    writable_folder(folder)
    cases, pictures = [], []
    for problem in map(read_problem, files):
        case, curves = judged(problem)
        pictures.append(folder / case.picture)
        draw_problem(problem, [*_exact(problem, curves), *curves], pictures[-1])
        cases.append(case)
        report(f"{problem.name}: {'passed' if case.passed else 'FAILED'}, {case.seconds:.1f} s")
        for item in case.judgements:
            if item.failure:
                report(f"  {item.claim.name}: {item.failure}")
    page = folder / "index.md"
    write_text(page, markdown(cases))
    values = write_numbers(folder / "manual.json", numbers(cases))
    return Manual(cases=tuple(cases), files=(page, values, *pictures))
