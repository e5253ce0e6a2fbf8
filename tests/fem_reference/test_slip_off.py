"""Slip-off: contacts whose node left its strip over an end, and the other contacts afterwards."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.active_set import _rearmed
from fem_reference.march import _condition_after, _slipped_off
from fem_reference.model import build
from fem_reference.newton import Attempt
from fem_reference.state import build_state
from fem_reference.touch import Condition
from tests.fem_reference.conftest import loads, make_problem, place_pin


@pytest.fixture(scope="module")
def touch():
    """The contact of an undeformed strip with a pin at a point below (its own side) or above it."""
    model = build(make_problem(mesh=(10, 1)))

    def at(point, **condition):
        placed = place_pin(model, point)
        state = build_state(placed, np.zeros((model.nodes, 2)), 0.0, (Condition(**condition),))
        return placed, state.touches[0]

    return at


@pytest.mark.parametrize(
    ("point", "before", "after"),
    [
        ((0.5, -0.1), True, True),
        ((0.5, -0.1), False, True),  # back on its side
        ((0.5, 0.1), False, False),  # through the strip, but not in contact: stays off
        ((0.5, 0.1), True, True),
        ((1.2, 0.1), True, False),  # round the end to the far side: has left
        ((1.2, 0.1), False, False),
        ((1.2, -0.1), False, True),  # beyond the end on its own side
        ((1.2, -0.1), True, True),
    ],
)
def test_node_is_armed_again_once_it_is_back_on_its_side(touch, point, before, after):
    model, contact = touch(point, armed=before)
    assert _rearmed(model, contact).armed is after
    assert not _rearmed(model, contact).closed


@pytest.mark.parametrize(
    ("point", "armed", "closed"),
    [
        ((0.5, -0.019), True, True),  # within the height, 0.02
        ((0.5, 0.019), True, True),
        ((0.5, -0.021), True, False),
        ((0.5, 0.021), True, False),
        ((1.01, -0.005), True, False),  # beyond the end
        ((0.5, -0.019), False, False),
    ],
)
def test_contacts_that_are_near_are_tried_closed_after_a_slip_off(touch, point, armed, closed):
    model, contact = touch(point, armed=armed)
    after = _condition_after(model, contact, None, lost=False)
    assert (after.closed, after.armed) == (closed, armed)


@pytest.mark.parametrize(("x", "lost"), [(0.5, None), (0.02, None), (0.98, None), (0.9999, 0), (1e-4, 0)])
def test_a_contact_is_lost_over_an_end_that_its_node_has_reached(touch, x, lost):
    """Newton's method that diverges may leave a contact anywhere. The node does not go through the strip then."""
    model, contact = touch((x, 0.0), closed=True, force=1.0)
    before = build_state(model, np.zeros((model.nodes, 2)), 0.0, (contact.condition,))
    assert (
        _slipped_off(before, Attempt(status=fr.Status.LOST_CONTACT, state=before, iterations=1, pair=0))
        == lost
    )
    assert _slipped_off(before, Attempt(status=fr.Status.SINGULAR, state=before, iterations=1)) is None


def test_lost_contact_is_open_and_disarmed_and_a_strip_at_rest_opens_all_of_its_contacts(touch):
    model, contact = touch((0.5, -0.001), closed=True, force=1.0)
    assert _condition_after(model, contact, None, lost=True) == Condition(armed=False)
    assert _condition_after(model, contact, 0, lost=False) == Condition(armed=True)
    assert _condition_after(model, contact, 1, lost=False).closed


def test_strip_that_was_left_by_its_pin_comes_to_rest_on_the_next(problem, strip):
    """Two pins lift a strip; the outer one passes its tip, and the inner one, until then not touching, takes over at once."""
    lifted = strip(mesh=(16, 1))
    pins = (
        fr.Pin(name="outer", path=((0.95, 0.0), (0.95, 0.5))),
        fr.Pin(name="inner", path=((0.6, -0.03), (0.6, 0.14))),
    )
    contacts = tuple(fr.Contact(node=pin.name, strip="cantilever", keep=False) for pin in pins)
    scene = fr.SolidProblem(strips=(lifted,), pins=pins, contacts=contacts)
    result = fr.solve(scene, loads(10))
    outer, inner = result.contacts["outer->cantilever"], result.contacts["inner->cantilever"]
    assert 0.3 < outer.slip_off < 0.9
    after = result.load_parameter > outer.slip_off
    assert np.all(outer.force[after] == 0)
    assert np.all(inner.force[after] > 0)
    alone = fr.solve(replace(scene, pins=pins[1:], contacts=contacts[1:]), loads(10))
    np.testing.assert_allclose(
        inner.force[after], alone.contacts["inner->cantilever"].force[after], rtol=1e-7
    )
