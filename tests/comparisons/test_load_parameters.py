"""The answer to a finding, a scene whose answer once depended on the number of load parameters, does not depend on it any more."""

from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.scene import load_scene
from tests.fuzz.world_judge import findings, run

FINDINGS = sorted((Path(__file__).parent / "findings").glob("*.toml"))
NUMBERS = (1, 2, 5, 8, 12, 40, 200)


@pytest.mark.slow
@pytest.mark.parametrize("element", ["exact", "mixed"])
@pytest.mark.parametrize("file", FINDINGS, ids=lambda file: file.stem)
def test_any_number_of_load_parameters_gives_the_same_answer(file: Path, element: str) -> None:
    """The same to 1e-6 at the last one, certified, or the same named stop."""
    scene = load_scene(str(file))
    rows = [run(replace(scene, load_parameters=number), element, every=False) for number in NUMBERS]
    assert [item.text for item in findings(scene, rows)] == []
