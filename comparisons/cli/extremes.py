"""``crossval extremes``: where the models hold, where they stop, and that they say so."""

from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli import values
from comparisons.cli.outcome import DONE, WRONG, report
from comparisons.files import writable_folder

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands

EXTREMES_EPILOG = """exit status: 0 every cell is right or stopped by name, 1 a cell is wrong, 2 a place that cannot be used,
130 interrupted; what is done is kept, and the same command goes on from there"""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    extremes = commands.add_parser(
        "extremes",
        help="map where the models hold and where they stop",
        description="Runs every model over extremes of units, slenderness, shear, meshes, contact positions, load steps, penalty, "
        "Poisson's ratio, depth and time, and compares each answer with the exact one.",
        epilog=EXTREMES_EPILOG,
    )
    extremes.add_argument(
        "--out",
        type=Path,
        default=Path("out/extremes"),
        metavar="DIR",
        help="folder of extremes.html, .csv and .json (out/extremes)",
    )
    extremes.add_argument("--quick", action="store_true", help="a part of the matrix, two minutes at most")
    extremes.add_argument("--workers", type=values.count, metavar="N", help="processes (one for each core)")
    extremes.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Run the matrix, name the files and whatever is wrong."""
    writable_folder(given.out, "extremes.html", "extremes.csv", "extremes.json")
    from comparisons.cases.progress import shown
    from comparisons.cases.workers import local
    from comparisons.claims.extremes.run import counts, extremes
    from comparisons.output import tabulated

    with shown() as progress:
        found = extremes(given.out, local(given.workers), progress, quick=given.quick)
    print(tabulated([{"axis": axis, **number} for axis, number in counts(found.judgements).items()]))
    print("files:", *(f"  {path}" for path in found.files), sep="\n")
    for item in found.wrong:
        report(f"crossval: {item.sentence}")
    return WRONG if found.wrong else DONE
