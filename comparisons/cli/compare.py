"""``crossval compare``: one scene, every model."""

from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.outcome import EPILOG, exit_status, report
from comparisons.scene import load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    compare = commands.add_parser("compare", help="solve a scene with every model and compare", epilog=EPILOG)
    compare.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    compare.add_argument("--out", type=Path, metavar="DIR", help="folder of the results (out/SCENE)")
    compare.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Compare, print the table and name the files."""
    scene = load_scene(given.scene)
    from comparisons.compare import ROD, compare
    from comparisons.table import table_text

    found = compare(scene, given.out or Path("out") / scene.name, report)
    print(table_text(found.rows, ROD.label))
    print("\nfiles:", *(f"  {path}" for path in found.files), sep="\n")
    return exit_status(scene, [(f"{row.label}: ", row.response) for row in found.rows])
