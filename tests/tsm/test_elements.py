"""Every element alone: gradients, tangents, limits, equivalences."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import root

from tsm.elements import CLOSED_FORM, beam, chord_contact, mixed_contact
from tsm.elements.curve import Curve
from tsm.elements.properties import Properties

STEP = 1e-30j
CHORD = [name for name, kind in CLOSED_FORM.items() if not kind.contact_unknowns]


def random_properties(rng, n=None):
    angle, l0 = rng.uniform(0, 2 * np.pi, n), 10 ** rng.uniform(-1, 1, n)
    EA, EI, Phi = (10 ** rng.uniform(low, high, n) for low, high in ((0, 3), (-2, 2), (-8, 2)))
    return Properties(l0 * np.cos(angle), l0 * np.sin(angle), l0, EA, EI, Phi)


def random_contact(rng):
    p = random_properties(rng)
    x = rng.normal(size=6) * np.array([0.1 * p.l0, 0.1 * p.l0, 0.4] * 2)
    d = np.array([p.dx0 + x[3] - x[0], p.dy0 + x[4] - x[1]])
    xi = rng.choice([rng.uniform(0.01, 0.99), 1e-9, 1 - 1e-9])
    lever = -(xi * d + 0.05 * rng.normal() * np.array([-d[1], d[0]]))
    return p, x, lever, xi, rng.normal(size=2), rng.choice([-1.0, 1.0]), rng.choice([0.0, 0.1 * p.l0])


def coefficients(name, p):
    kind = CLOSED_FORM[name]
    return kind.coefficients(kind.constants(p))


@pytest.mark.parametrize("name", CLOSED_FORM)
def test_beam_tangent_is_the_derivative_of_its_force(name):
    rng = np.random.default_rng(1)
    for _ in range(100):
        p = random_properties(rng, 10)
        c = coefficients(name, p)
        x, direction = rng.normal(size=(6, 10)) * 0.3, rng.normal(size=(6, 10))
        force, tangent = beam.response(c, x)
        tangent = tangent.reshape(6, 6, 10)
        stepped, _ = beam.response(c, x + STEP * direction)
        expected = stepped.imag / abs(STEP)
        assert (
            np.abs(np.einsum("ijn,jn->in", tangent, direction) - expected).max()
            <= 1e-12 * np.abs(expected).max()
        )
        assert np.abs(tangent - tangent.transpose(1, 0, 2)).max() <= 1e-13 * np.abs(tangent).max()
        assert force.shape == (6, 10)


@pytest.mark.parametrize("name", CHORD)
@pytest.mark.parametrize("l0", [1e-200, 1e200])
def test_contact_whose_powers_of_the_length_cannot_be_stated_is_not_finite(name, l0):
    p = Properties(l0, 0.0, l0, 1.0, 1.0, 0.1)
    gradient, tangent = CLOSED_FORM[name].contact.response(
        p, [0.0] * 6, (-0.3 * l0, 0.1 * l0), 0.3, (0, 0), 1.0, 0.0
    )
    assert np.isnan(gradient).any()
    assert np.isnan(tangent).any()


@pytest.mark.parametrize("name", CLOSED_FORM)
def test_contact_tangent_is_the_derivative_of_its_gradient(name):
    """1,000 random states, among them contacts within 1e-9 of both ends."""
    rng = np.random.default_rng(2)
    kind = CLOSED_FORM[name]
    for _ in range(1000):
        p, x, lever, xi, force, side, offset = random_contact(rng)
        direction = rng.normal(size=11 if kind.contact_unknowns else 8)
        slid = direction[10] / p.l0 if kind.contact_unknowns else 0.0
        pushed = direction[8:10] if kind.contact_unknowns else np.zeros(2)
        # tangent and derivative from one call: 1e-9 from an end, a last bit of the position moves both by 1e-7
        stepped, tangent = kind.contact.response(
            p,
            x + STEP * direction[:6],
            lever + STEP * (direction[:2] - direction[6:8]),
            xi + STEP * slid,
            force + STEP * pushed,
            side,
            offset,
        )
        expected = stepped.imag / abs(STEP)
        assert np.abs(tangent.real @ direction - expected).max() <= 1e-8 * np.abs(expected).max()


def test_mixed_contact_tangent_is_symmetric():
    rng = np.random.default_rng(3)
    for _ in range(100):
        _, tangent = mixed_contact.response(*random_contact(rng))
        assert np.abs(tangent - tangent.T).max() <= 1e-13 * np.abs(tangent).max()


def test_mixed_contact_gradient_is_the_derivative_of_its_energy():
    """With and without an offset, by central differences."""
    rng, h = np.random.default_rng(11), 1e-6
    for _ in range(100):
        p, x, lever, xi, force, side, offset = random_contact(rng)
        xi = min(max(xi, 0.01), 0.99)
        gradient, _ = mixed_contact.response(p, x, lever, xi, force, side, offset)
        direction = rng.normal(size=11)

        def energy(step, p=p, x=x, lever=lever, xi=xi, force=force, side=side, offset=offset, d=direction):
            moved = lever + step * (d[:2] - d[6:8])
            return mixed_contact.energy(
                p, x + step * d[:6], moved, xi + step * d[10] / p.l0, force + step * d[8:10], side, offset
            )

        slope = (energy(h) - energy(-h)) / (2 * h)
        # differences to second order: a step of 1e-6 of elements as short as 0.1
        scale = np.abs(gradient * direction).max() + abs(energy(0.0))
        assert gradient @ direction == pytest.approx(slope, abs=1e-7 * scale)


def clamped_deflection(Phi, xi, eta):
    """Deflection at xi by a unit force at eta of Timoshenko's beam with EI = l0 = 1 between clamps, from its equations.

    ``M = M0 + V0 s + <s - eta>``, ``theta' = M``, ``w' = theta - M' Phi/12``.
    """

    def at(s):
        past = max(s - eta, 0.0)
        rotation = np.array([s, s**2 / 2, past**2 / 2])
        return rotation, np.array([s**2 / 2, s**3 / 6 - Phi / 12 * s, past**3 / 6 - Phi / 12 * past])

    end = np.array(at(1.0))
    M0, V0 = np.linalg.solve(end[:, :2], -end[:, 2])
    return at(xi)[1] @ [M0, V0, 1.0]


def test_compliance_of_an_element_is_a_clamped_beams():
    rng = np.random.default_rng(12)
    for _ in range(100):
        p, (xi, eta) = random_properties(rng), rng.uniform(0.05, 0.95, 2)
        unit = p.l0**3 / p.EI
        across = mixed_contact.cross_compliance(p, xi, eta)[0]
        assert across == pytest.approx(unit * clamped_deflection(p.Phi, xi, eta), rel=1e-10)
        assert mixed_contact.cross_compliance(p, eta, xi)[0] == pytest.approx(across, rel=1e-14)
        below = mixed_contact.compliance(p, xi)[0]
        assert below == pytest.approx(unit * clamped_deflection(p.Phi, xi, xi), rel=1e-10)


def test_what_two_contacts_on_one_element_add_has_its_derivatives():
    """Of ``-C12 F_1 . F_2``, in force and arc position of either contact."""
    rng = np.random.default_rng(13)
    for _ in range(100):
        p, at, force = random_properties(rng), rng.uniform(0, 1, 2), rng.normal(size=(2, 2))
        d = rng.normal(size=6)
        xi, (first, second) = at + STEP * d[[2, 5]] / p.l0, force + STEP * d[[0, 1, 3, 4]].reshape(2, 2)
        gradient, tangent = mixed_contact.crossing(p, tuple(xi), first, second)
        value = -mixed_contact.cross_compliance(p, *xi)[0] * (first @ second)
        assert gradient.real @ d == pytest.approx(value.imag / abs(STEP), rel=1e-9)
        expected = gradient.imag / abs(STEP)
        assert np.abs(tangent.real @ d - expected).max() <= 1e-9 * np.abs(expected).max()


def test_contact_forces_of_an_element_balance_themselves():
    """Force and moment of element and node add up to nothing in any configuration."""
    rng = np.random.default_rng(5)
    for name, kind in CLOSED_FORM.items():
        for _ in range(100):
            p, x, lever, xi, force, side, offset = random_contact(rng)
            gradient, _ = kind.contact.response(p, x, lever, xi, force, side, offset)
            f = gradient[:8]
            d = np.array([p.dx0 + x[3] - x[0], p.dy0 + x[4] - x[1]])
            total = f[:2] + f[3:5] + f[6:8]
            moment = f[2] + f[5] + d[0] * f[4] - d[1] * f[3] - lever[0] * f[7] + lever[1] * f[6]
            bound = 1e-12 * np.abs(f).max() * (1 + p.l0)
            if not kind.contact_unknowns:
                assert max(np.abs(total).max(), abs(moment)) <= bound, name
                continue
            # out of equilibrium the node is not on the curve: the force acts over that distance
            assert np.abs(total).max() <= bound, name
            miss = gradient[8:10]
            assert abs(moment - (miss[0] * f[7] - miss[1] * f[6])) <= bound, name


@pytest.mark.parametrize("name", CLOSED_FORM)
def test_linear_beam_is_timoshenkos(name):
    """Bending stiffnesses (4 + Phi)/(1 + Phi) EI/l0 and (2 - Phi)/(1 + Phi) EI/l0; Euler-Bernoulli has Phi = 0."""
    p = Properties(*(np.array([value]) for value in (2.0, 0.0, 2.0, 30.0, 5.0, 0.7)))
    Phi = 0.0 if name.startswith("euler") else 0.7
    _, K = beam.response(coefficients(name, p), np.zeros((6, 1)))
    K = K.reshape(6, 6)
    assert K[2, 2] == pytest.approx((4 + Phi) / (1 + Phi) * 2.5, rel=1e-14)
    assert K[2, 5] == pytest.approx((2 - Phi) / (1 + Phi) * 2.5, rel=1e-14)
    assert K[0, 0] == pytest.approx(15.0, rel=1e-14)


def rod_energy(p, theta_i, theta_j, e, points=12):
    """Energy of a Reissner rod with given end rotations and elongation of its chord, by Ritz's method."""
    node, weight = np.polynomial.legendre.leggauss(points)
    s, weight = (node + 1) / 2, weight / 2
    GA = 12 * p.EI / (p.Phi * p.l0**2)
    bubbles = np.stack([s * (1 - s) * (2 * s - 1) ** k for k in range(4)])
    dbubbles = np.stack(
        [
            (1 - 2 * s) * (2 * s - 1) ** k + 2 * k * s * (1 - s) * (2 * s - 1) ** max(k - 1, 0)
            for k in range(4)
        ]
    )

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


@pytest.mark.parametrize("Phi", [0.05, 0.8, 5.0])
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
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx(order, abs=0.2), (errors, orders)


def integral_over_the_element(density, theta, field, xi, l0):
    """Integral of a polynomial in theta whose coefficients are constant along the element."""
    terms = sp.Poly(density, theta).terms()
    return l0 * sum(c * sp.integrate(sp.expand(field**power), (xi, 0, 1)) for (power,), c in terms)


@pytest.mark.slow
def test_the_six_coefficients_are_those_of_the_theory():
    """Reissner's functional at Timoshenko's rotation, by sympy up to the fourth degree in N, V and the rotation.

    ``N (l0 + e) - integral (N_s + N_s^2/2EA + Q_s^2/2GA - EI theta'^2/2)`` is stationary in N, V and theta. Its part of second
    degree gives V and the rotation of Timoshenko's beam. They serve for the higher degrees as well: what they miss is of third
    degree where N is of second, and changes the stationary value in the sixth only. ``N a - N^2 f/2`` is ``a^2/2f`` at its largest.
    """
    l0, EA, EI, GA, Phi = sp.symbols("l0 EA EI GA Phi", positive=True)
    e, m, h, xi, N, V, P, theta, size = sp.symbols("e m h xi N V P theta size")
    field = m + h - 2 * h * xi + P * xi * (1 - xi)
    along = size * N * sp.cos(size * theta) + size * V * sp.sin(size * theta)
    across = size * V * sp.cos(size * theta) - size * N * sp.sin(size * theta)
    density = along + along**2 / (2 * EA) + across**2 / (2 * GA)
    by_degree = [
        integral_over_the_element(density.diff(size, k).subs(size, 0) / sp.factorial(k), theta, field, xi, l0)
        for k in range(5)
    ]
    bending = EI / (2 * l0) * sp.integrate(sp.expand(sp.diff(field, xi) ** 2), (xi, 0, 1))

    of_second_degree = bending - by_degree[2].subs(N, 0)
    timoshenko = sp.solve([of_second_degree.diff(V), of_second_degree.diff(P)], [V, P], dict=True)[0]
    shear = {GA: 12 * EI / (Phi * l0**2)}
    timoshenko = {letter: sp.cancel(value.subs(shear)) for letter, value in timoshenko.items()}
    derived = (N * (l0 + e) + bending - sum(by_degree)).subs(timoshenko).subs(shear)

    D, v, B = 1 / shear[GA] - 1 / EA, -12 * EI / (l0**2 * (1 + Phi)), -6 / (1 + Phi)
    assert sp.cancel(timoshenko[V] - v * m) == 0
    assert sp.cancel(timoshenko[P] - B * m) == 0
    sm, sh = l0 * (1 + B / 2 + B**2 / 10 + B**3 / 140), l0 * (1 + B / 10)
    stated = {
        "e_m": l0 * (1 - 5 * Phi**2) / (10 * (1 + Phi) ** 2) + 12 * EI * Phi / (l0 * EA * (1 + Phi) ** 2),
        "e_h": l0 / 6,
        "c_m": D * l0 * (1 + 5 * Phi**2) / (5 * (1 + Phi) ** 2),
        "c_h": D * l0 / 3,
    }
    stated["r_4"] = v * sm / 6 + v**2 * stated["c_m"] / 2
    stated["r_2"] = v * sh / 6 + v**2 * stated["c_h"] / 2
    lengthening = e + stated["e_m"] * m**2 + stated["e_h"] * h**2
    flexibility = l0 / EA + stated["c_m"] * m**2 + stated["c_h"] * h**2
    linear = 6 * EI * m**2 / (l0 * (1 + Phi)) + 2 * EI * h**2 / l0
    formula = N * lengthening - N**2 * flexibility / 2 + linear
    formula += stated["r_4"] * m**4 + stated["r_2"] * m**2 * h**2
    assert sp.cancel(derived - formula) == 0

    values = {l0: 1.3, EA: 50.0, EI: 2.0, Phi: 0.8}
    c = beam.bowed_coefficients(Properties(*(np.array([v]) for v in (1.3, 0.0, 1.3, 50.0, 2.0, 0.8))))
    coded = (c.e[0] / 2, c.e[1] / 2, c.c[0], c.c[1], c.r4 / 8, c.r2 / 4)
    for number, coefficient in zip(coded, stated.values(), strict=True):
        assert float(number[0]) == pytest.approx(float(coefficient.subs(values)), rel=1e-13)


@pytest.mark.parametrize("xi", [1e-6, 0.1, 0.37, 0.5, 0.93])
@pytest.mark.parametrize("Phi", [1e-9, 0.3, 40.0])
def test_eliminating_the_force_gives_the_papers_matrix(xi, Phi):
    """``k + g g^T / C`` with the chord-normal gap's gradient g is [P] (9), corrected, to round-off."""
    p = Properties(1.3, 0.0, 1.3, 10.0, 2.0, Phi)
    k = p.EI / p.l0 / (1 + Phi) * np.array([[4 + Phi, 2 - Phi, 0], [2 - Phi, 4 + Phi, 0], [0, 0, 0]])
    half = Phi / 2
    w = p.l0 * xi * (1 - xi) / (1 + Phi) * np.array([1 - xi + half, -(xi + half), 0])
    g = np.array([0.0, 0.0, 1.0]) - w
    C = mixed_contact.compliance(p, xi)[0]
    K, _ = chord_contact.timoshenko(p, xi)
    assert np.abs(K - (k + np.outer(g, g) / C)).max() <= 1e-12 * np.abs(K).max()


def test_printed_entry_of_the_paper_has_the_wrong_dimension():
    """The entry M_i-theta_j of (9) scales with lengths only as corrected."""
    for factor in (2.0, 10.0):
        small, large = (Properties(s, 0.0, s, 1.0, s * s, 0.5) for s in (1.0, factor))
        corrected = [chord_contact.timoshenko(p, 0.3)[0][0, 1] for p in (small, large)]
        printed = []
        for p in (small, large):
            a, b, Psi = 0.3 * p.l0, 0.7 * p.l0, p.Phi * p.l0**2 / 12
            omega = (a * b) ** 2 + 3 * Psi * (p.l0**2 + a * b) + 36 * Psi**2
            printed.append((9 * (p.l0**2 - b * Psi) - omega) * p.EI / (p.l0 * omega))
        assert corrected[1] / corrected[0] == pytest.approx(factor, rel=1e-12)
        assert abs(printed[1] / printed[0] / factor - 1) > 0.1


def test_compliance_vanishes_at_both_ends_and_matches_its_limits():
    bending = Properties(2.0, 0.0, 2.0, 1.0, 3.0, 1e-14)
    assert mixed_contact.compliance(bending, 0.0)[0] == 0
    assert mixed_contact.compliance(bending, 1.0)[0] == 0
    assert mixed_contact.compliance(bending, 0.5)[0] == pytest.approx(2.0**3 / (192 * 3.0), rel=1e-12)
    shear = Properties(2.0, 0.0, 2.0, 1.0, 3.0, 1e9)
    GA = 12 * 3.0 / (1e9 * 4.0)
    assert mixed_contact.compliance(shear, 0.25)[0] == pytest.approx(0.5 * 1.5 / (2.0 * GA), rel=1e-8)


def test_curve_meets_the_nodes_in_position_and_slope():
    """Without shear the tangent at an end is the node's rotation, whatever its size: slopes are continuous."""
    rng = np.random.default_rng(6)
    for _ in range(50):
        p = random_properties(rng)._replace(Phi=1e-15)
        x = rng.normal(size=6) * np.array([0.05 * p.l0, 0.05 * p.l0, 0.5] * 2)
        curve = Curve(p, x)
        start = np.arctan2(p.dy0, p.dx0)
        for xi, theta in ((0.0, x[2]), (1.0, x[5])):
            assert curve.deflection(xi)[0] == 0
            angle = curve.slope_angle_jet(xi).value
            assert np.cos(angle - start - theta) == pytest.approx(1, abs=1e-14)


def test_slopes_of_the_axis_are_the_rotations_plus_the_shear_strain():
    """``w' = theta + gamma``, with the shear strain ``V/GA`` of Timoshenko's element."""
    rng = np.random.default_rng(14)
    for _ in range(50):
        p = random_properties(rng)
        x = rng.normal(size=6) * np.array([0.05 * p.l0, 0.05 * p.l0, 0.2] * 2)
        curve = Curve(p, x)
        chord = np.arctan2(curve.dy, curve.dx) - np.arctan2(p.dy0, p.dx0)
        theta = np.array([np.arctan2(np.sin(x[k] - chord), np.cos(x[k] - chord)) for k in (2, 5)])
        GA = 12 * p.EI / (p.Phi * p.l0**2)
        gamma = -12 * p.EI / (p.l0**2 * (1 + p.Phi)) * theta.mean() / GA
        for xi, rotation in zip((0.0, 1.0), theta, strict=True):
            assert curve.deflection(xi)[1] == pytest.approx(np.tan(rotation + gamma), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_surface_is_on_the_side_that_the_node_comes_from(side):
    """On a straight beam along +x a node from the right, below, touches at ``-offset``, one from the left at ``+offset``."""
    p = Properties(2.0, 0.0, 2.0, 10.0, 3.0, 0.4)
    # without a force the entries of the force are the node's place less the surface's
    gradient, _ = mixed_contact.response(p, np.zeros(6), (0.0, 0.0), 0.3, (0.0, 0.0), side, 0.1)
    assert -gradient[8:10] == pytest.approx([0.6, -side * 0.1], abs=1e-15)
