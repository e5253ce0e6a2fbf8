"""Ten lies of a program: every one is caught, and a success that was stated can be told from a failure."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.models import certified, solve
from comparisons.response import Response
from comparisons.scene import PinSpec
from tests.comparisons.models.outside.conftest import KS, stored

SOLVED_BEFORE = replace(KS, pins=(PinSpec(name="pin", start=(1.0, 0.0), displacement=(-1.0, 0.6)),))
"""The scene with another path of the pin, whose answer is the stale one."""

STRAIGHT = """
axis["position"] = [[[s, 0.0] for s in axis["arc_length"]] for _ in scene["load_parameters"]]
support["force"] = [[0.0, 0.0] for _ in support["force"]]
"""
LIES = {
    "zero force": ('contact["force"] = [0.0 for _ in contact["force"]]', "CHECK_FAILED", True),
    "NaN": ('contact["force"][2] = math.nan', "NOT_FINITE", True),
    "wrong sign": ('support["force"] = [[-x, -y] for x, y in support["force"]]', "NOT_AN_EQUILIBRIUM", True),
    "x and y swapped": (
        'axis["position"] = [[[y, x] for x, y in line] for line in axis["position"]]',
        "NOT_AN_EQUILIBRIUM",
        True,
    ),
    "wrong units": (
        """
for item in (contact, support):
    item["force"] = [f / 1000 if item is contact else [x / 1000 for x in f] for f in item["force"]]
contact["vector"] = [[x / 1000 for x in f] for f in contact["vector"]]
support["moment"] = [m / 1000 for m in support["moment"]]
""",
        "NOT_AN_EQUILIBRIUM",
        True,
    ),
    "hang": ("time.sleep(600)", "TIMED_OUT", False),
    "crash": ("os.abort()", "CRASHED", False),
    "truncated JSON": ("print(json.dumps(answer)[:3000]); sys.exit()", "INVALID_JSON", False),
    "success without contact": (
        STRAIGHT
        + """
contact["force"], contact["vector"] = [0.0 for _ in contact["force"]], support["force"]
contact["arc_position"] = contact["gap"] = [None for _ in contact["force"]]
support["moment"] = [0.0 for _ in support["moment"]]
""",
        "CHECK_FAILED",
        True,
    ),
    "stale answer": ('answer = json.loads(Path("stale.json").read_text())', "NOT_AN_EQUILIBRIUM", True),
}
"""The lines of each lie, the status that it gets, and whether the program stated success."""


def answered(file: str, which: str = "last") -> Response:
    return certified(solve(KS, file), KS, "all" if which == "all" else "last")


def test_the_truth_is_certified(program: Callable[..., str]) -> None:
    response = answered(program(), "all")
    assert (response.status, response.model) == ("COMPLETED", "liar")
    assert response.certificate is not None
    assert response.certificate.certified
    assert (response.reported_success, response.false_success) == (True, False)


@pytest.mark.parametrize("lie", LIES)
def test_a_lie_is_caught(lie: str, program: Callable[..., str], tmp_path: Path) -> None:
    lines, status, reported = LIES[lie]
    if lie == "stale answer":
        (tmp_path / "stale.json").write_text(stored(SOLVED_BEFORE))
    response = answered(program(lines, seconds=1.0 if lie == "hang" else 60.0))
    assert (response.status, response.completed) == (status, False), response.message
    assert response.message
    assert (response.reported_success, response.false_success) == (reported, reported)


def test_there_are_ten() -> None:
    assert len(LIES) == 10
