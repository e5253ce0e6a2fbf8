"""The built-in scenes: each is solved and certified, and has the limits that textbooks print."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import certify
from comparisons.response import Response
from comparisons.scene import Scene, built_in_scenes, load_scene
from tests.oracles.frames import Frame
from tests.verification.rod_by_shooting import Rod, free, pinned
from tsm.elements import EXACT, MIXED

NAMES = tuple(built_in_scenes())
PAPER = ("cantilever-critical-area", "double-beam")
KS = ("ks-cantilever", "ks-face", "ks-printed-shear", "ks-tied-tip")
OTHERS = tuple(name for name in NAMES if name not in {*PAPER, *KS})
"""Scenes that no other fast test solves; `tests/verification` has those of the paper and KS."""
ELEMENTS = (EXACT.name, MIXED.name)


def answer(scene: Scene, element: str = EXACT.name) -> Response:
    response = solve(scene, "tsm", Options(element=element))
    assert response.status == "COMPLETED", response.message
    return response


def test_the_page_counts_them(stated) -> None:
    stated("scenes", len(NAMES))


@pytest.mark.slow_at(
    "double-beam-friction-exact",
    "double-beam-friction-mixed",
    "hysteresis-exact",
    "hysteresis-mixed",
    "hysteresis-stages-exact",
    "hysteresis-stages-mixed",
    "ks-friction-exact",
    "ks-friction-mixed",
    "three-point-friction-exact",
    "three-point-friction-mixed",
)
@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("name", OTHERS)
def test_the_end_of_a_scene_is_certified(name: str, element: str) -> None:
    """With two load parameters, on which no answer depends; `test_every_load_parameter_is_certified` has all, of all scenes."""
    scene = replace(load_scene(name), load_parameters=2)
    found = certify(answer(scene, element), scene)
    assert found.certified, found.line()


@pytest.mark.slow
@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("name", NAMES)
def test_every_load_parameter_is_certified(name: str, element: str) -> None:
    scene = load_scene(name)
    found = certify(answer(scene, element), scene, at=range(len(scene.times)))
    assert found.certified, found.line()


@pytest.mark.parametrize(
    ("ratio", "x", "y"), [(1.063, 0.422, 0.881), (1.518, 0.792, 0.349), (1.884, 0.803, 0.123)]
)
def test_clamped_column(ratio: float, x: float, y: float) -> None:
    """Timoshenko and Gere (1961), table 2-4: P/P_1 and the head's place with the head turned by 40, 100 and 120 degrees.

    The imperfection is made a hundredth of what it is: the table is the perfect column's.
    """
    scene = load_scene("clamped-column")
    force = ratio * np.pi**2 / 4.0 * 175000.0 / 100.0**2
    near = replace(scene, loads=(replace(scene.loads[0], force=(0.0, -force), moment=1e-5 * force),))
    head = np.abs(answer(near).tips["column"][-1]) / 100.0
    assert head == pytest.approx([x, y], abs=2e-3)


def test_the_stages_of_a_cycle_end_as_the_cycle_does() -> None:
    response = answer(load_scene("hysteresis-stages"))
    (contact,) = response.contacts.values()
    assert contact.force[[19, 29]] == pytest.approx([44.8989432868, 19.1915545096], rel=1e-11)
    assert contact.arc_position[[19, 29]] == pytest.approx([63.9216785603, 82.9545104381], rel=1e-11)
    assert response.tips["cantilever"][-1] == pytest.approx((100.0, 0.0), abs=1e-7)
    turns = [(event.kind, event.stage) for event in response.events or () if event.kind == "stick"]
    assert turns == [("stick", 2), ("stick", 3), ("stick", 4)]


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_moment_straightens_an_arc(element: str) -> None:
    """The axis is an arc of the angle 2 (1 - t), which begins at the angle -1."""
    response = answer(load_scene("straightened-arc"), element)
    turn = 2.0 * (1.0 - response.load_parameter[:-1])
    tips = 100.0 * np.stack([np.sin(turn - 1.0) + np.sin(1.0), np.cos(1.0) - np.cos(turn - 1.0)], axis=1)
    tips = np.append(tips / turn[:, None], [[100.0 * np.cos(1.0), -100.0 * np.sin(1.0)]], axis=0)
    assert np.abs(response.tips["strip"] - tips).max() <= (1e-10 if element == EXACT.name else 1e-7)


def test_a_heavy_strip_by_shooting() -> None:
    response = answer(load_scene("heavy-strip"))
    support = response.supports["strip.start"]
    height, width, weight = 0.0006, 0.02, 7850.0 * 9.81 * 0.02 * 0.0006
    rod = Rod(
        height=(height, height),
        width=(width, width),
        youngs_modulus=2.1e11,
        shear_modulus=2.1e11 / 2.6,
        loads=((lambda _: np.array([0.0, -weight]), 0.0, 1.0),),
    )
    shot = free(rod, -np.array([*support.force[-1], support.moment[-1]]) + 1e-4)
    assert np.abs(response.tips["strip"][-1] - shot.tip[:2]).max() <= 1e-9
    assert shot.tip[:2] == pytest.approx([0.59321651, -0.74642688], abs=5e-9)
    assert support.moment[-1] == pytest.approx(-shot.clamp[2], abs=1e-9)
    assert -shot.clamp[2] == pytest.approx(0.3229455616, abs=5e-11)


def test_a_tapered_spring_by_shooting() -> None:
    """In units of 100 mm and EI at the clamp; the face of a straight taper is a line, the envelope of circles with these radii."""
    response = answer(load_scene("tapered-spring"))
    (contact,), support = response.contacts.values(), response.supports["spring.start"]
    unit = 2.1e5 * 10.0 * 2.0**3 / 12.0 / 100.0**2
    modulus = 2.1e5 * 100.0**2 / unit
    rod = Rod(height=(0.02, 0.008), width=(0.1, 0.1), youngs_modulus=modulus, shear_modulus=modulus / 2.6)
    steep = np.sin(np.arctan(0.006))
    least = 0.01 * np.cos(np.arctan(0.006)) + 0.05
    force = np.array([*-support.force[-1], -support.moment[-1] / 100.0]) / unit
    guess = np.array([*force, *contact.vector[-1] / unit, contact.arc_position[-1] / 100.0])
    shot = pinned(rod, (0.8, 0.19), (least, least - steep), guess + 1e-4)
    assert np.hypot(*shot.force) * unit == pytest.approx(contact.force[-1], rel=1e-9)
    assert shot.arc * 100.0 == pytest.approx(contact.arc_position[-1], rel=1e-9)
    assert -shot.clamp[2] * unit * 100.0 == pytest.approx(support.moment[-1], rel=1e-9)
    assert shot.tip[:2] * 100.0 == pytest.approx(response.tips["spring"][-1], rel=1e-9)
    found = [contact.force[-1], contact.arc_position[-1], support.moment[-1], *response.tips["spring"][-1]]
    assert found == pytest.approx(
        [117.9405689, 81.86984774, -9206.772399, 92.59595018, 33.11294977], rel=1e-9
    )


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_hinged_truss_snaps_through(element: str) -> None:
    scene = load_scene("hinged-truss")
    response = answer(scene, element)
    span, rise, EA = 100.0, 10.0, scene.beams[0].EA
    depth = 16.0 * response.load_parameter
    length = np.hypot(span, rise - depth)
    force = 2.0 * EA * (1.0 - length / np.hypot(span, rise)) * (rise - depth) / length
    # 1e-12 of the greatest force is two units in the last place of EA
    assert -response.supports["left.end"].force[:, 1] == pytest.approx(force, abs=8e-9)
    steep = np.cbrt(span / np.hypot(span, rise))
    greatest, place = 2.0 * EA * np.sqrt(1.0 - steep**2) ** 3, rise - span * np.sqrt(1.0 / steep**2 - 1.0)
    assert [greatest, place] == pytest.approx([8002.830999, 4.236074652], rel=1e-9)
    at = replace(scene.supports[2], displacement=(0.0, -place))
    peak = answer(replace(scene, load_parameters=2, supports=(*scene.supports[:2], at)), element)
    assert -peak.supports["left.end"].force[-1, 1] == pytest.approx(greatest, rel=1e-10)


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_beam_on_springs_sinks_and_turns(element: str) -> None:
    response = answer(load_scene("beam-on-springs"), element)
    t = response.load_parameter
    tip = np.stack([np.sqrt(200.0**2 - (65.0 * t) ** 2), -80.0 * t], axis=1)
    assert response.tips["beam"] == pytest.approx(tip, abs=1e-9)
    assert response.tips["beam"][-1, 0] == pytest.approx(189.1428, abs=5e-5)
    springs = [response.springs[f"beam.{end}"].force[:, 1] for end in ("start", "end")]
    assert springs == pytest.approx(np.array([60.0 * t, 240.0 * t]), abs=1e-8)


@pytest.mark.slow
def test_double_beam_with_friction() -> None:
    """Exact rods by the referee's equations."""
    scene = load_scene("double-beam-friction")
    for model in ("tsm", "rod"):
        response = answer(scene) if model == "tsm" else solve(scene, model)
        pin, tip = response.contacts["pin->upper"], response.contacts["upper.end->lower"]
        assert [pin.force[-1], tip.force[-1]] == pytest.approx([1.492913849, 0.687397776], abs=2e-9)
        assert [pin.arc_position[-1], tip.arc_position[-1]] == pytest.approx(
            [0.985892541, 0.887840364], abs=1e-9
        )
        assert pin.friction is not None
        assert tip.friction is not None
        spent = [pin.friction.dissipated[-1], tip.friction.dissipated[-1]]
        assert spent == pytest.approx([0.038616279, 0.005564158], abs=1e-9)
        if response.events is not None:
            touch = next(event for event in response.events if event.kind == "touch")
            assert 0.52 * touch.load_parameter == pytest.approx(0.149852, abs=1e-6)
    smooth = replace(scene, contacts=tuple(replace(item, friction=0.0) for item in scene.contacts))
    forces = [contact.force[-1] for contact in answer(smooth).contacts.values()]
    assert forces[:2] == pytest.approx([1.480763310, 0.659472563], abs=1e-9)


def test_portal_frame_under_a_small_load() -> None:
    """Kleinlogel: moments of the feet .3 H h, vertical reactions .2667 H; the rest is the stretch of columns and girder."""
    scene = load_scene("portal-frame")
    response = answer(replace(scene, loads=(replace(scene.loads[0], force=(0.1, 0.0)),)))
    left, right = response.supports["left.start"], response.supports["right.end"]
    assert left.moment[-1] + right.moment[-1] == pytest.approx(2.0 * 0.3 * 0.1 * 200.0, rel=1e-3)
    assert [left.force[-1, 1], right.force[-1, 1]] == pytest.approx([-0.1 * 4 / 15, 0.1 * 4 / 15], rel=1e-3)


def test_two_pins_at_a_small_depth() -> None:
    """Timoshenko's beam: ``F = d/(a^2 (3 L - 4 a)/(6 EI) + a/GA)``."""
    scene = load_scene("two-pins")
    depth, a, beam = 1e-5, 0.33, scene.beams[0]
    pins = tuple(replace(pin, displacement=(0.0, -depth)) for pin in scene.pins)
    response = answer(replace(scene, pins=pins, load_parameters=1))
    force = depth / (a**2 * (3.0 - 4.0 * a) / (6.0 * beam.EI) + a / beam.GA)
    found = [contact.force[-1] for contact in response.contacts.values()]
    assert found == pytest.approx([force, force], rel=1e-4)


def test_crossed_beams_with_an_upright_strut() -> None:
    """Before it buckles, a strut that does not lean moves down by the deflection of a beam that is loaded in its middle, and is shortened."""
    scene = load_scene("crossed-beams")
    lower, upper = scene.beams
    down = 2.0
    upright = replace(
        scene,
        load_parameters=2,
        beams=(lower, replace(upper, end=(100.0, 1.0))),
        supports=(replace(scene.supports[0], displacement=(0.0, -down)),),
    )
    (contact,) = answer(upright).contacts.values()
    joints = ((0.0, 0.0), (100.0, 0.0), (200.0, 0.0))
    frame = Frame(joints=joints, loaded=1, clamped=True, EA=lower.EA, GA=lower.GA, EI=lower.EI)
    down_to = [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.25, 1.5, 1.75]
    sunk = down - contact.force[-1] * 99.0 / upper.EA
    assert contact.force[-1] == pytest.approx(frame.load([*down_to, sunk])[-1], rel=1e-9)
    assert contact.arc_position[-1] == pytest.approx(100.0, abs=1e-9)
