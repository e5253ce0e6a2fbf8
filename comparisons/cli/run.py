"""``crossval run``: a suite of cases by its name, or a study file."""

import os
from argparse import Namespace
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from shutil import rmtree

from comparisons.cli.command import STOPPED, report, told
from comparisons.cli.options import refuse, workers
from comparisons.cli.screen import ended, shown, teller
from comparisons.files import writable_folder
from comparisons.models import TSM
from comparisons.output import cell, tabulated, write_rows
from comparisons.scene import InputError, load_scene
from comparisons.suite.progress import running
from comparisons.suite.run import UNSETTLED
from comparisons.suite.study import read_study, result_rows, result_table
from comparisons.suites.bench import write_bench
from comparisons.suites.extremes.run import extremes
from comparisons.suites.manual import manual, problems
from comparisons.suites.names import FIGURES, QUESTIONS
from comparisons.suites.paper.reproduce import reproduce
from comparisons.suites.solid_accuracy import STUDIES
from comparisons.suites.trade.cases import NoReferenceError
from comparisons.suites.trade.report import trade


def run(given: Namespace) -> int:
    """Run what is named, with the options that it has."""
    name: str = given.suite
    suite = STUDY_FILE if name.endswith(".toml") or os.sep in name else SUITES.get(name)
    if suite is None:
        raise InputError(name, f"must be a study file, NAME.toml, or one of {', '.join(SUITES)}")
    options, suite_run = suite
    foreign = (option for option in ("of", "quick", "workers") if option not in options.split())
    refuse(given, foreign, f"is no option of {name}")
    return suite_run(given)


def _out(given: Namespace, *names: str) -> Path:
    """Return the folder of the results, tried out."""
    return writable_folder(given.out or Path("out") / Path(given.suite).stem, *names)


def _figures(given: Namespace) -> int:
    folder = _out(given, "report.html")
    return shown(reproduce(given.suite, quick=given.quick, report=report), folder)


def _bench(given: Namespace) -> int:
    folder = given.out or Path("out") / given.suite
    return ended(write_bench(folder, given.of or [TSM.name], teller(quiet=given.quiet)))


def _manual(given: Namespace) -> int:
    stated = problems(given.of or None)
    folder = _out(given, "index.md", "manual.json", "junit.xml")
    return shown(manual(stated, teller(quiet=given.quiet)), folder)


def _extremes(given: Namespace) -> int:
    folder = _out(given, "extremes.html", "extremes.csv", "extremes.json")
    kept = folder / ".extremes"  # until the command has come to its end
    with running(kept, workers(given), quiet=given.quiet, repeats=0) as run_cases:
        found = extremes(run_cases, quick=given.quick)
    rmtree(kept)
    return shown(found, folder)


def _trade(given: Namespace) -> int:
    if len(given.of) != 1:
        raise InputError("SCENE", "is missing: crossval run trade SCENE")
    scene = load_scene(given.of[0])
    folder = given.out or Path("out/trade") / scene.name
    writable_folder(folder, "report.html", "trade.csv", "trade.json")
    try:
        with running(folder / "results", workers(given, 1), quiet=given.quiet) as run_cases:
            found = trade(scene, run_cases, quick=given.quick)
    except NoReferenceError as error:
        return told(error, STOPPED)
    return shown(found, folder)


def _question(given: Namespace) -> int:
    folder = _out(given, f"{given.suite}.csv")
    rows = []
    for row in STUDIES[given.suite]():
        rows.append(row)
        report(", ".join(f"{name} {cell(value)}" for name, value in row.items() if name != "message"))
    print(tabulated(rows))
    return ended([write_rows(folder / f"{given.suite}.csv", rows)])


def _study(given: Namespace) -> int:
    study = read_study(Path(given.suite))
    table = f"{study.name}.csv"
    folder = writable_folder(given.out or Path("out/study"), table)
    with running(folder / study.name, workers(given), quiet=given.quiet, repeats=study.repeats) as run_cases:
        rows = result_rows(run_cases(study.cases).values())
    ends = Counter(row["status"] for row in rows)
    print(result_table(rows))
    print(f"\n{study.name}: {len(rows)} cases: {', '.join(f'{name} {ends[name]}' for name in sorted(ends))}")
    left = sum(ends[name] for name in UNSETTLED)
    again = [f"{left} cases have no result; the same command tries them again"] if left else []
    return ended([write_rows(folder / table, rows)], again)


SUITES: dict[str, tuple[str, Callable[[Namespace], int]]] = {
    **dict.fromkeys(("paper", *FIGURES), ("quick", _figures)),
    "manual": ("of", _manual),
    "bench": ("of", _bench),
    "extremes": ("quick workers", _extremes),
    "trade": ("of quick workers", _trade),
    **dict.fromkeys(QUESTIONS, ("", _question)),
}
"""The options that a suite has beside ``--out``, and the function that runs it."""
STUDY_FILE = "workers", _study
