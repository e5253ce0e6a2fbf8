"""The exact element, one per beam, against the rod, the elastica, closed forms and itself seen otherwise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import tsm
from comparisons.claims.problems.frames import lee_limit
from comparisons.exact import elastica
from comparisons.exact.coupled import coupled_rods
from comparisons.exact.end_loads import tip_under_dead_load
from comparisons.exact.rod import rod_under_pin
from comparisons.models import solve as solve_scene
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tsm.events import EventKind
from tsm.rods.accuracy import deflected
from tsm.status import Status

PINS = (4.05, 4.1, 4.2, 4.3, 4.35, 4.4)
KS = tsm.Section.rectangle(width=0.02, height=0.02, youngs_modulus=2.1e4, shear_modulus=2.1e4 / 2.6)
SECTIONS = {
    "4.1": (tsm.Section(EA=2.1e11 * 0.005, GA=7.5e10 * 0.005, EI=2.1e11 * 0.001), 4.5),
    "4.2": (KS, 1.0),
    "4.3": (tsm.Section(EA=2e7 * 3e-4, GA=7.142e6 * 3e-4, EI=2e7 * 2.2e-8), 1.0),
}
STIFF = tsm.Section(EA=KS.EA * 1e10, GA=KS.GA * 1e10, EI=KS.EI)


def steps(count):
    return np.arange(1, count + 1) / count


def cantilever(
    *paths, section=KS, length=1.0, elements=1, element="exact", side="right", offset=0.0, load=None
):
    """Cantilever along x under pins that follow paths."""
    names = [f"p{k}" for k in range(len(paths))]
    beam = tsm.Beam(
        name="b", start=(0.0, 0.0), end=(length, 0.0), section=section, elements=elements, element=element
    )
    return tsm.Structure(
        beams=(beam,),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=tuple(tsm.Pin(name=name, path=path) for name, path in zip(names, paths, strict=True)),
        contacts=tuple(tsm.ContactPair(node=name, beam="b", side=side, offset=offset) for name in names),
        loads=(load,) if load else (),
    )


def raised(x, depth):
    return ((x, 0.0), (x, depth))


def oracle(structure, t):
    """The rod at load parameters, from comparisons.exact."""
    beam, pin = structure.beams[0], structure.pins[0]
    points = [pin.position(x) for x in (0.0, *t)]
    s = beam.section
    return rod_under_pin(
        points, EA=s.EA, GA=s.GA, EI=s.EI, length=beam.length, offset=structure.contacts[0].offset
    )


def dimensionless(result):
    """Force, arc position and clamp moment, tip, over the beam's own units; shape (steps, 5)."""
    beam = result.model.structure.beams[0]
    (contact,), EI, L = result.contacts.values(), beam.section.EI, beam.length
    found = [contact.force * L**2 / EI, contact.arc_position / L, result.supports[beam.name].moment * L / EI]
    return np.stack([*found, *result.tips[beam.name].T / L], axis=1)


def slip_offs(result):
    return [e.load_parameter for e in result.events if e.kind is EventKind.SLIP_OFF]


def essentials(result):
    return [(e.kind, e.pair) for e in result.events if e.kind is not EventKind.PASS_THROUGH]


@pytest.fixture(scope="module", params=["ks-cantilever", "ks-face"])
def ks_scene(request):
    return load_scene(request.param)


def test_ks_at_every_load_parameter(ks_scene):
    rod = solve_scene(ks_scene, "rod")
    result = tsm.solve(to_structure(ks_scene, element="exact"), steps(50))
    (contact,), (expected,) = result.contacts.values(), rod.contacts.values()
    assert len(result.model.element) == 1
    assert result.cutbacks == 0
    assert contact.force == pytest.approx(expected.force, rel=1e-9)
    assert contact.arc_position == pytest.approx(expected.arc_position, abs=1e-9)
    moment = rod.supports["cantilever"].moment
    assert result.supports["cantilever"].moment == pytest.approx(moment, rel=1e-9)
    assert np.abs(result.tips["cantilever"] - rod.tips["cantilever"]).max() <= 1e-9


@pytest.mark.parametrize("count", [2, 5, 50, pytest.param(500, marks=pytest.mark.slow)])
def test_ks_in_any_number_of_steps(ks_scene, count):
    """The path followed from the straight beam to its end in at most 80 iterations, and the same end with 2, 5, 50, 500 load parameters."""
    structure = to_structure(ks_scene, element="exact")
    once, result = (tsm.solve(structure, steps(n)) for n in (1, count))
    assert once.newton_iterations.sum() <= 80
    assert result.cutbacks == 0 or count < 50
    assert once.events == result.events == ()
    assert np.abs(dimensionless(result)[-1] - dimensionless(once)[-1]).max() <= 1e-9


@pytest.fixture(scope="module")
def slip_off_41():
    """Displacement at which the six pins of 4.1 slip off the rod."""
    section, length = SECTIONS["4.1"]
    rods = [oracle(cantilever(raised(x, 2.0), section=section, length=length), [1.0]) for x in PINS]
    return dict(zip(PINS, (2.0 * rod.slip_off for rod in rods), strict=True))


@pytest.mark.parametrize(
    "x", [x if x in {4.05, 4.2, 4.4} else pytest.param(x, marks=pytest.mark.slow) for x in PINS]
)
def test_41_at_60_depths_and_its_slip_off(x, slip_off_41):
    section, length = SECTIONS["4.1"]
    depth = 0.98 * slip_off_41[x]
    structure = cantilever(raised(x, depth), section=section, length=length)
    contact, exact = tsm.solve(structure, steps(60)).contacts["p0->b"], oracle(structure, steps(60))
    assert contact.force == pytest.approx(exact.magnitude[1:], rel=1e-9)
    assert contact.arc_position == pytest.approx(exact.arc_position[1:], abs=1e-9)
    for count in (1, 20):
        over = tsm.solve(cantilever(raised(x, 2.0), section=section, length=length), steps(count))
        assert essentials(over) == [(EventKind.SLIP_OFF, "p0->b")]
        assert 2.0 * slip_offs(over)[0] == pytest.approx(slip_off_41[x], rel=1e-9)
        assert np.abs(over.tips["b"][-1] - [length, 0.0]).max() <= 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("x", PINS)
def test_41_map(x, slip_off_41):
    """20 step counts from 1 to 500: all complete, with and without slip-off, and no answer depends on the count."""
    section, length = SECTIONS["4.1"]
    counts = (1, 2, 3, 4, 5, 6, 8, 10, 13, 18, 25, 35, 50, 70, 100, 140, 200, 270, 370, 500)
    ends = []
    for count in counts:
        below = tsm.solve(cantilever(raised(x, 0.8), section=section, length=length), steps(count))
        ends.append(dimensionless(below)[-1])
        over = tsm.solve(cantilever(raised(x, 2.0), section=section, length=length), steps(count))
        assert 2.0 * slip_offs(over)[0] == pytest.approx(slip_off_41[x], rel=1e-9)
    assert np.abs(np.array(ends) - ends[0]).max() <= 1e-9


DOUBLE_BEAM_EVENTS = [
    (EventKind.TOUCH, "upper.end->lower"),
    (EventKind.SLIP_OFF, "pin->upper"),
    (EventKind.TOUCH, "pin->lower"),
    (EventKind.RELEASE, "upper.end->lower"),
    (EventKind.SLIP_OFF, "pin->lower"),
]


def double_beam(element="exact", elements=None):
    return to_structure(load_scene("double-beam"), element=element, elements=elements)


@pytest.fixture(scope="module")
def double():
    return tsm.solve(double_beam(), steps(76))


def coupled(depths):
    s = SECTIONS["4.3"][0]
    return coupled_rods(depths, EA=s.EA, GA=s.GA, EI=s.EI, length=1.0, spacing=0.2, pin_x=0.8)


def test_double_beam_stages(double):
    """Every stage with one element per beam: single rod, coupled rods, single rod, nothing."""
    assert len(double.model.element) == 2
    assert essentials(double) == DOUBLE_BEAM_EVENTS
    depth = 0.76 * double.load_parameter
    stage = (depth > 0.15) & (depth < 0.537)
    exact = coupled(depth[stage])
    pin, tip = double.contacts["pin->upper"], double.contacts["upper.end->lower"]
    assert pin.force[stage] == pytest.approx(np.hypot(*exact.pin_force.T), rel=1e-8)
    assert tip.force[stage] == pytest.approx(np.hypot(*exact.tip_force.T), rel=1e-8)
    assert pin.arc_position[stage] == pytest.approx(exact.pin_arc, abs=1e-8)
    assert tip.arc_position[stage] == pytest.approx(exact.tip_arc, abs=1e-8)
    moments = np.stack([double.supports[name].moment[stage] for name in ("upper", "lower")], axis=1)
    assert np.abs(moments + exact.clamp_moments).max() <= 1e-8 * np.abs(moments).max()
    first, second = (0.76 * e.load_parameter for e in double.events[:2])
    assert first == pytest.approx(exact.touch_depth, abs=1e-8)
    assert second == pytest.approx(exact.end_depth, abs=1e-8)
    for stage, name, above in (
        (depth < 0.149, "pin->upper", 0.0),
        ((depth > 0.54) & (depth < 0.735), "pin->lower", 0.2),
    ):
        single = cantilever(raised(0.8, 0.6), section=SECTIONS["4.3"][0])
        rod = oracle(single, (depth[stage] - above) / 0.6)
        assert double.contacts[name].force[stage] == pytest.approx(rod.magnitude[1:], rel=1e-9)
        assert double.contacts[name].arc_position[stage] == pytest.approx(rod.arc_position[1:], abs=1e-9)
    leave = 0.76 * double.events[-1].load_parameter - 0.2
    assert leave == pytest.approx(0.6 * oracle(single, [1.0]).slip_off, rel=1e-9)
    assert np.abs(double.tips["lower"][depth > 0.74] - [1.0, -0.2]).max() <= 1e-9


@pytest.mark.parametrize("count", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 7))])
def test_double_beam_in_few_steps(double, count):
    """The coupled stage and the stage after the hand-over, each reached in any number of steps."""
    for end, k in ((50, 49), (70, 69)):
        result = tsm.solve(double_beam(), steps(count) * end / 76)
        for name, contact in result.contacts.items():
            assert contact.force[-1] == pytest.approx(double.contacts[name].force[k], rel=1e-9, abs=1e-12)
        assert essentials(result) == DOUBLE_BEAM_EVENTS[: len(essentials(result))]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_double_beam_events_do_not_depend_on_the_steps(double, count):
    """The whole path in one step meets what 76 steps meet."""
    result = tsm.solve(double_beam(), steps(count))
    assert essentials(result) == DOUBLE_BEAM_EVENTS
    assert [e.load_parameter for e in result.events] == pytest.approx(
        [e.load_parameter for e in double.events], abs=1e-9
    )


def test_mixed_converges_to_exact(double):
    """Root mean square over the coupled stage: fourth order down to 1e-7, below that slower but on to zero."""
    stage, errors, pairs = slice(15, 53), [], ("pin->upper", "upper.end->lower")
    for elements in (4, 8, 32):
        mixed = tsm.solve(double_beam("mixed", elements), steps(76)[:53])
        found, exact = ([r.contacts[pair].force[stage] for pair in pairs] for r in (mixed, double))
        errors.append(np.sqrt(((np.array(found) / np.array(exact) - 1) ** 2).mean(axis=1)))
    coarse, middle, fine = np.array(errors)
    assert (np.abs(np.log2(coarse / middle) - 4) <= 0.4).all(), errors
    assert (fine <= 1e-8).all()


def test_elastica_ks():
    """Theory's digits: KS with stretch and shear ten decades stiffer."""
    result = tsm.solve(cantilever(((1.0, 0.0), (0.0, 2 / np.pi)), section=STIFF), steps(4))
    contact = result.contacts["p0->b"]
    forces = [1.0618903425414, 4.66473101966107, 9.71796028591865, 8.18212814018414]
    arcs = [0.77007264053193, 0.612622877902267, 0.615457399152221, 0.895721692009856]
    assert contact.force / STIFF.EI == pytest.approx(forces, rel=1e-9)
    assert contact.arc_position == pytest.approx(arcs, rel=1e-9)
    assert result.supports["b"].moment[-1] / STIFF.EI == pytest.approx(-np.pi, rel=1e-9)
    assert np.abs(result.tips["b"][-1] - [-0.0831776691, 0.6995120682]).max() <= 1e-9


@pytest.mark.parametrize("count", [1, 20])
def test_elastica_pin_raised(count):
    """Pin at x = 1 raised by .1, .5, 1 and 2: beyond the force's limit point on the way."""
    depths = np.array([0.1, 0.5, 1.0, 2.0])
    t = np.union1d(steps(count), depths / 2)
    result = tsm.solve(cantilever(raised(1.0, 2.0), section=STIFF, length=4.0), t)
    contact, at = result.contacts["p0->b"], np.searchsorted(t, depths / 2)
    forces = [0.29571289218498, 1.08567496017108, 1.09558778157338, 0.57107081850518]
    arcs = [1.00598720165807, 1.14277139402601, 1.50936725404006, 2.5669307701048]
    assert contact.force[at] / STIFF.EI == pytest.approx(forces, rel=1e-9)
    assert contact.arc_position[at] == pytest.approx(arcs, rel=1e-9)


@pytest.mark.parametrize("x", [0.8, 0.9, 0.95, 0.99])
def test_elastica_slip_off(x):
    for count in (1, 10):
        result = tsm.solve(cantilever(raised(x, 1.0), section=STIFF), steps(count))
        assert slip_offs(result) == pytest.approx([elastica.slip_off_displacement(x)], rel=1e-9)


def top(x, y):
    """Greatest value and its place of the polynomial through samples about a maximum."""
    middle = x.mean()
    fit = np.polynomial.Polynomial.fit(x - middle, y, len(x) - 1)
    turn = next(r.real for r in fit.deriv().roots() if abs(r.imag) < 1e-12 and abs(r) < np.ptp(x) / 2)
    return fit(turn), turn + middle


def test_elastica_limit_points():
    """Greatest contact force, and greatest load of frictionless three-point bending (half of it)."""
    for limit, support in (
        (elastica.contact_force_limit(), False),
        (elastica.three_point_bending_limit(), True),
    ):
        depth = limit.displacement + 0.06 * np.cos(np.pi * (np.arange(13) + 0.5) / 13)[::-1]
        result = tsm.solve(cantilever(raised(1.0, 1.0), section=STIFF, length=3.0), depth)
        force = -2 * result.supports["b"].force[:, 1] if support else result.contacts["p0->b"].force
        load, displacement = top(depth, force / STIFF.EI)
        assert load == pytest.approx(limit.load, rel=1e-9)
        assert displacement == pytest.approx(limit.displacement, abs=1e-8)


@pytest.mark.parametrize("load", [1.0, 2.0, 5.0, 10.0])
def test_elastica_dead_load(load):
    tip = tsm.Load(beam="b", end="end", force=(0.0, load * STIFF.EI))
    result = tsm.solve(cantilever(section=STIFF, load=tip), steps(2))
    assert np.abs(result.tips["b"][-1] - tip_under_dead_load(load)).max() <= 1e-9


@pytest.mark.parametrize(("turns", "elements"), [(1, 1), (2, 2), (2, 1)])
def test_roll_up(turns, elements):
    """Full circles under an end moment, on a slack and on a stiff section; a circular arc on the way."""
    for section in (tsm.Section(EA=1.0, GA=1.0, EI=1.0), KS, STIFF):
        load = tsm.Load(beam="b", end="end", moment=2 * np.pi * turns * section.EI)
        result = tsm.solve(cantilever(section=section, elements=elements, load=load), steps(8))
        angle = 2 * np.pi * turns * result.load_parameter
        exact = np.stack([np.sin(angle) / angle, (1 - np.cos(angle)) / angle], axis=1)
        assert np.abs(result.tips["b"] - exact).max() <= 1e-9
        assert result.shape("b", -1)[-1, 2] == pytest.approx(2 * np.pi * turns, rel=1e-9)


def lees_frame(element, elements):
    """Column and girder of 120 cm, hinged at their far ends; the load 24 cm from the corner, at a joint of the girder."""
    section = tsm.Section(EA=4320.0, GA=4.32e9, EI=1440.0)
    corner, loaded = (0.0, 120.0), (24.0, 120.0)
    places = {
        "column": ((0.0, 0.0), corner, elements),
        "near": (corner, loaded, max(1, elements // 4)),
        "far": (loaded, (120.0, 120.0), elements),
    }
    return tsm.Structure(
        beams=tuple(
            tsm.Beam(name=name, start=start, end=end, section=section, elements=n, element=element)
            for name, (start, end, n) in places.items()
        ),
        supports=(
            tsm.Support(beam="column", end="start", rotation=None),
            tsm.Support(beam="far", end="end", rotation=None),
        ),
        loads=(tsm.Load(beam="near", end="end", force=(0.0, -0.1)),),
    )


def limit_load(element, elements, accuracy=1e-9):
    """``P L^2/EI`` at the first limit point."""
    settings = tsm.Settings(accuracy=accuracy)
    count = 20 * (2 + elements) if element == "mixed" else 25
    result = tsm.trace(lees_frame(element, elements), arc_length=0.3, steps=count, settings=settings)
    events = [e.load_parameter for e in result.events if e.kind is EventKind.LIMIT_POINT]
    return events[0] * 0.1 * 120**2 / 1440


def test_lees_frame():
    """Limit load 18.556 727 534, which exact rods coupled by shooting have too; Lee, Manuel & Rossow (1968) give 18.557."""
    found = limit_load("exact", 1)
    assert found == pytest.approx(limit_load("exact", 1, 1e-13), rel=1e-8)
    assert found == pytest.approx(limit_load("exact", 4), rel=1e-8)
    assert found == pytest.approx(lee_limit(), abs=1e-8)
    coarse, fine = limit_load("mixed", 8), limit_load("mixed", 16)
    assert abs(found - fine) <= 1e-5
    assert found == pytest.approx(fine + (fine - coarse) / 15, abs=0.1 * abs(fine - coarse) / 15)


def extreme(length, youngs_modulus):
    h = 0.02 * length
    section = tsm.Section.rectangle(
        width=h, height=h, youngs_modulus=youngs_modulus, shear_modulus=youngs_modulus / 2.6
    )
    return cantilever(((length, 0.0), (0.0, 2 * length / np.pi)), section=section, length=length)


@pytest.mark.parametrize("count", [1, 5, pytest.param(50, marks=pytest.mark.slow)])
def test_units_do_not_matter(count):
    """Lengths 1e-6 to 1e6 times Young's modulus 1e-6 to 1e15: the same iterations, the same dimensionless answer."""
    plain = tsm.solve(extreme(1.0, 1.0), steps(count))
    for length in (1e-6, 1e-3, 1.0, 1e3, 1e6):
        for youngs_modulus in (1e-6, 1.0, 1e5, 1e10, 1e15):
            result = tsm.solve(extreme(length, youngs_modulus), steps(count))
            assert np.array_equal(result.newton_iterations, plain.newton_iterations)
            assert np.abs(dimensionless(result) - dimensionless(plain)).max() <= 1e-9


SLENDER, SHEAR = (10, 20, 50, 100, 1e3, 1e4, 1e5, 1e6), (1e-2, 1e-1, 1 / 2.6, 1e3, 1e12)
CORNERS = {(s, g) for s in (10, 1e6) for g in (1e-2, 1e12)}


@pytest.mark.parametrize(
    ("slenderness", "shear"),
    [pytest.param(s, g, marks=() if (s, g) in CORNERS else pytest.mark.slow) for s in SLENDER for g in SHEAR],
)
def test_slenderness_and_shear_modulus(slenderness, shear):
    """KS with L/h from 10 to 1e6 and G/E from 1e-2 to 1e12: against the rod, in 50 steps and in one."""
    h = 1 / slenderness
    section = tsm.Section.rectangle(width=h, height=h, youngs_modulus=1.0, shear_modulus=shear)
    structure = cantilever(((1.0, 0.0), (0.0, 2 / np.pi)), section=section)
    result, exact = tsm.solve(structure, steps(50)), oracle(structure, steps(50))
    contact = result.contacts["p0->b"]
    assert contact.force == pytest.approx(exact.magnitude[1:], rel=1e-8)
    assert contact.arc_position == pytest.approx(exact.arc_position[1:], abs=1e-8)
    at_once = tsm.solve(structure, steps(1))
    assert at_once.newton_iterations.sum() <= 80
    assert np.abs(dimensionless(at_once)[-1] - dimensionless(result)[-1]).max() <= 1e-8


def offsets():
    """(x - x_node)/l beside a node: 1e-16 to 1e-1 on both sides, on it, the quarters."""
    powers = 10.0 ** np.arange(-16, 0)
    return np.concatenate([-powers, [0.0], powers, [0.25, 0.5, 0.75]])


@pytest.mark.slow
@pytest.mark.parametrize("section", SECTIONS)
def test_no_critical_area(section):
    """Around the places of 11 elements' nodes, ten depths each, 10,000 in all: no cut-back, one and eleven elements agree.

    The contact force turns no further from one position to the next than the positions are apart.
    """
    stiffness, length = SECTIONS[section]
    nodes, count = 11, 0
    for node in range(1, nodes):
        x0 = length * node / nodes
        around = {*(x0 + offsets() * length / nodes), np.nextafter(x0, 0), np.nextafter(x0, 9)}
        last = None
        for x in sorted(float(x) for x in around):
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


def turned(structure, angle, shift):
    """Structure after a rigid motion."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def place(point):
        return tuple((turn @ np.array(point) + shift).tolist())

    return replace(
        structure,
        beams=tuple(replace(b, start=place(b.start), end=place(b.end)) for b in structure.beams),
        pins=tuple(replace(pin, path=tuple(place(point) for point in pin.path)) for pin in structure.pins),
    )


def forces(result):
    """Contact forces and support moments, which no rigid motion changes."""
    contacts = [contact.force for contact in result.contacts.values()]
    return np.array([*contacts, *(support.moment for support in result.supports.values())])


@pytest.mark.parametrize(
    ("name", "t", "count"), [("ks-cantilever", 1.0, 20), ("ks-face", 1.0, 20), ("double-beam", 0.5, 3)]
)
def test_objectivity(name, t, count):
    """Random rigid motions change no force and no moment by more than 1e-10 of the largest."""
    rng = np.random.default_rng(11)
    structure, at = to_structure(load_scene(name), element="exact"), np.array([t / 2, t])
    plain = forces(tsm.solve(structure, at))
    for _ in range(count):
        moved = turned(structure, rng.uniform(-np.pi, np.pi), rng.normal(size=2))
        found = forces(tsm.solve(moved, at))
        assert np.abs(found - plain).max() <= 1e-10 * np.abs(plain).max()


@pytest.mark.parametrize("offset", [0.0, 0.01])
def test_end_swap_and_mirror(offset):
    """The beam named from its other end, or everything mirrored, which takes the node to the other side: the same force."""
    path = ((0.9, -offset), (0.5, 0.4))
    structure = cantilever(path, offset=offset)
    plain = tsm.solve(structure, steps(2))
    left = (tsm.ContactPair(node="p0", beam="b", side="left", offset=offset),)
    swapped = replace(
        structure,
        beams=(replace(structure.beams[0], start=(1.0, 0.0), end=(0.0, 0.0)),),
        supports=(tsm.Support(beam="b", end="end"),),
        contacts=left,
    )
    mirror = (tsm.Pin(name="p0", path=tuple((x, -y) for x, y in path)),)
    for other, sign in ((swapped, 1), (replace(structure, pins=mirror, contacts=left), -1)):
        found = tsm.solve(other, steps(2))
        assert found.contacts["p0->b"].force == pytest.approx(plain.contacts["p0->b"].force, rel=1e-10)
        assert found.supports["b"].moment == pytest.approx(sign * plain.supports["b"].moment, rel=1e-10)


@pytest.mark.parametrize("section", [KS, tsm.Section(EA=30.0, GA=10.0, EI=1.0)])
def test_work_of_the_pin_is_the_strain_energy(section):
    """Gauss quadrature of the pin's power on the way of KS, on a slender and on a slack section."""
    gauss, weight = np.polynomial.legendre.leggauss(40)
    t = np.append((gauss + 1) / 2, 1.0)
    structure = cantilever(((1.0, 0.0), (0.0, 2 / np.pi)), section=section)
    result = tsm.solve(structure, t)
    velocity = np.array(structure.pins[0].velocity(0.5, 0.5))
    power = -result.supports["b"].force @ velocity
    assert result.strain_energy[-1] == pytest.approx(weight @ power[:-1] / 2, rel=1e-9)


def random_pin(rng):
    x, angle, far = rng.uniform(0.2, 1.0), rng.uniform(0.02, 2.6), rng.uniform(0.15, 0.95)
    h = 10 ** -rng.uniform(1, 3)
    section = tsm.Section.rectangle(width=h, height=h, youngs_modulus=1.0, shear_modulus=1 / 2.6)
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


@pytest.mark.parametrize("count", [1, 2, 3, 5, 10, 20])
def test_one_step_does_not_jump_to_another_branch(count):
    """A way with two equilibria at its end: any number of steps finds the one that the path leads to."""
    h = 1 / 282.2200575929289
    section = tsm.Section.rectangle(width=h, height=h, youngs_modulus=1.0, shear_modulus=1 / 2.6)
    path = ((0.28473698936585956, 0.0), (-0.0375565617870191, 0.45278450670873704))
    fine = tsm.solve(cantilever(path, section=section), steps(200))
    found = tsm.solve(cantilever(path, section=section), steps(count))
    assert np.abs(dimensionless(found)[-1] - dimensionless(fine)[-1]).max() <= 1e-9
    assert fine.strain_energy[-1] / section.EI == pytest.approx(6.1627844667, rel=1e-9)


@pytest.mark.parametrize("elements", [3, 10])
def test_passing_from_element_to_element_leaves_no_trace(elements):
    ks, (section, length) = ((1.0, 0.0), (0.0, 2 / np.pi)), SECTIONS["4.1"]
    for path, given in ((ks, {}), (raised(2.9, 1.7), {"section": section, "length": length})):
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
    assert result.supports["b"].moment[-1] == pytest.approx(-exact.y[1, 0], rel=1e-9)


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
