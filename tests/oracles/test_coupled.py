"""Two rods in contact: integration from the clamps, and both ends of the stage."""

import numpy as np
import pytest

from comparisons.scene import load_scene
from tests.oracles.coupled import pair_of
from tests.oracles.shooting import shot

PAIR = pair_of(load_scene("double-beam"))
DEPTHS = np.linspace(0.16, 0.53, 8)


def test_all_conditions_hold_when_integrated_from_the_clamps():
    """At depths outside the stage there are none."""
    path, section = PAIR.stage([0.1, *DEPTHS, 0.6]), {"EA": PAIR.EA, "GA": PAIR.GA, "EI": PAIR.EI}
    assert np.isnan(path.pin_arc[[0, -1]]).all()
    for k, depth in enumerate(DEPTHS, start=1):
        P, T, s, (upper, lower) = (
            path.pin_force[k],
            path.tip_force[k],
            path.pin_arc[k],
            -path.clamp_moments[k],
        )
        pin, before = shot(P - T, [0.0, 0.0, 0.0, upper], s, **section)
        tip, _ = shot(-T, pin[:4], 1.0 - s, **section)
        after = shot(-T, pin[:4], 1e-12, **section)[1]
        contact, tangent = shot(T, [0.0, PAIR.spacing, 0.0, lower], path.tip_arc[k], **section)
        tail = np.array([np.cos(contact[2]), np.sin(contact[2])])
        np.testing.assert_allclose(pin[:2], [0.8, depth], atol=1e-12)
        np.testing.assert_allclose([tip[:2], path.tip[k]], [contact[:2]] * 2, atol=1e-12)
        np.testing.assert_allclose([tip[3], contact[3]], 0.0, atol=1e-12)
        np.testing.assert_allclose([P @ (before + after), T @ (tangent + tail)], 0.0, atol=1e-10)
        assert min(P[1], T[1]) > 0.0


def test_touch_and_hand_over():
    """The tip touches where a rod alone brings it; the pin is handed over at the first tip, to a rod that is already its own."""
    begin = PAIR.touch()[0]
    single, start = PAIR.single([begin]), PAIR.stage([begin])
    assert single.tip[1, 1] == pytest.approx(PAIR.spacing, abs=1e-12)
    np.testing.assert_allclose(start.pin_force[0], single.force[1], rtol=1e-11)
    np.testing.assert_array_equal(start.tip_force[0], 0.0)
    last, single = PAIR.stage([start.end_depth - 1e-10]), PAIR.single([start.end_depth - PAIR.spacing])
    np.testing.assert_allclose([last.pin_arc[0], *last.tip[0]], [1.0, 0.8, start.end_depth], atol=1e-9)
    np.testing.assert_allclose(last.tip_force[0], single.force[1], rtol=1e-8)
    assert last.tip_arc[0] == pytest.approx(single.arc_position[1], abs=1e-8)
