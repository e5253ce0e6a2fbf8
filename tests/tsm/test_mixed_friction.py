"""Coulomb friction in the contact law with the force as an unknown."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tsm.test_elements import STEP, random_contact, random_properties
from tsm.elements import mixed_contact, mixed_friction
from tsm.elements.contact_law import Rub, Surface
from tsm.elements.curve import Curve
from tsm.elements.properties import Properties

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


def test_a_force_across_the_beam_meets_the_frictionless_rows():
    """Without a component along the unloaded curve every row is the frictionless one, on the axis."""
    rng = np.random.default_rng(2)
    for _ in range(100):
        p, x, lever, xi, force, surface, rub = drawn(rng, stick=False)
        phi = Curve(p, x).slope_angle_jet(xi).value
        across = np.linalg.norm(force) * np.array([-np.sin(phi), np.cos(phi)])
        residual, _ = mixed_friction.response(p, x, lever, xi, across, surface, rub._replace(lean=0.0))
        expected, _ = mixed_contact.response(p, x, lever, xi, across, *surface)
        assert np.abs(residual - expected).max() <= 1e-13 * np.abs(expected).max()


@pytest.mark.parametrize("place", PLACES)
def test_slip_row_is_the_cone_of_friction(place):
    """The row vanishes where ``F_t = sigma mu F_n``, and nowhere else."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        p, x, lever, xi, force, surface, rub = drawn(rng, stick=False, place=place)
        residual, _ = mixed_friction.response(p, x, lever, xi, force, surface, rub)
        F_t, F_n, _ = mixed_friction.split(p, x, xi, force, surface, rub)
        assert np.hypot(F_t, F_n) == pytest.approx(np.hypot(*force), rel=1e-12)
        size = mixed_friction.slip(p, x, xi, force, surface, rub._replace(face=0.0, radius=0.0))[10]
        expected = rub.lean * surface.side * F_n - F_t
        assert np.sign(residual[10]) == np.sign(expected)
        if not rub.face:
            assert residual[10] == pytest.approx(size * expected, rel=1e-9)


@pytest.mark.parametrize("place", PLACES)
def test_a_stick_begins_with_no_residual(place):
    rng = np.random.default_rng(6)
    for _ in range(30):
        p, x, lever, xi, force, surface, rub = drawn(rng, stick=False, place=place)
        held = mixed_friction.hold(p, x, xi, force, surface, rub)
        residual, _ = mixed_friction.response(p, x, lever, xi, force, surface, held)
        assert abs(residual[10]) <= 1e-14 * held.unit * p.l0


@pytest.mark.parametrize("place", PLACES)
def test_stick_row_has_the_rate_of_the_slip(place):
    """Where a stick begins its row is the slip rate, so that nothing is dissipated to first order."""
    rng = np.random.default_rng(7)
    for _ in range(30):
        p, x, lever, xi, force, surface, rub = drawn(rng, stick=False, place=place)
        held = mixed_friction.hold(p, x, xi, force, surface, rub)
        _, tangent = mixed_friction.response(p, x, lever, xi, force, surface, held)
        form = mixed_friction.slip(p, x, xi, force, surface, held)
        form = form / (form[10] if place == "axis" else 1.0)
        assert np.abs(tangent[10] - held.unit * form).max() <= 1e-11 * held.unit * np.abs(form).max()


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


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("stick", [False, True])
def test_rows_turn_with_the_element(stick, place):
    """Under a rigid rotation of element, force, node and stick, forces turn and nothing else changes."""
    rng = np.random.default_rng(4)
    for _ in range(50):
        p, x, lever, xi, force, surface, rub = drawn(rng, stick=stick, place=place)
        angle = rng.uniform(-1, 1)
        c, s = np.cos(angle), np.sin(angle)
        Q = np.array([[c, -s], [s, c]])
        chord = np.array([p.dx0, p.dy0])
        d = Q @ (chord + x[3:5] - x[:2])
        turned = np.concatenate([Q @ x[:2], [x[2] + angle], Q @ x[:2] + d - chord, [x[5] + angle]])
        old, _ = mixed_friction.response(p, x, lever, xi, force, surface, rub)
        later = rub._replace(slope=rub.slope + angle)
        new, _ = mixed_friction.response(p, turned, Q @ lever, xi, Q @ force, surface, later)
        for pair in ([0, 1], [3, 4], [6, 7], [8, 9]):
            old[pair] = Q @ old[pair]
        # a turned element resolves its chord's angle to some last bits
        assert np.abs(new[:8] - old[:8]).max() <= 1e-11 * np.abs(old[:8]).max()
        assert np.abs(new[8:10] - old[8:10]).max() <= 1e-11 * p.l0
        assert new[10] == pytest.approx(old[10], rel=1e-9, abs=1e-10 * np.abs(old).max())


def timoshenko(p, x, xi, load):
    """Displacement (u, w, theta) at xi by a load there, and nodal loads, of two linear elements with held ends x; small x."""
    parts = []
    for length in (xi * p.l0, (1 - xi) * p.l0):
        Phi = p.Phi * (p.l0 / length) ** 2
        k = p.EI / (length**3 * (1 + Phi))
        K = np.zeros((6, 6))
        K[np.ix_([0, 3], [0, 3])] = p.EA / length * np.array([[1, -1], [-1, 1]])
        a, b = (4 + Phi) * length**2, (2 - Phi) * length**2
        l6 = 6 * length
        K[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = k * np.array(
            [[12, l6, -12, l6], [l6, a, -l6, b], [-12, -l6, 12, -l6], [l6, b, -l6, a]]
        )
        parts.append(K)
    whole = np.zeros((9, 9))
    whole[:6, :6] += parts[0]
    whole[3:, 3:] += parts[1]
    ends, inside = [0, 1, 2, 6, 7, 8], [3, 4, 5]
    moved = np.linalg.solve(whole[np.ix_(inside, inside)], load - whole[np.ix_(inside, ends)] @ x)
    return moved, whole[np.ix_(ends, ends)] @ x + whole[np.ix_(ends, inside)] @ moved


@pytest.mark.parametrize("place", ["axis", "face"])
def test_small_loads_deflect_as_a_linear_timoshenko_beam_of_two_elements(place):
    """Place of the node and nodal loads, by a force and its couple, to second order in the load."""
    rng = np.random.default_rng(9)
    for _ in range(30):
        l0 = float(10 ** rng.uniform(-1, 1))
        p = Properties(l0, 0.0, l0, *(10 ** rng.uniform(-2, 3, 3)))
        xi, side = float(rng.uniform(0.05, 0.95)), float(rng.choice([-1.0, 1.0]))
        face = PLACES[place][0] * l0
        rub, surface = Rub(0.2, None, 1.0, face, 0.0), Surface(side, face)
        errors = []
        for size in (1e-3, 1e-4):
            same = np.random.default_rng(10)
            x = size * same.normal(size=6) * np.array([l0, l0, 1, l0, l0, 1])
            scale = size / (mixed_contact.compliance(p, 0.5)[0] / l0 + 1 / p.EA)
            force = scale * same.normal(size=2)
            residual, _ = mixed_friction.response(p, x, (x[0], x[1]), xi, force, surface, rub)
            load = np.array([*force, side * face * force[0]])
            (u, w, theta), _ = timoshenko(p, x, xi, load)
            _, loads = timoshenko(p, np.zeros(6), xi, load)
            bent = mixed_friction.hold(p, x, xi, force, surface, rub)
            place_error = -residual[8:10] - (xi * l0 + u + side * face * bent.slope, w - side * face)
            nodal_error = (residual[:6] - loads) / np.array([1, 1, l0, 1, 1, l0]) / scale * size
            turn_error = bent.slope - bent.shear - theta
            errors.append([np.abs(place_error).max() / l0, np.abs(nodal_error).max(), abs(turn_error)])
        small, smaller = np.array(errors)
        assert (smaller <= 0.02 * small + 1e-12).all(), (small, smaller)


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


def test_rows_of_two_contacts_are_the_cones_of_their_tilted_tangents():
    """Each third row vanishes where the force along the beam, tilted by the other force, is ``sigma mu F_n``."""
    rng = np.random.default_rng(11)
    for _ in range(50):
        p, x, lever, _, _, _, _ = drawn(rng, stick=False)
        sides, xi = rng.choice([-1.0, 1.0], 2), rng.uniform(0.05, 0.95, 2)
        forces = 0.3 * rng.normal(size=(2, 2)) * p.EI / p.l0**2 / (1 + p.Phi)
        rubs = drawn_rub(rng, p, stick=False), drawn_rub(rng, p, stick=False)
        shared, _ = mixed_friction.crossing(p, tuple(xi), *forces, rubs)
        for own, other in ((0, 1), (1, 0)):
            surface, force = Surface(sides[own], 0.0), forces[own]
            residual, _ = mixed_friction.response(p, x, lever, xi[own], force, surface, rubs[own])
            rub = rubs[own]._replace(tilt=mixed_friction.tilt(p, xi[own], xi[other]) * forces[other])
            F_t, F_n, _ = mixed_friction.split(p, x, xi[own], force, surface, rub)
            size = mixed_friction.slip(p, x, xi[own], force, surface, rub)[10]
            expected = size * (rub.lean * sides[own] * F_n - F_t)
            assert residual[10] + shared[3 * own + 2] == pytest.approx(expected, rel=1e-9)


@pytest.mark.slow_at("face", "round on the face")
@pytest.mark.parametrize("place", ["face", "round", "round on the face"])
def test_a_stick_dissipates_of_third_order_in_its_size(place):
    """Work of F_t on the slip rate along a stick that rolls, for a path of the element's ends and of the node, and for its half."""
    rng = np.random.default_rng(12)
    ratios = []
    for _ in range(10):
        l0 = 1.0
        p = Properties(l0, 0.0, l0, 1e3, 1.0, float(10 ** rng.uniform(-2, 0)))
        x = 0.3 * rng.normal(size=6)
        face, radius = PLACES[place]
        surface = Surface(float(rng.choice([-1.0, 1.0])), face + radius)
        xi, force = float(rng.uniform(0.3, 0.7)), rng.normal(size=2)
        begin = Rub(0.0, None, 1.0, face, radius)
        rub = mixed_friction.hold(p, x, xi, force, surface, begin)
        residual, _ = mixed_friction.response(p, x, (0.0, 0.0), xi, force, surface, rub)
        lever, rate = residual[8:10], rng.normal(size=8)
        works = [_stick_work(size * rate, p, x, lever, xi, force, surface, rub) for size in (2e-4, 1e-4)]
        ratios.append(works[0] / works[1])
    assert np.median(ratios) == pytest.approx(8, rel=0.1)


def _stick_work(way, p, x, lever, xi, force, surface, rub):
    """Integral of F_t times the slip rate while ends and node move by `way`, by Gauss's rule on solved states."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    total = 0.0
    for part, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        moved, now = x + part * way[:6], lever + part * (way[:2] - way[6:])
        place, pushed = xi, force
        for _ in range(12):
            residual, tangent = mixed_friction.response(p, moved, now, place, pushed, surface, rub)
            step = np.linalg.solve(tangent[8:, 8:], -residual[8:])
            pushed, place = pushed + step[:2], place + step[2] / p.l0
        change = np.linalg.solve(tangent[8:, 8:], -tangent[8:, :8] @ way)
        F_t, _, _ = mixed_friction.split(p, moved, place, pushed, surface, rub)
        slip = mixed_friction.slip(p, moved, place, pushed, surface, rub)
        total += weight * F_t * (slip @ np.concatenate([way, change]))
    return total
