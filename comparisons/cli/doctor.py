"""``crossval doctor``: whether this machine has what the commands use."""

from typing import TYPE_CHECKING

from comparisons.cli.outcome import DONE, WRONG

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands

MARKS = {True: "ok", False: "MISSING", None: "-"}


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    doctor = commands.add_parser(
        "doctor",
        help="look at versions, optional extras, programs and OpenGL",
        epilog="exit status: 0 all that is needed is there, 1 something is missing",
    )
    doctor.set_defaults(run=run)


def run(_: "argparse.Namespace") -> int:
    """Print what was looked at."""
    from comparisons.cli.machine import examined

    well = True
    for finding in examined():
        print(f"{MARKS[finding.well]:8s}{finding.what:14s} {finding.state}")
        well = well and finding.well is not False
    return DONE if well else WRONG
