"""The errors of a response by every quantity."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.answer.errors import errors
from comparisons.answer.quantities import KEPT
from comparisons.models import solve
from comparisons.scene import load_scene
from tests.comparisons.referee.forged import contact

SCENE = replace(load_scene("ks-cantilever"), load_parameters=5)
PAIR, BEAM, CLAMP = "pin->cantilever", "cantilever", "cantilever.start"


@pytest.fixture(scope="module")
def rod() -> Response:
    return solve(SCENE, "rod")


def shifted(rod: Response, way: np.ndarray) -> Response:
    def line(beam: str, k: int) -> tuple[np.ndarray, np.ndarray]:
        arc, place = rod.axis_line(beam, k)
        return arc, place + way

    return replace(rod, axis_line=line)


def changed(rod: Response, name: str) -> tuple[Response, float]:
    """A response with a fault that one quantity sees, and its error on a beam twice as long."""
    own, support = rod.contacts[PAIR], rod.supports[CLAMP]
    way, moment = np.array([0.03, 0.04]), 0.01 * np.abs(support.moment).max()
    return {
        "force": lambda: (contact(rod, force=own.force + 0.01 * own.force.max()), 0.01),
        "arc": lambda: (contact(rod, arc_position=own.arc_position - 0.03), 0.015),
        "moment": lambda: (replace(rod, supports={CLAMP: replace(support, moment=support.moment + moment)}), 0.01),
        "friction": lambda: (replace(rod, material_force={BEAM: rod.material_force[BEAM] + 0.02 * own.force}), 0.02),
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
    lost = replace(contact(rod, arc_position=np.full(5, np.nan)), material_force={})
    for own, true in ((lost, rod), (rod, lost)):
        found = errors(own, true, SCENE)["path"]
        assert found["arc"] == found["friction"] == np.inf
