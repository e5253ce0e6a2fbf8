"""The exact element against itself seen otherwise: units, places, frames of reference, steps, numbers of elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import tsm
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tests.verification.structures import (
    KS,
    KS_PATH,
    SECTIONS,
    cantilever,
    dimensionless,
    double_beam,
    essentials,
    forces,
    mirrored,
    moved,
    oracle,
    places,
    raised,
    slip_offs,
    square,
    steps,
    swapped,
)
from tsm.events import EventKind
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


@pytest.mark.slow_at("ks-cantilever-1.0-20", "ks-face-1.0-20")
@pytest.mark.parametrize(
    ("name", "t", "count"), [("ks-cantilever", 1.0, 20), ("ks-face", 1.0, 20), ("double-beam", 0.5, 3)]
)
def test_objectivity(name, t, count):
    """Random rigid motions change no force and no moment by more than 1e-10 of the largest."""
    rng = np.random.default_rng(11)
    structure, at = to_structure(load_scene(name), element="exact"), np.array([t / 2, t])
    plain = forces(tsm.solve(structure, at))
    for _ in range(count):
        found = forces(tsm.solve(moved(structure, rng.uniform(-np.pi, np.pi), rng.normal(size=2)), at))
        assert np.abs(found - plain).max() <= 1e-10 * np.abs(plain).max()


@pytest.mark.parametrize("offset", [0.0, 0.01])
def test_end_swap_and_mirror(offset):
    """The beam named from its other end, or everything mirrored, which takes the node to the other side: the same force."""
    structure = cantilever(((0.9, -offset), (0.5, 0.4)), offset=offset)
    plain = tsm.solve(structure, steps(2))
    for other, sign in ((swapped(structure), 1), (mirrored(structure), -1)):
        found = tsm.solve(other, steps(2))
        assert found.contacts["p0->b"].force == pytest.approx(plain.contacts["p0->b"].force, rel=1e-10)
        (clamp,), (held,) = found.supports.values(), plain.supports.values()
        assert clamp.moment == pytest.approx(sign * held.moment, rel=1e-10)


@pytest.mark.parametrize("section", [KS, tsm.Section(EA=30.0, GA=10.0, EI=1.0)])
def test_work_of_the_pin_is_the_strain_energy(section):
    """Gauss quadrature of the pin's power on the way of KS, on a slender and on a slack section."""
    gauss, weight = np.polynomial.legendre.leggauss(40)
    t = np.append((gauss + 1) / 2, 1.0)
    structure = cantilever(KS_PATH, section=section)
    result = tsm.solve(structure, t)
    velocity = np.array(structure.pins[0].velocity(0.5, 0.5))
    power = -result.supports["b.start"].force @ velocity
    assert result.strain_energy[-1] == pytest.approx(weight @ power[:-1] / 2, rel=1e-9)


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


@pytest.mark.slow_at("1", "10", "2", "3", "5")
@pytest.mark.parametrize("count", [1, 2, 3, 5, 10, 20])
def test_one_step_does_not_jump_to_another_branch(count):
    """A way with two equilibria at its end: any number of steps finds the one that the path leads to."""
    h = 1 / 282.2200575929289
    section = square(h)
    path = ((0.28473698936585956, 0.0), (-0.0375565617870191, 0.45278450670873704))
    fine = tsm.solve(cantilever(path, section=section), steps(200))
    found = tsm.solve(cantilever(path, section=section), steps(count))
    assert np.abs(dimensionless(found)[-1] - dimensionless(fine)[-1]).max() <= 1e-9
    assert fine.strain_energy[-1] / section.EI == pytest.approx(6.1627844667, rel=1e-9)


@pytest.mark.parametrize("elements", [3, 10])
def test_passing_from_element_to_element_leaves_no_trace(elements):
    section, length = SECTIONS["4.1"]
    for path, given in ((KS_PATH, {}), (raised(2.9, 1.7), {"section": section, "length": length})):
        one = tsm.solve(cantilever(path, **given), steps(20))
        many = tsm.solve(cantilever(path, elements=elements, **given), steps(20))
        assert np.abs(dimensionless(many) - dimensionless(one)).max() <= 1e-9
        assert essentials(many) == []
        assert {e.kind for e in many.events} == {EventKind.PASS_THROUGH}


def two_pins(elements, element="exact", offset=0.0):
    """One from below, one from above."""
    structure = cantilever(
        ((0.5, -offset), (0.5, 0.2)),
        ((0.9, offset), (0.9, 0.1)),
        elements=elements,
        element=element,
        offset=offset,
    )
    below, above = structure.contacts
    return replace(structure, contacts=(below, replace(above, side="left")))


def clamped_at_both_ends(elements, element="exact"):
    structure = cantilever(raised(0.5, 0.2), elements=elements, element=element)
    return replace(structure, supports=(*structure.supports, tsm.Support(beam="b", end="end")))


def frame(elements, element="exact"):
    """Portal with a hinge, pushed down by a pin on its girder, a force and a moment at a corner."""
    corners = ((0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0))
    beams = tuple(
        tsm.Beam(name=name, start=a, end=b, section=KS, elements=elements, element=element)
        for name, a, b in zip(("left", "girder", "right"), corners, corners[1:], strict=False)
    )
    return tsm.Structure(
        beams=beams,
        supports=(tsm.Support(beam="left", end="start"), tsm.Support(beam="right", end="end", rotation=None)),
        pins=(tsm.Pin(name="p0", path=((0.5, 1.02), (0.6, 0.9))),),
        contacts=(tsm.ContactPair(node="p0", beam="girder", side="left"),),
        loads=(tsm.Load(beam="left", end="end", force=(2e-4, -3e-4), moment=1e-5),),
    )


def on_the_face(elements, element="exact"):
    return two_pins(elements, element, offset=0.01)


@pytest.mark.parametrize("make", [two_pins, on_the_face, clamped_at_both_ends, frame, "double beam"])
def test_one_element_is_as_good_as_four(make):
    """Several contacts on one element, none on it, offsets on both sides, tension, joints."""
    build = (lambda elements: double_beam(elements=elements)) if make == "double beam" else make
    t = steps(10) * (0.65 if make == "double beam" else 1.0)
    one, four = (tsm.solve(build(elements), t) for elements in (1, 4))
    assert max(abs(contact.force[-1]) for contact in one.contacts.values()) > 1e-4
    assert np.abs(forces(one) - forces(four)).max() <= 1e-9 * np.abs(forces(one)).max()
    for name, tip in one.tips.items():
        assert np.abs(tip - four.tips[name]).max() <= 1e-9


@pytest.mark.parametrize("make", [two_pins, on_the_face, frame])
def test_mixed_converges_to_it(make):
    """Another element on the same structure: the error falls sixteenfold with every halving, down to its floor."""
    exact = forces(tsm.solve(make(1), steps(5)))
    errors = [np.abs(forces(tsm.solve(make(n, "mixed"), steps(5))) - exact).max() for n in (10, 40)]
    errors = np.array(errors) / np.abs(exact).max()
    assert errors[1] <= 5e-6
    assert errors[0] > 10 * errors[1]


def test_exact_and_mixed_in_one_structure():
    """An exact girder on columns of the other element lies between the two frames of one kind, in error and in answer."""
    plain, mixed = frame(1), frame(40, "mixed")
    joined = replace(plain, beams=(mixed.beams[0], plain.beams[1], mixed.beams[2]))
    a, b, c = (forces(tsm.solve(structure, steps(5))) for structure in (plain, mixed, joined))
    assert 0 < np.abs(c - a).max() <= 1e-6 * np.abs(a).max()
    assert np.abs(c - a).max() <= 2 * np.abs(b - a).max()


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

    result = tsm.solve(clamped_at_both_ends(1), steps(4))
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


@pytest.mark.parametrize("count", [4, 40])
def test_a_pin_that_backs_off(count):
    """Up and down again: touched and released at the same height, the same forces both ways, nothing left behind."""
    path = ((0.8, -0.1), (0.8, 0.3), (0.8, -0.1))
    result = tsm.solve(cantilever(path), steps(count))
    assert essentials(result) == [(EventKind.TOUCH, "p0->b"), (EventKind.RELEASE, "p0->b")]
    assert [e.load_parameter for e in result.events] == pytest.approx([0.125, 0.875], abs=1e-9)
    force = result.contacts["p0->b"].force[:-1]
    assert np.abs(force - force[::-1]).max() <= 1e-9 * force.max()
    assert force[-1] == 0 or count == 4
    assert np.abs(result.tips["b"][-1] - [1.0, 0.0]).max() <= 1e-10
