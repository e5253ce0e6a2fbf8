"""Two cantilevers, a pin that pushes the upper onto the lower: [P] 4.3 against coupled and single exact rods."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.claims.problems.double_beam import LOWER, TIP, UPPER
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tests.oracles.coupled import pair_of

STEPS = 76
SCENE = load_scene("double-beam")
PAIR = pair_of(SCENE)


def double_beam(elements=10, element="mixed", x=0.8):
    pin = replace(SCENE.pins[0], start=(x, 0.0))
    return to_structure(replace(SCENE, pins=(pin,)), elements=elements, element=element)


@pytest.fixture(scope="module")
def result():
    return tsm.solve(double_beam(), np.arange(1, STEPS + 1) / STEPS)


def found(result, kind, pair):
    return next(event for event in result.events if (event.kind, event.pair) == (kind, pair))


def depth(event):
    return 0.76 * event.load_parameter


def test_events_in_order(result):
    events = [(e.kind, e.pair) for e in result.events if e.kind is not tsm.EventKind.PASS_THROUGH]
    assert events == [
        (tsm.EventKind.TOUCH, TIP),
        (tsm.EventKind.SLIP_OFF, UPPER),
        (tsm.EventKind.TOUCH, LOWER),
        (tsm.EventKind.RELEASE, TIP),
        (tsm.EventKind.SLIP_OFF, LOWER),
    ]


def test_coupled_stage_matches_the_coupled_rods(result):
    depths = 0.76 * result.load_parameter
    stage = (depths > 0.15) & (depths < 0.535)
    exact = PAIR.stage(depths[stage])
    assert result.contacts[UPPER].force[stage] == pytest.approx(np.hypot(*exact.pin_force.T), rel=1e-6)
    assert result.contacts[TIP].force[stage] == pytest.approx(np.hypot(*exact.tip_force.T), rel=1e-6)
    touch = found(result, tsm.EventKind.TOUCH, TIP)
    slip = found(result, tsm.EventKind.SLIP_OFF, UPPER)
    assert depth(touch) == pytest.approx(exact.touch_depth, abs=1e-9)
    assert depth(slip) == pytest.approx(exact.end_depth, abs=1e-6)


def test_single_stages_match_the_exact_rod(result):
    depths = 0.76 * result.load_parameter
    before, after = depths < 0.149, (depths > 0.54) & (depths < 0.73)
    for stage, pair, offset in ((before, UPPER, 0.0), (after, LOWER, 0.2)):
        exact = PAIR.single(depths[stage] - offset)
        assert result.contacts[pair].force[stage] == pytest.approx(exact.magnitude[1:], rel=1e-6)
        assert result.contacts[pair].arc_position[stage] == pytest.approx(exact.arc_position[1:], abs=2e-7)
    leave = found(result, tsm.EventKind.SLIP_OFF, LOWER)
    assert depth(leave) - 0.2 == pytest.approx(PAIR.slip_off() - 0.2, abs=3e-7)


@pytest.mark.slow
def test_what_stops_the_papers_element():
    """A pin that starts on a beam node leaves it no digits; at the hand-over two nodes meet on one of its elements."""
    t = np.arange(1, STEPS + 1) / STEPS
    stuck = tsm.solve(double_beam(element="timoshenko"), t, throw=False)
    assert stuck.status is tsm.Status.CUTBACK_FLOOR
    through = tsm.solve(double_beam(element="timoshenko", x=0.81), t, throw=False)
    assert through.status is tsm.Status.TWO_CONTACTS
    assert 0.76 * through.load_parameter[-1] > 0.5


@pytest.mark.slow_at("40")
@pytest.mark.parametrize("elements", [3, 10, 40])
def test_refinement_against_the_coupled_rods(elements, stated):
    t = np.array([0.31, 0.45]) / 0.76
    exact = PAIR.stage(0.76 * t)
    contacts = tsm.solve(double_beam(elements), t).contacts
    pairs = ((TIP, exact.tip_force), (UPPER, exact.pin_force))
    errors = [contacts[pair].force / np.hypot(*force.T) - 1 for pair, force in pairs]
    stated(f"double-beam.mixed-{elements}", np.abs(errors).max())
