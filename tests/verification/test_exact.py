"""The exact element, one per beam, against the rod, the elastica and closed forms, and against itself seen otherwise."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from comparisons.models import solve as solve_scene
from comparisons.models.tsm import to_structure
from comparisons.scene import load_scene
from tests.tsm.structures import essentials, raised, steps
from tests.verification.structures import (
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
