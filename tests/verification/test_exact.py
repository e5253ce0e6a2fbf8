"""The exact element, one per beam, against the rod, the elastica and closed forms, and against itself seen otherwise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.claims.paper import fig9 as double_beam
from comparisons.models import solve as solve_scene
from comparisons.models.options import Options
from comparisons.models.tsm import to_structure
from comparisons.scene import load_scene
from tests.oracles.coupled import pair_of
from tests.tsm.structures import KS_PATH, essentials, raised, steps
from tests.verification.structures import (
    KS,
    LENGTH,
    PINS,
    SECTION,
    SECTIONS,
    cantilever,
    dimensionless,
    off_rod,
    oracle,
    slip_offs,
)  # fmt: skip

TOUCH, RELEASE, OFF = tsm.EventKind.TOUCH, tsm.EventKind.RELEASE, tsm.EventKind.SLIP_OFF


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
        rod = solve_scene(scene, "rod")
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


def test_double_beam_stages(stated):
    scene, bound = load_scene("double-beam"), 1e-8
    double = tsm.solve(to_structure(scene, element="exact"), steps(76))
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
    alone = (depth > 0.54) & (depth < 0.73)
    rod = pair_of(scene).single(depth[alone] - 0.2)
    assert lower.force[alone] == pytest.approx(rod.magnitude[1:], rel=bound)
    assert times[-1] == pytest.approx(double_beam.EVENTS["slip-off"], abs=bound)
    assert np.abs(double.tips["lower"][depth > 0.74] - [1.0, -0.2]).max() <= 1e-9
    assert max(off) <= bound
    stated("exact.double-beam", off[0], bound=True)
    stated("exact.double-beam-events", off[1], bound=True)


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


@pytest.mark.parametrize(("elements", "x"), [(1, 5e-324), (11, 1e-16), (1, 1e-8), (11, 1e-4)])
def test_near_the_clamp(elements, x):
    """Raised by a part of the distance, which positions resolve to 1e-13 of the length: shear alone carries the force."""
    for section, length in SECTIONS.values():
        path = ((x * length, 0.0), (x * length, max(0.02 * x * length, 5e-324)))
        result = tsm.solve(cantilever(path, section=section, length=length, elements=elements), steps(3))
        assert result.cutbacks == 0
        if x >= 1e-8:
            assert result.contacts["p0->b"].force[-1] == pytest.approx(0.02 * section.GA, rel=1e-3)


def test_near_the_tip():
    """The slip-off is the rod's; the slid way is as depth^2, located to 1e-12, and a contact within 1e-10 of the tip is at the tip."""
    for section, length in SECTIONS.values():
        for x in (0.99, 1 - 1e-5, 1 - 1e-9, 1 - 1e-10, np.nextafter(1.0, 0), 1.0):
            path = raised(x * length, 0.02 * length)
            structure = cantilever(path, section=section, length=length, elements=11)
            squares = [(0.02 * t) ** 2 for t in slip_offs(tsm.solve(structure, steps(3)))]
            expected = oracle(structure, steps(3)).slip_off
            located = 5e-12 if 1 - x > 1.01e-10 else 2e-10
            assert squares == pytest.approx(
                [] if np.isnan(expected) else [(0.02 * expected) ** 2], abs=located
            )


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
