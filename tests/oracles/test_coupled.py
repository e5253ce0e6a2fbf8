"""Two rods in contact: integration from the clamps, work, the ends of the stage."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from comparisons.scene import load_scene
from tests.oracles.coupled import pair_of

PAIR = pair_of(load_scene("double-beam"))
DEPTHS = np.linspace(0.16, 0.53, 8)


@pytest.fixture(scope="module")
def path():
    return PAIR.stage([0.1, *DEPTHS, 0.6])


def integrate(start, force, length):
    """`x, y, theta, m` and strain energy at the end of a part, and the strained tangent there."""
    nx, ny = force

    def rate(_, state):
        c, s = np.cos(state[2]), np.sin(state[2])
        N, Q = nx * c + ny * s, ny * c - nx * s
        dx = (1.0 + N / PAIR.EA) * c - Q / PAIR.GA * s
        dy = (1.0 + N / PAIR.EA) * s + Q / PAIR.GA * c
        energy = (N**2 / PAIR.EA + Q**2 / PAIR.GA + state[3] ** 2 / PAIR.EI) / 2.0
        return [dx, dy, state[3] / PAIR.EI, dy * nx - dx * ny, energy]

    end = solve_ivp(rate, (0.0, length), start, method="DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    return end, np.array(rate(0.0, end)[:2])


def rods(path, k):
    """Both rods at the pin (first), at the tip (first), at the contact (second), with tangents on the near sides."""
    pin_force, tip_force = path.pin_force[k], path.tip_force[k]
    first = [0.0, 0.0, 0.0, -path.clamp_moments[k, 0], 0.0]
    pin, before = integrate(first, pin_force - tip_force, path.pin_arc[k])
    tip, _ = integrate(pin, -tip_force, 1.0 - path.pin_arc[k])
    after_pin = integrate(pin, -tip_force, 1e-12)[1]
    second = [0.0, PAIR.spacing, 0.0, -path.clamp_moments[k, 1], 0.0]
    return pin, before, after_pin, tip, *integrate(second, tip_force, path.tip_arc[k])


def test_all_conditions_hold_when_integrated_from_the_clamps(path):
    """At depths outside the stage there are none."""
    assert np.isnan(path.pin_arc[[0, -1]]).all()
    for k, depth in enumerate(DEPTHS, start=1):
        pin, before, after, tip, contact, tangent = rods(path, k)
        np.testing.assert_allclose(pin[:2], [0.8, depth], atol=1e-12)
        assert path.pin_force[k] @ (before + after) == pytest.approx(0.0, abs=1e-10)
        assert tip[3] == pytest.approx(0.0, abs=1e-12)
        np.testing.assert_allclose([tip[:2], path.tip[k]], [contact[:2]] * 2, atol=1e-12)
        assert contact[3] == pytest.approx(0.0, abs=1e-12)
        tail = np.array([np.cos(contact[2]), np.sin(contact[2])])
        assert path.tip_force[k] @ (tangent + tail) == pytest.approx(0.0, abs=1e-11)
        assert path.tip_force[k, 1] > 0.0
        assert path.pin_force[k, 1] > 0.0


def test_touch(path):
    single, start = PAIR.single([path.touch_depth]), PAIR.stage([path.touch_depth])
    assert single.tip[1, 1] == pytest.approx(PAIR.spacing, abs=1e-12)
    np.testing.assert_allclose(start.pin_force[0], single.force[1], rtol=1e-11)
    np.testing.assert_array_equal(start.tip_force[0], 0.0)
    assert start.tip_arc[0] == pytest.approx(single.tip[1, 0], abs=1e-12)


def test_hand_over(path):
    """The stage ends with the pin at the first rod's tip, where the second rod is already the one under the pin alone."""
    last, single = PAIR.stage([path.end_depth - 1e-10]), PAIR.single([path.end_depth - PAIR.spacing])
    assert last.pin_arc[0] == pytest.approx(1.0, abs=1e-9)
    np.testing.assert_allclose(last.tip[0], [0.8, path.end_depth], atol=1e-9)
    net = last.pin_force[0] - last.tip_force[0]
    assert last.clamp_moments[0, 0] == pytest.approx(path.end_depth * net[0] - 0.8 * net[1], abs=1e-9)
    np.testing.assert_allclose(last.tip_force[0], single.force[1], rtol=1e-8)
    assert last.tip_arc[0] == pytest.approx(single.arc_position[1], abs=1e-8)


def test_work_of_the_pin_is_strain_energy(path):
    nodes, weights = np.polynomial.legendre.leggauss(16)
    low, high = DEPTHS[0], DEPTHS[-1]
    between = PAIR.stage(low + (high - low) * (nodes + 1.0) / 2.0)
    work = (high - low) / 2.0 * weights @ between.pin_force[:, 1]
    energy = [sum(part[4] for part in rods(path, k)[3:5]) for k in (1, -2)]
    assert work == pytest.approx(energy[1] - energy[0], rel=1e-10)
