from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from fem_reference.material import Law
from fem_reference.model import build
from fem_reference.newton import _contact_residual, _correction, equilibrium
from fem_reference.settings import Settings
from fem_reference.state import imbalance, residual, state
from fem_reference.status import Status


@pytest.fixture(scope="module")
def model(problem):
    return build(problem(mesh=(10, 1)))


def at_rest(model, pin, **contact):
    return state(model, 0 * model.mesh.nodes, np.array(pin), **({"closed": False, "force": 0.0} | contact))


def test_correction_solves_the_full_saddle_point_system(model):
    """The solution by three columns against the assembled matrix of displacements and contact force."""
    found = equilibrium(model, at_rest(model, (0.9, 0.1)), Settings()).state
    at = state(model, found.u, np.array([0.89, 0.11]), closed=True, force=1.1 * found.force)
    free = model.stiffness.unknowns
    R, U = residual(model, at).ravel()[free], at.slopes[free]
    K = model.solid_stiffness(at.u).toarray() - at.force * U @ at.curvature @ U.T
    slope = U[:, :1]
    full = np.block([[K, -slope], [slope.T, np.array([[1 / model.problem.contact.penalty]])]])
    expected = np.linalg.solve(full, -np.append(R, _contact_residual(model, at)))
    du, dlam = _correction(model, at, R)
    np.testing.assert_allclose(np.append(du, dlam), expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_residuals_fall_quadratically(model):
    pin = np.array([0.9, 0.1])
    at = equilibrium(model, at_rest(model, pin), Settings()).state
    at = state(model, at.u, np.array([0.897, 0.103]), closed=True, force=at.force)
    free = model.stiffness.unknowns
    errors = []
    for _ in range(5):
        R = residual(model, at).ravel()[free]
        errors.append(np.abs(R).max() / at.force)
        du, dlam = _correction(model, at, R)
        u = at.u.copy()
        u.reshape(-1)[free] += du
        at = state(model, u, at.pin, closed=True, force=at.force + dlam)
    floor = model.round_off / at.force
    orders = [np.log(b) / np.log(a) for a, b in pairwise(errors[1:]) if floor < a < 0.1]
    assert orders, errors
    assert min(orders) > 1.6
    assert errors[-1] < floor


def test_open_contact_needs_no_iteration(model):
    attempt = equilibrium(model, at_rest(model, (0.9, -0.1)), Settings())
    assert (attempt.status, attempt.iterations, attempt.state.force) == (Status.CONVERGED, 0, 0.0)
    assert attempt.state.gap == pytest.approx(0.1)


def test_contact_that_pulls_is_opened(model):
    bent = equilibrium(model, at_rest(model, (0.9, 0.05)), Settings()).state
    away = state(model, bent.u, np.array([0.9, -0.01]), closed=True, force=bent.force)
    attempt = equilibrium(model, away, Settings())
    assert attempt.status is Status.CONVERGED
    assert not attempt.state.closed
    assert attempt.state.gap == pytest.approx(0.01, abs=1e-12)
    assert np.abs(attempt.state.u).max() < 1e-12


def test_equilibrium_balances_the_clamp(model):
    attempt = equilibrium(model, at_rest(model, (0.9, 0.05)), Settings())
    assert attempt.status is Status.CONVERGED
    assert imbalance(model, attempt.state) < 1e-9 * attempt.state.force


def test_iteration_limit_has_its_name(model):
    attempt = equilibrium(model, at_rest(model, (0.9, 0.1)), Settings(max_iterations=1))
    assert (attempt.status, attempt.iterations) == (Status.ITERATION_LIMIT, 1)


def test_nan_has_its_name(model):
    u = np.full_like(model.mesh.nodes, np.nan)
    at = state(model, u, np.array([0.9, 0.1]), closed=True, force=0.0)
    assert equilibrium(model, at, Settings()).status is Status.NOT_FINITE


def test_singular_tangent_has_its_name(model):
    """A material without stiffness: the tangent cannot be factorised, and nothing is raised."""
    zero = Law(
        energy=lambda F: 0 * F[0, 0],
        stress=lambda F: 0 * F,
        tangent=lambda F: np.zeros((2, 2, *F.shape)),
    )
    empty = replace(model, law=zero)
    assert equilibrium(empty, at_rest(model, (0.9, 0.1)), Settings()).status is Status.SINGULAR


def test_pin_round_the_tip_is_lost(model):
    assert equilibrium(model, at_rest(model, (1.2, 0.1)), Settings()).status is Status.LOST_CONTACT
    assert equilibrium(model, at_rest(model, (1.2, -0.1)), Settings()).status is Status.CONVERGED


def test_undecided_contact_has_its_name(model):
    at = at_rest(model, (0.9, -0.1), closed=True)
    assert equilibrium(model, at, Settings(max_contact_changes=0)).status is Status.UNDECIDED_CONTACT
