"""The manual as a folder: ``index.md``, a picture for each case, ``manual.json``."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from comparisons.claims.claim import Claim, judge
from comparisons.claims.manual.answers import ANSWER, Answers, Curve, answered, deflected, undeformed
from comparisons.claims.manual.measures import MEASURES
from comparisons.claims.manual.pictures import GUIDE, draw_problem
from comparisons.claims.manual.problem import Case, Problem, Trial, read_problem
from comparisons.claims.manual.text import markdown, numbers
from comparisons.files import writable_folder, write_text
from comparisons.output import Report, write_numbers


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
        statement=problem.statement,
        source=problem.source,
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
