"""``crossval compare``: one scene, every model."""

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.options import add_others
from comparisons.cli.outcome import DONE, STOPPED, exit_status, report
from comparisons.cli.progress import staging, watching
from comparisons.models.progress import Count, Watch
from comparisons.scene import load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands

EPILOG = """exit status: 0 compared, 2 bad input, 3 the exact rods stopped, or an answer was refused by its checks or the referee.
A model that stops with a named status is a row of the table."""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    compare = commands.add_parser("compare", help="solve a scene with every model and compare", epilog=EPILOG)
    compare.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    add_others(compare)
    compare.add_argument("--out", type=Path, metavar="DIR", help="folder of the results (out/SCENE)")
    compare.add_argument("--quiet", action="store_true", help="tell of no progress")
    compare.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Compare, print the table and name the files."""
    scene = load_scene(given.scene)
    from comparisons.compare import ROD, compare
    from comparisons.show.table import table_text

    def tell(line: str) -> None:
        if not given.quiet:
            report(line)

    def watch(label: str) -> AbstractContextManager[Watch]:
        return watching(label, quiet=given.quiet)

    def stage(label: str) -> AbstractContextManager[Count]:
        return staging(label, quiet=given.quiet)

    found = compare(scene, given.out or Path("out") / scene.name, tell, watch, stage, given.others)
    print(table_text(found.rows, ROD.label))
    if found.other_events:
        print("", *found.other_events, sep="\n")
    print("\nfiles:", *(f"  {path}" for path in found.files), sep="\n")
    exit_status(scene, [(f"{row.label}: ", row.response) for row in found.rows])
    for row in found.apart:
        report(f"crossval: {row.label}: OTHER_BRANCH: ends in another equilibrium than the {ROD.label}")
    return STOPPED if found.apart or found.wrong else DONE
