"""``crossval study``: one question to the solid model, or a study file."""

import os
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.claims.solid.questions import QUESTIONS
from comparisons.cli import values
from comparisons.cli.outcome import DONE, STOPPED, report
from comparisons.files import writable_folder
from comparisons.scene.tables import InputError

if TYPE_CHECKING:
    import argparse

    from comparisons.cases.workers import Workers
    from comparisons.cli.outcome import Commands

STUDY_EPILOG = """exit status: 0 every case has a result (a solution that stopped is one, and is named), 2 bad input or a place
that cannot be used, 3 cases are left without a result, 130 interrupted; what is done is kept, and the same command goes on from there"""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    asked = "; ".join(f"{name}: {what}" for name, what in QUESTIONS.items())
    study = commands.add_parser(
        "study",
        help="run the cases of a study file, or measure how far the solid can be trusted",
        description=f"A study file states a scene and what is varied in it. The questions are: {asked}.",
        epilog=STUDY_EPILOG,
    )
    study.add_argument("study", metavar="FILE|QUESTION", help=f"a TOML file, or {', '.join(QUESTIONS)}")
    study.add_argument(
        "--out",
        type=Path,
        default=Path("out/study"),
        metavar="DIR",
        help="folder of the table NAME.csv; a study file also leaves the results in NAME/ (out/study)",
    )
    where = study.add_mutually_exclusive_group()
    where.add_argument(
        "--workers", type=values.count, metavar="N", help="study file: processes (one for each core)"
    )
    where.add_argument("--cluster", metavar="ADDRESS", help="study file: the scheduler of a Dask cluster")
    study.add_argument("--quiet", action="store_true", help="study file: no progress bar")
    study.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Answer the question, or run the study file."""
    name: str = given.study
    if name in QUESTIONS:
        return _answer(given)
    if name.endswith(".toml") or os.sep in name:
        return _run_file(given)
    raise InputError(name, f"must be a study file, NAME.toml, or one of {', '.join(QUESTIONS)}")


def _answer(given: "argparse.Namespace") -> int:
    for option in ("workers", "cluster"):
        if getattr(given, option):
            raise InputError(f"--{option}", f"belongs to a study file, {given.study} is a question")
    writable_folder(given.out, f"{given.study}.csv")
    from comparisons.claims.solid.solid_accuracy import STUDIES
    from comparisons.output import tabulated, write_rows

    rows = list(STUDIES[given.study](report))
    print(tabulated(rows))
    print("file:", write_rows(given.out / f"{given.study}.csv", rows))
    return DONE


def _run_file(given: "argparse.Namespace") -> int:
    from comparisons.cases.progress import shown
    from comparisons.cases.run import UNSETTLED
    from comparisons.cases.run import run as run_cases
    from comparisons.cases.study import read_study
    from comparisons.cases.table import result_rows, result_table
    from comparisons.output import write_rows

    study = read_study(Path(given.study))
    folder = writable_folder(given.out, f"{study.name}.csv")
    with shown(quiet=given.quiet) as progress:
        found = run_cases(
            study.cases,
            folder / study.name,
            workers(given),
            repeats=study.repeats,
            progress=progress,
        )
    rows = result_rows(found)
    ends = Counter(row["status"] for row in rows)
    print(result_table(rows))
    print(f"\n{study.name}: {len(rows)} cases: {', '.join(f'{name} {ends[name]}' for name in sorted(ends))}")
    print("file:", write_rows(folder / f"{study.name}.csv", rows))
    left = sum(ends[name] for name in UNSETTLED)
    if left:
        print(f"crossval: {left} cases have no result; the same command tries them again", file=sys.stderr)
    return STOPPED if left else DONE


def workers(given: "argparse.Namespace") -> "Workers":
    """Return where the cases run: ``--cluster``, or ``--workers`` processes."""
    from comparisons.cases.workers import cluster, local

    return local(given.workers) if given.cluster is None else cluster(given.cluster)
