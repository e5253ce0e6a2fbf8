"""What the benchmark measures stands in the pages."""

import numpy as np
import pytest

from comparisons.models import solve
from tests.benchmarks import bench, inside, plain
from tests.benchmarks.measure import Bench, Gate
from tests.stated import MARK, NUMBER, ROOT


def test_a_ratio_that_has_moved_is_named():
    ratios = [Gate("mixed over timoshenko, seconds per iteration", value, 1.3) for value in (0.9, 2.5)]
    (failure,) = bench.compared([*ratios, Gate("cut-backs", 1, 0)], write=False)
    assert "bench.mixed-over-timoshenko-seconds-per-iteration" in failure
    assert "2.5" in failure


def test_the_page_says_which_targets_are_missed():
    page = (ROOT / "docs" / "results" / "speed.md").read_text()
    rows = [line.split("|")[2:4] for line in page.splitlines() if "<!--bench." in line]
    assert len(rows) > 15
    for measured, target in rows:
        values = [float(number) for number, _ in NUMBER.findall(MARK.sub(" ", measured))]
        bars = [float(number) for number, _ in NUMBER.findall(target)]
        bars *= len(values) // len(bars)
        met = all(
            value >= bar if "or more" in target else value <= bar
            for value, bar in zip(values, bars, strict=True)
        )
        assert met == ("not met" not in target), (measured, target)


def test_the_plain_program_is_as_near_the_rod_as_its_elements_allow():
    force = solve(inside.KS, "rod").contacts["pin->cantilever"].force
    assert np.abs(plain.solved(inside.KS) - force).max() < 6e-4 * force.max()


@pytest.mark.slow
def test_a_part_measures_what_the_page_states():
    """The modules of the benchmark import, and their shortest part runs."""
    made = Bench()
    inside.beams(made)
    assert len(made.gates) == 3
    assert all(gate.mark in (ROOT / "docs" / "results" / "speed.md").read_text() for gate in made.gates)
