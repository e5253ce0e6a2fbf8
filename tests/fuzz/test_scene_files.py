"""Whatever a scene file holds: done and checked, refused in one line, or stopped by name; and what is done is right."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings

from comparisons.verify import CHECK_FAILED
from tests.fuzz.broken import toml_text
from tests.fuzz.judge import solved
from tests.fuzz.run import tally
from tests.fuzz.scenes import Tables, cantilevers

FINE, COARSE = 16, 8
"""Numbers of `mixed` elements: of fourth order, the error of the fine ones is below what the refinement changes."""
EXACT = 1e-6
DRAWN = settings(
    deadline=None,
    database=None,
    derandomize=True,
    phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)


def check_files(number: int, seed: int) -> None:
    found = tally(number, seed)
    assert not found.wrong, "\n\n".join(f"{model}\n{why}\n{data!r}" for model, why, data in found.wrong)
    ends = {kind.split()[0] for _, kind in found.kinds}
    assert ends == {"done", "refused", "stopped"}


def test_files_end_as_documented() -> None:
    check_files(80, 1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 6))
def test_many_files_end_as_documented(seed: int) -> None:
    check_files(250, seed)


def histories(data: dict[str, Any], length: float, steps: int) -> np.ndarray:
    """Contact forces, clamp moments over the length and clamp forces, at the first load parameters."""
    forces = [pair["force"] for pair in data["contacts"].values()]
    moments = [np.array(support["moment"]) / length for support in data["supports"].values()]
    held = [row for support in data["supports"].values() for row in np.array(support["force"]).T]
    return np.array([row[:steps] for row in (*forces, *moments, *held)], dtype=float)


def check_agreement(scene: Tables, folder: Path) -> int:
    """Compare exact and mixed elements with the rod where all have reached; return how many load parameters that are."""
    file = folder / "scene.toml"
    file.write_text(toml_text(scene))
    found = []
    for model in ("rod", "tsm --element exact", f"tsm --elements {COARSE}", f"tsm --elements {FINE}"):
        outcome, result = solved(file, *model.split())
        assert outcome.wrong is None, outcome.wrong
        if not result.is_file():
            return 0
        found.append(json.loads(result.read_text()))
    steps = min(len(data["load_parameter"]) for data in found)
    if steps == 0 or any(data["status"] == CHECK_FAILED for data in found):
        return 0
    beam = scene["beam"][0]
    length = math.dist(beam["start"], beam["end"])
    area = beam.get("area") or beam["width"] * beam["height"]
    EI = beam["youngs_modulus"] * (beam.get("second_moment") or beam["width"] * beam["height"] ** 3 / 12)
    rod, exact, coarse, fine = (histories(data, length, steps) for data in found)
    scale = max(float(np.abs(rod).max(initial=0.0)), 1e-3 * EI / length**2)
    shear = float(np.abs(rod).max(initial=0.0)) / (0.1 * beam["youngs_modulus"] * area)
    assert np.abs(exact - rod).max(initial=0.0) <= EXACT * scale
    left = np.abs(fine - rod).max(initial=0.0) - np.abs(fine - coarse).max(initial=0.0)
    assert left <= (EXACT + shear**3) * scale
    return steps


def compared(number: int, folder: Path) -> int:
    total = 0

    @settings(DRAWN, max_examples=number)
    @given(cantilevers())
    def run(scene: Tables) -> None:
        nonlocal total
        total += check_agreement(scene, folder)

    run()
    return total


def test_answers_are_the_rods(tmp_path: Path) -> None:
    assert compared(15, tmp_path) > 15


@pytest.mark.slow
def test_many_answers_are_the_rods(tmp_path: Path) -> None:
    assert compared(200, tmp_path) > 200
