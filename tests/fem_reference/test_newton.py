from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.active_set import equilibrium
from fem_reference.material import Law
from fem_reference.model import build
from fem_reference.settings import Settings
from fem_reference.state import at_rest, build_state, residual, tie_residuals
from fem_reference.status import Status
from fem_reference.tangent import linearise
from fem_reference.touch import Condition
from tests.fem_reference.conftest import dense_hessian, make_portal, make_problem, make_strip, place_pin


@pytest.fixture(scope="module")
def place():
    """The model with its pin at a point."""
    model = build(make_problem(mesh=(10, 1)))
    return lambda *point: place_pin(model, point)


def solved(model, state=None, **settings):
    """Equilibrium from a state; from rest if None."""
    return equilibrium(model, at_rest(model) if state is None else state, Settings(**settings))


def closed(model, u, force):
    return build_state(model, u, 0.0, (Condition(closed=True, force=force),))


def with_law(model, energy, stress, tangent):
    law = Law(energy=energy, stress=stress, tangent=tangent)
    return replace(model, bodies=(replace(model.bodies[0], law=law),))


def one_strip(place):
    before = solved(place(0.9, 0.1)).state
    model = place(0.89, 0.11)
    return model, closed(model, before.u, 1.1 * before.touches[0].force)


def two_strips(_):
    """A pin on the upper strip, whose end presses on the lower one: both contacts are closed."""
    upper = make_strip(name="upper", mesh=(6, 1), height=0.05)
    lower = make_strip(name="lower", start=(0.1, -0.1), end=(1.2, -0.12), mesh=(5, 1), height=0.05)
    nodes = (("pin", "upper"), ("upper.end", "lower"))
    contacts = tuple(fr.Contact(node=node, strip=strip, side="left", surface="face") for node, strip in nodes)
    pin = fr.Pin(name="pin", path=((0.7, 0.04), (0.7, -0.2)), radius=0.01)
    model = build(fr.SolidProblem(strips=(upper, lower), pins=(pin,), contacts=contacts))
    last = fr.solve(model.problem, np.array([0.4, 0.6])).states[-1]
    conditions = tuple(replace(condition, force=1.1 * condition.force) for condition in last.conditions)
    return model, build_state(model, last.u, 0.62, conditions)


def portal(_):
    """A frame without clamps under a moment and a pin, away from equilibrium: supports, joints, dead load and contact."""
    model = build(make_portal(fr.Pin(name="pin", path=((0.5, 0.83), (0.5, 0.7)))))
    last = fr.solve(model.problem, np.array([0.5, 1.0])).states[-1]
    conditions = tuple(replace(condition, force=1.1 * condition.force) for condition in last.conditions)
    return model, build_state(model, 1.01 * last.u, 0.9, conditions, 1.05 * last.tie_forces)


@pytest.mark.parametrize(("case", "tolerance"), [(one_strip, 1e-9), (two_strips, 1e-8), (portal, 1e-8)])
def test_correction_solves_the_full_saddle_point_system(place, case, tolerance):
    """The solution by columns of contacts and end sections against the assembled matrix of displacements and forces."""
    model, state = case(place)
    assert len(state.closed) == len(model.pairs)
    T, (K, gradients) = model.expansion, dense_hessian(model, state)
    np.testing.assert_allclose(K, K.T, rtol=0, atol=1e-12 * np.abs(K).max())
    ties = tie_residuals(model, state)
    C = np.diag([*(1 / touch.pair.penalty for touch in state.closed), *(0 * ties)])
    G = np.stack(gradients, 1)
    R = T.T @ residual(model, state).ravel()
    right = -np.concatenate([R, [touch.gap_residual for touch in state.closed], ties])
    expected = np.linalg.solve(np.block([[K, -G], [G.T, C]]), right)
    step = linearise(model, state).correction(R)
    found, expected = np.append(step.u, step.forces), np.append(T @ expected[: len(R)], expected[len(R) :])
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * np.abs(expected).max())


def test_iteration_limit_is_a_status(place):
    attempt = solved(place(0.9, 0.1), max_iterations=1)
    assert (attempt.status, attempt.iterations) == (Status.ITERATION_LIMIT, 1)


def test_nan_is_a_status(place):
    model = place(0.9, 0.1)
    assert solved(model, closed(model, np.full((model.nodes, 2), np.nan), 0.0)).status is Status.NOT_FINITE


def test_singular_tangent_is_a_status(place):
    """A material without stiffness: the tangent cannot be factorised, and nothing is raised."""
    model = place(0.9, 0.1)
    empty = with_law(model, lambda F: 0 * F[0, 0], lambda F: 0 * F, lambda F: np.zeros((2, 2, *F.shape)))
    assert solved(empty).status is Status.SINGULAR


def test_unbalanced_reactions_are_a_status(place):
    """A law that is linear in the displacement gradient: a rotated element has moments."""
    model = place(0.7, 0.2)
    A = model.bodies[0].law.tangent(np.eye(2)[:, :, None])

    def stress(F):
        return np.einsum("ijkl,kl...->ij...", A[..., 0], F - np.eye(2).reshape(2, 2, *(1,) * (F.ndim - 2)))

    def tangent(F):
        return A.reshape(2, 2, 2, 2, *(1,) * (F.ndim - 2)) + np.zeros((2, 2, *F.shape))

    false = with_law(model, lambda F: (stress(F) * F).sum(axis=(0, 1)) / 2, stress, tangent)
    assert solved(false).status is Status.UNBALANCED


def test_pin_round_the_tip_is_lost(place):
    assert solved(place(1.2, 0.1)).status is Status.LOST_CONTACT
    assert solved(place(1.2, -0.1)).status is Status.CONVERGED


def test_undecided_contact_is_a_status(place):
    model = place(0.9, -0.1)
    attempt = solved(model, closed(model, np.zeros((model.nodes, 2)), 0.0), max_contact_changes=0)
    assert (attempt.status, attempt.pair) == (Status.UNDECIDED_CONTACT, 0)


def test_cycling_is_a_status(place):
    """A law with reversed stiffness: the closed contact pulls, and the open one is penetrated again."""
    model = place(0.9, 0.01)
    law = model.bodies[0].law
    unstable = with_law(model, lambda F: -law.energy(F), lambda F: -law.stress(F), lambda F: -law.tangent(F))
    attempt = solved(unstable)
    assert (attempt.status, attempt.pair) == (Status.CYCLING, 0)


def test_a_correction_that_grows_is_halved_and_still_converges(place):
    """A pin far away in one step, with full corrections and with corrections that must not double."""
    full, damped = (solved(place(0.7, 0.3), max_iterations=40, largest_growth=g) for g in (1e9, 2.0))
    assert full.status is damped.status is Status.CONVERGED
    assert damped.iterations > full.iterations
    assert damped.state.touches[0].force == pytest.approx(full.state.touches[0].force, rel=1e-8)
