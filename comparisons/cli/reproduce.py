"""``crossval reproduce``: the paper's figures and claims."""

from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.claims.paper.figures import FIGURES
from comparisons.cli.outcome import DONE, EPILOG, STOPPED, report
from comparisons.files import writable_folder

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    reproduce = commands.add_parser(
        "reproduce",
        help="reproduce the paper's figures and judge its claims",
        description="; ".join(f"{name}: {what}" for name, what in FIGURES.items()),
        epilog=EPILOG,
    )
    reproduce.add_argument(
        "figure", metavar="FIGURE", choices=(*FIGURES, "all"), help=f"{', '.join(FIGURES)} or all"
    )
    reproduce.add_argument(
        "--out",
        type=Path,
        default=Path("out/reproduce"),
        metavar="DIR",
        help="folder of the results (out/reproduce)",
    )
    reproduce.add_argument(
        "--quick", action="store_true", help="coarse settings, about half a minute for all"
    )
    reproduce.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Reproduce and name the files."""
    writable_folder(given.out, "report.html")
    from comparisons.claims.paper.reproduce import reproduce

    files, stopped = reproduce(given.figure, given.out, quick=given.quick, report=report)
    print("files:", *(f"  {path}" for path in files), sep="\n")
    for reason in stopped:
        report(f"crossval: {reason}")
    return STOPPED if stopped else DONE
