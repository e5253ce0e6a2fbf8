"""The Reissner rod under a pin: printed values, shooting, elastica limit, energy, events, units."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from comparisons.exact.elastica import elastica_under_pin, slip_off_displacement
from comparisons.exact.outcome import Outcome
from comparisons.exact.rod import rod_under_pin

E, A, INERTIA, HEIGHT = 2.1e4, 4e-4, 0.02**4 / 12.0, 0.02
KS = {"EA": E * A, "GA": 5.0 / 6.0 * E / 2.6 * A, "EI": E * INERTIA, "length": 1.0}
SHORT = {"EA": 2.1e11 * 0.005, "GA": 7.5e10 * 0.005, "EI": 2.1e11 * 0.001, "length": 4.5}
STEPS = np.linspace(0.0, 1.0, 21)
PRINTED = [0.1, 0.25, 0.5, 0.75, 1.0]


def ks_pins(t, offset=0.0):
    t = np.asarray(t)
    return np.stack([1.0 - t, 2.0 * t / np.pi - offset], axis=1)


def integrate(path, k, stiffness):
    """Integrate the rod's equations from the clamp to the contact; `x, y, theta, m` and strain energy there."""
    nx, ny = path.force[k]
    EA, GA, EI = (stiffness[name] for name in ("EA", "GA", "EI"))

    def rate(_, state):
        c, s = np.cos(state[2]), np.sin(state[2])
        N, Q = nx * c + ny * s, -nx * s + ny * c
        dx, dy = (1.0 + N / EA) * c - Q / GA * s, (1.0 + N / EA) * s + Q / GA * c
        return [
            dx,
            dy,
            state[3] / EI,
            -(dx * ny - dy * nx),
            (N**2 / EA + Q**2 / GA + state[3] ** 2 / EI) / 2.0,
        ]

    start = [0.0, 0.0, 0.0, -path.clamp_moment[k], 0.0]
    scale = np.array([1.0, 1.0, 1.0, abs(path.clamp_moment[k]), abs(path.clamp_moment[k])])
    solution = solve_ivp(
        rate,
        (0.0, path.arc_position[k]),
        start,
        method="DOP853",
        rtol=1e-13,
        atol=1e-15 * scale,
        dense_output=True,
    )
    return solution.y[:, -1], rate(0.0, solution.y[:, -1])[:2], solution.sol


@pytest.mark.parametrize(
    ("offset", "F", "s"),
    [
        (
            0.0,
            [
                7.279980308998e-05,
                2.971723827275e-04,
                1.304991984260e-03,
                2.717905910938e-03,
                2.288274307175e-03,
            ],
            [0.9026989400, 0.7700720074, 0.6126214853, 0.6155108916, 0.8960220975],
        ),
        (
            HEIGHT / 2.0,
            [
                7.299229040762e-05,
                2.999095335254e-04,
                1.346233117025e-03,
                2.881130179598e-03,
                2.423414546757e-03,
            ],
            [0.9016399646, 0.7669419948, 0.6042648292, 0.6002969972, 0.8766313645],
        ),
    ],
)
def test_printed_values_of_the_ks_cantilever(offset, F, s):
    path = rod_under_pin(ks_pins([0.0, *PRINTED], offset), offset=offset, **KS)
    np.testing.assert_allclose(path.magnitude[1:], F, rtol=5e-13)  # half a unit of the last digit
    np.testing.assert_allclose(path.arc_position[1:], s, rtol=0, atol=6e-11)


@pytest.mark.parametrize(
    ("x", "d"),
    [
        (4.05, 1.7814439389),
        (4.1, 1.6861593947),
        (4.2, 1.4716026278),
        (4.3, 1.2107350431),
        (4.35, 1.0524732309),
        (4.4, 0.8625478871),
    ],
)
def test_slip_off_of_the_short_cantilever(x, d):
    path = rod_under_pin([[x, 0.0], [x, 0.5], [x, 2.5]], **SHORT)
    assert path.outcome == (Outcome.CONTACT, Outcome.CONTACT, Outcome.SLIPPED)
    assert path.slip_off * 2.5 == pytest.approx(d, abs=6e-11)
    close = rod_under_pin([[x, 0.0], [x, 2.5 * path.slip_off - 1e-9]], **SHORT)
    assert close.arc_position[-1] == pytest.approx(4.5, abs=2e-9)
    assert close.arc_position[-1] < 4.5


@pytest.mark.parametrize("offset", [0.0, HEIGHT / 2.0])
def test_against_integration_from_the_clamp(offset):
    """The four conditions of the shooting problem hold for a path integrated by another method."""
    path = rod_under_pin(ks_pins(STEPS, offset), offset=offset, **KS)
    for k in range(1, len(STEPS)):
        end, before, sol = integrate(path, k, KS)
        after = np.array([np.cos(end[2]), np.sin(end[2])])
        f = path.force[k] / path.magnitude[k]
        assert f @ (np.array(before) + after) == pytest.approx(0.0, abs=2e-12)
        assert end[3] == pytest.approx(0.0, abs=3e-12 * abs(path.clamp_moment[k]))
        np.testing.assert_allclose(end[:2] - offset * f, ks_pins(STEPS, offset)[k], rtol=0, atol=2e-12)
        shape = path.shape(k, 33)
        arc = np.linspace(0.0, 1.0, 33)
        loaded = arc <= path.arc_position[k]
        np.testing.assert_allclose(shape[loaded], sol(arc[loaded])[:3].T, rtol=0, atol=1e-11)
        tail = end[:2] + np.outer(arc[~loaded] - path.arc_position[k], after)
        np.testing.assert_allclose(shape[~loaded, :2], tail, rtol=0, atol=2e-12)
        np.testing.assert_allclose(shape[-1], [*path.tip[k], path.tip_rotation[k]], rtol=0, atol=1e-14)


@pytest.mark.parametrize("t", [0.05, 0.3, 0.6, 0.8, 1.0])
def test_stiff_limit_is_the_elastica(t):
    stiff = KS | {"EA": 1e8 * KS["EA"], "GA": 1e8 * KS["GA"]}
    path = rod_under_pin(ks_pins([0.0, t]), **stiff)
    state = elastica_under_pin(*ks_pins([t])[0], EI=KS["EI"])
    assert path.magnitude[1] == pytest.approx(state.magnitude, rel=1e-8, abs=0.0)
    assert path.arc_position[1] == pytest.approx(state.arc_position, rel=1e-8)
    assert path.clamp_moment[1] == pytest.approx(state.clamp_moment, rel=1e-8, abs=0.0)
    np.testing.assert_allclose(path.tip[1], state.tip, atol=1e-8)
    np.testing.assert_allclose(path.shape(1, 51)[:, :2], state.shape(51), atol=1e-8)


@pytest.mark.parametrize("offset", [0.0, HEIGHT / 2.0])
def test_equilibrium_and_work_of_the_pin(offset):
    """The clamp balances the pin, and the pin's work is the strain energy."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    t = np.concatenate([[0.0], (nodes + 1.0) / 2.0, [1.0]])
    pins = ks_pins(t, offset)
    path = rod_under_pin(pins, offset=offset, **KS)
    np.testing.assert_array_equal(path.clamp_force, -path.force)
    moment = pins[:, 0] * path.force[:, 1] - pins[:, 1] * path.force[:, 0]
    np.testing.assert_allclose(path.clamp_moment, -moment, rtol=0, atol=1e-13 * np.max(moment))
    work = weights / 2.0 @ (path.force[1:-1] @ [-1.0, 2.0 / np.pi])
    assert work == pytest.approx(integrate(path, -1, KS)[0][4], rel=1e-11, abs=0.0)


def test_start_of_the_ks_path():
    path = rod_under_pin(ks_pins([0.0, 1e-9]), **KS)
    assert path.outcome == (Outcome.CONTACT, Outcome.CONTACT)
    assert path.arc_position[0] == 1.0
    assert path.magnitude[0] == 0.0
    timoshenko = 1.0 / (1.0 / (3.0 * KS["EI"]) + 1.0 / KS["GA"])
    assert path.magnitude[1] == pytest.approx(2e-9 / np.pi * timoshenko, rel=1e-8, abs=0.0)


def test_touch_release_and_touch_again():
    pins = [[0.8, -0.3], [0.8, -0.1], [0.8, 0.2], [0.7, -0.2], [0.6, 0.1], [0.6, 0.0], [0.6, -0.1]]
    path = rod_under_pin(pins, **KS)
    closed = [False, False, True, False, True, True, False]
    assert path.outcome == tuple(Outcome.CONTACT if item else Outcome.OPEN for item in closed)
    np.testing.assert_array_equal(np.isnan(path.arc_position), ~np.array(closed))
    again = rod_under_pin([[0.6, 0.0], [0.6, 0.1]], **KS)
    assert path.magnitude[4] == pytest.approx(again.magnitude[1], rel=1e-13, abs=0.0)
    assert path.magnitude[5] == pytest.approx(0.0, abs=1e-15 * KS["EI"])
    np.testing.assert_array_equal(path.shape(0, 3), [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]])


def test_touch_on_the_surface():
    path = rod_under_pin([[0.8, -0.5], [0.8, -0.01], [0.8, 0.1]], offset=0.01, **KS)
    direct = rod_under_pin([[0.8, -0.01], [0.8, 0.1]], offset=0.01, **KS)
    assert path.arc_position[1] == pytest.approx(0.8, abs=1e-15)
    np.testing.assert_allclose(path.magnitude[1:], direct.magnitude, rtol=1e-13)


def test_a_pin_that_all_but_slides_into_the_clamp_is_lost_within_bounds():
    """It passes the clamp .05 % of the length above: strains grow without bound, and steps shrink without end."""
    path = rod_under_pin([[0.25, 0.0], [-0.209, 0.001]], EA=3e4, GA=2.5e5, EI=1.0, length=1.0)
    assert path.outcome[-1] is Outcome.LOST
    assert path.iterations[-1] < 5000


def test_a_pin_that_comes_along_the_surface_from_beyond_the_tip_pushes():
    path = rod_under_pin([[1.2, -0.01], [0.8, -0.01], [0.8, 0.1]], offset=0.01, **KS)
    direct = rod_under_pin([[0.8, -0.01], [0.8, 0.1]], offset=0.01, **KS)
    assert path.outcome == (Outcome.OPEN, Outcome.OPEN, Outcome.CONTACT)
    assert path.magnitude[2] == pytest.approx(direct.magnitude[1], rel=1e-13)


def test_slip_off_frees_the_rod_until_the_pin_comes_from_below_again():
    points = [[0.8, -0.1], [0.8, 0.7], [0.8, 0.6], [0.8, -0.1], [0.8, 0.1], [0.8, 0.7]]
    path = rod_under_pin(points, **KS)
    free = [Outcome.OPEN, Outcome.SLIPPED, Outcome.SLIPPED, Outcome.OPEN]
    assert path.outcome == (*free, Outcome.CONTACT, Outcome.SLIPPED)
    np.testing.assert_array_equal(path.magnitude[:4], 0.0)
    np.testing.assert_array_equal(path.tip[:4], 4 * [[1.0, 0.0]])
    again = rod_under_pin(points[3:5], **KS)
    assert path.magnitude[4] == pytest.approx(again.magnitude[1], rel=1e-12)
    way = sum(abs(b[1] - a[1]) for a, b in pairwise(points))
    assert path.slip_off * way == pytest.approx(rod_under_pin(points[:2], **KS).slip_off * 0.8, rel=1e-12)


def test_slip_off_over_the_tip_on_the_way_down():
    path = rod_under_pin([[0.8, 0.0], [0.8, 0.3], [1.5, -0.1]], **KS)
    assert path.outcome == (*2 * [Outcome.CONTACT], Outcome.OPEN)
    assert 0.3 / (0.3 + np.hypot(0.7, 0.4)) < path.slip_off < 1.0


def test_slip_off_of_the_stiff_rod_is_the_elasticas():
    path = rod_under_pin([[0.9, 0.0], [0.9, 0.5]], EA=np.inf, GA=np.inf, EI=3.0, length=1.0)
    assert path.slip_off * 0.5 == pytest.approx(slip_off_displacement(0.9), abs=1e-13)


def test_slip_off_at_the_touch():
    path = rod_under_pin([[1.0, -0.1], [1.0, 0.1]], **KS)
    assert path.outcome[-1] is Outcome.SLIPPED
    assert path.slip_off == pytest.approx(0.5, abs=1e-12)


def test_pin_that_passes_beyond_the_tip_or_behind_the_clamp():
    path = rod_under_pin([[1.1, -0.1], [1.1, 0.1], [0.5, 0.1], [-0.1, 0.1], [-0.1, -0.1]], **KS)
    assert set(path.outcome) == {Outcome.OPEN}


def test_lost_equilibrium_is_named():
    path = rod_under_pin([*ks_pins([0.0, 0.5, 1.0]), [-0.3, 0.3], [-0.3, 0.2]], **KS)
    assert path.outcome == (*3 * [Outcome.CONTACT], *2 * [Outcome.LOST])
    assert np.all(np.isfinite(path.magnitude[:3]))
    assert np.all(np.isnan(path.magnitude[3:]))
    assert np.all(np.isnan(path.shape(3, 4)))
    assert np.isnan(path.slip_off)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"EA": 0.0}, "EA = 0.0: must be positive"),
        ({"GA": np.nan}, "GA = nan: must be positive"),
        ({"EI": np.inf}, "EI = inf: must be positive and finite"),
        ({"length": -1.0}, "length = -1.0: must be positive and finite"),
        ({"offset": -0.1}, "offset = -0.1: must be finite and not negative"),
        ({"points": [[0.8, np.nan]]}, "points"),
        ({"points": [0.8, 0.1]}, "points"),
        ({"points": [[0.8, 0.1]]}, "must start below the rod"),
    ],
)
def test_bad_input(change, message):
    arguments = {"points": [[0.8, 0.0]], **KS} | change
    with pytest.raises(ValueError, match=message):
        rod_under_pin(**arguments)


def test_iterations_are_few():
    path = rod_under_pin(ks_pins(np.linspace(0.0, 1.0, 51)), **KS)
    assert path.iterations[0] == 0
    assert all(0 < count <= 5 for count in path.iterations[1:])
