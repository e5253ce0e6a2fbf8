"""Branch control, and the critical points at which paths end."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from scipy.special import ellipk

import fem_reference as fr
from fem_reference.critical import _displacement_controlled
from fem_reference.model import build
from fem_reference.state import at_rest, build_state
from fem_reference.tangent import linearise
from fem_reference.touch import Condition
from fem_reference.track import accept
from tests.fem_reference.conftest import CLAMP, NU, STRIP, B, E, loads


def effective(P, height=0.02):
    """``P (1 + P (1/GA - 1/EA))``, the load of the Reissner column in Euler's formula [N]."""
    EA = E * B * height
    return P * (1 + P * (2 * (1 + NU) * 6 / 5 - 1) / EA)


def euler(height=0.02):
    """Buckling load of the Reissner column of length 1, ``effective(P) = (pi / 2)^2 EI`` [N]."""
    P0 = (np.pi / 2) ** 2 * E * B * height**3 / 12
    return brentq(lambda P: effective(P, height) - P0, P0 / 2, 2 * P0)


def column(strip, factor, lateral=0.0, height=0.02, **changes):
    """A clamped-free column under ``factor`` times its buckling load."""
    P = factor * euler(height)
    changes = {"height": height, "material": "biot-linear", "mesh": (20, 1)} | changes
    return fr.SolidProblem(
        strips=(strip(**changes),), loads=(fr.EndLoad(strip=STRIP, force=(-P, lateral * P)),)
    )


@pytest.mark.parametrize("n", [5, 20])
def test_column_ends_as_bifurcation_at_the_buckling_load(strip, n):
    """Within .01 % of the Reissner rod, for any number of load parameters."""
    result = fr.solve(column(strip, 8.3), loads(n), throw=False)
    assert result.status is fr.Status.BIFURCATION
    (point,) = result.critical
    assert point.kind == "bifurcation"
    assert 8.3 * point.load_parameter == pytest.approx(1, abs=1e-4)
    assert result.reached == point.load_parameter
    assert np.all(result.index == 0)
    assert np.all(result.load_parameter < point.load_parameter)
    mode = point.mode[STRIP]
    x = result.model.body(STRIP)[0].mesh.stations
    np.testing.assert_allclose(np.abs(mode[:, 1]), 1 - np.cos(np.pi / 2 * x), atol=1e-4)
    assert mode[-1, 1] == pytest.approx(1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("material", "expected"), [("biot-linear", 6.1e-5), ("st-venant-kirchhoff", -1.86e-4)]
)
def test_buckling_load_does_not_depend_on_the_load_parameters(strip, material, expected):
    """The same within 2e-8; St. Venant-Kirchhoff's column is 2e-4 softer at h/L = .02."""
    problem = column(strip, 1.3, material=material, mesh=(50, 2))
    results = [fr.solve(problem, loads(n), throw=False) for n in (1, 2, 8, 30, 50, 100)]
    t = [result.critical[0].load_parameter for result in results]
    assert 1.3 * t[0] - 1 == pytest.approx(expected, abs=2e-6)
    np.testing.assert_allclose(t, t[0], rtol=2e-8)


def test_primary_branch_continues_and_counts_unstable_modes(strip):
    """The index of the straight column is the number of odd n with ``(n pi / 2)^2 EI < P (1 + P (1/GA - 1/EA))``."""
    result = fr.solve(column(strip, 30.0), loads(15), fr.Settings(branch="primary"))
    P, EI = 30 * euler() * result.load_parameter, E * B * 0.02**3 / 12
    expected = [sum((n * np.pi / 2) ** 2 * EI < p for n in (1, 3, 5, 7)) for p in effective(P)]
    assert result.index.tolist() == expected
    assert sorted(set(expected)) == [1, 2, 3]
    assert [point.kind for point in result.critical] == ["bifurcation"] * 3
    np.testing.assert_allclose(result.tips[STRIP][:, 1], 0, atol=1e-6)


@pytest.mark.slow
def test_stable_branch_is_the_elasticas(strip):
    """P/P_1 = (2 K(p) / pi)^2 with p = sin(tip angle / 2)."""
    problem = column(strip, 1.2, mesh=(40, 1), height=0.01)
    result = fr.solve(problem, loads(12), fr.Settings(branch="stable"))
    assert np.all(result.index == 0)
    assert len(result.critical) == 1
    for t, tip in zip(result.load_parameter, result.tips[STRIP], strict=True):
        if t * 1.2 > 1.01:
            m = brentq(lambda m, t=t: (2 * ellipk(m) / np.pi) ** 2 - t * 1.2, 1e-9, 0.9)
            height = 2 * np.sqrt(m) / ((np.pi / 2) * np.sqrt(t * 1.2))
            assert tip[1] == pytest.approx(height, rel=5e-3)  # to the left, as beams
        else:
            assert abs(tip[1]) < 1e-5


@pytest.mark.slow
def test_imperfect_column_is_followed_whatever_the_number_of_load_parameters(strip):
    """Along and 1e-3 across: one bent answer on the side of the lateral load."""
    problem = column(strip, 2.0, lateral=1e-3)
    tips = np.array([fr.solve(problem, loads(n)).tips[STRIP][-1] for n in (1, 3, 20)])
    np.testing.assert_allclose(tips - tips[0], 0, atol=1e-6)
    assert tips[0, 1] > 0.7


def fold_of_the_elastica():
    """Largest polar angle of a pin that a cantilever long enough can press, in closed form (`alpha(t_c)`)."""

    def angle(tc):
        i2 = quad(lambda v: 2 * v * np.sqrt(np.sin(v * v)), 0, np.sqrt(tc))[0]
        return tc - np.arctan2(i2, 2 * np.sqrt(np.sin(tc)))

    found = minimize_scalar(lambda tc: -angle(tc), bounds=(2.2, 3.1), method="bounded")
    return -found.fun


@pytest.mark.slow
@pytest.mark.parametrize("n", [1, 4, 20])
def test_pin_that_is_led_behind_the_clamp_meets_the_elasticas_limit_point(problem, n):
    """Polar angle 99.57 degrees; within 3e-4 of the path for h/L = .02."""
    first, last = np.array([0.3, 0.0]), np.array([-0.15, 0.3])
    limit = fold_of_the_elastica()
    t = brentq(lambda t: np.arctan2(*(first + t * (last - first))[::-1]) - limit, 0, 1)
    path = (tuple(map(float, first)), tuple(map(float, last)))
    scene = problem(path=path, mesh=(30, 1), material="biot-linear")
    result = fr.solve(scene, loads(n), throw=False)
    assert result.status is fr.Status.LIMIT_POINT
    (point,) = result.critical
    assert (point.kind, point.load_parameter) == ("limit point", result.reached)
    assert point.load_parameter == pytest.approx(t, abs=3e-4)
    assert np.all(result.index == 0)
    assert "limit on this branch" in result.message


@pytest.mark.slow
def test_pin_that_presses_a_buckled_column_straight_loses_it_at_a_limit_point(strip):
    """At 1.1 times the buckling load the pin's force has fallen to zero: the free column is unstable there, index 1."""
    P = 1.5 * euler()
    scene = fr.SolidProblem(
        strips=(strip(mesh=(20, 1), material="biot-linear"),),
        pins=(fr.Pin(name="pin", path=((0.7, 0.8), (0.7, -0.3))),),
        contacts=(fr.Contact(node="pin", strip=STRIP, side="left"),),
        loads=(fr.EndLoad(strip=STRIP, force=(-P, 1e-3 * P)),),
    )
    few, many = (fr.solve(scene, loads(n), throw=False) for n in (5, 20))
    assert few.status is many.status is fr.Status.LIMIT_POINT
    assert [point.kind for point in many.critical] == ["limit point"]
    assert few.reached == pytest.approx(many.reached, abs=1e-6)
    assert 1.5 * many.reached == pytest.approx(1.0977, abs=1e-3)
    assert np.all(many.index == 0)
    mode = many.critical[0].mode[STRIP]
    x = many.model.body(STRIP)[0].mesh.stations
    np.testing.assert_allclose(mode[:, 1], 1 - np.cos(np.pi / 2 * x), atol=0.05)


@pytest.mark.parametrize("delta", [np.inf, np.nan])
def test_a_step_of_displacement_control_that_is_not_finite_ends_without_a_state(strip, delta):
    """The search for a limit point may diverge. It then has no load parameter at which a pin could be placed."""
    pins = (fr.Pin(name="pin", path=((0.7, -0.1), (0.7, 0.3))),)
    contacts = (fr.Contact(node="pin", strip=STRIP),)
    load = fr.EndLoad(strip=STRIP, force=(0.0, euler()))
    model = build(fr.SolidProblem(strips=(strip(mesh=(10, 1)),), pins=pins, contacts=contacts, loads=(load,)))
    settings = fr.Settings()
    start = accept(model, at_rest(model), settings)
    rate = start.rate(0.0, settings.min_step).u
    found = _displacement_controlled(
        model, start.state, start.state.u, rate / np.linalg.norm(rate), delta, settings
    )
    assert found is None


def test_contact_closed_without_force_has_no_index_where_its_sides_differ(strip):
    """A straight column beyond its buckling load that a pin just touches is stable if the contact is closed only."""
    pins = (fr.Pin(name="pin", path=((1.0, 0.0), (1.0, 0.1))),)
    contacts = (fr.Contact(node="pin", strip=STRIP),)
    model = build(fr.SolidProblem(strips=(strip(mesh=(10, 1)),), pins=pins, contacts=contacts))
    u = np.zeros((model.nodes, 2))
    u[:, 0] = -2 * euler() / (E * B * 0.02) * model.bodies[0].mesh.nodes[:, 0]
    for force, expected in ((1e-3, 0), (1e-13, -1)):
        at = build_state(model, u, 0.0, (Condition(closed=True, force=force),))
        assert linearise(model, at).index(force_tolerance=1e-12) == expected
    opened = build_state(model, u, 0.0, (Condition(),))
    assert linearise(model, opened).index() == 1


def test_end_load_is_spread_evenly_and_reacts_at_the_clamp(strip):
    """A strip under tension has no end effect, and the stretch ``F / EA`` to first order."""
    F = 1e-3 * E * B * 0.02
    for element in fr.ELEMENTS:
        for rows in (1, 2, 3):
            bar = strip(mesh=(4, rows), element=element, material="biot-linear")
            load = fr.EndLoad(strip=STRIP, force=(F, 0.0))
            result = fr.solve(fr.SolidProblem(strips=(bar,), loads=(load,)), loads(1))
            np.testing.assert_allclose(result.supports[CLAMP].force[0], [-F, 0], atol=1e-9 * F)
            assert result.tips[STRIP][0, 0] == pytest.approx(1.001, abs=1e-9)
            sheared = result.displacement[0, :, 0] / result.mesh_points[:, 0].clip(1e-9)
            np.testing.assert_allclose(sheared[result.mesh_points[:, 0] > 0], 1e-3, rtol=1e-7)
