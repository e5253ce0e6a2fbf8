"""The exact element against itself seen otherwise: units, places, frames of reference, steps, numbers of elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import tsm
from tests.verification.structures import (
    KS,
    KS_PATH,
    SECTIONS,
    cantilever,
    dimensionless,
    essentials,
    oracle,
    places,
    raised,
    slip_offs,
    square,
    steps,
)
from tsm.rods.accuracy import deflected
from tsm.status import Status


def extreme(length, youngs_modulus):
    h = 0.02 * length
    section = tsm.Section.rectangle(
        width=h, height=h, youngs_modulus=youngs_modulus, shear_modulus=youngs_modulus / 2.6
    )
    return cantilever(((length, 0.0), (0.0, 2 * length / np.pi)), section=section, length=length)


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 5, pytest.param(50, marks=pytest.mark.slow)])
def test_units_do_not_matter(count, stated):
    """Lengths 1e-6 to 1e6 times Young's modulus 1e-6 to 1e15: the same iterations, the same dimensionless answer."""
    plain = tsm.solve(extreme(1.0, 1.0), steps(count))
    for length in (1e-6, 1e-3, 1.0, 1e3, 1e6):
        for youngs_modulus in (1e-6, 1.0, 1e5, 1e10, 1e15):
            result = tsm.solve(extreme(length, youngs_modulus), steps(count))
            assert np.array_equal(result.newton_iterations, plain.newton_iterations)
            error = np.abs(dimensionless(result) - dimensionless(plain)).max()
            assert error <= 1e-9
            stated("exact.units", error, part=True)


SLENDER, SHEAR = (10, 20, 50, 100, 1e3, 1e4, 1e5, 1e6), (1e-2, 1e-1, 1 / 2.6, 1e3, 1e12)
CORNERS = {(s, g) for s in (10, 1e6) for g in (1e-2, 1e12)}


@pytest.mark.parametrize(
    ("slenderness", "shear"),
    [pytest.param(s, g, marks=() if (s, g) in CORNERS else pytest.mark.slow) for s in SLENDER for g in SHEAR],
)
def test_slenderness_and_shear_modulus(slenderness, shear, stated):
    """KS with L/h from 10 to 1e6 and G/E from 1e-2 to 1e12: against the rod, in 50 steps and in one."""
    h = 1 / slenderness
    section = tsm.Section.rectangle(width=h, height=h, youngs_modulus=1.0, shear_modulus=shear)
    structure = cantilever(KS_PATH, section=section)
    result, exact = tsm.solve(structure, steps(50)), oracle(structure, steps(50))
    contact = result.contacts["p0->b"]
    differences = contact.force / exact.magnitude[1:] - 1, contact.arc_position - exact.arc_position[1:]
    error = np.abs(differences).max()
    assert error <= 1e-8
    stated("exact.slenderness", error, part=True)
    at_once = tsm.solve(structure, steps(1))
    assert at_once.newton_iterations.sum() <= 80
    assert np.abs(dimensionless(at_once)[-1] - dimensionless(result)[-1]).max() <= 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("section", SECTIONS)
def test_no_critical_area(section, stated):
    """Around the places of 11 elements' nodes, ten depths each: no cut-back, one and eleven elements agree.

    The contact force turns no further from one position to the next than the positions are apart.
    """
    stiffness, length = SECTIONS[section]
    nodes, count = 11, 0
    every = list(places(nodes, length, extra=(0.25, 0.75)))
    stated(f"exact.places-{section}", len(set().union(*every)))
    for around in every:
        last = None
        for x in sorted(set(around)):
            found = []
            for elements in (1, nodes):
                path = raised(x, 0.02 * length)
                structure = cantilever(path, section=stiffness, length=length, elements=elements)
                result = tsm.solve(structure, steps(10))
                assert result.cutbacks == 0
                assert max(e.residuals[-1] for e in result.equilibria) <= 1e-9
                found.append(dimensionless(result))
            count += len(found[0])
            assert np.abs(found[1] - found[0]).max() <= 1e-9 * np.abs(found[0]).max()
            force = np.array([e.state.touches[0].force for e in result.equilibria])
            angle = np.arctan2(force[:, 1], force[:, 0])
            if last is not None:
                apart = (x - last[0]) / length
                assert np.abs(angle - last[1]).max() <= 10 * apart + 1e-9
            last = x, angle
    assert count >= 3333


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize("elements", [1, 11])
@pytest.mark.parametrize("x", [5e-324, 1e-300, 1e-100, 1e-16, 1e-12, 1e-8, 1e-6, 1e-4])
def test_near_the_clamp(section, elements, x):
    """Raised by a part of the distance, which positions resolve to 1e-13 of the length: shear alone carries the force."""
    stiffness, length = SECTIONS[section]
    path = ((x * length, 0.0), (x * length, max(0.02 * x * length, 5e-324)))
    structure = cantilever(path, section=stiffness, length=length, elements=elements)
    result = tsm.solve(structure, steps(3))
    assert result.cutbacks == 0
    if x >= 1e-8:
        assert result.contacts["p0->b"].force[-1] == pytest.approx(0.02 * stiffness.GA, rel=1e-3)


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize("elements", [1, 11])
def test_near_the_tip(section, elements):
    """The slip-off is the rod's; the slid way is as depth^2, located to 1e-12, and a contact within 1e-10 of the tip is at the tip."""
    stiffness, length = SECTIONS[section]
    for x in (*(1 - 10.0 ** -np.arange(2, 16, 3)), 1 - 1e-9, 1 - 1e-10, np.nextafter(1.0, 0), 1.0):
        path = raised(x * length, 0.02 * length)
        structure = cantilever(path, section=stiffness, length=length, elements=elements)
        result = tsm.solve(structure, steps(3))
        expected = oracle(structure, steps(3)).slip_off
        squares = [(0.02 * t) ** 2 for t in slip_offs(result)]
        located = 5e-12 if 1 - x > 1.01e-10 else 2e-10
        assert squares == pytest.approx([] if np.isnan(expected) else [(0.02 * expected) ** 2], abs=located)


def random_pin(rng):
    x, angle, far = rng.uniform(0.2, 1.0), rng.uniform(0.02, 2.6), rng.uniform(0.15, 0.95)
    h = 10 ** -rng.uniform(1, 3)
    section = square(h)
    return cantilever(((x, 0.0), (far * np.cos(angle), far * np.sin(angle))), section=section)


@pytest.mark.slow
def test_random_pins_in_one_step_and_in_fifty():
    """200 random ways of a pin under random cantilevers: both end alike, with the same answer or the same status."""
    rng = np.random.default_rng(0)
    ends = []
    for _ in range(200):
        structure = random_pin(rng)
        once, fine = (tsm.solve(structure, steps(count), throw=False) for count in (1, 50))
        assert once.status is fine.status, structure
        assert essentials(once) == essentials(fine), structure
        ends.append(fine.status)
        if fine.status is Status.COMPLETED:
            a, b = (dimensionless(result)[-1] for result in (once, fine))
            assert np.array_equal(np.isnan(a), np.isnan(b)), structure
            assert np.nanmax(np.abs(a - b)) <= 1e-7 * (1 + np.nanmax(np.abs(b))), structure
    assert 100 <= ends.count(Status.COMPLETED) < 200


def test_strong_tension():
    """Clamped at both ends and pushed aside by a fifth of its length: against SciPy's boundary value solver for a half of it."""
    s, depth = KS, 0.2

    def rates(_, y, n):
        c, sn = np.cos(y[0]), np.sin(y[0])
        N, Q = n[0] * c + n[1] * sn, n[1] * c - n[0] * sn
        dx, dy = (1 + N / s.EA) * c - Q / s.GA * sn, (1 + N / s.EA) * sn + Q / s.GA * c
        return np.stack([y[1] / s.EI, n[0] * dy - n[1] * dx, dx, dy])

    def misses(a, b, _):
        return np.array([a[0], a[2], a[3], b[0], b[2] - 0.5, b[3] - depth])

    pushed = cantilever(raised(0.5, 0.2), elements=1, element="exact")
    clamps = (*pushed.supports, tsm.Support(beam="b", end="end"))
    result = tsm.solve(replace(pushed, supports=clamps), steps(4))
    rods, state = result.model.rods, result.equilibria[-1].state
    arc = np.linspace(0, 0.5, 401)
    at = deflected(rods, state).at(0, arc)
    guess = 1.001 * np.stack([at.angle, at.moment, *at.position.T])
    exact = solve_bvp(rates, misses, arc, guess, p=1.001 * at.force[0], tol=1e-10, max_nodes=100_000)
    assert exact.success
    assert exact.p[0] / s.EI > 500
    assert result.contacts["p0->b"].force[-1] == pytest.approx(2 * abs(exact.p[1]), rel=1e-9)
    assert result.supports["b.start"].moment[-1] == pytest.approx(-exact.y[1, 0], rel=1e-9)


def test_moved_support_is_a_moved_pin():
    """The support shifts and turns under a pin at rest: what an observer on the support sees is a moving pin."""
    shift, turn, place = np.array([0.1, -0.2]), 0.1, np.array([0.8, 0.0])
    rest = cantilever(((0.8, 0.0), (0.8, 1e-300)))
    support = tsm.Support(beam="b", end="start", ux=shift[0], uy=shift[1], rotation=turn)
    back = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    a = tsm.solve(replace(rest, supports=(support,)), steps(5))
    b = tsm.solve(cantilever(((0.8, 0.0), tuple((back @ (place - shift)).tolist()))), steps(5))
    pushed, pushing = a.contacts["p0->b"], b.contacts["p0->b"]
    assert pushing.force[-1] > 1e-4
    assert pushed.force[-1] == pytest.approx(pushing.force[-1], rel=1e-9)
    assert pushed.arc_position[-1] == pytest.approx(pushing.arc_position[-1], abs=1e-9)
    assert np.abs(back @ (a.tips["b"][-1] - shift) - b.tips["b"][-1]).max() <= 1e-9
