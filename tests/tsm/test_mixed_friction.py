"""Coulomb friction in the contact law with the force as an unknown."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tsm.test_elements import STEP, random_contact, random_properties
from tsm.elements import mixed_contact, mixed_friction
from tsm.elements.contact_law import Rub, Surface

PLACES = {"axis": (0.0, 0.0), "face": (0.1, 0.0), "round": (0.0, 0.2), "round on the face": (0.1, 0.2)}


def drawn_rub(rng, p, *, stick, place="axis"):
    """Slip of any sign, or a stick that began nearby."""
    unit, (face, radius) = p.EI / p.l0**3, PLACES[place]
    held = float(rng.uniform(-1, 1)) * p.l0 if stick else None
    lean = 0.0 if stick else float(rng.uniform(-0.9, 0.9))
    return Rub(lean, held, unit, face * p.l0, radius * p.l0, *rng.uniform(0.5, 1.5, 3).tolist())


def drawn(rng, *, stick, place="axis"):
    """A state in the range of the element: the contact's dent is a part of its length."""
    p, x, lever, xi, force, side, _ = random_contact(rng)
    force = 0.3 * force * p.EI / p.l0**2 / (1 + p.Phi)
    rub = drawn_rub(rng, p, stick=stick, place=place)
    return p, x, lever, xi, force, Surface(side, rub.face + rub.radius), rub


def along(direction, p, x, lever, xi, force, step=STEP):
    """State after a step along a direction of the eleven unknowns."""
    return (
        p,
        x + step * direction[:6],
        lever + step * (direction[:2] - direction[6:8]),
        xi + step * direction[10] / p.l0,
        force + step * direction[8:10],
    )


@pytest.mark.slow_at(
    "False-axis",
    "False-face",
    "False-round",
    "False-round on the face",
    "True-face",
    "True-round",
    "True-round on the face",
)
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("stick", [False, True])
def test_tangent_is_the_derivative_of_every_row(stick, place):
    rng = np.random.default_rng(1)
    for _ in range(100):
        *state, surface, rub = drawn(rng, stick=stick, place=place)
        _, tangent = mixed_friction.response(*state, surface, rub)
        for column, direction in enumerate(np.eye(11)):
            stepped, _ = mixed_friction.response(*along(direction, *state), surface, rub)
            expected = stepped.imag / abs(STEP)
            bound = 1e-8 * np.abs(expected).max() + 1e-13 * np.abs(tangent).max()
            assert np.abs(tangent[:, column] - expected).max() <= bound


@pytest.mark.parametrize("place", PLACES)
def test_work_is_stored_or_dissipated(place):
    """The power of the node is that of the nodal loads, the change of energy, and F_t times the slip rate; for any rates."""
    rng = np.random.default_rng(8)
    for _ in range(100):
        p, x, lever, xi, force, surface, rub = drawn(rng, stick=False, place=place)
        residual, tangent = mixed_friction.response(p, x, lever, xi, force, surface, rub)
        rate = rng.normal(size=11)
        rate[[0, 1, 3, 4, 6, 7, 10]] *= p.l0
        rate[8:10] *= np.linalg.norm(force)
        # the node's velocity from the derivative of its two rows
        rate[6:8] = 0.0
        rate[6:8] = -tangent[8:10] @ rate
        dE = mixed_friction.energy(*along(rate, p, x, lever, xi, force), surface, rub).imag / abs(STEP)
        F_t, _, _ = mixed_friction.split(p, x, xi, force, surface, rub)
        slip = mixed_friction.slip(p, x, xi, force, surface, rub) @ rate
        parts = np.array([force @ rate[6:8], residual[:6] @ rate[:6], -dE, -F_t * slip])
        assert abs(parts.sum()) <= 1e-11 * np.abs(parts).max()


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
