"""Two rods in contact: integration from the clamps, work, the ends of the stage, units."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from comparisons.exact.coupled import coupled_rods
from comparisons.exact.rod import rod_under_pin

ROD = {"EA": 2e7 * 3e-4, "GA": 7.142e6 * 3e-4, "EI": 2e7 * 2.2e-8, "length": 1.0}
SCENE = {"pin_x": 0.8, "spacing": 0.2}
DEPTHS = np.linspace(0.16, 0.53, 8)


@pytest.fixture(scope="module")
def path():
    return coupled_rods(DEPTHS, **SCENE, **ROD)


def integrate(start, force, length):
    """`x, y, theta, m` and strain energy at the end of a part, and the strained tangent there."""
    nx, ny = force

    def rate(_, state):
        c, s = np.cos(state[2]), np.sin(state[2])
        N, Q = nx * c + ny * s, ny * c - nx * s
        dx = (1.0 + N / ROD["EA"]) * c - Q / ROD["GA"] * s
        dy = (1.0 + N / ROD["EA"]) * s + Q / ROD["GA"] * c
        energy = (N**2 / ROD["EA"] + Q**2 / ROD["GA"] + state[3] ** 2 / ROD["EI"]) / 2.0
        return [dx, dy, state[3] / ROD["EI"], dy * nx - dx * ny, energy]

    end = solve_ivp(rate, (0.0, length), start, method="DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    return end, np.array(rate(0.0, end)[:2])


def rods(path, k):
    """Both rods at the pin (first), at the tip (first), at the contact (second), with tangents on the near sides."""
    pin_force, tip_force = path.pin_force[k], path.tip_force[k]
    first = [0.0, 0.0, 0.0, -path.clamp_moments[k, 0], 0.0]
    pin, before = integrate(first, pin_force - tip_force, path.pin_arc[k])
    tip, _ = integrate(pin, -tip_force, 1.0 - path.pin_arc[k])
    after_pin = integrate(pin, -tip_force, 1e-12)[1]
    second = [0.0, SCENE["spacing"], 0.0, -path.clamp_moments[k, 1], 0.0]
    return pin, before, after_pin, tip, *integrate(second, tip_force, path.tip_arc[k])


@pytest.mark.parametrize("k", range(len(DEPTHS)))
def test_all_conditions_hold_when_integrated_from_the_clamps(path, k):
    pin, before, after, tip, contact, tangent = rods(path, k)
    np.testing.assert_allclose(pin[:2], [0.8, DEPTHS[k]], atol=1e-12)
    assert path.pin_force[k] @ (before + after) == pytest.approx(0.0, abs=1e-10)
    assert tip[3] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(tip[:2], contact[:2], atol=1e-12)
    np.testing.assert_allclose(path.tip[k], contact[:2], atol=1e-12)
    assert contact[3] == pytest.approx(0.0, abs=1e-12)
    tail = np.array([np.cos(contact[2]), np.sin(contact[2])])
    assert path.tip_force[k] @ (tangent + tail) == pytest.approx(0.0, abs=1e-11)
    assert path.tip_force[k, 1] > 0.0
    assert path.pin_force[k, 1] > 0.0


def test_touch(path):
    single = rod_under_pin([[0.8, 0.0], [0.8, path.touch_depth]], **ROD)
    assert single.tip[1, 1] == pytest.approx(0.2, abs=1e-12)
    start = coupled_rods([path.touch_depth], **SCENE, **ROD)
    np.testing.assert_allclose(start.pin_force[0], single.force[1], rtol=1e-11)
    np.testing.assert_array_equal(start.tip_force[0], 0.0)
    assert start.tip_arc[0] == pytest.approx(single.tip[1, 0], abs=1e-12)


def test_hand_over(path):
    """The stage ends with the pin at the first rod's tip, where the second rod is already the one under the pin alone."""
    assert path.end == "pin at the tip"
    last = coupled_rods([path.end_depth - 1e-10], **SCENE, **ROD)
    assert last.pin_arc[0] == pytest.approx(1.0, abs=1e-9)
    np.testing.assert_allclose(last.tip[0], [0.8, path.end_depth], atol=1e-9)
    np.testing.assert_allclose(
        last.clamp_moments[0, 0], last.pin_arc[0] * 0.0 - moment_of_first(last), atol=1e-9
    )
    single = rod_under_pin([[0.8, 0.0], [0.8, path.end_depth - 0.2]], **ROD)
    np.testing.assert_allclose(last.tip_force[0], single.force[1], rtol=1e-8)
    assert last.tip_arc[0] == pytest.approx(single.arc_position[1], abs=1e-8)
    assert np.isnan(coupled_rods([path.end_depth + 1e-8], **SCENE, **ROD).pin_arc[0])


def moment_of_first(path):
    """Moment of pin and tip forces about the first clamp."""
    net = path.pin_force[0] - path.tip_force[0]
    return 0.8 * net[1] - path.end_depth * net[0]


def test_work_of_the_pin_is_strain_energy(path):
    nodes, weights = np.polynomial.legendre.leggauss(16)
    low, high = DEPTHS[0], DEPTHS[-1]
    between = coupled_rods(low + (high - low) * (nodes + 1.0) / 2.0, **SCENE, **ROD)
    work = (high - low) / 2.0 * weights @ between.pin_force[:, 1]

    def energy(k):
        _, _, _, tip, contact, _ = rods(path, k)
        return tip[4] + contact[4]

    assert work == pytest.approx(energy(-1) - energy(0), rel=1e-10)


def test_depths_outside_the_stage_are_nan(path):
    wide = coupled_rods([0.1, *DEPTHS, 0.6], **SCENE, **ROD)
    assert np.isnan(wide.pin_arc[[0, -1]]).all()
    np.testing.assert_allclose(wide.pin_force[1:-1], path.pin_force, rtol=1e-11)
    assert wide.end_depth == pytest.approx(path.end_depth, abs=1e-12)


@pytest.mark.slow
def test_a_tip_that_slips_off_the_second_rod():
    """A pin near the clamps bends the rods far: the first one's tip runs along the second to its end."""
    scene = {"pin_x": 0.3, "spacing": 0.05}
    end = coupled_rods([0.1], **scene, **ROD)
    assert end.end == "tip slipped"
    last = coupled_rods([end.end_depth - 1e-9, end.end_depth + 1e-9], **scene, **ROD)
    assert last.tip_arc[0] == pytest.approx(1.0, abs=1e-7)
    assert last.pin_arc[0] < 1.0
    assert np.isnan(last.tip_arc[1])


@pytest.mark.slow
def test_a_pair_is_lost_at_its_fold():
    """Where equilibrium ends, all unknowns go with the square root of the depth that is left."""
    scene = {"pin_x": 0.3, "spacing": 0.6}
    fold = coupled_rods([0.2], **scene, **ROD)
    assert fold.end == "lost"
    left = 1e-7 * np.array([25.0, 16.0, 9.0, 4.0])
    path = coupled_rods(fold.end_depth - left, **scene, **ROD)
    for steps in (np.diff(path.pin_arc), np.diff(path.clamp_moments[:, 0]), np.diff(path.tip[:, 0])):
        assert steps == pytest.approx(steps[0], rel=0.02)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"spacing": 3.0}, "must reach the second rod"),
        ({"pin_x": 1.0}, "pin_x = 1.0: must be less than length"),
        ({"depths": [0.3, 0.2]}, "increasing"),
        ({"EI": -1.0}, "EI = -1.0: must be positive"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises(ValueError, match=message):
        coupled_rods(**({"depths": DEPTHS} | SCENE | ROD | change))
