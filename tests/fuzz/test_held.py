"""Beams that are held at both ends: the path is followed inside elements too, with any number of load parameters."""

import subprocess
import sys
from dataclasses import replace

import pytest

from comparisons.models import solve
from comparisons.models.model import Options
from tests.fuzz.command import one
from tests.fuzz.held import drawn_held
from tests.fuzz.world_judge import Row, apart, findings

WITHOUT_MEASURE = (9, 11, 14, 17, 18, 23, 35, 74, 75, 78)
"""Scenes that end wrongly where a step is measured at the nodes only."""


@pytest.mark.slow_at("14", "23", "35", "74")
@pytest.mark.parametrize("seed", WITHOUT_MEASURE)
def test_beams_held_at_both_ends(seed: int) -> None:
    """One exact element against 20 mixed ones, and against itself with other numbers of load parameters."""
    scene = drawn_held(seed)
    rows = []
    for model, elements, number in (("exact", 1, 1), ("exact", 1, 7), ("mixed", 20, 3)):
        answer = solve(
            replace(scene, load_parameters=number), "tsm", Options(element=model, elements=elements)
        )
        rows.append(Row(model=model, number=number, ended=answer.status, response=answer, certified=True))
    assert not list(findings(scene, rows))
    once, often, mixed = rows
    assert not once.completed or apart(scene, once, often) <= 1e-9
    assert once.ended == "BIFURCATION" or mixed.ended != "BIFURCATION"


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 20, 5))
def test_more_beams_held_at_both_ends(first: int) -> None:
    for seed in range(first, first + 5):
        ends, reports = one("held", seed)
        assert not reports, reports
        assert ends["exact COMPLETED"] or not ends["mixed COMPLETED"]


@pytest.mark.slow
def test_the_command_judges_on_all_cores() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tests.fuzz", "held", "0", "2"], capture_output=True, text=True, check=True
    )
    assert "0 wrong: " in done.stdout
