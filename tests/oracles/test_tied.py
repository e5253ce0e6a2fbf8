"""The rod with a tied tip: integration from the clamp, energy, limits known in closed form, slender rods, stability."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.oracles.tied import rod_with_tied_tip

EI = 2.8e-4
KS = {"EA": 8.4, "GA": 5 / 6 * 2.1e4 / 2.6 * 4e-4, "EI": EI}
KNEE = brentq(lambda k: np.tan(k) - k, 4.4, 4.6)
"""Root of `tan k = k`: a slender rod that is clamped and hinged buckles at `k^2 EI/L^2`."""


def tips(t):
    return np.column_stack([1.0 - np.asarray(t), 2.0 / np.pi * np.asarray(t)])


def shoot(path, k):
    """`x, y, theta, m` and strain energy at the tip, integrated from the clamp."""
    nx, ny = path.force[k]

    def rate(_, state):
        c, s = np.cos(state[2]), np.sin(state[2])
        N, Q = nx * c + ny * s, ny * c - nx * s
        dx = (1.0 + N / KS["EA"]) * c - Q / KS["GA"] * s
        dy = (1.0 + N / KS["EA"]) * s + Q / KS["GA"] * c
        energy = (N**2 / KS["EA"] + Q**2 / KS["GA"] + state[3] ** 2 / EI) / 2.0
        return [dx, dy, state[3] / EI, dy * nx - dx * ny, energy]

    start = [0.0, 0.0, 0.0, -path.clamp_moment[k], 0.0]
    return solve_ivp(rate, (0.0, 1.0), start, method="DOP853", rtol=1e-13, atol=1e-17).y[:, -1]


def test_integration_from_the_clamp_arrives_at_the_tied_tip():
    """Whatever the pieces into which the path is cut."""
    t = [0.0, 0.02, 0.1, 0.55, 0.9, 1.0]
    path, whole = rod_with_tied_tip(tips(t), **KS), rod_with_tied_tip(tips([0.0, 1.0]), **KS)
    for k in range(1, len(t)):
        x, y, theta, moment, _ = shoot(path, k)
        np.testing.assert_allclose([[x, y]], tips([t[k]]), atol=1e-12)
        assert theta == pytest.approx(path.tip_rotation[k], abs=1e-12)
        assert moment == pytest.approx(0.0, abs=1e-12 * EI)
    np.testing.assert_allclose(whole.force[-1], path.force[-1], rtol=1e-12)


def test_the_force_is_the_derivative_of_the_strain_energy():
    nodes, weights = np.polynomial.legendre.leggauss(20)
    path = rod_with_tied_tip(tips([0.0, 0.1, *(0.55 + 0.45 * nodes), 1.0]), **KS)
    work = 0.45 * weights @ (path.force[2:-1] @ [-1.0, 2.0 / np.pi])
    assert work == pytest.approx(shoot(path, -1)[4] - shoot(path, 1)[4], rel=1e-10)


def test_a_straight_rod_buckles_at_eulers_load_and_sags():
    """It sags as its tip rises, and without a rise is followed up to the buckling load only."""
    risen = rod_with_tied_tip(tips([0.0, 0.02]), **KS)
    assert -risen.force[1, 0] == pytest.approx(KNEE**2 * EI, rel=0.02)
    assert np.all(risen.rotations[1, :10] < 0.0)
    before = rod_with_tied_tip([[1.0, 0.0], [1.0 - 1e-4, 1e-9]], **KS)
    assert before.force[1, 0] == pytest.approx(-1e-4 * KS["EA"], rel=1e-6)
    times = np.linspace(0.0, 1e-3, 101)
    pushed = rod_with_tied_tip(np.column_stack([1.0 - times, 0.0 * times]), **KS)
    reached = int(np.argmax(np.isnan(pushed.force[:, 0])))
    assert KS["EA"] * times[reached - 1] < KNEE**2 * EI * 1.001
    assert KS["EA"] * times[reached] > KNEE**2 * EI * 0.99


def slender(slenderness):
    """Stiffnesses over EI of a rectangular section of height `1/slenderness`."""
    EA = 12.0 * slenderness**2
    return {"EA": EA, "GA": EA / 3.12, "EI": 1.0}


@pytest.mark.parametrize(("slenderness", "rise"), [(593.2, 1e-3), (1e5, 1e-5)])
def test_a_slender_rod_moved_sideways_is_stretched_in_few_iterations(slenderness, rise):
    """A tensioned beam, `w'''' = N w''` with `N = EA/2 int w'^2`: right to the slope's square."""
    arcs, weights = np.polynomial.legendre.leggauss(40)

    def slope(N):
        return rise / (1.0 - np.tanh(np.sqrt(N)) / np.sqrt(N))

    def excess(N):
        k = np.sqrt(N)
        along = slope(N) * (1.0 - np.cosh(k * (1.0 - arcs) / 2.0) / np.cosh(k))
        return N - 12.0 * slenderness**2 * weights @ along**2 / 4.0

    N = brentq(excess, 1e-6, 1e3, xtol=1e-14, rtol=1e-14)
    found = rod_with_tied_tip([[1.0, 0.0], [1.0, rise]], **slender(slenderness))
    np.testing.assert_allclose(found.force[1], [N, N * slope(N)], rtol=5e-6)
    assert found.clamp_moment[1] == pytest.approx(-np.sqrt(N) * np.tanh(np.sqrt(N)) * slope(N), rel=5e-6)
    assert found.iterations[1] < 80


@pytest.mark.parametrize(
    ("slenderness", "tip"), [(1e3, (1.0, 0.8)), (1e4, (1.02, -0.7)), (1e4, (0.9, 0.7)), (1e3, (1.3, 0.1))]
)
def test_a_taut_slender_rod_bends_in_a_layer_at_its_clamp(slenderness, tip):
    """`m^2/2 + N + N^2/2 EA + Q^2/2 GA` is the same along the rod; far from the clamp `theta'' = 0`, so `Q (1 + (1/EA - 1/GA) N) = 0`."""
    rod = slender(slenderness)
    found = rod_with_tied_tip([(1.0, 0.0), tip], **rod)
    N, Q = found.force[1]
    clamp = Q**2 / 2.0 * (1.0 / rod["GA"] - 1.0 / rod["EA"]) - Q**2 / (np.hypot(N, Q) + N)
    assert found.clamp_moment[1] ** 2 / 2.0 == pytest.approx(-clamp, rel=1e-10)
    assert found.tip_rotation[1] == pytest.approx(np.arctan2(Q, N), rel=2e-9)
    assert found.clamp_moment[1] == pytest.approx(tip[1] * N - tip[0] * Q, rel=1e-8)
    assert found.iterations[1] < 1500


@pytest.mark.parametrize(("slenderness", "imperfection"), [(20.0, 1e-6), (1e3, 1e-3)])
def test_a_long_step_does_not_cross_to_the_other_side_of_buckling(slenderness, imperfection):
    rod = slender(slenderness)
    tip = np.array([-0.3, imperfection])
    times = np.concatenate([np.geomspace(1e-3 / rod["EA"], 0.1, 200), [1.0]])
    cut = rod_with_tied_tip([(1.0, 0.0), *([1.0, 0.0] + times[:, None] * tip)], **rod)
    whole = rod_with_tied_tip([(1.0, 0.0), tip + np.array([1.0, 0.0])], **rod)
    np.testing.assert_allclose(whole.force[-1], cut.force[-1], rtol=1e-10)
    assert np.all(whole.rotations[1, 1:10] < 0.0)
