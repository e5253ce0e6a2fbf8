"""What each model is given, and what it refuses to state."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from comparisons.models import MODELS, solve
from comparisons.models.options import ModelError
from comparisons.models.translate import to_rod, to_solid, to_structure
from comparisons.scene import LoadSpec, PinSpec, Scene, SpringSpec, SupportSpec, load_scene

KS = load_scene("ks-cantilever")
FACE = load_scene("ks-face")


def with_beam(scene: Scene, **changes: object) -> Scene:
    return replace(scene, beams=(replace(scene.beams[0], **changes),))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"width": None, "height": None, "area": 1.0, "second_moment": 1.0}, "needs the width and height"),
        ({"poissons_ratio": None, "shear_modulus": 1e3}, "needs a Poisson's ratio between"),
        ({"mesh": (1, 1)}, "needs at least 2 elements along"),
    ],
)
def test_solid_refuses(changes: dict[str, object], reason: str) -> None:
    with pytest.raises(ModelError, match=reason):
        to_solid(with_beam(KS, **changes))


@pytest.mark.parametrize(
    "changes",
    [
        {"supports": (SupportSpec(beam="cantilever", end="start", kind="clamped", rotation=0.1),)},
        {
            "supports": (SupportSpec(beam="cantilever", end="start", kind="clamped"),),
            "loads": (LoadSpec(beam="cantilever", end="start", moment=1.0),),
        },
        {
            "supports": (SupportSpec(beam="cantilever", end="start", kind="clamped"),),
            "springs": (SpringSpec(beam="cantilever", end="start", stiffness=(1.0, 1.0)),),
        },
    ],
)
def test_solid_holds_the_section_where_a_clamp_moves_or_is_loaded(changes: dict[str, Any]) -> None:
    scene = replace(KS, beams=(replace(KS.beams[0], clamped=()),), **changes)
    problem = to_solid(scene)
    assert problem.strips[0].clamped == ()
    assert [item.node for item in problem.supports] == ["cantilever.start"]
    with pytest.raises(ModelError, match=r'full clamp at rest .*, "cantilever\.start" is another'):
        to_solid(replace(scene, beams=(replace(scene.beams[0], solid_clamp="full"),)))


def test_solid_refuses_a_beam_that_only_contact_holds() -> None:
    pinned = SupportSpec(beam="cantilever", end="start", kind="pinned")
    pin = replace(KS.pins[0], start=(1.0, -0.1))
    scene = replace(KS, beams=(replace(KS.beams[0], clamped=()),), supports=(pinned,), pins=(pin,))
    reason = MODELS["solid"].refusal(scene)
    assert reason is not None
    assert reason.endswith("must hold cantilever, with the pins that touch at the start")
    assert "\n" not in reason


def test_unknown_element_is_named() -> None:
    with pytest.raises(ModelError, match=r"element = nosuch: must be one of .*mixed"):
        to_structure(KS, element="nosuch")


@pytest.mark.parametrize("clamped", ["start", "end"])
@pytest.mark.parametrize("side", ["left", "right"])
def test_rod_frame_has_the_clamp_at_the_origin_and_pushes_up(side: str, clamped: str) -> None:
    beam = replace(KS.beams[0], start=(1.0, 2.0), end=(1.6, 2.8), clamped=(clamped,))
    normal = np.array([-0.8, 0.6]) * (1.0 if side == "left" else -1.0)
    place = np.array([1.3, 2.4]) + 0.1 * normal
    pin = PinSpec(name="pin", start=tuple(place), displacement=tuple(-0.2 * normal))  # type: ignore[arg-type]
    contact = replace(KS.contacts[0], side=side)
    rod = to_rod(replace(KS, beams=(beam,), pins=(pin,), contacts=(contact,), load_parameters=2))
    assert rod.path == pytest.approx(np.array([[0.5, -0.1], [0.5, 0.0], [0.5, 0.1]]))
    assert rod.points == pytest.approx(np.array([[0.5, 0.0], [0.5, 0.1]]))
    assert rod.position(np.array([0.5, -0.1])) == pytest.approx(place)
    ends = (beam.start, beam.end) if clamped == "start" else (beam.end, beam.start)
    assert rod.position(np.array([[0.0, 0.0], [1.0, 0.0]])) == pytest.approx(np.array(ends))
    (rx, ry), (fx, fy) = rod.vector(np.eye(2))
    assert rod.moment(np.array(1.0)) == pytest.approx(rx * fy - ry * fx)  # of a unit force on a unit arm


def test_rod_path_keeps_corners_between_load_parameters() -> None:
    pin = PinSpec(name="pin", path=((1.0, -0.1), (1.0, 0.2), (0.5, 0.2)))
    rod = to_rod(replace(KS, pins=(pin,), load_parameters=2))
    assert rod.path == pytest.approx(np.array([[1.0, -0.1], [1.0, 0.2], [0.9, 0.2], [0.5, 0.2]]))
    assert list(rod.hits) == [2, 3]


def test_mesh_file_that_is_not_there_costs_one_line() -> None:
    with pytest.raises(
        ModelError, match=r"solid: Strip\('cantilever'\)\.mesh_file = 'nothing.msh': cannot be read"
    ):
        solve(with_beam(KS, solid_mesh_file="nothing.msh"), "solid")
