"""Coulomb friction in the contact law with the force as an unknown."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tsm.test_elements import STEP, random_contact, random_properties
from tsm.elements import mixed_contact, mixed_friction
from tsm.elements.contact_law import Rub, Surface


def drawn_rub(rng, p, *, stick):
    unit = p.EI / p.l0**3
    if stick:
        return Rub(0.0, float(rng.uniform(-1, 1)) * p.l0, unit)
    return Rub(float(rng.uniform(-0.9, 0.9)), None, unit)


def drawn(rng, *, stick):
    p, x, lever, xi, force, side, _ = random_contact(rng)
    return p, x, lever, xi, force, Surface(side, 0.0), drawn_rub(rng, p, stick=stick)


def along(direction, p, x, lever, xi, force, step=STEP):
    """State after a step along a direction of the eleven unknowns."""
    return (
        p,
        x + step * direction[:6],
        lever + step * (direction[:2] - direction[6:8]),
        xi + step * direction[10] / p.l0,
        force + step * direction[8:10],
    )


@pytest.mark.parametrize("stick", [False, True])
def test_tangent_is_the_derivative_of_every_row(stick):
    rng = np.random.default_rng(1)
    for _ in range(300):
        *state, surface, rub = drawn(rng, stick=stick)
        _, tangent = mixed_friction.response(*state, surface, rub)
        for column, direction in enumerate(np.eye(11)):
            stepped, _ = mixed_friction.response(*along(direction, *state), surface, rub)
            expected = stepped.imag / abs(STEP)
            bound = 1e-8 * np.abs(expected).max() + 1e-13 * np.abs(tangent).max()
            assert np.abs(tangent[:, column] - expected).max() <= bound


def test_without_lean_the_rows_are_the_frictionless_ones():
    rng = np.random.default_rng(2)
    for _ in range(100):
        *state, surface, rub = drawn(rng, stick=False)
        residual, tangent = mixed_friction.response(*state, surface, rub._replace(lean=0.0))
        expected, hessian = mixed_contact.response(*state, *surface)
        assert np.abs(residual - expected).max() <= 1e-13 * np.abs(expected).max()
        assert np.abs(tangent - hessian).max() <= 1e-12 * np.abs(hessian).max()


def test_slip_row_is_the_cone_of_friction():
    """The row vanishes where ``F_t = sigma mu F_n``, and nowhere else."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        *state, surface, rub = drawn(rng, stick=False)
        p, x, _, xi, force = state
        residual, _ = mixed_friction.response(*state, surface, rub)
        F_t, F_n, _ = mixed_friction.split(p, x, xi, force, surface, rub)
        size = mixed_friction.slip(p, x, xi, force, surface, rub)[10]
        assert residual[10] == pytest.approx(-size * (F_t - rub.lean * surface.side * F_n), rel=1e-9)


def test_forces_and_rows_turn_with_the_element():
    """A rigid rotation of element, force and node leaves ``F_t, F_n``, the travel and the third row."""
    rng = np.random.default_rng(4)
    for _ in range(100):
        *state, surface, rub = drawn(rng, stick=False)
        p, x, _, xi, force = state
        angle = rng.uniform(-1, 1)
        c, s = np.cos(angle), np.sin(angle)
        Q = np.array([[c, -s], [s, c]])
        chord = np.array([p.dx0, p.dy0])
        d = Q @ (chord + x[3:5] - x[:2])
        turned = np.concatenate([Q @ x[:2], [x[2] + angle], Q @ x[:2] + d - chord, [x[5] + angle]])
        old = mixed_friction.split(p, x, xi, force, surface, rub)
        new = mixed_friction.split(p, turned, xi, Q @ force, surface, rub)
        assert new == pytest.approx(old, rel=1e-8, abs=1e-10)


def test_two_contacts_on_an_element():
    """The tangent of the coupling is its derivative; without friction it is the frictionless coupling."""
    rng = np.random.default_rng(5)
    for n in range(40):
        p = random_properties(rng)
        xi, forces = rng.uniform(0.01, 0.99, 2), rng.normal(size=(2, 2))
        rubs = drawn_rub(rng, p, stick=n % 2 == 0), drawn_rub(rng, p, stick=n % 3 == 0)
        _, tangent = mixed_friction.crossing(p, tuple(xi), *forces, rubs)
        for column, direction in enumerate(np.eye(6)):
            d = STEP * direction.reshape(2, 3)
            stepped, _ = mixed_friction.crossing(
                p, tuple(xi + d[:, 2] / p.l0), forces[0] + d[0, :2], forces[1] + d[1, :2], rubs
            )
            expected = stepped.imag / abs(STEP)
            assert np.abs(tangent[:, column] - expected).max() <= 1e-10 * np.abs(tangent).max()
        free = Rub(0.0, None, 1.0)
        residual, tangent = mixed_friction.crossing(p, tuple(xi), *forces, (free, free))
        expected, hessian = mixed_contact.crossing(p, tuple(xi), *forces)
        assert np.abs(residual - expected).max() <= 1e-14 * np.abs(expected).max()
        assert np.abs(tangent - hessian).max() <= 1e-14 * np.abs(hessian).max()
