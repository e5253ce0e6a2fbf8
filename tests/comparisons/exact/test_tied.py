"""The rod with a tied tip: integration from the clamp, energy, limits known in closed form, slender rods, stability, symmetry, units."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from comparisons.exact.outcome import Outcome
from comparisons.exact.tied import rod_with_tied_tip

EI = 2.8e-4
KS = {"EA": 8.4, "GA": 5 / 6 * 2.1e4 / 2.6 * 4e-4, "EI": EI, "length": 1.0}
TIMES = np.linspace(0.0, 1.0, 51)
TIPS = np.column_stack([1.0 - TIMES, 2.0 / np.pi * TIMES])


@pytest.fixture(scope="module")
def path():
    return rod_with_tied_tip(TIPS, **KS)


def shoot(path, k, arcs=None):
    """`x, y, theta, m` and strain energy at the tip, or at arc positions, integrated from the clamp."""
    nx, ny = path.force[k]

    def rate(_, state):
        c, s = np.cos(state[2]), np.sin(state[2])
        N, Q = nx * c + ny * s, ny * c - nx * s
        dx = (1.0 + N / KS["EA"]) * c - Q / KS["GA"] * s
        dy = (1.0 + N / KS["EA"]) * s + Q / KS["GA"] * c
        energy = (N**2 / KS["EA"] + Q**2 / KS["GA"] + state[3] ** 2 / EI) / 2.0
        return [dx, dy, state[3] / EI, dy * nx - dx * ny, energy]

    start = [0.0, 0.0, 0.0, -path.clamp_moment[k], 0.0]
    arcs = [1.0] if arcs is None else arcs
    found = solve_ivp(rate, (0.0, 1.0), start, method="DOP853", rtol=1e-13, atol=1e-17, t_eval=arcs)
    return found.y.T


@pytest.mark.parametrize("k", [1, 2, 5, 10, 20, 30, 40, 45, 50])
def test_integration_from_the_clamp_arrives_at_the_tied_tip(path, k):
    x, y, theta, moment, _ = shoot(path, k)[-1]
    np.testing.assert_allclose([x, y], TIPS[k], atol=1e-12)
    assert theta == pytest.approx(path.tip_rotation[k], abs=1e-12)
    assert moment == pytest.approx(0.0, abs=1e-12 * EI)


def test_the_force_is_the_derivative_of_the_strain_energy(path):
    nodes, weights = np.polynomial.legendre.leggauss(20)
    between = np.array([0.1, *(0.55 + 0.45 * nodes), 1.0])
    tips = np.array([[1.0, 0.0], *np.column_stack([1.0 - between, 2.0 / np.pi * between])])
    found = rod_with_tied_tip(tips, **KS)
    work = 0.45 * weights @ (found.force[2:-1] @ [-1.0, 2.0 / np.pi])
    energy = [shoot(found, k)[-1, 4] for k in (1, -1)]
    assert work == pytest.approx(energy[1] - energy[0], rel=1e-10)


def test_the_straight_rod_buckles_at_eulers_load_and_sags(path):
    """Clamped and hinged: `tan k = k`, `P = k^2 EI/L^2` = 20.19 EI/L^2; the rod sags as its tip rises."""
    k = brentq(lambda k: np.tan(k) - k, 4.4, 4.6)
    assert -path.force[1, 0] == pytest.approx(k**2 * EI, rel=0.02)
    assert np.all(path.shape(1, 41)[1:38, 1] < 0.0)
    before = rod_with_tied_tip([[1.0, 0.0], [1.0 - 1e-4, 1e-9]], **KS)
    assert before.force[1, 0] == pytest.approx(-1e-4 * KS["EA"], rel=1e-6)


def test_a_tip_pushed_straight_is_followed_up_to_its_buckling_load_only():
    times = np.linspace(0.0, 1e-3, 101)
    found = rod_with_tied_tip(np.column_stack([1.0 - times, 0.0 * times]), **KS)
    reached = found.outcome.index(Outcome.LOST)
    critical = brentq(lambda k: np.tan(k) - k, 4.4, 4.6) ** 2 * EI
    assert KS["EA"] * times[reached - 1] < critical * 1.001
    assert KS["EA"] * times[reached] > critical * 0.99
    assert np.all(np.isnan(found.force[reached:]))


def test_the_path_may_be_cut_into_any_pieces(path):
    few = rod_with_tied_tip(TIPS[[0, 25, 50]], **KS)
    np.testing.assert_allclose(few.force[1:], path.force[[25, 50]], rtol=1e-12)


def slender(slenderness):
    """Stiffnesses over EI of a rectangular section of height `1/slenderness`."""
    EA = 12.0 * slenderness**2
    return {"EA": EA, "GA": EA / 3.12, "EI": 1.0, "length": 1.0}


def tied_strip(EA, rise):
    """Force on the tip and clamp moment of a tensioned beam, `w'''' = N w''`, with `N = EA/2 int w'^2`: right to slope^2."""
    arcs, weights = np.polynomial.legendre.leggauss(40)

    def excess(N):
        k = np.sqrt(N)
        slope = rise / (1.0 - np.tanh(k) / k)
        return N - EA * weights @ (slope * (1.0 - np.cosh(k * (1.0 - arcs) / 2.0) / np.cosh(k))) ** 2 / 4.0

    N = brentq(excess, 1e-6, 1e3, xtol=1e-14, rtol=1e-14)
    slope = rise / (1.0 - np.tanh(np.sqrt(N)) / np.sqrt(N))
    return [N, N * slope], -np.sqrt(N) * np.tanh(np.sqrt(N)) * slope


@pytest.mark.parametrize(("slenderness", "rise"), [(593.2, 1e-3), (593.2, 1e-5), (1e4, 1e-4), (1e5, 1e-5)])
def test_a_slender_rod_moved_sideways_is_stretched_in_few_iterations(slenderness, rise):
    found = rod_with_tied_tip([[1.0, 0.0], [1.0, rise]], **slender(slenderness))
    force, moment = tied_strip(12.0 * slenderness**2, rise)
    np.testing.assert_allclose(found.force[1], force, rtol=5e-6)
    assert found.clamp_moment[1] == pytest.approx(moment, rel=5e-6)
    assert found.iterations[1] < 80


@pytest.mark.slow_at("tip2-100000.0")
@pytest.mark.parametrize("slenderness", [1e3, 1e4, 1e5])
@pytest.mark.parametrize("tip", [(1.0, 0.8), (1.02, -0.7), (0.9, 0.7), (1.0, 0.01), (1.3, 0.1)])
def test_a_taut_slender_rod_bends_in_a_layer_at_its_clamp(slenderness, tip):
    """`m^2/2 + N + N^2/2 EA + Q^2/2 GA` is the same along the rod; far from the clamp `theta'' = 0`, so `Q (1 + (1/EA - 1/GA) N) = 0`."""
    rod = slender(slenderness)
    found = rod_with_tied_tip([(1.0, 0.0), tip], **rod)
    assert found.outcome[1] is Outcome.CONTACT
    N, Q = found.force[1]
    tension = np.hypot(N, Q)
    layer = found.clamp_moment[1] ** 2 / 2.0
    clamp = Q**2 / 2.0 * (1.0 / rod["GA"] - 1.0 / rod["EA"]) - Q**2 / (tension + N)
    assert layer == pytest.approx(-clamp, rel=1e-10)
    assert found.tip_rotation[1] == pytest.approx(np.arctan2(Q, N), rel=2e-9)
    moment = found.tip[1, 0] * Q - found.tip[1, 1] * N
    assert found.clamp_moment[1] == pytest.approx(-moment, rel=1e-8)
    assert found.iterations[1] < 1500


@pytest.mark.slow_at("1000.0-1e-09", "100000.0-0.001", "100000.0-1e-06", "100000.0-1e-09")
@pytest.mark.parametrize("imperfection", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("slenderness", [20.0, 1e3, 1e5])
def test_a_long_step_does_not_cross_to_the_other_side_of_buckling(slenderness, imperfection):
    rod = slender(slenderness)
    tip = np.array([-0.3, imperfection])
    times = np.concatenate([np.geomspace(1e-3 / rod["EA"], 0.1, 200), [1.0]])
    cut = rod_with_tied_tip([(1.0, 0.0), *([1.0, 0.0] + times[:, None] * tip)], **rod)
    whole = rod_with_tied_tip([(1.0, 0.0), tip + np.array([1.0, 0.0])], **rod)
    np.testing.assert_allclose(whole.force[-1], cut.force[-1], rtol=1e-10)
    assert whole.shape(1, 3)[1, 1] < 0.0


def test_values_at_the_end(path):
    """Bar of the project's other models: force, clamp moment and rotation at t = 1, confirmed above by integration."""
    np.testing.assert_allclose(path.force[-1] / EI, [-2.78166798, -8.54820614], atol=5e-9)
    assert path.clamp_moment[-1] / EI == pytest.approx(-1.77086483545, abs=1e-10)
    assert np.degrees(path.tip_rotation[-1]) == pytest.approx(154.2, abs=0.05)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": [[0.9, 0.0], [0.5, 0.5]]}, "must be the undeformed tip"),
        ({"points": [1.0, 0.0]}, "of shape"),
        ({"points": [[1.0, 0.0], [np.nan, 0.0]]}, "must be finite"),
        ({"EA": np.inf}, "EA = inf: must be positive and finite"),
        ({"GA": 0.0}, "GA = 0.0: must be positive"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises(ValueError, match=message):
        rod_with_tied_tip(**({"points": TIPS} | KS | change))
