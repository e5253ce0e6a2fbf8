"""Decisions at their bounds: contacts armed again, crossed past an end, broken margins, residuals that are round-off, roots, sizes."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import SECTION, beam, cantilever, turned

# no structure brings these decisions to their bounds: the notes name mutants that survive every solution
from tsm.contact.contact_set import initial_state, rearm
from tsm.contact.events import EventKind, normal_force
from tsm.contact.root import find_root
from tsm.model.model import Model
from tsm.model.projection import arc_position, slide
from tsm.model.scales import joined_extents, sizes_of
from tsm.path.crossing import crossing
from tsm.path.margins import WATCHES, Margin, broken
from tsm.statement.status import Status
from tsm.system.newton import Newton


def open_states(*path):
    """The model, which is turned, and the undeformed states in which the pin is at the places of its path."""
    model = Model(turned(cantilever(((0.5, -1.0), *path))))
    start = initial_state(model)
    assert start.touches == (None,)
    lengths = np.cumsum(np.hypot(*np.diff([(0.5, -1.0), *path], axis=0).T))
    return model, [replace(start, load_parameter=float(t)) for t in lengths / lengths[-1]]


@pytest.mark.parametrize(
    ("place", "armed"),
    [
        ((0.5, -0.1), True),  # back on its side, over the beam
        ((0.5, 0.1), False),  # behind the beam
        ((1.2, 0.1), True),  # behind its line, off the beam
        ((0.5, -1e-12), False),  # on the line to round-off
    ],
)
def test_a_passed_pair_is_armed_again_off_the_beam_or_back_on_its_side(place, armed):
    model, (state,) = open_states(place)
    assert rearm(model, replace(state, armed=(False,))).armed == (armed,)
    assert rearm(model, state).armed == (True,)


@pytest.mark.parametrize(
    ("before", "after", "crosses"),
    [
        ((0.9, -0.1), (1.1, 0.1), True),  # through the tip itself
        ((0.7, -0.1), (1.1, 0.1), True),  # through the beam
        ((1.05, -0.05), (1.3, 0.1), False),  # around the tip
        ((0.99, -0.01), (1.2, 0.1), True),  # so near to the tip that a shorter step must tell
        ((0.9, 0.1), (1.1, 0.1), False),  # behind the beam from the start
        ((0.9, 1e-3), (1.1, 0.1), False),
        ((0.9, 0.0), (1.1, 0.1), True),  # on the line, over the beam
        ((0.9, -0.1), (1.1, -0.01), False),  # on its side all the time
    ],
)
def test_crossing_past_an_end(before, after, crosses):
    """An open pair whose node lies past the end after a step, by where it was before the step."""
    model, (first, last) = open_states(before, after)
    found = crossing(model, first, last)
    assert (found is not None) == crosses
    assert crossing(model, replace(first, armed=(False,)), last) is None
    if found is not None:
        t, pair = found
        x, y = model.node_position(model.pairs[0], first.q, t)
        assert pair == 0
        assert math.cos(0.7) * y - math.sin(0.7) * x == pytest.approx(0.0, abs=1e-12)


def test_a_margin_is_broken_below_round_off():
    def margin(value):
        return Margin(kind=EventKind.TOUCH, pair=0, value=value)

    for value, breaks in ((1e-3, False), (0.0, False), (-1e-11, False), (-1e-9, True), (-1e-7, True)):
        assert bool(broken([margin(1.0)], [margin(value)])) == breaks


def test_a_new_event_is_a_row(monkeypatch):
    """A contact that may carry so much and no more: the path ends where it does, located like every event."""
    rows = {row.kind: row for row in WATCHES}
    rows[EventKind.LINE_CONTACT] = rows[EventKind.LINE_CONTACT]._replace(
        awaited=lambda point, k: point.state.touches[k] is not None,
        margin=lambda point, k, _: 1.0 - normal_force(point, k) / 0.5,
    )
    monkeypatch.setattr("tsm.path.margins.WATCHES", tuple(rows.values()))
    path = ((0.8, 0.0), (0.8, 0.3))
    result = tsm.solve(cantilever(path), [0.5, 1.0], throw=False)
    assert result.status is Status.LINE_CONTACT
    assert result.events[-1].force == pytest.approx(0.5, rel=1e-11)


def test_no_contact_is_so_stiff_that_a_large_residual_is_round_off():
    """Round-off of a stiff contact counts up to 1e-6 of the force scale, whatever the stiffness: beyond it lies the critical area."""
    newton = Newton(
        Model(cantilever(((0.5, 0.0), (0.5, 0.1)), element="euler-bernoulli-simple")), tsm.Settings()
    )
    scale = newton.model.force_scale

    def noisy(noise, carried=0.0):
        groups = (SimpleNamespace(ends=np.full((6, 1), carried * scale)),)
        return SimpleNamespace(noise=noise * scale, groups=groups)

    stiff = noisy(1e3)
    assert newton.noise < 1e-8
    assert newton.converged([5e-7, 5e-7], stiff)
    assert not newton.converged([2e-6, 2e-6], stiff)
    assert not newton.converged([2e-6, 5e-7], stiff)
    assert not newton.converged([5e-7], stiff)
    assert not newton.converged([5e-7, 5e-7], noisy(1e-8))
    assert newton.converged([1e-9, 1e-9], noisy(0.0, 1e6))
    assert not newton.converged([1e-9, 1e-9], noisy(0.0, 1e5))


def test_a_position_passes_from_element_to_element():
    graded = replace(beam("b", (0.0, 0.0), (1.0, 0.0), section=SECTION), elements=4, nodes=(0.1, 0.5, 0.6))
    target = Model(tsm.Structure(beams=(graded,))).beams["b"]
    for element, xi in ((0, 1.5), (0, 7.0), (3, -0.5), (3, -1.2), (2, 1.0), (1, -1e-17), (3, 1.5), (0, -0.5)):
        arc = target.arcs[element] + xi * target.lengths[element]
        owner, at = slide(target.lengths, element, xi)
        assert arc_position(target, owner, at) == pytest.approx(arc, abs=1e-15)
        assert 0.0 <= at <= 1.0 or arc < 0.0 or arc > 1.0


def test_sizes_of_a_frame_and_of_a_beam_beside_it():
    """The frame is as large as its diagonal, 5, and the beam as its own length, though it ends where it begins."""
    nodes = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [9.0, 9.0], [9.0, 9.5]])
    lengths = np.array([4.0, 3.0, 2.0])
    extents = joined_extents(np.array([[0, 1], [1, 2], [3, 4]]), np.array([0, 1, 3]), nodes, lengths)
    assert extents.tolist() == [5.0, 5.0, 2.0]
    assert sizes_of(lengths, extents, np.array([160.0, 45.0, 4.0])) == (4.0, 5.0, 10.0, 6.4)


JUMP, HIGH = 0.7310585, 0.39999999979993894
ROOTS = {  # function of t, root, how near
    "rising": (lambda t: t**3 - 0.2, 0.2 ** (1 / 3), 1e-11),
    "flat at one end": (lambda t: math.exp(-5 * t) - math.exp(-4.5), 0.9, 1e-11),
    "tenfold root": (lambda t: (0.37 - t) ** 9, 0.37, 0.05),
    "a jump down": (lambda t: 2.0 if t < JUMP else -1.0, JUMP, 1e-13),
    "a jump up": (lambda t: -2.0 if t < JUMP else 1.0, JUMP, 1e-13),
    # false position comes to this jump from the side of the larger value last
    "a high jump": (lambda t: 1.0 if t < HIGH else -0.3 * (t - 1 / 3), HIGH, 1e-13),
}


@pytest.mark.parametrize("name", ROOTS)
def test_a_root_is_found_well_within_the_bound_of_evaluations(name):
    """The last sample is the answer; behind a jump it is past it, found by bisection."""
    function, root, near = ROOTS[name]
    asked = []

    def evaluate(t):
        asked.append(t)
        return function(t), t

    low, high = (0.25, 0.5) if "high" in name else (0.0, 1.0)
    found = find_root(evaluate, (low, function(low)), (high, function(high)), small=1e-13, apart=1e-14)
    assert found == pytest.approx(root, abs=near)
    assert abs(function(found)) <= 1e-13 or 0 <= found - root < 1e-13
    assert found == asked[-1]
    assert len(asked) <= (100 if "jump" in name else 50)
