"""What each model is given, and what it refuses to state."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import tsm
from comparisons.models import MODELS, solve
from comparisons.models.options import ModelError
from comparisons.models.translate import to_rod, to_solid, to_structure
from comparisons.scene import ContactSpec, LoadSpec, PinSpec, Scene, SpringSpec, SupportSpec, load_scene

KS = load_scene("ks-cantilever")
FACE = load_scene("ks-face")


def with_beam(scene: Scene, **changes: object) -> Scene:
    return replace(scene, beams=(replace(scene.beams[0], **changes),))  # type: ignore[arg-type]


def test_structure_of_the_face_scene() -> None:
    structure = to_structure(FACE, elements=7, element="timoshenko")
    beam, contact = structure.beams[0], structure.contacts[0]
    assert (beam.elements, beam.element, contact.offset, contact.side) == (7, "timoshenko", 0.01, "right")
    assert pytest.approx(5 / 6 * 2.1e4 / 2.6 * 4e-4) == beam.section.GA
    assert structure.pins[0].path == FACE.pins[0].points
    assert [(support.beam, support.end) for support in structure.supports] == [("cantilever", "start")]


def test_solid_takes_the_scene_or_the_option() -> None:
    scene = with_beam(FACE, mesh=(30, 4), solid_clamp="full", material="biot-linear")
    scene = replace(scene, contacts=(replace(scene.contacts[0], penalty=7.0),))
    problem = to_solid(scene)
    strip, contact = problem.strips[0], problem.contacts[0]
    assert (strip.mesh, strip.clamp, strip.material) == ((30, 4), "full", "biot-linear")
    assert (contact.penalty, contact.surface) == (7.0, "face")
    assert to_solid(scene, mesh=(10, 1)).strips[0].mesh == (10, 1)


def test_solid_finds_nu_from_the_shear_modulus() -> None:
    scene = with_beam(KS, poissons_ratio=None, shear_modulus=2.1e4 / 2.5)
    assert to_solid(scene).strips[0].poissons_ratio == pytest.approx(0.25)


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


def test_two_beams_are_for_beams_only() -> None:
    lower = replace(KS.beams[0], name="lower", start=(0.0, -0.2), end=(1.0, -0.2))
    tip = ContactSpec(node="lower.end", beam="cantilever", side="right")
    scene = replace(KS, beams=(*KS.beams, lower), contacts=(*KS.contacts, tip))
    assert [contact.name for contact in to_structure(scene).contacts] == [
        "pin->cantilever",
        "lower.end->cantilever",
    ]
    assert [contact.name for contact in to_solid(scene).contacts] == [
        "pin->cantilever",
        "lower.end->cantilever",
    ]
    with pytest.raises(ModelError, match="one beam, one pin and one contact"):
        to_rod(scene)


def test_solid_takes_the_rectangle_of_area_and_second_moment() -> None:
    strips = to_solid(load_scene("double-beam")).strips
    assert [strip.name for strip in strips] == ["upper", "lower"]
    for strip in strips:
        assert strip.width * strip.height == pytest.approx(3.0e-4)
        assert strip.bending_stiffness == pytest.approx(2.0e7 * 2.2e-8)
        assert strip.poissons_ratio == pytest.approx(0.4, abs=2e-4)


def test_solid_takes_joints_supports_and_moments() -> None:
    other = replace(KS.beams[0], name="other", start=(1.0, 0.0), end=(2.0, 0.0), clamped=("end",))
    roller = SupportSpec(beam="other", end="start", kind="roller", free="x", displacement=(0.0, 0.1))
    load = LoadSpec(beam="cantilever", end="end", force=(1.0, 0.0), moment=2.0)
    problem = to_solid(replace(KS, beams=(*KS.beams, other), supports=(roller,), loads=(load,)))
    assert [strip.clamped for strip in problem.strips] == [("start",), ("end",)]
    assert [joint.ends for joint in problem.joints] == [("cantilever.end", "other.start")]
    assert [(item.node, item.motion) for item in problem.supports] == [("other.start", (None, 0.1, None))]
    assert [(item.node, item.force, item.moment) for item in problem.loads] == [
        ("cantilever.end", (1.0, 0.0), 2.0)
    ]


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


def test_solid_clamps_the_edge_where_another_end_is_loaded_or_sprung() -> None:
    loads = (LoadSpec(beam="cantilever", end="end", moment=1.0),)
    springs = (SpringSpec(beam="cantilever", end="end", stiffness=(1.0, 1.0)),)
    problem = to_solid(replace(KS, loads=loads, springs=springs))
    assert (problem.strips[0].clamped, problem.supports) == (("start",), ())


def test_solid_refuses_a_beam_that_only_contact_holds() -> None:
    pinned = SupportSpec(beam="cantilever", end="start", kind="pinned")
    pin = replace(KS.pins[0], start=(1.0, -0.1))
    scene = replace(KS, beams=(replace(KS.beams[0], clamped=()),), supports=(pinned,), pins=(pin,))
    reason = MODELS["solid"].refusal(scene)
    assert reason is not None
    assert reason.endswith("must hold cantilever, with the pins that touch at the start")
    assert "\n" not in reason


def test_solid_takes_dead_forces_on_free_ends() -> None:
    load = LoadSpec(beam="cantilever", end="end", force=(1.0, -2.0))
    for scene in (replace(KS, loads=(load,)), replace(KS, pins=(), contacts=(), loads=(load,))):
        (found,) = to_solid(scene).loads
        assert (found.strip, found.force) == ("cantilever", (1.0, -2.0))


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


def test_structure_takes_over_supports_loads_and_keep() -> None:
    scene = replace(
        KS,
        supports=(
            SupportSpec(beam="cantilever", end="end", kind="roller", free="y", displacement=(-0.1, 0.0)),
        ),
        loads=(LoadSpec(beam="cantilever", end="end", force=(0.0, 1.0), moment=-2.0),),
        contacts=(replace(KS.contacts[0], keep=True),),
    )
    structure = to_structure(scene)
    clamp, roller = structure.supports
    assert (clamp.end, clamp.ux, clamp.uy, clamp.rotation) == ("start", 0.0, 0.0, 0.0)
    assert (roller.end, roller.ux, roller.uy, roller.rotation) == ("end", -0.1, None, None)
    assert [(load.beam, load.end, load.force, load.moment) for load in structure.loads] == [
        ("cantilever", "end", (0.0, 1.0), -2.0)
    ]
    assert structure.contacts[0].keep


@pytest.mark.parametrize("element", tsm.ELEMENTS)
def test_every_element_of_tsm_can_be_chosen_by_name(element: str) -> None:
    assert to_structure(KS, element=element).beams[0].element == element


def test_round_pin_is_an_offset_for_rods_and_a_radius_for_the_solid() -> None:
    pin = replace(FACE.pins[0], start=(1.0, -0.015), radius=0.005)
    contact = replace(FACE.contacts[0], penetration=1e-10)
    scene = replace(FACE, pins=(pin,), contacts=(contact,))
    assert to_structure(scene).contacts[0].offset == pytest.approx(0.015)
    assert to_rod(scene).offset == pytest.approx(0.015)
    problem = to_solid(with_beam(scene, solid_element="Q2-full"))
    assert (problem.pins[0].radius, problem.contacts[0].penetration) == (0.005, 1e-10)
    assert problem.strips[0].element == "Q2-full"


def test_mesh_file_is_the_scenes_unless_a_mesh_is_asked_for() -> None:
    scene = with_beam(KS, solid_mesh_file="mine.msh")
    assert to_solid(scene).strips[0].mesh_file == "mine.msh"
    assert to_solid(scene, mesh=(20, 2)).strips[0].mesh_file is None


def test_mesh_file_that_is_not_there_costs_one_line() -> None:
    with pytest.raises(
        ModelError, match=r"solid: Strip\('cantilever'\)\.mesh_file = 'nothing.msh': cannot be read"
    ):
        solve(with_beam(KS, solid_mesh_file="nothing.msh"), "solid")
