"""The table of errors is what the models leave, to the digits stated; the README has some of its rows."""

import re
from pathlib import Path

import pytest

from comparisons.compare import ELASTICA, MIXED, PAPER, ROD, RUNS, SOLID
from comparisons.errors import errors
from comparisons.models import solve
from comparisons.scene import load_scene

ROOT = Path(__file__).parents[2]
PAGE, README = ROOT / "docs" / "results" / "accuracy.md", ROOT / "README.md"
COLUMNS = ("force", "arc", "moment", "tip")
ROWS = {
    "`timoshenko`, 10 elements": PAPER[0],
    "`timoshenko`, 20 elements": PAPER[1],
    "`timoshenko`, 50 elements": PAPER[2],
    "`mixed`, 10 elements": RUNS[3],
    "`mixed`, 20 elements": MIXED,
    "`exact`, 1 element": RUNS[5],
    "solid, 50 x 2 elements": SOLID,
    "elastica": ELASTICA,
}
"""By the first cell."""


def stated(page: Path) -> dict[str, list[float]]:
    """Return unknowns and the four errors of every row."""
    table = page.read_text().split("| model | unknowns |")[1].split("\n\n")[0]
    rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:])
    return {name: [float(cell) for cell in cells] for name, *cells in rows}


@pytest.mark.parametrize("name", ROWS)
def test_the_table_of_errors(name: str) -> None:
    """Within half a unit of the last digit stated; what the exact elements leave is round-off, and bounded only."""
    numbers, scene, run = stated(PAGE), load_scene("ks-cantilever"), ROWS[name]
    assert numbers.keys() == ROWS.keys()
    response = solve(scene, run.model, run.options)
    found = errors(response, solve(scene, ROD.model), scene)["path"]
    unknowns, *limits = numbers[name]
    assert response.unknowns == unknowns
    for column, limit in zip(COLUMNS, limits, strict=True):
        value = found[column]
        if run.options.element == "exact":
            assert value <= 1.5 * limit, column
        else:
            assert value == pytest.approx(limit, rel=0.5 / digits(limit)), column


def test_the_readme_has_rows_of_this_table() -> None:
    """Every model at least once, and the same numbers."""
    few, every = stated(README), stated(PAGE)
    assert few.items() <= every.items()
    models = [ROWS[name].options.element or ROWS[name].model for name in few]
    assert set(models) == {"timoshenko", "mixed", "exact", "solid", "elastica"}


def digits(limit: float) -> float:
    """Return the mantissa of a number in units of its last stated digit: 13 for 1.3e-2, 9 for 9e-7."""
    mantissa = f"{limit:.1e}".split("e")[0]
    return float(re.sub(r"\.0$", "", mantissa).replace(".", ""))
