from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.active_set import equilibrium
from fem_reference.material import Law
from fem_reference.model import build
from fem_reference.newton import updated
from fem_reference.settings import Settings
from fem_reference.state import Condition, at_rest, build_state, imbalance, residual
from fem_reference.status import Status
from fem_reference.tangent import linearise


@pytest.fixture(scope="module")
def place(problem, with_pin):
    """The model with its pin at a point."""
    model = build(problem(mesh=(10, 1)))
    return lambda *point: with_pin(model, point)


def found(model, at, settings=None):
    return equilibrium(model, at, settings or Settings())


def closed(model, u, force):
    return build_state(model, u, 0.0, (Condition(closed=True, force=force),))


def test_correction_solves_the_full_saddle_point_system(place):
    """The solution by three columns against the assembled matrix of displacements and contact force."""
    before = found(place(0.9, 0.1), at_rest(place(0.9, 0.1))).state
    model = place(0.89, 0.11)
    at = closed(model, before.u, 1.1 * before.touches[0].force)
    touch, T = at.touches[0], model.expansion
    R, U = T.T @ residual(model, at).ravel(), T.T @ touch.slopes
    K = model.bodies[0].tangent(at.u).toarray() - touch.force * U @ touch.curvature @ U.T
    full = np.block([[K, -U[:, :1]], [U[:, :1].T, np.array([[1 / model.pairs[0].penalty]])]])
    expected = np.linalg.solve(full, -np.append(R, touch.gap_residual))
    step = linearise(model, at).correction(R)
    np.testing.assert_allclose(
        np.append(step.u, step.forces),
        np.append(T @ expected[:-1], expected[-1]),
        rtol=0,
        atol=1e-9 * np.abs(expected).max(),
    )


def test_correction_of_two_strips_solves_the_full_system(strip):
    """A pin on the upper strip, whose end is pressed on the lower one: both contacts closed, bodies coupled by one alone."""
    upper = strip(name="upper", start=(0.0, 0.0), end=(1.0, 0.0), mesh=(6, 1), height=0.05)
    lower = strip(name="lower", start=(0.1, -0.1), end=(1.2, -0.12), mesh=(5, 1), height=0.05)
    contacts = (
        fr.Contact(node="pin", strip="upper", side="left", surface="face"),
        fr.Contact(node="upper.end", strip="lower", side="left", surface="face"),
    )
    pin = fr.Pin(name="pin", path=((0.7, 0.04), (0.7, -0.2)), radius=0.01)
    model = build(fr.SolidProblem(strips=(upper, lower), pins=(pin,), contacts=contacts))
    result = fr.solve(model.problem, np.array([0.4, 0.6]))
    at = build_state(
        model,
        result.states[-1].u,
        0.62,
        tuple(replace(condition, force=1.1 * condition.force) for condition in result.states[-1].conditions),
    )
    assert len(at.closed) == 2
    T = model.expansion
    R = T.T @ residual(model, at).ravel()
    K = np.zeros((model.unknowns, model.unknowns))
    start = 0
    for body, part in model.bodies_and_nodes():
        size = body.expansion.shape[1]
        K[start : start + size, start : start + size] = body.tangent(at.u[part]).toarray()
        start += size
    slopes = []
    for touch in at.closed:
        U = T.T @ touch.slopes
        K -= touch.force * U @ touch.curvature @ U.T
        slopes.append(U[:, 0])
    G, C = np.stack(slopes, 1), np.diag([1 / touch.pair.penalty for touch in at.closed])
    full = np.block([[K, -G], [G.T, C]])
    expected = np.linalg.solve(full, -np.append(R, [touch.gap_residual for touch in at.closed]))
    step = linearise(model, at).correction(R)
    np.testing.assert_allclose(K, K.T, rtol=0, atol=1e-12 * np.abs(K).max())
    np.testing.assert_allclose(
        np.append(step.u, step.forces),
        np.append(T @ expected[:-2], expected[-2:]),
        rtol=0,
        atol=1e-8 * np.abs(expected).max(),
    )


def test_residuals_fall_quadratically(place):
    before = found(place(0.9, 0.1), at_rest(place(0.9, 0.1))).state
    model = place(0.897, 0.103)
    at = closed(model, before.u, before.touches[0].force)
    errors = []
    for _ in range(5):
        R = model.expansion.T @ residual(model, at).ravel()
        errors.append(np.abs(R).max() / at.touches[0].force)
        at = updated(model, at, linearise(model, at).correction(R), 1.0)
    floor = model.round_off / at.touches[0].force
    orders = [np.log(b) / np.log(a) for a, b in pairwise(errors[1:]) if floor < a < 0.1]
    assert orders, errors
    assert min(orders) > 1.6
    assert errors[-1] < floor


def test_open_contact_needs_no_iteration(place):
    model = place(0.9, -0.1)
    attempt = found(model, at_rest(model))
    assert (attempt.status, attempt.iterations) == (Status.CONVERGED, 0)
    assert attempt.state.touches[0].force == 0
    assert attempt.state.touches[0].gap == pytest.approx(0.1)


def test_contact_that_pulls_is_opened(place):
    bent = found(place(0.9, 0.05), at_rest(place(0.9, 0.05))).state
    model = place(0.9, -0.01)
    attempt = found(model, closed(model, bent.u, bent.touches[0].force))
    assert attempt.status is Status.CONVERGED
    assert not attempt.state.closed
    assert attempt.state.touches[0].gap == pytest.approx(0.01, abs=1e-12)
    assert np.abs(attempt.state.u).max() < 1e-12


def test_equilibrium_balances_the_clamp(place):
    model = place(0.9, 0.05)
    attempt = found(model, at_rest(model))
    assert attempt.status is Status.CONVERGED
    assert imbalance(model, attempt.state) < 1e-9 * attempt.state.touches[0].force


def test_iteration_limit_has_its_name(place):
    model = place(0.9, 0.1)
    attempt = found(model, at_rest(model), Settings(max_iterations=1))
    assert (attempt.status, attempt.iterations) == (Status.ITERATION_LIMIT, 1)


def test_nan_has_its_name(place):
    model = place(0.9, 0.1)
    assert found(model, closed(model, np.full((model.nodes, 2), np.nan), 0.0)).status is Status.NOT_FINITE


def test_singular_tangent_has_its_name(place):
    """A material without stiffness: the tangent cannot be factorised, and nothing is raised."""
    zero = Law(
        energy=lambda F: 0 * F[0, 0], stress=lambda F: 0 * F, tangent=lambda F: np.zeros((2, 2, *F.shape))
    )
    model = place(0.9, 0.1)
    empty = replace(model, bodies=(replace(model.bodies[0], law=zero),))
    assert found(empty, at_rest(empty)).status is Status.SINGULAR


def test_reactions_that_do_not_balance_have_their_name(place):
    """A law that is linear in the displacement gradient: a turned element has moments."""
    model = place(0.7, 0.2)
    A = model.bodies[0].law.tangent(np.eye(2)[:, :, None])

    def linear(F):
        H = F - np.eye(2).reshape(2, 2, *(1,) * (F.ndim - 2))
        return np.einsum("ijkl,kl...->ij...", A[..., 0], H)

    law = Law(
        energy=lambda F: (linear(F) * F).sum(axis=(0, 1)) / 2,
        stress=linear,
        tangent=lambda F: A.reshape(2, 2, 2, 2, *(1,) * (F.ndim - 2)) + np.zeros((2, 2, *F.shape)),
    )
    false = replace(model, bodies=(replace(model.bodies[0], law=law),))
    assert found(false, at_rest(false)).status is Status.UNBALANCED


def test_pin_round_the_tip_is_lost(place):
    assert found(place(1.2, 0.1), at_rest(place(1.2, 0.1))).status is Status.LOST_CONTACT
    assert found(place(1.2, -0.1), at_rest(place(1.2, -0.1))).status is Status.CONVERGED


def test_undecided_contact_has_its_name(place):
    model = place(0.9, -0.1)
    at = closed(model, np.zeros((model.nodes, 2)), 0.0)
    attempt = found(model, at, Settings(max_contact_changes=0))
    assert (attempt.status, attempt.pair) == (Status.UNDECIDED_CONTACT, 0)


def test_cycling_has_its_name(place):
    """A law whose stiffness is reversed: the penetrated contact pulls, and opened it is penetrated again."""
    model = place(0.9, 0.01)
    law = model.bodies[0].law
    reversed_ = Law(
        energy=lambda F: -law.energy(F), stress=lambda F: -law.stress(F), tangent=lambda F: -law.tangent(F)
    )
    unstable = replace(model, bodies=(replace(model.bodies[0], law=reversed_),))
    attempt = found(unstable, at_rest(unstable))
    assert (attempt.status, attempt.pair) == (Status.CYCLING, 0)


def test_a_correction_that_grows_is_halved_and_still_arrives(place):
    """A pin far away in one step, with full corrections and with the next one not allowed to double."""
    model = place(0.7, 0.3)
    full, damped = (
        found(model, at_rest(model), Settings(max_iterations=40, largest_growth=growth))
        for growth in (1e9, 2.0)
    )
    assert full.status is damped.status is Status.CONVERGED
    assert damped.iterations > full.iterations
    assert damped.state.touches[0].force == pytest.approx(full.state.touches[0].force, rel=1e-8)
