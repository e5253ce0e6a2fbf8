"""The rod with a tied tip: integration from the clamp, and limits known in closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.oracles.shooting import shot
from tests.oracles.tied import rod_with_tied_tip

EI = 2.8e-4
KS = {"EA": 8.4, "GA": 5 / 6 * 2.1e4 / 2.6 * 4e-4, "EI": EI}


def tips(t):
    return np.column_stack([1.0 - np.asarray(t), 2.0 / np.pi * np.asarray(t)])


def test_integration_from_the_clamp_arrives_at_the_tied_tip():
    """Whatever the pieces into which the path is cut: a long step does not cross to the other side of buckling."""
    t = [0.0, 1e-5, 1e-3, 0.02, 0.1, 0.55, 0.9, 1.0]
    path, whole = rod_with_tied_tip(tips(t), **KS), rod_with_tied_tip(tips([0.0, 1.0]), **KS)
    for k in range(1, len(t)):
        (x, y, theta, moment, _), _ = shot(path.force[k], [0.0, 0.0, 0.0, -path.clamp_moment[k]], 1.0, **KS)
        np.testing.assert_allclose([[x, y]], tips([t[k]]), atol=1e-12)
        assert [theta, moment / EI] == pytest.approx([path.tip_rotation[k], 0.0], abs=2e-12)
    np.testing.assert_allclose(whole.force[-1], path.force[-1], rtol=1e-12)
    assert np.all(path.rotations[3, 1:10] < 0.0)


def test_a_straight_rod_buckles_at_eulers_load_and_sags():
    """`tan k = k`, `P = k^2 EI/L^2` for a slender rod: it is followed up to there, and sags where its tip rises."""
    load = brentq(lambda k: np.tan(k) - k, 4.4, 4.6) ** 2 * EI
    risen = rod_with_tied_tip(tips([0.0, 0.02]), **KS)
    assert -risen.force[1, 0] == pytest.approx(load, rel=0.02)
    times = np.linspace(0.0, 1e-3, 101)
    pushed = rod_with_tied_tip(np.column_stack([1.0 - times, 0.0 * times]), **KS)
    reached = int(np.argmax(np.isnan(pushed.force[:, 0])))
    assert pushed.force[5, 0] == pytest.approx(-times[5] * KS["EA"], rel=1e-6)
    assert KS["EA"] * times[reached - 1] < load * 1.001
    assert KS["EA"] * times[reached] > load * 0.99


@pytest.mark.parametrize(("slenderness", "tip"), [(1e3, (1.0, 0.8)), (1e4, (0.9, 0.7))])
def test_a_taut_slender_rod_bends_in_a_layer_at_its_clamp(slenderness, tip):
    """`m^2/2 + N + N^2/2 EA + Q^2/2 GA` is the same along the rod; far from the clamp `theta'' = 0`, so `Q (1 + (1/EA - 1/GA) N) = 0`."""
    EA, GA = 12.0 * slenderness**2, 12.0 * slenderness**2 / 3.12
    found = rod_with_tied_tip([(1.0, 0.0), tip], EA=EA, GA=GA, EI=1.0)
    N, Q = found.force[1]
    clamp = Q**2 / 2.0 * (1.0 / GA - 1.0 / EA) - Q**2 / (np.hypot(N, Q) + N)
    assert found.clamp_moment[1] ** 2 / 2.0 == pytest.approx(-clamp, rel=1e-10)
    assert found.tip_rotation[1] == pytest.approx(np.arctan2(Q, N), rel=2e-9)
    assert found.clamp_moment[1] == pytest.approx(tip[1] * N - tip[0] * Q, rel=1e-8)
    assert found.iterations[1] < 1500
