"""Tangents are exact: Newton's method gains four digits in one more iteration, where one that is off by a percent takes two."""

import pytest

import fem_reference
import tsm
from comparisons.models.solid import to_solid
from comparisons.models.tsm import to_structure
from tests.laws.scenes import ELEMENTS, scene, states

LOOSE, SHARP = 1e-5, 1e-9
STEP = (0.9, 0.92)
SCENES = {"world-0": 1, "world-2": 1, "world-13": 1, "world-20": 1, "held-8": 1, "friction-10": 2}
"""Number of iterations by scene; the pin's path with friction has more than one step."""
CASES = [(model, name) for name in SCENES for model in (*ELEMENTS, "solid") if states(model, scene(name))]
QUICK = [("exact", "world-20"), ("mixed", "world-20"), ("timoshenko", "world-2"), ("exact", "friction-10"), ("mixed", "friction-10"), ("solid", "world-20")]  # fmt: skip


def iterations(model: str, name: str, tolerance: float) -> int:
    """Number of iterations of a step in the middle of the path, without events."""
    if model == "solid":
        problem = to_solid(scene(name))
        result = fem_reference.solve(problem, STEP, fem_reference.Settings(tolerance=tolerance))
        return int(result.newton_iterations[-1])
    structure = to_structure(scene(name), element=model)
    return int(tsm.solve(structure, STEP, tsm.Settings(tolerance=tolerance)).newton_iterations[-1])


@pytest.mark.parametrize(
    ("model", "name"),
    [pytest.param(*case, marks=() if case in QUICK else pytest.mark.slow) for case in CASES],
)
def test_newton_converges_quadratically(model: str, name: str) -> None:
    assert iterations(model, name, SHARP) - iterations(model, name, LOOSE) <= SCENES[name]
