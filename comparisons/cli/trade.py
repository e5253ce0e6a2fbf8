"""``crossval trade``: what accuracy costs, setting by setting."""

from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli import values
from comparisons.cli.outcome import DONE, STOPPED, report
from comparisons.cli.study import workers
from comparisons.scene import load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands
    from comparisons.cost.points import Trade

TRADE_EPILOG = """exit status: 0 every setting was tried (those that stopped are listed), 2 bad input or a place that cannot be used,
3 nothing to measure errors against, 130 interrupted; what is done is kept, and the same command goes on from there"""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    trade = commands.add_parser(
        "trade",
        help="measure what accuracy costs with beams and with the solid",
        description="Sweeps model, element, resolution, order, penalty and load steps: error against seconds, iterations and unknowns.",
        epilog=TRADE_EPILOG,
    )
    trade.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    trade.add_argument("--out", type=Path, metavar="DIR", help="folder of the results (out/trade/SCENE)")
    where = trade.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=values.count,
        metavar="N",
        help="processes (1: cases that run side by side slow each other down)",
    )
    where.add_argument("--cluster", metavar="ADDRESS", help="the scheduler of a Dask cluster")
    trade.add_argument("--quick", action="store_true", help="fewer settings, less than 90 seconds")
    trade.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Measure, print the tables and name the files."""
    scene = load_scene(given.scene)
    folder = given.out or Path("out/trade") / scene.name
    given.workers = given.workers or 1
    from comparisons.cases.progress import shown
    from comparisons.cost.references import NoReferenceError
    from comparisons.cost.sweep import trade_off

    try:
        with shown() as progress:
            found = trade_off(scene, folder, workers(given), quick=given.quick, progress=progress)
    except NoReferenceError as error:
        report(f"crossval: {error}")
        return STOPPED
    print(_text(found.trade))
    print("\nfiles:", *(f"  {path}" for path in found.files), sep="\n")
    return DONE


def _text(trade: "Trade") -> str:
    from comparisons.cost.orders import orders
    from comparisons.cost.sweep import SHOWN
    from comparisons.cost.tables import cheapest_text, orders_text, stopped_text

    limit = (
        "not known: a solid that it is extrapolated from stopped"
        if trade.limit is None
        else trade.limit.sentence
    )
    head = f"""{trade.scene.name}: {len(trade.points)} settings
errors against: {trade.reference.sentence}
the solid's own limit: {limit}
seconds: processor time of one thread from the scene to the checked answer, median of repeats after a warm-up
-: no setting does it; not told: the limit is known less well than that; [n]: n load steps"""
    fitted = orders_text(list(orders(trade, SHOWN)))
    title = f"orders of convergence and cost exponents, error of {SHOWN} over the path"
    return "\n\n".join([head, cheapest_text(trade, SHOWN), title, fitted, stopped_text(trade)])
