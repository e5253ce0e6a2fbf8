"""``crossval league``: every program on every scene that it can state."""

from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli import values
from comparisons.cli.options import add_others
from comparisons.cli.outcome import DONE
from comparisons.cli.study import workers
from comparisons.files import writable_folder
from comparisons.scene import built_in_scenes, load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands

EPILOG = """exit status: 0 every run has a result (those that stopped or were wrong are listed), 2 bad input or a place that cannot be used,
130 interrupted; what is done is kept, and the same command goes on from there"""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    league = commands.add_parser(
        "league",
        help="measure every program on every scene against the exact rods",
        description="Runs every model at up to five of its own resolutions: errors, spurious friction, processor seconds, and "
        "how often a program said success and was wrong.",
        epilog=EPILOG,
    )
    league.add_argument(
        "scenes", nargs="*", metavar="SCENE", help="built-in scenes or TOML files (all built-in ones)"
    )
    add_others(league)
    league.add_argument(
        "--out",
        type=Path,
        default=Path("out/league"),
        metavar="DIR",
        help="folder of the results (out/league)",
    )
    where = league.add_mutually_exclusive_group()
    where.add_argument("--workers", type=values.count, metavar="N", help="processes (1)")
    where.add_argument("--cluster", metavar="ADDRESS", help="the scheduler of a Dask cluster")
    league.add_argument("--quick", action="store_true", help="at most two resolutions of every program")
    league.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Measure, print the summary and name the files."""
    scenes = [load_scene(name) for name in given.scenes or built_in_scenes()]
    folder = writable_folder(
        given.out, *(f"league.{kind}" for kind in ("csv", "json", "svg", "png")), "report.html"
    )
    given.workers = given.workers or 1
    from comparisons.cases.progress import shown
    from comparisons.league.entries import measure_league
    from comparisons.league.page import summary, write_league
    from comparisons.output import tabulated

    with shown() as progress:
        league = measure_league(
            scenes,
            given.others,
            folder / "results",
            workers(given),
            quick=given.quick,
            progress=progress,
        )
    print(tabulated(summary(league)))
    for name, program, reason in league.left_out:
        print(f"{name}: {program}: left out, {reason}")
    print("\nfiles:", *(f"  {path}" for path in write_league(league, folder)), sep="\n")
    return DONE
