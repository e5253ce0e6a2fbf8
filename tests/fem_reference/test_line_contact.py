"""Round pins: contact at a point ends where the strip is as curved as the pin."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

import fem_reference as fr
from fem_reference.curve import CurveFrom, closest
from fem_reference.line_contact import clearance
from fem_reference.model import build
from fem_reference.state import build_state
from fem_reference.touch import Condition
from tests.fem_reference.conftest import loads, place_pin

PAIR = "drum->cantilever"


def drum(strip, load, radius=0.5, height=0.005, mesh=(40, 1)):
    """A cantilever with a load on its tip over a drum of radius .5 below x = .3; EI = 1 for h = .005."""
    center = (0.3, -height / 2 - radius)
    clamped = strip(height=height, youngs_modulus=4.8e9, mesh=mesh, material="biot-linear")
    return fr.SolidProblem(
        strips=(clamped,),
        pins=(fr.Pin(name="drum", path=(center, (0.3, center[1] + 1e-9)), radius=radius),),
        contacts=(fr.Contact(node="drum", strip="cantilever", surface="face"),),
        loads=(fr.EndLoad(strip="cantilever", force=(0.0, -load)),),
    )


@pytest.mark.slow
def test_strip_bent_round_a_drum_ends_as_line_contact(strip):
    result = fr.solve(drum(strip, 12.0), loads(4), throw=False)
    assert result.status is fr.Status.LINE_CONTACT
    assert f"({PAIR}), at load parameter" in result.message
    assert 0.25 < result.reached < 0.5
    clearances = [clearance(at.touches[0]) for at in result.states]
    assert np.all(np.array(clearances) > 0)
    assert np.all(result.index == 0)
    assert np.all(result.contacts[PAIR].gap >= -1e-8)


@pytest.mark.slow
def test_line_contact_does_not_depend_on_steps_or_on_the_load_at_the_end(strip):
    """Within 1e-7 on paths to 12 N in 25 load parameters and to 30 N in 10."""
    begins = [
        load * fr.solve(drum(strip, load, mesh=(100, 1)), loads(n), throw=False).reached
        for load, n in ((12.0, 25), (30.0, 10))
    ]
    assert begins[0] == pytest.approx(begins[1], rel=1e-7)


@pytest.mark.slow
def test_line_contact_begins_where_the_beams_curvature_reaches_the_drums(strip):
    """A Bernoulli beam bent by contact and tip: ``m_c / EI = 1 / (R + h / 2)`` at the contact, by shooting; .13 % of the load."""
    R, h, EI = 0.5, 0.005, 4.8e9 * 0.02 * 0.005**3 / 12
    center = np.array([0.3, -h / 2 - R])

    def tail(P, s, angle):
        """Moment at s of an elastica from (s, angle) to a free end under P downwards."""

        def end(m):
            right = solve_ivp(
                lambda _, y: [y[1], P * np.cos(y[0]) / EI], (s, 1), [angle, m / EI], rtol=1e-10, atol=1e-12
            )
            return right.y[1, -1]

        return end

    def equations(x):
        P, s, force, m0, angle, mc = x
        # From the clamp to the contact: force (fx, fy) of the part beyond, contact force along the normal.
        normal = np.array([-np.sin(angle), np.cos(angle)])
        beyond = np.array([0.0, -P]) + force * normal

        def slope(_, y):
            th, k = y[0], y[1]
            return [k, -(np.cos(th) * beyond[1] - np.sin(th) * beyond[0]) / EI, np.cos(th), np.sin(th)]

        left = solve_ivp(slope, (0, s), [0.0, m0 / EI, 0.0, 0.0], rtol=1e-10, atol=1e-12)
        th, k, px, py = left.y[:, -1]
        place = center + (R + h / 2) * normal
        return [
            th - angle,
            EI * k - mc,
            px - place[0],
            py - place[1],
            tail(P, s, angle)(mc),
            -mc / EI - 1 / (R + h / 2),
        ]

    x, _, found, _ = fsolve(equations, [4.5, 0.44, 12.0, -1.0, -0.5, -2.0], full_output=True)
    assert found == 1
    begins = 12 * fr.solve(drum(strip, 12.0, mesh=(100, 1)), np.array([1.0]), throw=False).reached
    assert begins == pytest.approx(x[0], rel=2e-3)


def test_sharp_pin_has_no_line_contact_and_clearance_follows_the_curvature(problem):
    """A strip bent to an arc of radius 2 with a pin below its middle: ``1 - R / 2``."""
    model = build(problem(mesh=(20, 1)))
    X = model.bodies[0].mesh.nodes
    angle = (X[:, 0] - 0.5) / 2
    x = np.stack([(2 + X[:, 1]) * np.sin(angle), (2 + X[:, 1]) * np.cos(angle)], axis=1)
    for radius in (0.0, 0.5, 1.9):
        placed = place_pin(model, (0.0, 2 - radius), radius=radius)
        at = build_state(placed, x - X, 0.0, (Condition(closed=True, force=1.0),))
        assert clearance(at.touches[0]) == pytest.approx(1 - radius / 2, abs=1e-4)


def test_closest_point_is_found_up_to_the_centre_of_curvature(problem):
    """``(r - x_c) . r' = 0`` on an arc of radius 2 for points up to a millionth from the centre of curvature."""
    pair = build(problem(mesh=(20, 1))).pairs[0]
    s = pair.curve.stations
    angle = (s - 0.5) / 2
    arc = np.stack([2 * np.sin(angle), 2 * np.cos(angle)], axis=1)
    arc[:, 1] -= 0.05 * (s - 0.47) ** 2  # curvature is largest, and the closest point unique, off the middle
    B = pair.curve.basis(0.47)
    r, r1, r2 = B @ arc
    normal = np.array([-r1[1], r1[0]]) / np.hypot(*r1)
    radius = r1 @ r1 / abs(normal @ r2)
    for part in (0.5, 0.9, 0.99, 0.9999, 1 - 1e-6):
        point = r + part * radius * np.sign(normal @ r2) * normal
        zeta, stationary = closest(CurveFrom(curve=pair.curve, points=arc - point))
        assert stationary
        assert zeta == pytest.approx(0.47, abs=1e-6 / (1 - part))
