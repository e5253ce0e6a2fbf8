"""The exact values that the manual states are computed anew by oracles, which share nothing with the models."""

from collections.abc import Callable, Sequence

import pytest

# the table of problems, whose stated digits are the subject
from comparisons.claims.manual.problems import PROBLEMS
from tests.oracles import elastica, frames


def column() -> tuple[float, float]:
    """Place of the head of the clamped column over its length."""
    x, y, _ = elastica.tip_under_thrust(80.0 / 17.5, 0.08 / 17.5)
    return float(x), float(y)


ORACLES: dict[str, Callable[[], Sequence[float]]] = {
    "dead-load": lambda: [elastica.tip_under_dead_load(load)[1] for load in (1.0, 2.0, 5.0, 10.0)],
    "clamped-column": lambda: [column()[0], -column()[1], -8.0 - 8000.0 * column()[1]],
    "pinned-column": lambda: [column()[0], column()[1] / 2.0],
    "lees-frame": lambda: [frames.lee_limit()],
    "williams-toggle": frames.toggle_limits,
    "portal-frame": lambda: [frames.portal_sway()],
}
"""The exact values of problems, in order."""


@pytest.mark.parametrize("name", ORACLES)
def test_an_oracle_has_the_values_of_the_manual(name: str) -> None:
    problem = PROBLEMS[name]()
    for quantity, value in zip(problem.quantities, ORACLES[name](), strict=True):
        scale = abs(quantity.exact) if quantity.scale is None else quantity.scale
        assert abs(value - quantity.exact) <= problem.uncertainty * scale, quantity.name
