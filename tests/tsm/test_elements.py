"""The equations of every element alone: gradients, tangents, energies and tables, against derivatives and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import root

# what an element does at any state, in equilibrium or not, is nowhere public
from tsm.elements import CLOSED_FORM, beam
from tsm.elements.properties import Properties

STEP = 1e-30j


def random_properties(rng, n=None):
    angle, l0 = rng.uniform(0, 2 * np.pi, n), 10 ** rng.uniform(-1, 1, n)
    EA, EI, Phi = (10 ** rng.uniform(low, high, n) for low, high in ((0, 3), (-2, 2), (-8, 2)))
    return Properties(l0 * np.cos(angle), l0 * np.sin(angle), l0, EA, EI, Phi)


def random_contact(rng, near=1e-9):
    """Element, nodal displacements, lever, position, force, side and offset; two of three contacts are near an end."""
    p = random_properties(rng)
    x = rng.normal(size=6) * np.array([0.1 * p.l0, 0.1 * p.l0, 0.4] * 2)
    d = np.array([p.dx0 + x[3] - x[0], p.dy0 + x[4] - x[1]])
    xi = rng.choice([rng.uniform(0.01, 0.99), near, 1 - near])
    lever = -(xi * d + 0.05 * rng.normal() * np.array([-d[1], d[0]]))
    return p, x, lever, xi, rng.normal(size=2), rng.choice([-1.0, 1.0]), rng.choice([0.0, 0.1 * p.l0])


def along(direction, p, x, lever, xi, force, step=STEP):
    """State after a step along a direction of the eleven unknowns: nodes, node in contact, force, arc position."""
    return (
        p,
        x + step * direction[:6],
        lever + step * (direction[:2] - direction[6:8]),
        xi + step * direction[10] / p.l0,
        force + step * direction[8:10],
    )


@pytest.mark.parametrize("name", CLOSED_FORM)
def test_beam_tangent_is_the_derivative_of_its_force(name):
    rng = np.random.default_rng(1)
    kind = CLOSED_FORM[name]
    c = kind.coefficients(kind.constants(random_properties(rng, 1000)))
    x, direction = rng.normal(size=(6, 1000)) * 0.3, rng.normal(size=(6, 1000))
    tangent = beam.response(c, x)[1].reshape(6, 6, -1)
    expected = beam.response(c, x + STEP * direction)[0].imag / abs(STEP)
    apart = np.abs(np.einsum("ijn,jn->in", tangent, direction) - expected).max(axis=0)
    assert (apart <= 1e-12 * np.abs(expected).max(axis=0)).all()
    assert np.abs(tangent - tangent.transpose(1, 0, 2)).max() <= 1e-13 * np.abs(tangent).max()


@pytest.mark.parametrize("name", CLOSED_FORM)
def test_contact_tangent_is_the_derivative_of_its_gradient(name):
    """1,000 random states, contacts within 1e-9 of both ends, 1e-13 where the position is no unknown."""
    rng = np.random.default_rng(2)
    kind = CLOSED_FORM[name]
    for k in range(1000):
        near = 1e-9 if kind.contact_unknowns else 10 ** rng.uniform(-13, -9)
        *state, side, offset = random_contact(rng, near)
        direction = rng.normal(size=11) * ([1] * 8 + [bool(kind.contact_unknowns)] * 3)
        # tangent and derivative from one call: near an end, a last bit of the position moves both by 1e-7
        stepped, tangent = kind.contact.response(*along(direction, *state), side, offset)
        expected = stepped.imag / abs(STEP)
        assert len(expected) == 8 + kind.contact_unknowns
        moved = tangent.real @ direction[: len(tangent)]
        assert np.abs(moved - expected).max() <= 1e-8 * np.abs(expected).max()
        if kind.contact_unknowns and k < 100:
            assert np.abs(tangent - tangent.T).max() <= 1e-13 * np.abs(tangent).max()


@pytest.mark.parametrize("name", ["timoshenko", "euler-bernoulli-cantilever"])
@pytest.mark.parametrize("l0", [1e-200, 1e200])
def test_contact_whose_powers_of_the_length_cannot_be_stated_is_not_finite(l0, name):
    """Arrays overflow; plain numbers raise."""
    p, lever = Properties(l0, 0.0, l0, 1.0, 1.0, 0.1), (-0.3 * l0, 0.1 * l0)
    found = CLOSED_FORM[name].contact.response(p, [0.0] * 6, lever, 0.3, (0, 0), 1.0, 0.0)
    assert [part.shape for part in found if np.isnan(part).all()] == [(8,), (8, 8)]


def rod_energy(p, theta_i, theta_j, e, points=12):
    """Energy of a Reissner rod with given end rotations and elongation of its chord, by Ritz's method."""
    node, weight = np.polynomial.legendre.leggauss(points)
    s, weight = (node + 1) / 2, weight / 2
    GA = 12 * p.EI / (p.Phi * p.l0**2)
    powers = [np.polynomial.Polynomial([-1, 2]) ** k * np.polynomial.Polynomial([0, 1, -1]) for k in range(4)]
    bubbles, dbubbles = np.stack([f(s) for f in powers]), np.stack([f.deriv()(s) for f in powers])

    def functional(z):
        N, V, c = z[0], z[1], z[2:]
        theta = theta_i * (1 - s) + theta_j * s + c @ bubbles
        kappa = (theta_j - theta_i + c @ dbubbles) / p.l0
        along, across = N * np.cos(theta) + V * np.sin(theta), V * np.cos(theta) - N * np.sin(theta)
        inside = along + along**2 / (2 * p.EA) + across**2 / (2 * GA) - p.EI / 2 * kappa**2
        return N * (p.l0 + e) - p.l0 * (weight @ inside)

    def gradient(z):
        return np.array([functional(z + STEP * unit).imag / abs(STEP) for unit in np.eye(len(z))])

    z = root(gradient, np.zeros(6), tol=1e-14).x
    assert np.abs(gradient(z)).max() < 1e-9
    return functional(z)


@pytest.mark.parametrize("Phi", [0.05, 5.0])
@pytest.mark.parametrize(("power", "largest", "order"), [(2, 0.1, 6.0), (1, 0.025, 4.0)])
def test_energy_is_the_reissner_rods_to_fourth_order(power, largest, order, Phi):
    """Halving the rotations divides the energy's error by 2^6 where the elongation is of second order, by 2^4 where it is of first."""
    p = Properties(1.0, 0.0, 1.0, 50.0, 2.0, Phi)
    c = beam.bowed_coefficients(Properties(*(np.array([v]) for v in p)))
    errors = []
    for scale in (largest, largest / 2, largest / 4):
        theta_i, theta_j, e = 0.9 * scale, 0.3 * scale, 0.4 * scale**power
        m, h = (theta_i + theta_j) / 2, (theta_i - theta_j) / 2
        polynomial = (c.constant + c.of_mm * m * m + c.of_hh * h * h)[:2, 0]
        bending = float(c.constant[2, 0] * m * m + c.constant[3, 0] * h * h) / 2
        quartic = float(c.r4[0] * m**4 / 8 + c.r2[0] * m * m * h * h / 4)
        element_energy = (e + polynomial[0]) ** 2 / polynomial[1] / 2 + bending + quartic
        errors.append(abs(element_energy - rod_energy(p, theta_i, theta_j, e)))
    assert -np.diff(np.log2(errors)) == pytest.approx(order, abs=0.2)
