"""The referee against the elastica's closed forms, and against every special case of the exact rods."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.claims.problems.double_beam import TIP, UPPER
from comparisons.claims.problems.frames import toggle_scene
from comparisons.exact.elastica import elastica_under_pin
from comparisons.exact.rod import rod_under_pin
from comparisons.models import solve
from comparisons.referee import AnswerState, Equilibrium, SearchStatus, answer_state, equilibrium
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, load_scene
from tests.oracles.coupled import pair_of
from tests.oracles.elastica import tip_under_dead_load
from tests.oracles.frames import toggle
from tests.oracles.tied import rod_with_tied_tip

STIFF = 1e10 * 12.0 / 0.02**2
"""EA and GA over EI: KS's times 1e10, the elastica."""


def unit_beam(EA: float = STIFF, GA: float = STIFF, name: str = "beam") -> BeamSpec:
    return BeamSpec(
        name=name, start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",),
        youngs_modulus=1.0, shear_modulus=1.0, area=EA, second_moment=1.0, shear_area=GA,
    )  # fmt: skip


def at(t: float, axis: np.ndarray, beam: str = "beam", **more: dict) -> AnswerState:
    arc = np.linspace(0.0, 1.0, len(axis))
    nothing = {"arcs": {}, "forces": {}, "reactions": {}, "tips": {}}
    return AnswerState(load_parameter=t, axes={beam: (arc, axis)}, **(nothing | more))


def found(scene: Scene, given: AnswerState) -> Equilibrium:
    exact = equilibrium(scene, given)
    assert exact.status is SearchStatus.FOUND, exact.message
    return exact


KS = Scene(
    name="ks",
    load_parameters=1,
    beams=(unit_beam(),),
    pins=(PinSpec(name="pin", start=(1.0, 0.0), displacement=(-1.0, 2.0 / np.pi)),),
    contacts=(ContactSpec(node="pin", beam="beam", side="right"),),
)


@pytest.mark.parametrize("t", [0.25, 0.75, 1.0])
def test_elastica_under_a_pin_to_1e_12(t: float) -> None:
    x, y = KS.pin("pin").position(t)
    truth = elastica_under_pin(x, y)
    rough = {"arcs": {"pin->beam": 1.001 * truth.arc_position}, "forces": {"pin->beam": 0.97 * truth.force}}
    exact = found(KS, at(t, truth.shape(41), **rough))
    contact = exact.contacts["pin->beam"]
    size = np.hypot(*truth.force)
    np.testing.assert_allclose(contact.force, truth.force, rtol=0.0, atol=1e-12 * size)
    assert contact.push == pytest.approx(size, rel=1e-12)
    assert contact.arc_position == pytest.approx(truth.arc_position, rel=1e-12)
    np.testing.assert_allclose(exact.ends["beam.end"], truth.tip, rtol=0.0, atol=1e-12)
    shape = exact.shape("beam", np.linspace(0.0, 1.0, 101))
    np.testing.assert_allclose(shape.position, truth.shape(101), rtol=0.0, atol=1e-12)
    assert exact.reactions["beam.start"][2] == pytest.approx(truth.clamp_moment, rel=1e-12)
    assert exact.index == 0


@pytest.mark.parametrize("load", [1.0, 10.0, 100.0])
def test_elastica_under_a_dead_load_to_1e_12(load: float) -> None:
    scene = Scene(
        name="dead", load_parameters=1, beams=(unit_beam(),), loads=(LoadSpec(beam="beam", end="end", force=(0.0, load)),)
    )  # fmt: skip
    truth = tip_under_dead_load(load)
    arc = np.linspace(0.0, 1.0, 41)
    bent = np.stack([arc * truth[0], arc**2 * truth[1]], axis=1)
    exact = found(scene, at(1.0, bent))
    np.testing.assert_allclose(exact.ends["beam.end"], truth, rtol=0.0, atol=1e-12)


def test_roll_up_by_a_moment_to_1e_12() -> None:
    moment = 2.0 * np.pi
    scene = Scene(
        name="roll", load_parameters=1, beams=(unit_beam(),), loads=(LoadSpec(beam="beam", end="end", moment=moment),)
    )  # fmt: skip
    arc = np.linspace(0.0, 1.0, 81)[1:]
    circle = np.stack([np.sin(6.0 * arc), 1.0 - np.cos(6.0 * arc)], axis=1) / 6.0
    exact = found(scene, at(1.0, np.vstack([[0.0, 0.0], circle])))
    np.testing.assert_allclose(exact.ends["beam.end"], [0.0, 0.0], rtol=0.0, atol=1e-12)
    assert exact.strain_energy == pytest.approx(moment**2 / 2.0, rel=1e-12)


@pytest.mark.parametrize("name", ["ks-face", pytest.param("ks-cantilever", marks=pytest.mark.slow)])
def test_rod_under_a_pin_to_1e_11(name: str) -> None:
    scene = replace(load_scene(name), load_parameters=10)
    beams = solve(scene, "tsm")
    beam, contact = scene.beams[0], scene.contacts[0]
    path = [scene.pin("pin").position(t) for t in (0.0, *scene.times)]
    local = np.array(path) - np.array(beam.start)
    truth = rod_under_pin(
        local, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length, offset=scene.offset(contact)
    )
    for k in range(10):
        exact = found(scene, answer_state(beams, scene, k))
        touch = exact.contacts[contact.pair]
        size = truth.magnitude[k + 1]
        np.testing.assert_allclose(touch.force, truth.force[k + 1], rtol=0.0, atol=1e-11 * size)
        assert touch.arc_position == pytest.approx(truth.arc_position[k + 1], rel=1e-11)
        np.testing.assert_allclose(exact.ends["cantilever.end"], truth.tip[k + 1], rtol=0.0, atol=1e-11)
        assert exact.reactions["cantilever.start"][2] == pytest.approx(truth.clamp_moment[k + 1], rel=1e-11)
        assert abs(touch.drag) < 1e-12 * size
        assert exact.index == 0


@pytest.mark.slow
def test_tied_tip_to_1e_11() -> None:
    scene = replace(load_scene("ks-tied-tip"), load_parameters=5)
    beams, beam = solve(scene, "tsm"), scene.beams[0]
    moved = np.array(scene.supports[0].displacement)
    points = np.array([1.0, 0.0]) + np.outer([0.0, *scene.times], moved)
    truth = rod_with_tied_tip(points, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length)
    for k in range(5):
        exact = found(scene, answer_state(beams, scene, k))
        size = np.hypot(*truth.force[k + 1])
        held = exact.reactions["cantilever.end"]
        np.testing.assert_allclose(held[:2], truth.force[k + 1], rtol=0.0, atol=1e-11 * size)
        assert exact.reactions["cantilever.start"][2] == pytest.approx(truth.clamp_moment[k + 1], rel=1e-11)


@pytest.mark.slow
def test_coupled_rods_to_1e_11() -> None:
    scene = replace(load_scene("double-beam"), load_parameters=10)
    beams = solve(scene, "tsm")
    depth = 0.76 * beams.load_parameter
    both = np.flatnonzero((depth > 0.16) & (depth < 0.53))
    truth = pair_of(scene).stage(depth[both])
    assert len(both) > 3
    for row, k in enumerate(both):
        exact = found(scene, answer_state(beams, scene, int(k)))
        # positive there from x to y, depth downwards
        for pair, force, arc in (
            (UPPER, truth.pin_force[row], truth.pin_arc[row]),
            (TIP, truth.tip_force[row], truth.tip_arc[row]),
        ):
            here = exact.contacts[pair]
            np.testing.assert_allclose(here.force, force * [1.0, -1.0], rtol=0.0, atol=1e-11)
            assert here.arc_position == pytest.approx(arc, rel=1e-11)
        np.testing.assert_allclose(
            exact.ends["upper.end"], truth.tip[row] * [1.0, -1.0], rtol=0.0, atol=1e-11
        )


@pytest.mark.parametrize(
    "deflection", [pytest.param(0.15, marks=pytest.mark.slow), 0.3, pytest.param(0.5, marks=pytest.mark.slow)]
)
def test_a_toggle_beyond_its_limit_to_1e_11(deflection: float) -> None:
    """Williams' toggle: its load is a maximum near .235, a minimum near .39, unstable between."""
    frame = toggle_scene()
    apex = frame.beams[0].end
    span, rise = apex
    load = toggle().load(np.linspace(0.0, deflection, 11)[1:])[-1]
    scene = replace(frame, load_parameters=1, loads=(replace(frame.loads[0], force=(0.0, -float(load))),))
    arc, x = np.linspace(0.0, np.hypot(span, rise), 41), np.linspace(0.0, 1.0, 41)
    smooth = x**2 * (3.0 - 2.0 * x)
    left = np.stack([span * x, rise * x - deflection * smooth], axis=1)
    right = np.stack([2.0 * span - span * x, left[:, 1]], axis=1)[::-1]
    given = AnswerState(
        load_parameter=1.0,
        arcs={},
        forces={},
        axes={"left": (arc, left), "right": (arc, right)},
        reactions={},
        tips={},
    )
    exact = found(scene, given)
    moved = exact.ends["left.end"] - apex
    np.testing.assert_allclose(moved, [0.0, -deflection], rtol=0.0, atol=1e-11)
    assert exact.index == (1 if deflection == 0.3 else 0)
