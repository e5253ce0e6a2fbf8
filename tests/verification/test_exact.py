"""The exact element, one per beam, against the rod, the elastica and closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from comparisons.claims.problems.double_beam import EVENTS, LOWER, TIP, UPPER
from comparisons.claims.problems.frames import LEE_LIMIT, LEE_UNIT, lee_scene
from comparisons.models import solve as solve_scene
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tests.oracles.coupled import pair_of
from tests.oracles.elastica import (
    contact_force_limit,
    slip_off_height,
    three_point_limit,
    tip_under_dead_load,
)
from tests.verification.structures import (
    KS,
    KS_PATH,
    PINS,
    SECTIONS,
    cantilever,
    dimensionless,
    divided,
    double_beam,
    essentials,
    limit_points,
    oracle,
    raised,
    slip_offs,
    steps,
)
from tsm.events import EventKind

STIFF = tsm.Section(EA=KS.EA * 1e10, GA=KS.GA * 1e10, EI=KS.EI)


@pytest.fixture(scope="module", params=["ks-cantilever", "ks-face"])
def ks_scene(request):
    return load_scene(request.param)


@pytest.mark.slow_at("ks-face")
def test_ks_at_every_load_parameter(ks_scene, stated):
    rod = solve_scene(ks_scene, "rod")
    result = tsm.solve(to_structure(ks_scene, element="exact"), steps(50))
    (contact,), (expected,) = result.contacts.values(), rod.contacts.values()
    assert len(result.model.element) == 1
    assert result.cutbacks == 0
    differences = (
        contact.force / expected.force - 1,
        contact.arc_position - expected.arc_position,
        result.supports["cantilever.start"].moment / rod.supports["cantilever.start"].moment - 1,
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


@pytest.fixture(scope="module")
def slip_off_41():
    """Displacement at which the six pins of 4.1 slip off the rod."""
    section, length = SECTIONS["4.1"]
    rods = [oracle(cantilever(raised(x, 2.0), section=section, length=length), [1.0]) for x in PINS]
    return dict(zip(PINS, (2.0 * rod.slip_off for rod in rods), strict=True))


@pytest.mark.parametrize(
    "x", [x if x in {4.05, 4.2, 4.4} else pytest.param(x, marks=pytest.mark.slow) for x in PINS]
)
def test_41_at_60_depths_and_its_slip_off(x, slip_off_41, stated):
    section, length = SECTIONS["4.1"]
    depth = 0.98 * slip_off_41[x]
    structure = cantilever(raised(x, depth), section=section, length=length)
    contact, exact = tsm.solve(structure, steps(60)).contacts["p0->b"], oracle(structure, steps(60))
    differences = contact.force / exact.magnitude[1:] - 1, contact.arc_position - exact.arc_position[1:]
    error = np.abs(differences).max()
    assert error <= 1e-9
    stated("exact.4.1", error, part=True)
    for count in (1, 20):
        over = tsm.solve(cantilever(raised(x, 2.0), section=section, length=length), steps(count))
        assert essentials(over) == [(EventKind.SLIP_OFF, "p0->b")]
        error = abs(2.0 * slip_offs(over)[0] / slip_off_41[x] - 1)
        assert error <= 1e-9
        stated("exact.4.1-slip-off", error, part=True)
        assert np.abs(over.tips["b"][-1] - [length, 0.0]).max() <= 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("x", PINS)
def test_41_map(x, slip_off_41, stated):
    """Step counts from 1 to 500: all complete, with and without slip-off, and no answer depends on the count."""
    section, length = SECTIONS["4.1"]
    counts = (1, 2, 3, 4, 5, 6, 8, 10, 13, 18, 25, 35, 50, 70, 100, 140, 200, 270, 370, 500)
    ends = []
    for count in counts:
        below = tsm.solve(cantilever(raised(x, 0.8), section=section, length=length), steps(count))
        ends.append(dimensionless(below)[-1])
        over = tsm.solve(cantilever(raised(x, 2.0), section=section, length=length), steps(count))
        assert 2.0 * slip_offs(over)[0] == pytest.approx(slip_off_41[x], rel=1e-9)
    error = np.abs(np.array(ends) - ends[0]).max()
    assert error <= 1e-9
    stated("exact.step-counts", len(counts))
    stated("exact.4.1-map", error, part=True)


DOUBLE_BEAM_EVENTS = [
    (EventKind.TOUCH, TIP),
    (EventKind.SLIP_OFF, UPPER),
    (EventKind.TOUCH, LOWER),
    (EventKind.RELEASE, TIP),
    (EventKind.SLIP_OFF, LOWER),
]


@pytest.fixture(scope="module")
def double():
    return tsm.solve(double_beam(), steps(76))


def test_double_beam_stages(double, stated):
    """Every stage with one element per beam: single rod, coupled rods, single rod, nothing."""
    assert len(double.model.element) == 2
    assert essentials(double) == DOUBLE_BEAM_EVENTS
    depth = 0.76 * double.load_parameter
    stage = (depth > 0.15) & (depth < 0.537)
    pair = pair_of(load_scene("double-beam"))
    exact = pair.stage(depth[stage])
    pin, tip = double.contacts[UPPER], double.contacts[TIP]
    differences = (
        pin.force[stage] / np.hypot(*exact.pin_force.T) - 1,
        tip.force[stage] / np.hypot(*exact.tip_force.T) - 1,
        pin.arc_position[stage] - exact.pin_arc,
        tip.arc_position[stage] - exact.tip_arc,
    )
    error = np.abs(differences).max()
    assert error <= 1e-8
    stated("exact.double-beam", error, bound=True)
    moments = np.stack(
        [double.supports[f"{name}.start"].moment[stage] for name in ("upper", "lower")], axis=1
    )
    assert np.abs(moments + exact.clamp_moments).max() <= 1e-8 * np.abs(moments).max()
    first, second = (0.76 * e.load_parameter for e in double.events[:2])
    error = max(abs(first - exact.touch_depth), abs(second - exact.end_depth))
    assert error <= 1e-8
    stated("exact.double-beam-events", error, bound=True)
    for stage, name, above in (
        (depth < 0.149, UPPER, 0.0),
        ((depth > 0.54) & (depth < 0.735), LOWER, 0.2),
    ):
        rod = pair.single(depth[stage] - above)
        assert double.contacts[name].force[stage] == pytest.approx(rod.magnitude[1:], rel=1e-9)
        assert double.contacts[name].arc_position[stage] == pytest.approx(rod.arc_position[1:], abs=1e-9)
    leave = 0.76 * double.events[-1].load_parameter - 0.2
    assert leave == pytest.approx(EVENTS["slip-off"] - 0.2, rel=1e-9)
    assert np.abs(double.tips["lower"][depth > 0.74] - [1.0, -0.2]).max() <= 1e-9


def test_elastica_ks(stated):
    """Theory's digits: KS with stretch and shear ten decades stiffer."""
    result = tsm.solve(cantilever(KS_PATH, section=STIFF), steps(4))
    contact = result.contacts["p0->b"]
    forces = [1.0618903425414, 4.66473101966107, 9.71796028591865, 8.18212814018414]
    arcs = [0.77007264053193, 0.612622877902267, 0.615457399152221, 0.895721692009856]
    differences = (
        contact.force / STIFF.EI / forces - 1,
        contact.arc_position / arcs - 1,
        result.supports["b.start"].moment[-1] / STIFF.EI / -np.pi - 1,
    )
    error = max(np.abs(part).max() for part in differences)
    assert error <= 1e-9
    stated("exact.elastica", error, part=True)
    assert np.abs(result.tips["b"][-1] - [-0.0831776691, 0.6995120682]).max() <= 1e-9


@pytest.mark.parametrize("x", [0.8, 0.9, 0.95, 0.99])
def test_elastica_slip_off(x, stated):
    for count in (1, 10):
        result = tsm.solve(cantilever(raised(x, 1.0), section=STIFF), steps(count))
        assert slip_offs(result) == pytest.approx([slip_off_height(x)], rel=1e-9)
        stated("exact.elastica", abs(slip_offs(result)[0] / slip_off_height(x) - 1), part=True)


def top(x, y):
    """Greatest value and its place of the polynomial through samples about a maximum."""
    middle = x.mean()
    fit = np.polynomial.Polynomial.fit(x - middle, y, len(x) - 1)
    turn = next(r.real for r in fit.deriv().roots() if abs(r.imag) < 1e-12 and abs(r) < np.ptp(x) / 2)
    return fit(turn), turn + middle


def test_elastica_limit_points(stated):
    """Greatest contact force, and greatest load of frictionless three-point bending (half of it)."""
    for (greatest, place), support in ((contact_force_limit(), False), (three_point_limit()[0], True)):
        depth = place + 0.06 * np.cos(np.pi * (np.arange(13) + 0.5) / 13)[::-1]
        result = tsm.solve(cantilever(raised(1.0, 1.0), section=STIFF, length=3.0), depth)
        force = -result.supports["b.start"].force[:, 1] if support else result.contacts["p0->b"].force
        load, displacement = top(depth, force / STIFF.EI)
        assert load == pytest.approx(greatest, rel=1e-9)
        stated("exact.elastica", abs(load / greatest - 1), part=True)
        assert displacement == pytest.approx(place, abs=1e-8)


@pytest.mark.parametrize("load", [1.0, 2.0, 5.0, 10.0])
def test_elastica_dead_load(load, stated):
    tip = tsm.Load(beam="b", end="end", force=(0.0, load * STIFF.EI))
    result = tsm.solve(cantilever(section=STIFF, load=tip), steps(2))
    error = np.abs(result.tips["b"][-1] - tip_under_dead_load(load)).max()
    assert error <= 1e-9
    stated("exact.elastica", error, part=True)


@pytest.mark.parametrize(("turns", "elements"), [(1, 1), (2, 2), (2, 1)])
def test_roll_up(turns, elements, stated):
    """Full circles under an end moment, on a slack and on a stiff section; a circular arc on the way."""
    for section in (tsm.Section(EA=1.0, GA=1.0, EI=1.0), KS, STIFF):
        load = tsm.Load(beam="b", end="end", moment=2 * np.pi * turns * section.EI)
        result = tsm.solve(cantilever(section=section, elements=elements, load=load), steps(8))
        angle = 2 * np.pi * turns * result.load_parameter
        exact = np.stack([np.sin(angle) / angle, (1 - np.cos(angle)) / angle], axis=1)
        error = np.abs(result.tips["b"] - exact).max()
        assert error <= 1e-9
        stated("exact.roll-up", error, part=True)
        assert result.shape("b", -1)[-1, 2] == pytest.approx(2 * np.pi * turns, rel=1e-9)


def limit_load(element, elements, integration_tolerance=1e-9):
    """``P L^2/EI`` at the first limit point of Lee's frame."""
    count = 20 * (2 + elements) if element == "mixed" else 25
    structure = divided(lee_scene(), elements, element)
    return (
        limit_points(structure, 0.3, count, integration_tolerance=integration_tolerance)[0] * 0.1 * LEE_UNIT
    )


def test_lees_frame(stated):
    """Limit load 18.556 727 534, which exact rods coupled by shooting have too; Lee, Manuel & Rossow (1968) give 18.557."""
    found = limit_load("exact", 1)
    assert found == pytest.approx(limit_load("exact", 1, 1e-13), rel=1e-8)
    assert found == pytest.approx(limit_load("exact", 4), rel=1e-8)
    assert found == pytest.approx(LEE_LIMIT, abs=1e-8)
    stated("lee.exact", found)
    coarse, fine = limit_load("mixed", 8), limit_load("mixed", 16)
    assert abs(found - fine) <= 1e-5
    assert found == pytest.approx(fine + (fine - coarse) / 15, abs=0.1 * abs(fine - coarse) / 15)
