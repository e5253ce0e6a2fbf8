"""An answer does not depend on how many load parameters are asked for: every built-in scene and every finding."""

from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.scene import built_in_scenes, load_scene
from tests.fuzz.world_judge import findings, run

BUILT_IN = tuple(built_in_scenes())
SCENES = (*BUILT_IN, *sorted(map(str, (Path(__file__).parent / "findings").glob("*.toml"))))
FEW = (1, 12, 200)
"""Numbers of load parameters of a built-in scene."""
MANY = (1, 2, 5, 8, 12, 40, 200)
"""Numbers of load parameters of a finding, a scene whose answer once depended on one of these numbers."""


@pytest.mark.slow
@pytest.mark.parametrize("element", ["exact", "mixed"])
@pytest.mark.parametrize("name", SCENES, ids=lambda name: Path(name).stem)
def test_any_number_of_load_parameters_gives_the_same_answer(name: str, element: str) -> None:
    """The same to 1e-6 at the last one, certified, or the same named stop."""
    scene = load_scene(name)
    numbers = FEW if name in BUILT_IN else MANY
    rows = [run(replace(scene, load_parameters=number), element, every=False) for number in numbers]
    assert [item.text for item in findings(scene, rows)] == []
