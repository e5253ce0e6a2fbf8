"""``crossval gate``: bounds on errors, for continuous integration."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.options import ModelNames, add_options, chosen
from comparisons.cli.outcome import DONE, WRONG, exit_status, report
from comparisons.files import result_file, write_text
from comparisons.models import TSM
from comparisons.quantities import COMPARED
from comparisons.scene import load_scene

if TYPE_CHECKING:
    from comparisons.cli.outcome import Commands

GATE_EPILOG = """exit status: 0 every bound holds, 1 an error lies beyond its bound, 2 bad input, 3 a solution stopped"""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    gate = commands.add_parser(
        "gate",
        help="fail where errors lie beyond bounds",
        description="Errors are relative and the largest over all load parameters, against the exact rods "
        "or another model.",
        epilog=GATE_EPILOG,
    )
    gate.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    gate.add_argument(
        "--max-error",
        required=True,
        action="append",
        type=_bound,
        metavar="QUANTITY=X",
        help="a bound, any number of them: " + ", ".join(COMPARED),
    )
    gate.add_argument(
        "--model", choices=ModelNames(), default=TSM.name, help="the model that is measured (tsm)"
    )
    gate.add_argument("--against", choices=ModelNames(), help="the model that it is measured against")
    add_options(gate, "elements", "element", "mesh")
    gate.add_argument("--junit", metavar="FILE", help="write the bounds as JUnit XML")
    gate.set_defaults(run=run)


def _bound(text: str) -> tuple[str, float]:
    quantity, _, bound = text.partition("=")
    try:
        value = float(bound)
    except ValueError:
        value = -1.0
    if quantity not in COMPARED or not value > 0:
        raise argparse.ArgumentTypeError(
            f"{text}: must be QUANTITY=X with X above 0 and one of {', '.join(COMPARED)}"
        )
    return quantity, value


def run(given: argparse.Namespace) -> int:
    """Measure, print the bounds and write them."""
    scene = load_scene(given.scene)
    file = None if given.junit is None else result_file(Path(given.junit))
    from comparisons.claims.gate import gate

    found = gate(scene, given.model, chosen(given), dict(given.max_error), given.against)
    if file is not None:
        write_text(file, found.junit())
    print(f"{scene.name}: {found.response.model} against {found.reference.model}")
    for item in found.bounds:
        sign = "<=" if item.holds else "> "
        print(
            f"  {item.name:8s} {item.error:9.3g}  {sign} {item.allowed:<6g} {found.place(item.name)}".rstrip()
        )
    status = exit_status(scene, [("", found.response), ("reference: ", found.reference)])
    if status != DONE or found.held:
        return status
    report(f"crossval: {', '.join(item.name for item in found.bounds if not item.holds)}: beyond the bound")
    return WRONG
