"""``crossval study``: one question to the solid model."""

from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.outcome import DONE, EPILOG, report
from comparisons.files import writable_folder
from comparisons.studies.questions import QUESTIONS

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    study = commands.add_parser(
        "study",
        help="measure how far the solid can be trusted",
        description="; ".join(f"{name}: {what}" for name, what in QUESTIONS.items()),
        epilog=EPILOG,
    )
    study.add_argument("question", metavar="QUESTION", choices=tuple(QUESTIONS), help=", ".join(QUESTIONS))
    study.add_argument(
        "--out", type=Path, default=Path("out/study"), metavar="DIR", help="folder of the table (out/study)"
    )
    study.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Answer, print the table and write it."""
    writable_folder(given.out)
    from comparisons.studies.output import write_rows
    from comparisons.studies.solid_accuracy import STUDIES, tabulated

    rows = STUDIES[given.question](report)
    print(tabulated(rows))
    print("file:", write_rows(given.out / f"{given.question}.csv", rows))
    return DONE
