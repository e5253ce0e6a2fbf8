"""The rod with a tied tip: integration from the clamp, and limits known in closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.oracles.shooting import KS, ks_pins, shot
from tests.oracles.tied import rod_with_tied_tip

EI = KS["EI"]


def test_integration_from_the_clamp_arrives_at_the_tied_tip():
    """Whatever the pieces into which the path is cut: a long step does not cross to the other side of buckling."""
    t = [0.0, 1e-5, 1e-3, 0.02, 0.1, 0.55, 0.9, 1.0]
    path, whole = rod_with_tied_tip(ks_pins(t), **KS), rod_with_tied_tip(ks_pins([0.0, 1.0]), **KS)
    for k in range(1, len(t)):
        (x, y, theta, moment, _), _ = shot(path.force[k], [0.0, 0.0, 0.0, -path.clamp_moment[k]], 1.0, **KS)
        np.testing.assert_allclose([[x, y]], ks_pins([t[k]]), atol=1e-12)
        assert [theta, moment / EI] == pytest.approx([path.tip_rotation[k], 0.0], abs=2e-12)
    np.testing.assert_allclose(whole.force[-1], path.force[-1], rtol=1e-12)
    assert path.clamp_moment[3] > 0.0


def test_a_straight_rod_buckles_at_eulers_load_and_sags():
    """`tan k = k`, `P = k^2 EI/L^2` for a slender rod: it is followed up to there, and sags where its tip rises."""
    load = brentq(lambda k: np.tan(k) - k, 4.4, 4.6) ** 2 * EI
    risen = rod_with_tied_tip(ks_pins([0.0, 0.02]), **KS)
    assert -risen.force[1, 0] == pytest.approx(load, rel=0.02)
    times = np.linspace(0.0, 1e-3, 101)
    pushed = rod_with_tied_tip(np.column_stack([1.0 - times, 0.0 * times]), **KS)
    reached = int(np.argmax(np.isnan(pushed.force[:, 0])))
    assert pushed.force[5, 0] == pytest.approx(-times[5] * KS["EA"], rel=1e-6)
    assert KS["EA"] * times[reached - 1] < load * 1.001
    assert KS["EA"] * times[reached] > load * 0.99
