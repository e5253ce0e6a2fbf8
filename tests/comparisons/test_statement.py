"""What is stated of a response: JSON, its errors by every quantity, and one error wherever it is stated."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.cli import main
from comparisons.errors import errors
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.quantities import KEPT
from comparisons.response import Response
from comparisons.scene import Scene, load_scene, to_toml

SCENE = replace(load_scene("ks-cantilever"), load_parameters=5)
PAIR, BEAM, CLAMP = "pin->cantilever", "cantilever", "cantilever.start"


@pytest.fixture(scope="module")
def rod() -> Response:
    return solve(SCENE, "rod")


def stated(folder: Path, scene: Scene, *options: str) -> dict[str, Any]:
    """What ``crossval solve`` writes."""
    (folder / "my.toml").write_text(to_toml(scene))
    main(["solve", str(folder / "my.toml"), *options, "--json", str(folder / "a.json"), "--quiet"])
    found: dict[str, Any] = json.loads((folder / "a.json").read_text())
    return found


def test_json_has_every_digit(tmp_path):
    data, beams = stated(tmp_path, SCENE, "--elements", "5"), solve(SCENE, "tsm", Options(elements=5))
    assert data["contacts"][PAIR]["force"] == list(beams.contacts[PAIR].force)
    assert np.shape(data["supports"][CLAMP]["force"]) == np.shape(data["tips"][BEAM]) == (5, 2)
    assert all(isinstance(count, int) for count in data["newton_iterations"])


def with_contact(rod: Response, **changes: Any) -> Response:
    return replace(rod, contacts={PAIR: replace(rod.contacts[PAIR], **changes)})


def shifted(rod: Response, way: np.ndarray) -> Response:
    def line(beam: str, k: int) -> tuple[np.ndarray, np.ndarray]:
        arc, place = rod.axis_line(beam, k)
        return arc, place + way

    return replace(rod, axis_line=line)


def changed(rod: Response, name: str) -> tuple[Response, float]:
    """A response with a fault that one quantity sees, and its error on a beam twice as long."""
    contact, support = rod.contacts[PAIR], rod.supports[CLAMP]
    way, moment = np.array([0.03, 0.04]), 0.01 * np.abs(support.moment).max()
    return {
        "force": lambda: (with_contact(rod, force=contact.force + 0.01 * contact.force.max()), 0.01),
        "arc": lambda: (with_contact(rod, arc_position=contact.arc_position - 0.03), 0.015),
        "moment": lambda: (replace(rod, supports={CLAMP: replace(support, moment=support.moment + moment)}), 0.01),
        "friction": lambda: (replace(rod, material_force={BEAM: rod.material_force[BEAM] + 0.02 * contact.force}), 0.02),
        "tip": lambda: (replace(rod, tips={BEAM: rod.tips[BEAM] + way}), 0.025),
        "shape": lambda: (shifted(rod, way), 0.025),
    }[name]()  # fmt: skip


LONG = replace(SCENE, beams=(replace(SCENE.beams[0], end=(2.0, 0.0)),))


@pytest.mark.parametrize("name", ["force", "arc", "moment", "friction", "tip", "shape"])
def test_every_quantity_sees_its_own_fault(name, rod):
    """Relative to the largest of the reference, or to the length; the stress, which rods have not, has the solid's own tests."""
    response, error = changed(rod, name)
    found = errors(response, rod, LONG)
    assert found["path"].keys() == set(KEPT)
    seen = {"shape", "shape_mean"} if name == "shape" else {name}
    for quantity, value in found["path"].items():
        assert value == pytest.approx(error if quantity in seen else 0.0, abs=1e-9), quantity
    assert found["end"][name] == pytest.approx(error)


def test_errors_of_a_stopped_run_are_unknown_and_of_a_contact_lost_alone_infinite(rod):
    stopped = replace(rod, load_parameter=rod.load_parameter[:2])
    assert np.isnan(errors(stopped, rod, SCENE)["path"]["force"])
    lost = with_contact(rod, arc_position=np.full(5, np.nan))
    assert errors(lost, rod, SCENE)["path"]["arc"] == np.inf
