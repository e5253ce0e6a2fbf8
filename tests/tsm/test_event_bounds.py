"""What a contact may do next, at its bounds: armed again, crossed past an end, broken margins, residuals that are round-off."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import cantilever
from tsm.contact_set import initial_state, rearm
from tsm.crossing import crossing
from tsm.events import EventKind, Margin, broken
from tsm.model import Model
from tsm.newton import Newton


def open_states(*path):
    """The model, and the undeformed states in which the pin is at the places of its path."""
    model = Model(cantilever(((0.5, -1.0), *path)))
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
        ((0.99, -0.01), (1.2, 0.1), False),  # around the tip
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
        height = model.node_position(model.pairs[0], first.q, t)[1]
        assert pair == 0
        assert height == pytest.approx(0.0, abs=1e-12)


def test_a_margin_is_broken_below_round_off():
    def margin(value):
        return Margin(kind=EventKind.TOUCH, pair=0, value=value)

    for value, breaks in ((1e-3, False), (0.0, False), (-1e-11, False), (-1e-9, True), (-1e-7, True)):
        assert bool(broken([margin(1.0)], [margin(value)])) == breaks


def test_no_contact_is_so_stiff_that_a_large_residual_is_round_off():
    """Round-off of a stiff contact counts up to 1e-6 of the force scale, whatever the stiffness: beyond it lies the critical area."""
    newton = Newton(
        Model(cantilever(((0.5, 0.0), (0.5, 0.1)), element="euler-bernoulli-simple")), tsm.Settings()
    )
    scale = newton.model.force_scale

    def noisy(noise: float, carried: float = 0.0) -> SimpleNamespace:
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
