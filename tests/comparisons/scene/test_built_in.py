"""The built-in scenes: each is solved and certified, and has the limits that textbooks print."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.claims.problems.peaks import summit
from comparisons.cli import main
from comparisons.exact.chain import Chain, load_path
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import certify
from comparisons.response import Response
from comparisons.scene import Scene, built_in_scenes, load_scene
from tsm.elements import EXACT, MIXED

NAMES = tuple(built_in_scenes())
PAPER = ("cantilever-critical-area", "double-beam")
OTHERS = tuple(name for name in NAMES if name not in PAPER and not name.startswith("ks-"))
"""Scenes that no other fast test solves; `tests/verification` has those of the paper and KS."""
ELEMENTS = (EXACT.name, MIXED.name)


def answer(scene: Scene, element: str = EXACT.name) -> Response:
    response = solve(scene, "tsm", Options(element=element))
    assert response.status == "COMPLETED", response.message
    return response


def test_there_are_seventeen() -> None:
    assert len(NAMES) == 17


@pytest.mark.parametrize("name", OTHERS)
def test_check_draws_a_scene(name: str, tmp_path, capsys) -> None:
    assert main(["check", name, "--out", str(tmp_path / "scene.svg")]) == 0
    assert "  tsm: yes" in capsys.readouterr().out


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
    found = certify(answer(scene, element), scene, at=range(scene.load_parameters))
    assert found.certified, found.line()


@pytest.mark.parametrize(("load", "height"), [(1, 0.30172), (2, 0.49346), (5, 0.71379), (10, 0.81061)])
def test_tip_load(load: int, height: float) -> None:
    """Bisshopp and Drucker (1945); a strip with h/L = 1/100 stretches and shears by some 1e-4 besides."""
    response = answer(load_scene("tip-load"))
    assert response.tips["cantilever"][load - 1, 1] / 100.0 == pytest.approx(height, abs=2e-4)


def test_roll_up() -> None:
    """Bathe and Bolourchi (1979): an arc, for any section."""
    tips = answer(load_scene("roll-up")).tips["cantilever"] / 100.0
    assert tips[1, 0] == pytest.approx(2.0 / np.pi, rel=1e-9)
    assert tips[3, 1] == pytest.approx(2.0 / np.pi, rel=1e-9)
    assert np.abs(tips[7]).max() <= 1e-9


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


def test_pinned_column_is_two_clamped_ones() -> None:
    whole, half = answer(load_scene("pinned-column")), answer(load_scene("clamped-column"))
    assert whole.tips["column"][-1, 1] == pytest.approx(2.0 * half.tips["column"][-1, 1], rel=1e-7)


def test_three_point_bending() -> None:
    """The greatest load of the elastica, 1.667952 EI/a^2 at .476378 a, of a strip with h/a = 1/50."""
    response = answer(load_scene("three-point-bending"))
    load, place = summit(70.0 * response.load_parameter, -response.supports["left"].force[:, 1])
    assert [load * 100.0**2 / 1.4e6, place / 100.0] == pytest.approx([1.667952, 0.476378], rel=3e-4)
    assert [load, place] == pytest.approx([233.474683, 47.6442], rel=1e-6)


def test_portal_frame_under_a_small_load() -> None:
    """Kleinlogel: moments of the feet .3 H h, vertical reactions .2667 H; the rest is the stretch of columns and girder."""
    scene = load_scene("portal-frame")
    response = answer(replace(scene, loads=(replace(scene.loads[0], force=(0.1, 0.0)),)))
    left, right = response.supports["left"], response.supports["right"]
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
    chain = Chain(joints=joints, loaded=1, clamped=True, EA=lower.EA, GA=lower.GA, EI=lower.EI)
    down_to = [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.25, 1.5]
    sunk = down - contact.force[-1] * 99.0 / upper.EA
    assert contact.force[-1] == pytest.approx(load_path(chain, [*down_to, sunk])[-1], rel=1e-9)
    assert contact.arc_position[-1] == pytest.approx(100.0, abs=1e-9)


@pytest.mark.parametrize("element", ELEMENTS)
def test_lees_frame_past_its_limit_load(element: str) -> None:
    """18.557 EI/L^2 (Lee, Manuel and Rossow, 1968)."""
    response = answer(load_scene("lees-frame"), element)
    load, place = summit(54.0 * response.load_parameter, -response.supports["near"].force[:, 1])
    assert load * 10.0 == pytest.approx(18.557, rel=1e-4)
    assert [load, place] == pytest.approx([1.855672753, 48.7351], rel=2e-6)


@pytest.mark.parametrize("element", ELEMENTS)
def test_williams_toggle_past_both_limit_loads(element: str) -> None:
    """33.87 and 31.28 lb (Wood and Zienkiewicz, 1977)."""
    response = answer(load_scene("williams-toggle"), element)
    pressed = response.supports["left"].other_end
    assert pressed is not None
    down, load = 0.6 * response.load_parameter, -pressed.force[:, 1]
    greatest, least = summit(down[:16], load[:16])[0], -summit(down[10:], -load[10:])[0]
    assert [greatest, least] == pytest.approx([33.87, 31.28], rel=2e-4)
    assert [greatest, least] == pytest.approx([33.8696, 31.2780], rel=3e-6)
