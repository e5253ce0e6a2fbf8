"""``crossval results``: what a study or a trade found, as a table."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.outcome import DONE

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    results = commands.add_parser("results", help="print the results of a study")
    results.add_argument("file", type=Path, metavar="FILE", help="a results file, NAME.sqlite")
    results.add_argument("--csv", action="store_true", help="every column, as CSV")
    results.add_argument(
        "--no-timings",
        dest="timings",
        action="store_false",
        help="leave out seconds and memory: the rest is the same, byte for byte, in every run",
    )
    results.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Print the table."""
    from comparisons.cases.results import read_results, result_rows, result_table
    from comparisons.output import csv_text

    found = read_results(given.file)
    if not given.csv:
        print(result_table(found, timings=given.timings))
    elif found:
        sys.stdout.write(csv_text(result_rows(found, timings=given.timings)))
    return DONE
