"""Derivatives of friction: of slip and direction, of all residuals, and the rates along the path."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.active_set import equilibrium
from fem_reference.dissipation import slip_rates
from fem_reference.friction import (
    force_curvature,
    friction_at,
    slip_gradient,
    slip_increment,
    stretch_column,
)
from fem_reference.model import build
from fem_reference.newton import updated
from fem_reference.settings import Settings
from fem_reference.state import build_state, residual
from fem_reference.tangent import linearise
from fem_reference.track import accept
from tests.fem_reference.conftest import (
    STEP,
    make_problem,
    make_strip,
    place_pin,
)
from tests.fem_reference.test_friction import ks


def bent(model, seed=0):
    """Displacements of a bent strip with some noise."""
    x = model.bodies[0].mesh.nodes
    noise = 0.004 * np.random.default_rng(seed).standard_normal(x.shape)
    angle = 1.2 * x[:, 0]
    bend = np.stack([np.sin(angle), 1 - np.cos(angle)], 1) / 1.2
    return bend + x[:, 1:] * np.stack([-np.sin(angle), np.cos(angle)], 1) + noise - x


@pytest.fixture(params=["axis", "face"])
def model(request):
    """A strip turned by 0.4 in its scene, so that no frame is mistaken for another."""
    changes = {"end": (float(np.cos(0.4)), float(np.sin(0.4))), "height": 0.2, "mesh": (5, 2)}
    contact = {"surface": request.param, "friction": 0.3}
    return build(make_problem(path=((2.0, 2.0), (1.0, 1.0)), contact=contact, **changes))


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("radius", [0.0, 0.05])
@pytest.mark.parametrize("zeta", [0.33, 0.4, 0.97])
def test_slip_and_direction_of_friction_by_complex_steps(model, side, radius, zeta):
    u = bent(model)
    r, r1, _ = model.pairs[0].curve.basis(zeta) @ model.pairs[0].carrier.points(u)
    point = r + 0.05 * np.array([-r1[1], r1[0]]) / np.hypot(*r1)
    pair = place_pin(model, point, radius=radius).pairs[0]
    pair = replace(pair, contact=replace(pair.contact, side=side))
    last = friction_at(pair.project(0.8 * u, 0.0))
    at = pair.project(u, 0.0)
    columns = np.hstack([pair.gap_derivatives(at)[0], stretch_column(pair, at)])
    v = np.random.default_rng(3).standard_normal(u.shape)
    y = columns.T @ v.ravel()
    moved = pair.project(u + 1j * STEP * v, 0.0)
    assert abs(float(slip_increment(pair, at, last))) > 1e-4
    change = slip_increment(pair, moved, last).imag / STEP
    assert slip_gradient(pair, at, last) @ y == pytest.approx(float(change), rel=1e-10)
    turned = pair.gap_derivatives(moved)[0][:, 1].imag / STEP
    np.testing.assert_allclose(columns @ (force_curvature(pair, at) @ y), turned, rtol=0, atol=1e-9)


def pressed(direction, radius=0.0):
    """A state away from equilibrium that sticks or slips, after an accepted state."""
    problem = make_problem(contact={"friction": 0.3, "surface": "face"}, radius=radius, mesh=(10, 1))
    return build(problem), disturbed(problem, np.array([0.1, 0.2]), 0.2002, direction)


def disturbed(problem, load_parameters, t, direction):
    """State at t with the displacements of the last of some load parameters, with other contact forces."""
    result = fr.solve(problem, load_parameters)
    last = result.states[-1]
    condition = last.conditions[0]
    assert condition.friction.slip != 0
    friction = replace(condition.friction, direction=direction, force=1.2 * condition.friction.force)
    conditions = (replace(condition, force=1.1 * condition.force, friction=friction),)
    return build_state(result.model, last.u, t, conditions)


def two_strips(direction):
    """The end of an upper strip on a lower one."""
    upper = make_strip(name="upper", start=(0.0, 0.1), end=(0.8, 0.05), mesh=(8, 1))
    lower = make_strip(name="lower", start=(1.0, 0.0), end=(0.1, 0.0), mesh=(8, 1))
    contact = fr.Contact(node="upper.end", strip="lower", surface="face", friction=0.3)
    load = fr.EndLoad(strip="upper", force=(0.0, -4e-3))
    problem = fr.SolidProblem(strips=(upper, lower), contacts=(contact,), loads=(load,))
    return build(problem), disturbed(problem, np.array([0.4, 0.5]), 0.502, direction)


CASES = [
    pytest.param(make, id=name)
    for name, make in {
        "stick": lambda: pressed(0),
        "slip": lambda: pressed(-1),
        "roll": lambda: pressed(0, radius=0.05),
        "round-slip": lambda: pressed(-1, radius=0.05),
        "end-stick": lambda: two_strips(0),
        "end-slip": lambda: two_strips(1),
    }.items()
]


def all_residuals(model, state):
    touch = state.touches[0]
    R = model.expansion.T @ residual(model, state).ravel()
    return R, np.array([*R, touch.gap_residual, touch.slip_residual])


@pytest.mark.slow_at("end-slip")
@pytest.mark.parametrize("make", CASES)
def test_correction_removes_the_linear_part_of_all_residuals(make):
    """``J c = -r`` with the derivative J along c by central differences, extrapolated."""
    model, state = make()
    R, r = all_residuals(model, state)
    correction = linearise(model, state).correction(R)

    def slope(h):
        ahead, behind = (all_residuals(model, updated(model, state, correction, step))[1] for step in (h, -h))
        return (ahead - behind) / (2 * h)

    found = (4 * slope(2e-3) - slope(4e-3)) / 3
    for rows in (slice(0, -2), slice(-2, -1), slice(-1, None)):  # forces, gap, slip
        scale = np.abs(r[rows]).max()
        np.testing.assert_allclose(found[rows], -r[rows], rtol=0, atol=1e-4 * scale + 1e-12)


def test_rates_of_slip_and_force_are_those_of_the_path():
    result, _ = ks(0.3, n=10)
    model, settings = result.model, Settings()
    at = accept(model, result.states[3], settings)
    rates = slip_rates(at.tangent, 0, forward=True)
    h, state = 1e-4, at.state
    guess = build_state(model, state.u, state.t + h, state.conditions)
    after = equilibrium(model, guess, settings).state.touches[0]
    assert rates[0] == pytest.approx(after.slip / h, rel=1e-3)
    assert rates[1] == pytest.approx(
        (after.tangential_force - state.touches[0].tangential_force) / h, rel=1e-3
    )
