"""Branch control, and the critical points at which paths end."""

import numpy as np
import pytest
from scipy.optimize import brentq

import fem_reference as fr
from tests.fem_reference.strips import EA, EI, NU, STRIP, held, load, loads, make_problem, pressed, support


def effective(P):
    """``P (1 + P (1/GA - 1/EA))``, the load of the Reissner column in Euler's formula [N]."""
    return P * (1 + P * (2 * (1 + NU) * 6 / 5 - 1) / EA)


def buckling_load(k):
    """``effective(P) = k^2 EI`` [N]."""
    return brentq(lambda P: effective(P) - k**2 * EI, 0, 2 * k**2 * EI)


EULER = buckling_load(np.pi / 2)


def column(factor, lateral=0.0, **changes):
    """A clamped-free column under ``factor`` times its buckling load."""
    P = factor * EULER
    changes = {"clamped": ("start",), "material": "biot-linear", "mesh": (20, 1)} | changes
    return held(load(force=(-P, lateral * P)), **changes)


COLUMNS = {
    "clamped at a section and free": (np.pi / 2, [1, 1], (0.0, 0.0, 0.0), None),
    "clamped and clamped": (2 * np.pi, [1, 2], (0.0, 0.0, 0.0), (None, 0.0, 0.0)),
}


@pytest.mark.parametrize("case", COLUMNS)
def test_column_ends_as_bifurcation_at_its_buckling_load(case):
    """``effective(P) = (k L)^2 EI`` but for .742 of the strain P/EA, whatever the supports; the index counts the modes."""
    k, modes, *motions = COLUMNS[case]
    P = buckling_load(k)
    ends = [support(end, motion) for end, motion in zip(("start", "end"), motions, strict=True) if motion]
    problem = held(*ends, load(force=(-3 * P, 0.0)), mesh=(32, 2), material="biot-linear")
    result = fr.solve(problem, loads(4), throw=False)
    assert result.status is fr.Status.BIFURCATION
    (point,) = result.critical
    assert (point.kind, point.load_parameter) == ("bifurcation", result.reached)
    assert np.all(result.index == 0)
    if case == "clamped at a section and free":
        shape = 1 - np.cos(np.pi / 2 * fr.axis_stations(result, STRIP))
        np.testing.assert_allclose(point.mode[STRIP][:, 1], shape, rtol=0, atol=1e-4)
    assert (3 * point.load_parameter - 1) / (P / EA) == pytest.approx(0.742, abs=0.01)
    assert fr.solve(problem, loads(2), fr.Settings(branch="primary")).index.tolist() == modes


def test_buckling_load_does_not_depend_on_the_load_parameters():
    """The same within 2e-8; St. Venant-Kirchhoff's column is 2e-4 softer at h/L = .02."""
    problem = column(1.3, material="st-venant-kirchhoff", mesh=(50, 2))
    t = [fr.solve(problem, loads(n), throw=False).critical[0].load_parameter for n in (1, 8)]
    assert 1.3 * t[0] - 1 == pytest.approx(-1.86e-4, abs=2e-6)
    np.testing.assert_allclose(t, t[0], rtol=2e-8)


def test_pin_that_is_led_behind_the_clamp_meets_the_elasticas_limit_point():
    """Polar angle 99.57 degrees; within 3e-4 of the path for h/L = .02."""
    first, last = np.array([0.3, 0.0]), np.array([-0.15, 0.3])
    limit = np.radians(99.568499)  # largest `tc - atan2(int_0^tc sqrt(sin), 2 sqrt(sin tc))`, in closed form
    t = brentq(lambda t: np.arctan2(*(first + t * (last - first))[::-1]) - limit, 0, 1)
    path = (tuple(map(float, first)), tuple(map(float, last)))
    result = fr.solve(make_problem(path=path, mesh=(30, 1), material="biot-linear"), loads(1), throw=False)
    assert result.status is fr.Status.LIMIT_POINT
    (point,) = result.critical
    assert (point.kind, point.load_parameter) == ("limit point", result.reached)
    assert point.load_parameter == pytest.approx(t, abs=3e-4)
    assert np.all(result.index == 0)
    assert "limit on this branch" in result.message


def test_a_column_that_a_pin_holds_by_round_off_alone_ends_at_a_limit_point():
    """From its buckling load on its index depends on the contact, and is unknown: no step is refused for it."""
    result = fr.solve(pressed(column(1.5), ((0.8, 0.0), (0.8, 1e-9))), loads(1), throw=False)
    assert result.status is fr.Status.LIMIT_POINT
    assert 1.5 * result.reached == pytest.approx(1.0, abs=0.05)


def test_pin_that_presses_a_buckled_column_straight_loses_it_at_a_limit_point():
    """At 1.1 times the buckling load the pin's force has fallen to zero: the free column is unstable there, index 1."""
    scene = pressed(column(1.5, 1e-3), ((0.7, 0.8), (0.7, -0.3)), side="left")
    result = fr.solve(scene, loads(5), throw=False)
    assert result.status is fr.Status.LIMIT_POINT
    (point,) = result.critical
    assert point.kind == "limit point"
    assert 1.5 * result.reached == pytest.approx(1.0977, abs=1e-3)
    assert np.all(result.index == 0)
    shape = 1 - np.cos(np.pi / 2 * fr.axis_stations(result, STRIP))
    np.testing.assert_allclose(point.mode[STRIP][:, 1], shape, rtol=0, atol=0.05)
