"""The manual as a folder: ``index.md``, a picture for each case, ``manual.json``."""

from collections.abc import Callable, Sequence
from pathlib import Path

from comparisons.claims.manual.judge import answered
from comparisons.claims.manual.pictures import draw
from comparisons.claims.manual.record import Manual, Problem
from comparisons.claims.manual.text import markdown, numbers
from comparisons.files import writable_folder, write_text
from comparisons.output import Report, write_numbers


def write_manual(folder: Path, report: Report, problems: Sequence[Callable[[], Problem]]) -> Manual:
    """Solve all problems, judge the answers and write the manual.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    report : callable
        Takes a line for each case.
    problems : sequence of callable
        What is solved, of `comparisons.claims.manual.problems.named`.

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
    for state in problems:
        problem = state()
        picture = folder / f"{problem.name}.svg"
        case, curves = answered(problem, picture.name)
        draw(problem.title, problem.picture, curves, picture)
        cases.append(case)
        pictures.append(picture)
        report(f"{problem.name}: {'passed' if case.passed else 'FAILED'}, {case.seconds:.1f} s")
        for item in case.judgements:
            if item.failure:
                report(f"  {item.claim.name}: {item.failure}")
    page = folder / "index.md"
    write_text(page, markdown(cases))
    values = write_numbers(folder / "manual.json", numbers(cases))
    return Manual(cases=tuple(cases), files=(page, values, *pictures))
