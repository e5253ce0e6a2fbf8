"""Beams under a pin against the rod and the literature, and what a node that slides along a beam must not notice: beam nodes and steps."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from comparisons.exact import rod_under_pin
from comparisons.models import solve
from comparisons.models.tsm import to_structure
from comparisons.scene import load_scene
from tests.oracles.coupled import pair_of
from tests.tsm.structures import KS_PATH, essentials, kinds, raised, steps, when
from tests.tsm.structures import cantilever as made

PINS = (4.05, 4.1, 4.2, 4.3, 4.35, 4.4)
"""Places of the pin in [P] 4.1."""
EXAMPLES = {"4.1": "cantilever-critical-area", "4.2": "ks-cantilever", "4.3": "double-beam"}
BEAMS = {example: to_structure(load_scene(scene)).beams[0] for example, scene in EXAMPLES.items()}
SECTIONS = {example: (beam.section, beam.length) for example, beam in BEAMS.items()}
"""Sections and lengths of the beams of [P]."""
KS = BEAMS["4.2"].section
SECTION, LENGTH = SECTIONS["4.1"]
TOUCH, RELEASE, OFF = tsm.EventKind.TOUCH, tsm.EventKind.RELEASE, tsm.EventKind.SLIP_OFF


def cantilever(*paths, section=KS, element="exact", **more):
    return made(*paths, section=section, element=element, **more)


def square(height):
    return tsm.Section.rectangle(width=height, height=height, youngs_modulus=1.0, shear_modulus=1 / 2.6)


def oracle(structure, t):
    """The rod at load parameters, from comparisons.exact."""
    beam, pin = structure.beams[0], structure.pins[0]
    points = [pin.position(x) for x in (0.0, *t)]
    s = beam.section
    return rod_under_pin(points, EA=s.EA, GA=s.GA, EI=s.EI, length=beam.length)


def dimensionless(result):
    """Force, arc position and clamp moment, tip, over the beam's own units; shape (steps, 5)."""
    beam = result.model.structure.beams[0]
    (contact,), EI, L = result.contacts.values(), beam.section.EI, beam.length
    moment = next(iter(result.supports.values())).moment
    found = [contact.force * L**2 / EI, contact.arc_position / L, moment * L / EI]
    return np.stack([*found, *result.tips[beam.name].T / L], axis=1)


def places(elements, length, extra=()):
    """Places on and beside every node of a mesh: one unit in the last place, 1e-16 to 1e-1 of an element, the middle, and `extra`."""
    powers = 10.0 ** np.arange(-16, 0)
    away = np.concatenate([[0.0, 0.5], powers, -powers, extra])
    for node in range(1, elements):
        x0 = length * node / elements
        yield [*(x0 + away * length / elements).tolist(), np.nextafter(x0, 0), np.nextafter(x0, 9)]


def mixed(path, *, section="4.1", elements=18, element="mixed"):
    stiffness, length = SECTIONS[section]
    return cantilever(tuple(path), section=stiffness, length=length, elements=elements, element=element)


@pytest.mark.parametrize("x", PINS)
def test_slip_off_displacements(x, stated):
    """Within 1e-5 of the rod, which is of the third power of the shear strain there, with 18 and with 72 elements."""
    found = [when(tsm.solve(mixed(raised(x, 2.0), elements=n), steps(20)), OFF)[0] for n in (18, 72)]
    exact = oracle(mixed(raised(x, 2.0)), [1.0]).slip_off
    error = np.abs(np.array(found) / exact - 1).max()
    assert error <= 1e-5
    stated("sliding.slip-off", error, part=True)


@pytest.mark.slow
@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_no_critical_area(element, section, stated):
    """Around the places of 11 elements' nodes, ten depths each: the same tolerance everywhere, no cut-back."""
    length = SECTIONS[section][1]
    exact, count = element == "exact", 0
    every = list(places(11, length, extra=(0.25, 0.75) if exact else ()))
    number = len(set().union(*every))
    stated(f"exact.places-{section}", number) if exact else stated(f"sliding.places-{section}", number)
    for around in every:
        last = None
        for x in sorted(set(around)):
            path, found = raised(float(x), 0.02 * length), []
            for elements in (1, 11) if exact else (11,):
                result = tsm.solve(
                    mixed(path, section=section, elements=elements, element=element), steps(10)
                )
                assert result.cutbacks == 0
                assert max(e.residuals[-1] for e in result.equilibria) <= 1e-9
                found.append(dimensionless(result))
            count += len(found[0])
            if not exact:
                continue
            assert np.abs(found[1] - found[0]).max() <= 1e-9 * np.abs(found[0]).max()
            force = np.array([e.state.touches[0].force for e in result.equilibria])
            angle = np.arctan2(force[:, 1], force[:, 0])
            if last is not None:
                assert np.abs(angle - last[1]).max() <= 10 * (x - last[0]) / length + 1e-9
            last = x, angle
    assert count >= 3250


@pytest.mark.slow
def test_a_thousand_cycles_leave_nothing_behind(stated):
    """Touch, push .05 and release, again and again: the same force and the same straight beam to 1e-10."""
    cycles = 1000
    path = [(4.1, -0.05), *([(4.1, 0.05), (4.1, -0.05)] * cycles)]
    result = tsm.solve(mixed(path), steps(2 * cycles))
    force = result.contacts["p0->b"].force
    drift = np.abs(force[0::2] / force[0] - 1).max()
    assert drift <= 1e-10
    stated("sliding.cycles", drift, bound=True)
    assert (force[1::2] == 0).all()
    assert np.abs(result.tips["b"][1::2] - [LENGTH, 0.0]).max() <= 1e-10 * LENGTH
    assert kinds(result) == [TOUCH, RELEASE] * cycles


@pytest.mark.slow_at("0.00303014214-path0")
@pytest.mark.parametrize(
    ("height", "path"),
    [
        (0.00303014214, ((0.9773519805, 0.0), (-0.3390120922, 0.7057013676))),
        (0.0854887241, ((0.7927555626, 0.0), (-0.08104586997, 0.6300149440))),
        (0.01212944359, ((0.5395708677, 0.0), (0.06041369545, 0.9213513552))),
    ],
)
def test_a_beam_that_is_let_go_far_over_falls_to_rest(height, path, stated):
    """At the slip-off no dead load in place of the contact has an equilibrium nearby; exact elements jump to the same energy."""
    results = [
        tsm.solve(cantilever(path, section=square(height), element=name), steps(50))
        for name in ("mixed", "exact")
    ]
    slips = [next(e for e in r.events if e.kind is OFF) for r in results]
    assert slips[0].load_parameter == pytest.approx(slips[1].load_parameter, abs=1e-5)
    error = abs(slips[0].released / slips[1].released - 1)
    assert error <= 1e-5
    stated("sliding.released", error, part=True)
    assert results[0].strain_energy[-1] <= 1e-12 * slips[0].released


def test_what_many_elements_leave_on_the_ks_cantilever(stated):
    structure = cantilever(KS_PATH, section=KS, elements=640, element="mixed")
    exact = oracle(structure, steps(5)).magnitude[1:]
    assert 0.4 * (exact.max() / KS.GA) ** 3 == pytest.approx(4.5e-10, rel=0.01)
    force = tsm.solve(structure, steps(5)).contacts["p0->b"].force
    stated("ks.many-elements", np.abs(force - exact).max() / exact.max())


@pytest.mark.parametrize(("place", "order", "factors"), [(0.5, 4, (10, 25)), (0.4137, 2, (0.3, 0.7))])
def test_order_between_the_nodes_of_a_stretched_strip(place, order, factors):
    """Fourth order where the pin is at a node, second order between nodes: the kink of a contact's own shear is not stretched with the axis."""
    section = tsm.Section.rectangle(width=1.0, height=0.02, youngs_modulus=1e5, shear_modulus=1e5 / 2.6)
    supports = tuple(tsm.Support(beam="b", end=end) for end in ("start", "end"))

    def force(**mesh):
        structure = cantilever(raised(place, 0.05), section=section, supports=supports, **mesh)
        return tsm.solve(structure, steps(10)).contacts["p0->b"].force[-1]

    exact = force(elements=2)
    assert exact / section.EI == pytest.approx(50, rel=0.05)
    for n in (16, 32):
        error = abs(force(elements=n, element="mixed") / exact - 1)
        assert factors[0] <= error * n**order <= factors[1]


@pytest.mark.slow_at("40")
@pytest.mark.parametrize("elements", [3, 10, 40])
def test_refinement_against_the_coupled_rods(elements, stated):
    scene, t = load_scene("double-beam"), np.array([0.31, 0.45]) / 0.76
    exact = pair_of(scene).stage(0.76 * t)
    contacts = tsm.solve(to_structure(scene, elements=elements), t).contacts
    pairs = (("upper.end->lower", exact.tip_force), ("pin->upper", exact.pin_force))
    stated(f"double-beam.mixed-{elements}", np.abs([contacts[pair].force / np.hypot(*force.T) - 1 for pair, force in pairs]).max())  # fmt: skip


@pytest.mark.slow_at("ks-face-50")
@pytest.mark.parametrize("count", [2, 5, 50, pytest.param(500, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["ks-cantilever", "ks-face"])
def test_ks_in_any_number_of_steps(name, count, stated):
    """From the straight beam to the end in at most 80 iterations, the same end with 2, 5, 50, 500 load parameters, and at each of 50 the rod."""
    scene = load_scene(name)
    structure = to_structure(scene, element="exact")
    once, result = (tsm.solve(structure, steps(n)) for n in (1, count))
    assert once.newton_iterations.sum() <= 80
    assert result.cutbacks == 0 or count < 50
    assert once.events == result.events == ()
    error = np.abs(dimensionless(result)[-1] - dimensionless(once)[-1]).max()
    assert error <= 1e-9
    stated("ks.any-steps", error, part=True)
    if count == 50:
        if name == "ks-cantilever":
            stated("ks.iterations", result.newton_iterations.sum())
        rod = solve(scene, "rod")
        (contact,), (expected,) = result.contacts.values(), rod.contacts.values()
        moment = result.supports["cantilever.start"].moment / rod.supports["cantilever.start"].moment - 1
        arc, force = contact.arc_position - expected.arc_position, contact.force / expected.force - 1
        parts = (force, arc, moment, result.tips["cantilever"] - rod.tips["cantilever"])
        error = max(np.abs(part).max() for part in parts)
        assert error <= 1e-9
        stated("exact.ks", error, part=True)


@pytest.mark.slow_at("4.1", "4.2", "4.3", "4.35", "4.4")
@pytest.mark.parametrize("x", PINS)
def test_41_at_60_depths_and_its_slip_off(x, stated):
    given = {"section": SECTION, "length": LENGTH}
    slip_off = 2.0 * oracle(cantilever(raised(x, 2.0), **given), [1.0]).slip_off
    below = cantilever(raised(x, 0.98 * slip_off), **given)
    contact, exact = tsm.solve(below, steps(60)).contacts["p0->b"], oracle(below, steps(60))
    off = contact.force / exact.magnitude[1:] - 1, contact.arc_position - exact.arc_position[1:]
    error = np.abs(off).max()
    assert error <= 1e-9
    stated("exact.4.1", error, part=True)
    for count in (1, 20):
        over = tsm.solve(cantilever(raised(x, 2.0), **given), steps(count))
        assert essentials(over) == [(OFF, "p0->b")]
        error = abs(2.0 * when(over, OFF)[0] / slip_off - 1)
        assert error <= 1e-9
        stated("exact.4.1-slip-off", error, part=True)
        assert np.abs(over.tips["b"][-1] - [LENGTH, 0.0]).max() <= 1e-9


def test_near_the_tip():
    """The slip-off is the rod's; the slid way is as depth^2, located to 1e-12, and a contact within 1e-10 of the tip is at the tip."""
    for section, length in SECTIONS.values():
        for x in (0.99, 1 - 1e-5, 1 - 1e-9, 1 - 1e-10, np.nextafter(1.0, 0), 1.0):
            path = raised(x * length, 0.02 * length)
            structure = cantilever(path, section=section, length=length, elements=11)
            squares = [(0.02 * t) ** 2 for t in when(tsm.solve(structure, steps(3)), OFF)]
            expected = oracle(structure, steps(3)).slip_off
            located = 5e-12 if 1 - x > 1.01e-10 else 2e-10
            assert squares == pytest.approx(
                [] if np.isnan(expected) else [(0.02 * expected) ** 2], abs=located
            )
