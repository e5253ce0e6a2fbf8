"""Benchmark cards: a problem of the manual as one JSON file, complete in itself."""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from comparisons.files import writable_folder, write_text
from comparisons.output import Report, json_text
from comparisons.scene import to_tables
from comparisons.scene.read import json_schema
from comparisons.suites.manual.problem import Problem, Quantity, read_problem

SYMBOLS = {
    "t": "load parameter, 0 to 1; loads and prescribed motions grow with it, a pin is at the fraction t of its path's length",
    "F": "magnitude of the contact force",
    "s": "distance of the contact point from the beam's start, along the undeformed axis",
    "M": "moment that a support exerts on the beam, anticlockwise",
    "P": "the load",
    "L": "length of the beam",
    "EA, GA, EI": "stiffnesses of a beam's section in stretch, shear and bending; they are listed under stiffness",
}
"""Symbols that the names of quantities use."""
SCHEMA = Path(__file__).with_name("card.schema.json")
"""The JSON Schema of a card, but for its scene."""


def card(problem: Problem) -> dict[str, Any]:
    """Return the card of a problem.

    Examples
    --------
    >>> from comparisons.suites.manual import problems
    >>> card(read_problem(*problems(["roll-up"])))["quantities"][0]
    {'name': 'x/L of the tip, a quarter of a circle', 'value': 0.6366197723675814, 'digits': 14, 'uncertainty': 6.366197723675814e-15}
    """
    texts = {name: getattr(problem, name) for name in ("name", "title", "purpose", "statement", "source")}
    beams = problem.scene.beams
    return {
        "$schema": "card.schema.json",
        **texts,
        "scene": to_tables(problem.scene),
        "stiffness": {
            beam.name: {name: getattr(beam, name) for name in ("EA", "GA", "EI")} for beam in beams
        },
        "quantities": [_quantity(one, problem.uncertainty) for one in problem.quantities],
        "symbols": SYMBOLS,
    }


def _quantity(quantity: Quantity, uncertainty: float) -> dict[str, Any]:
    """Return a quantity with its uncertainty, and the significant digits (decimals of zero) it leaves, at most 15."""
    error = uncertainty * quantity.size
    share = error / (abs(quantity.exact) or quantity.size) or 1e-15
    digits = max(0, min(15, math.floor(-math.log10(share))))
    return {"name": quantity.name, "value": quantity.exact, "digits": digits, "uncertainty": error}


def write_cards(folder: Path, report: Report, stated: Sequence[Path]) -> int:
    """Write the cards of problems, ``NAME.json``, and their schema; return the number of cards."""
    writable_folder(folder)
    for problem in map(read_problem, stated):
        write_text(folder / f"{problem.name}.json", json_text(card(problem)))
        report(f"{problem.name}: {len(problem.quantities)} quantities")
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    # the scene has the schema of scene files
    schema["properties"]["scene"] = json_schema() | schema["properties"]["scene"]
    del schema["properties"]["scene"]["$schema"]
    write_text(folder / "card.schema.json", json_text(schema))
    return len(stated)
