"""The table of errors is what the models leave, to the digits stated; the README has some of its rows."""

from collections.abc import Callable

import pytest

from comparisons.compare import ELASTICA, MIXED, PAPER, ROD, RUNS, SOLID
from comparisons.errors import errors
from comparisons.models import solve
from comparisons.response import Response
from comparisons.scene import load_scene
from tests.stated import MARK, ROOT

COLUMNS = ("force", "arc", "moment", "tip")
ROWS = {
    "timoshenko-10": PAPER[0],
    "timoshenko-20": PAPER[1],
    "timoshenko-50": PAPER[2],
    "mixed-10": RUNS[3],
    "mixed-20": MIXED,
    "exact-1": RUNS[5],
    "solid": SOLID,
    "elastica": ELASTICA,
}


@pytest.fixture(scope="module")
def rod() -> Response:
    return solve(load_scene("ks-cantilever"), ROD.model)


@pytest.mark.parametrize("name", ROWS)
def test_the_table_of_errors(name: str, rod: Response, stated: Callable[..., None]) -> None:
    """To half a unit of the last digit stated; what the exact elements leave is round-off, and bounded only."""
    scene, run = load_scene("ks-cantilever"), ROWS[name]
    response = solve(scene, run.model, run.options)
    found = errors(response, rod, scene)["path"]
    stated(f"unknowns.{name}", response.unknowns)
    stated(f"errors.{name}", *(found[column] for column in COLUMNS), bound=run.options.element == "exact")


def test_the_readme_has_rows_of_this_table() -> None:
    """Every model at least once."""
    marks = MARK.findall((ROOT / "README.md").read_text())
    rows = [ROWS[name.partition(".")[2]] for name in marks if name.startswith("errors.")]
    models = {run.options.element or run.model for run in rows}
    assert models == {"timoshenko", "mixed", "exact", "solid", "elastica"}
