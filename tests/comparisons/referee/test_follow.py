"""Certificates of beams held at both ends: the path is followed from rest to every judged load parameter."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import Equilibrium, Verdict, answer_state, certify, equilibrium
from comparisons.response import Response
from comparisons.scene import Scene, read_scene
from tests.comparisons.referee.forged import bent, stated

COLUMN = """
scene = {{ name = "column", load_parameters = {steps} }}
[[beam]]
name = "b"
start = [0, 0]
end = [1, 0]
clamped = ["start"]
width = {height}
height = {height}
youngs_modulus = 1e7
poissons_ratio = 0.25
[[support]]
beam = "b"
end = "end"
kind = "clamped"
displacement = [{short}, 0]
rotation = {turn}
"""
TOUCHED = """
[[beam]]
name = "arm"
start = [0, 1]
end = [1, 1]
clamped = ["start"]
width = 0.1
height = 0.1
youngs_modulus = 1e7
poissons_ratio = 0.25
[[pin]]
name = "pin"
start = [0.6, 0.98]
displacement = [0, 0.05]
[[contact]]
node = "pin"
beam = "arm"
side = "right"
"""


def column(
    steps: int, *, turn: float = 0.01, short: float = -0.0626, height: float = 0.1, more: str = ""
) -> Scene:
    """A column between two clamps, one of which moves in and turns."""
    return read_scene(COLUMN.format(steps=steps, turn=turn, short=short, height=height) + more, "column")


def mirrored(scene: Scene, response: Response, k: int) -> Equilibrium:
    """Return the equilibrium that bends to the other side."""
    arc, line = response.axis_line("b", k)
    grid = np.linspace(0.0, 1.0, 201)
    other = np.stack([np.interp(grid, arc, line[:, 0]), -np.interp(grid, arc, line[:, 1])], axis=1)
    return bent(scene, float(response.load_parameter[k]), {"b": other})


@pytest.mark.parametrize("steps", [1, 4])
def test_the_other_side_of_a_column_is_another_branch(steps: int) -> None:
    """Both ends are held, so that the displacements of the ends tell nothing. The other branch has index 0 too."""
    scene = column(steps)
    true = solve(scene, "tsm", Options(element="exact"))
    assert float(true.supports["b.start"].moment[-1]) == pytest.approx(174.945, abs=0.01)
    found = certify(true, scene)
    assert found.certified, found.line()
    wrong = mirrored(scene, true, -1)
    assert wrong.index == 0
    path = [certify(true, scene, at=range(steps)).judged[k].exact for k in range(steps - 1)]
    forged = stated(scene, [*(item for item in path if item is not None), wrong])
    for at in (None, range(steps)):
        found = certify(forged, scene, at=at)
        assert found.verdict is Verdict.UNSTABLE
        assert "another branch at 1, 0.67 L away" in found.reason


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_both_sides_of_a_symmetric_bifurcation_are_right(side: float) -> None:
    """The straight path ends there, and both bent branches lead back to it."""
    scene = column(3, turn=0.0)
    x = np.linspace(0.0, 1.0, 201)
    path = []
    for t in scene.times:
        # the shortening beyond the critical one, .0298, is (pi a)^2/4 of a wave a/2 (1 - cos 2 pi x)
        a = side * 2.0 / np.pi * np.sqrt(max(0.0626 * t - 0.0298, 0.0))
        path.append(
            bent(
                scene,
                t,
                {"b": np.stack([x * (1.0 - 0.0626 * t), a / 2.0 * (1.0 - np.cos(2.0 * np.pi * x))], axis=1)},
            )
        )
    assert side * path[-1].shape("b", np.array([0.5])).position[0, 1] > 0.1
    for at in (None, range(3)):
        found = certify(stated(scene, path), scene, at=at)
        assert found.certified, found.line()


def test_the_path_is_followed_through_a_touch() -> None:
    """A pin touches an arm beside the column, before the only load parameter; the column stands on its other branch."""
    scene = column(1, more=TOUCHED)
    true = solve(scene, "tsm", Options(element="exact"))
    assert true.events is not None
    assert [event.kind for event in true.events] == ["touch"]
    found = certify(true, scene)
    assert found.certified, found.line()
    answer = answer_state(true, scene, -1)
    axes = {**answer.axes, "b": (answer.axes["b"][0], answer.axes["b"][1] * [1.0, -1.0])}
    wrong = equilibrium(scene, replace(answer, axes=axes, reactions={}))
    assert wrong.index == 0
    assert wrong.contacts["pin->arm"].push == pytest.approx(float(true.contacts["pin->arm"].force[-1]))
    found = certify(replace(stated(scene, [wrong]), events=true.events), scene)
    assert found.verdict is Verdict.UNSTABLE
    assert "ends on another branch at 1" in found.reason
