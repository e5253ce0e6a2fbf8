"""The closed-form elastica against the printed values, its own identities and limits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from comparisons.exact.elastica import (
    _polar_angle,
    contact_force_limit,
    elastica_under_pin,
    fold_angle,
    slip_off_displacement,
    three_point_bending_limit,
)
from comparisons.exact.outcome import Outcome

KS_END = (0.0, 2.0 / np.pi)


def test_end_of_the_ks_path():
    state = elastica_under_pin(*KS_END)
    assert state.tangent_angle == pytest.approx(2.49418626227322, abs=1e-14)
    assert state.arc_position == pytest.approx(0.895721692009856, abs=1e-14)
    assert state.magnitude == pytest.approx(8.18212814018414, rel=1e-14)
    assert state.clamp_moment == pytest.approx(-np.pi, rel=1e-14)
    np.testing.assert_allclose(state.tip, [-0.0831776691, 0.6995120682], atol=1e-10, rtol=0)


@pytest.mark.parametrize(
    ("t", "s", "F"),
    [
        (0.25, 0.77007264053193, 1.0618903425414),
        (0.5, 0.612622877902267, 4.66473101966107),
        (0.75, 0.615457399152221, 9.71796028591865),
    ],
)
def test_along_the_ks_path(t, s, F):
    state = elastica_under_pin(1.0 - t, 2.0 * t / np.pi)
    assert state.arc_position == pytest.approx(s, abs=2e-14)
    assert state.magnitude == pytest.approx(F, rel=2e-14)


@pytest.mark.parametrize(
    ("d", "F", "s"),
    [
        (0.1, 0.29571289218498, 1.00598720165807),
        (0.5, 1.08567496017108, 1.14277139402601),
        (1.0, 1.09558778157338, 1.50936725404006),
        (2.0, 0.57107081850518, 2.5669307701048),
    ],
)
def test_raised_pin(d, F, s):
    state = elastica_under_pin(1.0, d, length=3.0)
    assert state.magnitude == pytest.approx(F, rel=2e-14)
    assert state.arc_position == pytest.approx(s, abs=2e-14)


@pytest.mark.parametrize(
    ("x", "d"),
    [
        (0.8, 0.538697355156334),
        (0.9, 0.394866206259796),
        (0.95, 0.283990753739304),
        (0.99, 0.128683691340723),
    ],
)
def test_slip_off(x, d):
    assert slip_off_displacement(x) == pytest.approx(d, abs=1e-14)
    assert slip_off_displacement(3.0 * x, length=3.0) == pytest.approx(3.0 * d, abs=1e-14)
    assert elastica_under_pin(x, d - 1e-9).outcome is Outcome.CONTACT
    assert elastica_under_pin(x, d + 1e-9).outcome is Outcome.SLIPPED


def test_three_point_bending_limit():
    limit = three_point_bending_limit()
    assert limit.load == pytest.approx(1.66795210859543, rel=1e-14)
    assert limit.displacement == pytest.approx(0.476377597825455, rel=1e-13)
    for d in limit.displacement + np.array([-1e-3, 1e-3]):
        state = elastica_under_pin(1.0, d, length=2.0)
        assert 2.0 * state.force[1] < limit.load


def test_contact_force_has_a_maximum_on_a_vertical_path():
    limit = contact_force_limit(2.0, EI=3.0)
    F = [
        elastica_under_pin(2.0, limit.displacement + d, EI=3.0, length=5.0).magnitude
        for d in (-1e-3, 0.0, 1e-3)
    ]
    assert F[1] == pytest.approx(limit.load, rel=1e-14)
    assert max(F[0], F[2]) < limit.load


@pytest.mark.parametrize("pin", [KS_END, (1.0, 2.0), (1.0, 0.1), (-0.05, 0.5)])
def test_against_integration_from_the_clamp(pin):
    state = elastica_under_pin(*pin, length=3.0)
    nx, ny = state.force
    solution = solve_ivp(
        lambda _, u: [u[1], np.sin(u[0]) * nx - np.cos(u[0]) * ny, np.cos(u[0]), np.sin(u[0])],
        (0.0, state.arc_position),
        [0.0, -state.clamp_moment, 0.0, 0.0],
        method="DOP853",
        rtol=1e-13,
        atol=1e-15,
    )
    np.testing.assert_allclose(solution.y[:, -1], [state.tangent_angle, 0.0, *pin], atol=2e-12)


@pytest.mark.parametrize("y", [1e-3, 0.2, 2.0 / np.pi])
def test_shape_is_the_curve(y):
    state = elastica_under_pin(0.3, y)
    points = state.shape(20001)
    chords = np.hypot(*np.diff(points, axis=0).T)
    np.testing.assert_allclose(points[[0, -1]], [[0.0, 0.0], state.tip], atol=1e-15)
    np.testing.assert_allclose(chords, 1.0 / 20000.0, rtol=1e-6)
    angle = np.arctan2(*np.diff(points, axis=0)[:, ::-1].T)
    arc = (np.arange(20000) + 0.5) / 20000.0
    moment = state.force[1] * (0.3 - points[:, 0]) - state.force[0] * (y - points[:, 1])
    loaded = arc[1:] < state.arc_position - 1e-3
    np.testing.assert_allclose(
        np.diff(angle)[loaded] * 20000.0, moment[1:-1][loaded], atol=3e-6 * state.magnitude
    )


def test_outcomes():
    assert elastica_under_pin(0.5, -0.1).outcome is Outcome.OPEN
    assert elastica_under_pin(1.0, 0.0).outcome is Outcome.CONTACT
    assert elastica_under_pin(1.0, 0.0).arc_position == 1.0
    assert elastica_under_pin(1.1, 0.0).outcome is Outcome.OPEN
    assert elastica_under_pin(0.9, 0.6).outcome is Outcome.SLIPPED
    assert elastica_under_pin(-0.1, 0.2).outcome is Outcome.LOST
    free = elastica_under_pin(0.9, 0.6)
    assert free.magnitude == 0.0
    assert np.isnan(free.arc_position)
    np.testing.assert_array_equal(free.shape(3), [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]])


def test_pin_behind_the_clamp_below_the_fold():
    state = elastica_under_pin(-0.05, 0.5)
    assert state.outcome is Outcome.CONTACT
    assert 2.494 < state.tangent_angle < fold_angle()


def test_a_direction_of_the_pin_has_one_solution_below_the_fold_and_one_beyond():
    """The polar angle of the pin grows up to the fold, at 2.983418, and falls beyond: the smaller root is the straight beam's branch."""
    assert fold_angle() == pytest.approx(2.983418, abs=5e-7)
    below, beyond = np.linspace(1e-3, fold_angle(), 400), np.linspace(fold_angle(), np.pi, 100)
    polar = [np.array([_polar_angle(angle) for angle in part]) for part in (below, beyond)]
    assert np.all(np.diff(polar[0]) > 0.0)
    assert np.all(np.diff(polar[1]) < 0.0)
    direction = _polar_angle(3.1)
    pin = 0.5 * np.cos(direction), 0.5 * np.sin(direction)
    assert elastica_under_pin(*pin).tangent_angle < fold_angle()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: elastica_under_pin(np.nan, 0.1), "x = nan: must be finite"),
        (lambda: elastica_under_pin(0.5, 0.1, EI=-1.0), "EI = -1.0: must be positive"),
        (lambda: elastica_under_pin(0.5, 0.1, length=0.0), "length = 0.0: must be positive"),
        (lambda: slip_off_displacement(1.0), "x = 1.0: must lie between"),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ValueError, match=message):
        call()
