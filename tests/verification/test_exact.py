"""The exact element, one per beam, against the rod, the elastica and closed forms, and against itself seen otherwise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.models import solve as solve_scene
from comparisons.models.options import Options
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tests.tsm.structures import KS_PATH, essentials, raised, steps
from tests.verification.structures import (
    KS,
    LENGTH,
    PINS,
    SECTION,
    SECTIONS,
    cantilever,
    dimensionless,
    divided,
    double_beam,
    elastica,
    frames,
    limit_points,
    off_rod,
    oracle,
    pair_of,
    slip_offs,
    tip_under_dead_load,
)  # fmt: skip

TOUCH, RELEASE, OFF = tsm.EventKind.TOUCH, tsm.EventKind.RELEASE, tsm.EventKind.SLIP_OFF
STIFF = tsm.Section(EA=KS.EA * 1e10, GA=KS.GA * 1e10, EI=KS.EI)


@pytest.fixture(scope="module", params=["ks-cantilever", "ks-face"])
def ks_scene(request):
    return load_scene(request.param)


@pytest.mark.slow_at("ks-face")
def test_ks_at_every_load_parameter(ks_scene, stated):
    rod = solve_scene(ks_scene, "rod")
    result = tsm.solve(to_structure(ks_scene, element="exact"), steps(50))
    (contact,), (expected,) = result.contacts.values(), rod.contacts.values()
    moment = result.supports["cantilever.start"].moment / rod.supports["cantilever.start"].moment
    differences = (
        contact.force / expected.force - 1,
        contact.arc_position - expected.arc_position,
        moment - 1,
        result.tips["cantilever"] - rod.tips["cantilever"],
    )
    error = max(np.abs(part).max() for part in differences)
    assert error <= 1e-9
    stated("exact.ks", error, part=True)


@pytest.mark.parametrize("count", [2, 5, 50, pytest.param(500, marks=pytest.mark.slow)])
def test_ks_in_any_number_of_steps(ks_scene, count, stated):
    """The path followed from the straight beam to its end in at most 80 iterations, and the same end with 2, 5, 50, 500 load parameters."""
    structure = to_structure(ks_scene, element="exact")
    once, result = (tsm.solve(structure, steps(n)) for n in (1, count))
    assert once.newton_iterations.sum() <= 80
    assert result.cutbacks == 0 or count < 50
    if count == 50 and ks_scene.name == "ks-cantilever":
        stated("ks.iterations", result.newton_iterations.sum())
    assert once.events == result.events == ()
    error = np.abs(dimensionless(result)[-1] - dimensionless(once)[-1]).max()
    assert error <= 1e-9
    stated("ks.any-steps", error, part=True)


@pytest.mark.slow_at("4.1", "4.2", "4.3", "4.35", "4.4")
@pytest.mark.parametrize("x", PINS)
def test_41_at_60_depths_and_its_slip_off(x, stated):
    given = {"section": SECTION, "length": LENGTH}
    slip_off = 2.0 * oracle(cantilever(raised(x, 2.0), **given), [1.0]).slip_off
    _, error = off_rod(cantilever(raised(x, 0.98 * slip_off), **given), steps(60))
    assert error <= 1e-9
    stated("exact.4.1", error, part=True)
    for count in (1, 20):
        over = tsm.solve(cantilever(raised(x, 2.0), **given), steps(count))
        assert essentials(over) == [(OFF, "p0->b")]
        error = abs(2.0 * slip_offs(over)[0] / slip_off - 1)
        assert error <= 1e-9
        stated("exact.4.1-slip-off", error, part=True)
        assert np.abs(over.tips["b"][-1] - [LENGTH, 0.0]).max() <= 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("x", PINS)
def test_41_map(x, stated):
    """Step counts from 1 to 500: all complete, with and without slip-off, and no answer depends on the count."""
    given, ends, slipped = {"section": SECTION, "length": LENGTH}, [], []
    counts = (1, 2, 3, 4, 5, 6, 8, 10, 13, 18, 25, 35, 50, 70, 100, 140, 200, 270, 370, 500)
    for count in counts:
        below, over = (tsm.solve(cantilever(raised(x, depth), **given), steps(count)) for depth in (0.8, 2.0))
        ends.append(dimensionless(below)[-1])
        slipped += slip_offs(over)
    assert slipped == pytest.approx([slipped[0]] * len(counts), rel=1e-9)
    error = np.abs(np.array(ends) - ends[0]).max()
    assert error <= 1e-9
    stated("exact.step-counts", len(counts))
    stated("exact.4.1-map", error, part=True)


@pytest.mark.parametrize(("element", "elements", "bound"), [("exact", 1, 1e-8), ("mixed", 10, 1e-6)])
def test_double_beam_stages(element, elements, bound, stated):
    """Every stage: single rod, coupled rods, single rod, nothing."""
    scene = load_scene("double-beam")
    double = tsm.solve(to_structure(scene, element=element, elements=elements), steps(76))
    upper, tip, lower = (
        double.contacts[name] for name in (double_beam.UPPER, double_beam.TIP, double_beam.LOWER)
    )
    expected = [(TOUCH, double_beam.TIP), (OFF, double_beam.UPPER), (TOUCH, double_beam.LOWER), (RELEASE, double_beam.TIP), (OFF, double_beam.LOWER)]  # fmt: skip
    assert essentials(double) == expected
    depth = 0.76 * double.load_parameter
    stage = (depth > 0.15) & (depth < 0.535)
    exact = pair_of(scene).stage(depth[stage])
    differences = (
        upper.force[stage] / np.hypot(*exact.pin_force.T) - 1,
        tip.force[stage] / np.hypot(*exact.tip_force.T) - 1,
        upper.arc_position[stage] - exact.pin_arc,
        tip.arc_position[stage] - exact.tip_arc,
    )
    off = [np.abs(differences).max()]
    moments = np.stack(
        [double.supports[f"{name}.start"].moment[stage] for name in ("upper", "lower")], axis=1
    )
    assert np.abs(moments + exact.clamp_moments).max() <= bound * np.abs(moments).max()
    times = [0.76 * e.load_parameter for e in double.events if e.kind is not tsm.EventKind.PASS_THROUGH]
    off.append(max(abs(times[0] - exact.touch_depth), abs(times[1] - exact.end_depth)))
    for within, contact, above in (
        (depth < 0.149, upper, 0.0),
        ((depth > 0.54) & (depth < 0.73), lower, 0.2),
    ):
        rod = pair_of(scene).single(depth[within] - above)
        assert contact.force[within] == pytest.approx(rod.magnitude[1:], rel=bound)
        assert contact.arc_position[within] == pytest.approx(rod.arc_position[1:], abs=bound)
    assert times[-1] == pytest.approx(double_beam.EVENTS["slip-off"], abs=bound)
    assert np.abs(double.tips["lower"][depth > 0.74] - [1.0, -0.2]).max() <= 1e-9
    assert max(off) <= bound
    if element == "exact":
        stated("exact.double-beam", off[0], bound=True)
        stated("exact.double-beam-events", off[1], bound=True)


@pytest.mark.parametrize(("turns", "elements"), [(1, 1), (2, 2), (2, 1)])
def test_roll_up(turns, elements, stated):
    """Full circles under an end moment, on a slack and on a stiff section; a circular arc on the way."""
    for section in (tsm.Section(EA=1.0, GA=1.0, EI=1.0), KS, STIFF):
        moment = 2 * np.pi * turns * section.EI
        load = tsm.Load(beam="b", end="end", moment=moment)
        result = tsm.solve(cantilever(section=section, elements=elements, load=load), steps(8))
        angle = 2 * np.pi * turns * result.load_parameter
        exact = np.stack([np.sin(angle) / angle, (1 - np.cos(angle)) / angle], axis=1)
        error = np.abs(result.tips["b"] - exact).max()
        assert error <= 1e-9
        stated("exact.roll-up", error, part=True)
        assert result.shape("b", -1)[-1, 2] == pytest.approx(2 * np.pi * turns, rel=1e-9)
        assert result.strain_energy == pytest.approx(angle * moment * result.load_parameter / 2, rel=1e-12)


def test_lees_frame(stated):
    """Limit load 18.556 727 534, which exact rods coupled by shooting have too; Lee, Manuel & Rossow (1968) give 18.557."""

    def limit_load(elements, tolerance):
        structure = divided(frames.lee_scene(), elements, "exact")
        return limit_points(structure, 0.3, 25, integration_tolerance=tolerance)[0] * 0.1 * frames.LEE_UNIT

    found = limit_load(1, 1e-9)
    assert found == pytest.approx(limit_load(4, 1e-13), rel=1e-8)
    assert found == pytest.approx(frames.LEE_LIMIT, abs=1e-8)
    stated("lee.exact", found)


def extreme(length, youngs_modulus):
    h = 0.02 * length
    section = tsm.Section.rectangle(
        width=h, height=h, youngs_modulus=youngs_modulus, shear_modulus=youngs_modulus / 2.6
    )
    return cantilever(((length, 0.0), (0.0, 2 * length / np.pi)), section=section, length=length)


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 5, 50])
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
CORNERS = {(10, 1e-2), (1e6, 1e12)}


@pytest.mark.parametrize(
    ("slenderness", "shear"),
    [pytest.param(s, g, marks=() if (s, g) in CORNERS else pytest.mark.slow) for s in SLENDER for g in SHEAR],
)
def test_slenderness_and_shear_modulus(slenderness, shear, stated):
    """KS with L/h from 10 to 1e6 and G/E from 1e-2 to 1e12: against the rod, in 50 steps and in one."""
    h = 1 / slenderness
    section = tsm.Section.rectangle(width=h, height=h, youngs_modulus=1.0, shear_modulus=shear)
    structure = cantilever(KS_PATH, section=section)
    result, error = off_rod(structure, steps(50))
    assert error <= 1e-8
    stated("exact.slenderness", error, part=True)
    at_once = tsm.solve(structure, steps(1))
    assert at_once.newton_iterations.sum() <= 80
    assert np.abs(dimensionless(at_once)[-1] - dimensionless(result)[-1]).max() <= 1e-8


@pytest.mark.parametrize("elements", [1, 11])
@pytest.mark.parametrize("x", [5e-324, 1e-300, 1e-16, 1e-8, 1e-6, 1e-4])
def test_near_the_clamp(elements, x):
    """Raised by a part of the distance, which positions resolve to 1e-13 of the length: shear alone carries the force."""
    for section, length in SECTIONS.values():
        path = ((x * length, 0.0), (x * length, max(0.02 * x * length, 5e-324)))
        result = tsm.solve(cantilever(path, section=section, length=length, elements=elements), steps(3))
        assert result.cutbacks == 0
        if x >= 1e-8:
            assert result.contacts["p0->b"].force[-1] == pytest.approx(0.02 * section.GA, rel=1e-3)


@pytest.mark.parametrize("elements", [1, 11])
def test_near_the_tip(elements):
    """The slip-off is the rod's; the slid way is as depth^2, located to 1e-12, and a contact within 1e-10 of the tip is at the tip."""
    for section, length in SECTIONS.values():
        for x in (*(1 - 10.0 ** -np.arange(2, 16, 3)), 1 - 1e-9, 1 - 1e-10, np.nextafter(1.0, 0), 1.0):
            path = raised(x * length, 0.02 * length)
            structure = cantilever(path, section=section, length=length, elements=elements)
            squares = [(0.02 * t) ** 2 for t in slip_offs(tsm.solve(structure, steps(3)))]
            expected = oracle(structure, steps(3)).slip_off
            located = 5e-12 if 1 - x > 1.01e-10 else 2e-10
            assert squares == pytest.approx(
                [] if np.isnan(expected) else [(0.02 * expected) ** 2], abs=located
            )


def test_elastica(stated):
    """Theory's digits: KS with stretch and shear ten decades stiffer; slip-offs; limits of the contact force and of three-point bending; dead loads."""
    result = tsm.solve(cantilever(KS_PATH, section=STIFF), steps(4))
    contact, moment = result.contacts["p0->b"], result.supports["b.start"].moment[-1] / STIFF.EI
    forces = [1.0618903425414, 4.66473101966107, 9.71796028591865, 8.18212814018414]
    arcs = [0.77007264053193, 0.612622877902267, 0.615457399152221, 0.895721692009856]
    ratios = [*(contact.force / STIFF.EI / forces), *(contact.arc_position / arcs), moment / -np.pi]
    assert np.abs(result.tips["b"][-1] - [-0.0831776691, 0.6995120682]).max() <= 1e-9
    for x in (0.8, 0.99):
        for count in (1, 10):
            (found,) = slip_offs(tsm.solve(cantilever(raised(x, 1.0), section=STIFF), steps(count)))
            ratios.append(found / elastica.slip_off_height(x))
    for (greatest, place), support in (
        (elastica.contact_force_limit(), False),
        (elastica.three_point_limit()[0], True),
    ):
        depth = place + 0.06 * np.cos(np.pi * (np.arange(13) + 0.5) / 13)[::-1]
        result = tsm.solve(cantilever(raised(1.0, 1.0), section=STIFF, length=3.0), depth)
        force = -result.supports["b.start"].force[:, 1] if support else result.contacts["p0->b"].force
        fit = np.polynomial.Polynomial.fit(depth - place, force / STIFF.EI, len(depth) - 1)
        top = min(fit.deriv().roots(), key=abs)
        assert abs(top) <= 1e-8
        ratios.append(fit(top.real) / greatest)
    error = np.abs(np.array(ratios) - 1).max()
    for load in (1.0, 2.0, 5.0, 10.0):
        tip = tsm.Load(beam="b", end="end", force=(0.0, load * STIFF.EI))
        found = tsm.solve(cantilever(section=STIFF, load=tip), steps(2)).tips["b"][-1]
        error = max(error, np.abs(found - tip_under_dead_load(load)).max())
    assert error <= 1e-9
    stated("exact.elastica", error, bound=True)


def test_strong_tension():
    """Clamped at both ends and pushed aside by a fifth of its length: the referee's axial force is more than 500 EI/L^2."""
    scene = load_scene("ks-cantilever")
    beam = replace(scene.beams[0], clamped=("start", "end"))
    pin = replace(scene.pins[0], start=(0.5, 0.0), displacement=(0.0, 0.2))
    held = replace(scene, beams=(beam,), pins=(pin,), load_parameters=4)
    answer, exact = (
        solve_scene(held, name, options)
        for name, options in (("tsm", Options(element="exact")), ("rod", Options()))
    )
    assert exact.supports["cantilever.start"].force[-1, 0] < -500 * KS.EI
    for found, expected in ((answer.contacts, exact.contacts), (answer.supports, exact.supports)):
        for name in expected:
            assert found[name].force[-1] == pytest.approx(expected[name].force[-1], rel=1e-9)
