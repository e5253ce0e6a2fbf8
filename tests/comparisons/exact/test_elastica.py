"""The elastica under a pin, in closed form, against integration from the clamp and its own limits."""

import numpy as np
import pytest

from comparisons.exact import Outcome, elastica_under_pin

# the polar angle of the pin, whose turning point ends the branch
from comparisons.exact.elastica import _polar_angle, fold_angle
from tests.oracles.shooting import RIGID, shot

KS_END = (0.0, 2.0 / np.pi)


@pytest.mark.parametrize("pin", [KS_END, (0.5, 1.0 / np.pi), (1.0, 2.0), (1.0, 0.1), (-0.05, 0.5)])
def test_integration_from_the_clamp_arrives_at_the_pin(pin):
    """The points of the shape lie on the way."""
    state = elastica_under_pin(*pin, EI=2.0, length=3.0)
    start, stiff = [0.0, 0.0, 0.0, -state.clamp_moment], {**RIGID, "EI": 2.0}
    end, tangent = shot(state.force, start, state.arc_position, **stiff)
    for x, point in zip(np.linspace(0.0, 3.0, 7), state.shape(7), strict=True):
        at = shot(state.force, start, min(x, state.arc_position), **stiff)[0]
        np.testing.assert_allclose(point, at[:2] + max(x - state.arc_position, 0.0) * tangent, atol=1e-11)
    np.testing.assert_allclose(end[:4], [*pin, state.tangent_angle, 0.0], atol=4e-12)
    assert tangent @ state.force == pytest.approx(0.0, abs=4e-12)
    np.testing.assert_allclose(state.tip, end[:2] + (3.0 - state.arc_position) * tangent, atol=4e-12)
    assert state.magnitude == pytest.approx(np.hypot(*state.force), rel=1e-14)


def test_the_clamp_moment_at_the_end_of_the_ks_path_is_pi():
    assert elastica_under_pin(*KS_END).clamp_moment == pytest.approx(-np.pi, rel=1e-14)


def test_outcomes():
    places = {
        (0.5, -0.1): Outcome.OPEN,
        (1.1, 0.0): Outcome.OPEN,
        (1.0, 0.0): Outcome.CONTACT,
        (0.9, 0.6): Outcome.SLIPPED,
        (-0.1, 0.2): Outcome.LOST,
    }
    assert {place: elastica_under_pin(*place).outcome for place in places} == places
    assert elastica_under_pin(1.0, 0.0).arc_position == 1.0
    free = elastica_under_pin(0.9, 0.6)
    assert free.magnitude == 0.0
    assert np.isnan(free.arc_position)
    np.testing.assert_array_equal(free.shape(3), [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]])


def test_a_direction_of_the_pin_has_one_solution_below_the_fold_and_one_beyond():
    """The polar angle of the pin grows up to the fold, at 2.983418, and falls beyond: the smaller root is the straight beam's branch."""
    assert fold_angle() == pytest.approx(2.983418, abs=5e-7)
    below, beyond = np.linspace(1e-3, fold_angle(), 400), np.linspace(fold_angle(), np.pi, 100)
    assert np.all(np.diff([_polar_angle(angle) for angle in below]) > 0.0)
    assert np.all(np.diff([_polar_angle(angle) for angle in beyond]) < 0.0)
    direction = _polar_angle(3.1)
    assert elastica_under_pin(np.cos(direction) / 2.0, np.sin(direction) / 2.0).tangent_angle < fold_angle()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": np.nan}, "x = nan: must be finite"),
        ({"EI": -1.0}, "EI = -1.0: must be positive"),
        ({"length": 0.0}, "length = 0.0: must be positive"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises(ValueError, match=message):
        elastica_under_pin(**({"x": 0.5, "y": 0.1} | change))
