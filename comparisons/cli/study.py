"""``crossval study``: one question to the solid model, or a study file."""

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.claims.solid.questions import QUESTIONS
from comparisons.cli import values
from comparisons.cli.outcome import DONE, STOPPED, report
from comparisons.files import writable_folder
from comparisons.scene.tables import InputError

if TYPE_CHECKING:
    import argparse

    from comparisons.cases.run import Tally
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
        help="folder of the table, or of the results NAME.sqlite (out/study)",
    )
    study.add_argument("--results", type=Path, metavar="FILE", help="study file: the results file")
    where = study.add_mutually_exclusive_group()
    where.add_argument(
        "--workers", type=values.count, metavar="N", help="study file: processes (one for each core)"
    )
    where.add_argument("--cluster", metavar="ADDRESS", help="study file: the scheduler of a Dask cluster")
    study.add_argument(
        "--keep-old-versions",
        action="store_true",
        help="study file: results that other versions of this program left in the file are not computed anew",
    )
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
    for option in ("results", "workers", "cluster", "keep_old_versions"):
        if getattr(given, option):
            raise InputError(
                f"--{option.replace('_', '-')}", f"belongs to a study file, {given.study} is a question"
            )
    writable_folder(given.out, f"{given.study}.csv")
    from comparisons.claims.solid.solid_accuracy import STUDIES
    from comparisons.output import tabulated, write_rows

    rows = STUDIES[given.study](report)
    print(tabulated(rows))
    print("file:", write_rows(given.out / f"{given.study}.csv", rows))
    return DONE


def _run_file(given: "argparse.Namespace") -> int:
    from comparisons.cases.progress import line_ended, shown
    from comparisons.cases.run import run as run_cases
    from comparisons.cases.store import Store
    from comparisons.cases.study import read_study

    study = read_study(Path(given.study))
    file = given.results or writable_folder(given.out) / f"{study.name}.sqlite"
    where = workers(given)
    with line_ended(), Store(file) as store:
        tally = run_cases(
            study.cases,
            store,
            where,
            repeats=study.repeats,
            progress=shown(quiet=given.quiet),
            keep=given.keep_old_versions,
        )
    report_older(tally, keep=given.keep_old_versions)
    return _concluded(study.name, tally, file)


def workers(given: "argparse.Namespace") -> "Workers":
    """Return where the cases run: ``--cluster``, or ``--workers`` processes."""
    from comparisons.cases.workers import cluster, local

    return local(given.workers) if given.cluster is None else cluster(given.cluster)


def report_older(tally: "Tally", *, keep: bool = False) -> None:
    """Say in one line what became of the results of other versions, if there are any."""
    if tally.older:
        versions = ", ".join(tally.older)
        what = "kept" if keep else "left aside, and the cases computed anew"
        report(f"crossval: {sum(tally.older.values())} results of other versions ({versions}) were {what}")


def _concluded(name: str, tally: "Tally", file: Path) -> int:
    """Say how the cases ended; a case without a result makes the exit status."""
    from comparisons.cases.store import UNSETTLED

    ends = ", ".join(f"{status} {number}" for status, number in tally.statuses.items())
    print(f"{name}: {tally.done} cases: {ends}")
    print(f"file: {file}", f"crossval results {file} shows them", sep="\n")
    left = sum(tally.statuses.get(status, 0) for status in UNSETTLED)
    if left:
        print(f"crossval: {left} cases have no result; the same command tries them again", file=sys.stderr)
    return STOPPED if left else DONE
