"""``crossval manual``: the verification manual, run and written anew."""

from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.outcome import DONE, WRONG, report
from comparisons.files import result_file, writable_folder, write_text

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands
    from comparisons.output import Report

MANUAL_EPILOG = """exit status: 0 every answer is within its tolerance, 1 one is not (named, with its numbers) or a solution stopped,
2 bad input or a place that cannot be written in, 130 interrupted"""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    manual = commands.add_parser(
        "manual",
        help="solve the problems of the verification manual and write it",
        description="Problems with exact answers, put to every model that can state them: a page with a table and pictures, and the numbers.",
        epilog=MANUAL_EPILOG,
    )
    manual.add_argument(
        "--out",
        type=Path,
        default=Path("out/manual"),
        metavar="DIR",
        help="folder of the manual (out/manual)",
    )
    manual.add_argument("--junit", type=Path, metavar="FILE", help="write every case and model as JUnit XML")
    manual.add_argument(
        "--cards",
        type=Path,
        metavar="DIR",
        help="write every problem as a JSON file with its scene, values and source, and solve nothing",
    )
    manual.add_argument("--only", nargs="+", metavar="PROBLEM", help="these problems only")
    manual.add_argument("--quiet", action="store_true", help="no line for each case")
    manual.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Solve, write, name what failed; or write the cards."""
    from comparisons.claims.manual.problems import named

    watch: Report = (lambda _: None) if given.quiet else report
    problems = named(given.only)
    if given.cards is not None:
        from comparisons.claims.manual.cards import write_cards

        cards = write_cards(given.cards, watch, problems)
        print(f"{len(cards) - 1} cards and their schema in {given.cards}")
        return DONE
    writable_folder(given.out, "index.md", "manual.json")
    file = None if given.junit is None else result_file(given.junit)
    from comparisons.claims.junit import junit_text
    from comparisons.claims.manual import write_manual
    from comparisons.claims.manual.text import junit_cases

    manual = write_manual(given.out, watch, problems)
    if file is not None:
        write_text(file, junit_text("crossval manual", junit_cases(manual.cases)))
    answers = [(case, one) for case in manual.cases for one in case.judgements]
    failed = [(case, one) for case, one in answers if not one.passed]
    print(f"{len(manual.cases)} cases, {len(answers)} answers, {len(failed)} beyond their tolerance")
    print("files:", *(f"  {path}" for path in (*manual.files, *([file] if file else []))), sep="\n")
    for case, one in failed:
        report(f"crossval: {case.problem.name}, {one.claim.name}: {one.failure}")
    return WRONG if failed else DONE
