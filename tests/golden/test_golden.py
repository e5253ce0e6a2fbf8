"""What the commands say is what stands in the files beside this one, and the referee redoes its digits."""

import re

import numpy as np
import pytest

from comparisons.scene import built_in_scenes
from tests.golden.write import COMPARED, HERE, MODELS, SLOW, SOURCES, differences, machine, pages

MACHINE = (HERE / "machine.txt").read_text(encoding="utf-8").strip()
BOUND = 1e-12 if machine() == MACHINE else 1e-10 if machine().split(";")[0] == MACHINE.split(";")[0] else 1e-9
"""Largest difference of a number over the largest of its line; on other processors, and with other libraries, Newton's method ends elsewhere in its tolerance."""
SOLID = BOUND if machine() == MACHINE else 1e-7
"""That of the solid: its Newton's method ends at 1e-9 of the forces, which move a slender strip by more."""
LATE = {
    *SLOW, "heavy-strip", "tip-load", "hinged-truss", "sleeve", "page-hysteresis-stages", *(f"compare-{scene}" for scene in COMPARED),
}  # fmt: skip
ALLOWED = {"exact": 1e-8, "mixed": 2e-3, "timoshenko": 0.03, "elastica": 5e-3, "solid": 0.06}
"""Largest difference of a model from the referee, over the largest number of a line."""
THICK = {("sleeve", "solid"): 0.25}
"""Where pins stand as close as the beam is high, which no beam theory states."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name in LATE)) for name in pages()]
)
def test_the_answers_are_those_that_were_written(name: str) -> None:
    kept = (HERE / f"{name}.txt").read_text(encoding="utf-8")
    assert differences(pages()[name](), kept, BOUND, SOLID) == []


def histories(section: str) -> dict[str, list[float]]:
    """Return the numbers of an answer that has reached the end, 0 for the place of an open contact."""
    lines = re.findall(r"^(contacts .*|supports .*|tips .*): (.*)$", section, re.MULTILINE)
    reached = section.startswith("COMPLETED")
    return {name: [0.0 if x == "None" else float(x) for x in text.split()] for name, text in lines if reached}


@pytest.mark.parametrize("scene", SOURCES)
def test_the_referee_redoes_every_digit(scene: str) -> None:
    """From the files alone; every source is there, and every model has a section."""
    text = (HERE / f"{scene}.txt").read_text(encoding="utf-8")
    assert (HERE.parents[1] / SOURCES[scene].partition(",")[0]).is_file()
    sections = (part.split("\n", 1) for part in text.split("== solve ")[1:])
    found = {model: histories(section) for model, section in sections}
    assert list(found) == list(MODELS)
    assert found["exact"]
    for model, usual in ALLOWED.items():
        allowed = THICK.get((scene, model), usual)
        for name, numbers in found[model].items():
            exact = np.array(found["rod"][name])
            size = max(np.abs(exact).max(), 1e-9)
            assert np.abs(numbers - exact).max() <= allowed * size, (model, name)


@pytest.mark.parametrize(
    ("now", "apart"),
    [("0.25000000000001 1", 0), ("0.250000000003 1", 1), ("0.25 1 3", 1), ("0.25", 1), ("x 1", 1)],
)
def test_a_difference_is_seen(now: str, apart: int) -> None:
    assert len(differences(f"force: {now}", "force: 0.2500000000000 1", 1e-12)) == apart


def test_every_file_has_its_writer() -> None:
    assert {path.stem for path in HERE.glob("*.txt")} == {*pages(), "machine"}
    assert set(SOURCES) < set(built_in_scenes())
