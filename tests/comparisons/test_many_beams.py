"""The cost of a scene is in proportion to the number of its beams."""

import sys
from collections.abc import Callable
from typing import Any

import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.scene import BeamSpec, SupportSpec, read_scene
from tests.comparisons.many_beams import MANY, chain


def calls(work: Callable[[], Any]) -> int:
    """Number of calls, of Python and of C, in some work."""
    count = 0

    def note(_: object, event: str, __: object) -> None:
        nonlocal count
        count += event.endswith("call")

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(before)
    return count


def whole(text: str) -> None:
    response = solve(read_scene(text, "many.toml"), "tsm")
    assert response.status == "COMPLETED"
    response.page()
    response.table()


@pytest.mark.slow
@pytest.mark.parametrize("kind", MANY)
def test_calls_grow_with_the_number_of_beams(kind):
    """From 50 over 100 to 200: the second rise is twice the first, of quadratic work four times."""
    whole(MANY[kind](8))
    few, some, many = (calls(lambda n=n: whole(MANY[kind](n))) for n in (50, 98, 200))  # type: ignore[misc]
    assert (many - some) / 102 < 1.15 * (some - few) / 48


def test_nobody_counts_the_pairs_of_beams_by_comparing_them(monkeypatch):
    """Comparing records is not a call that is counted above."""
    compared = 0

    def never(self: object, other: object) -> bool:
        nonlocal compared
        compared += 1
        return self is other

    for kind in (BeamSpec, SupportSpec):
        monkeypatch.setattr(kind, "__eq__", never)
    whole(chain(60))
    assert compared <= 60


def test_a_long_chain_is_bent_in_few_iterations():
    """Steps are measured by the chain and not by one of its beams; the elastica under ``P = .6 EI/L^2``."""
    response = solve(read_scene(chain(300), "many.toml"), "tsm")
    assert response.completed
    assert response.newton_iterations.sum() < 40
    assert response.tips["b299"][-1] / 300 == pytest.approx([0.977512, 0.192350], abs=2e-6)


@pytest.mark.slow
def test_many_beams_are_solved_from_the_command_line(tmp_path):
    """Six hundred in a frame, the kind with most joints; `make bench` measures thousands of every kind."""
    file = tmp_path / "many.toml"
    file.write_text(MANY["frame"](600))
    assert main(["solve", str(file), "--model", "tsm", "--quiet"]) == 0
