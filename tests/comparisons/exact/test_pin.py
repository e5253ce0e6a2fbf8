"""The elastica and the Reissner rod under a pin: limits, events, input; `tests/oracles/test_referee.py` has their equilibria."""

import numpy as np
import pytest

from comparisons.exact import Outcome, elastica_under_pin, rod_under_pin
from tests.oracles.shooting import KS as SECTION
from tests.oracles.shooting import ks_pins

KS = {**SECTION, "length": 1.0}
OPEN, CONTACT, SLIPPED, LOST = Outcome.OPEN, Outcome.CONTACT, Outcome.SLIPPED, Outcome.LOST


def test_the_branch_of_the_straight_beam_ends_at_the_fold():
    """The tangent's angle grows with the direction of the pin up to 2.983418; beyond that direction the pin is lost."""

    def at(direction):
        return elastica_under_pin([(np.cos(direction) / 5.0, np.sin(direction) / 5.0)])

    found, lost = 1.5, 2.5
    while lost - found > 1e-13:
        middle = (found + lost) / 2.0
        found, lost = (found, middle) if at(middle).outcome[0] is LOST else (middle, lost)
    angles = [at(direction).shape(0, 2)[-1, 2] for direction in np.linspace(0.1, found, 50)]
    assert np.all(np.diff(angles) > 0.0)
    assert angles[-1] == pytest.approx(2.983418, abs=2e-6)


UP = [(0.8, -0.1), (0.8, 0.7), (0.8, 0.6), (0.8, -0.1), (0.8, 0.1), (0.8, 0.7)]


@pytest.mark.parametrize(
    ("pins", "offset", "outcomes"),
    [
        ([(0.8, -0.3), (0.8, 0.2), (0.7, -0.2), (0.6, 0.1), (0.6, 0.0), (0.6, -0.1)], 0.0, "o c o c c o"),
        (UP, 0.0, "o s s o c s"),
        ([(0.8, 0.0), (0.8, 0.3), (1.5, -0.1)], 0.0, "c c o"),
        ([(1.0, -0.1), (1.0, 0.1)], 0.0, "o s"),
        ([(1.1, -0.1), (1.1, 0.1), (0.5, 0.1), (-0.1, 0.1), (-0.1, -0.1)], 0.0, "o o o o o"),
        ([(1.2, -0.01), (0.8, -0.01), (0.8, 0.1)], 0.01, "o o c"),
        ([*ks_pins([0.0, 0.5, 1.0]), (-0.3, 0.3), (-0.3, 0.2)], 0.0, "c c c l l"),
    ],
)
def test_a_contact_opens_closes_slips_off_and_is_lost(pins, offset, outcomes):
    """What is closed has the force of a pin that comes there straight from the tip; what is open is straight, what is lost nan."""
    path, straight = rod_under_pin(pins, offset=offset, **KS), np.outer([0.0, 0.5, 1.0], [1.0, 0.0, 0.0])
    named = {"o": OPEN, "c": CONTACT, "s": SLIPPED, "l": LOST}
    assert path.outcome == tuple(named[letter] for letter in outcomes.split())
    for k, outcome in enumerate(path.outcome):
        assert np.isnan(path.arc_position[k]) == (outcome is not CONTACT)
        if outcome is LOST:
            assert np.all(np.isnan([path.magnitude[k], *path.shape(k, 3).ravel()]))
        elif outcome is not CONTACT:
            np.testing.assert_array_equal(path.shape(k, 3), straight)
            np.testing.assert_array_equal([path.magnitude[k], *path.tip[k]], [0.0, 1.0, 0.0])
        elif path.magnitude[k] > 1e-15:
            direct = rod_under_pin([(1.0, -offset), pins[k]], offset=offset, **KS)
            assert path.magnitude[k] == pytest.approx(direct.magnitude[1], rel=1e-12, abs=1e-15 * KS["EI"])


def test_a_pin_that_leaves_a_face_outwards_comes_nearer_at_first():
    """The rotation of the face draws the contact in; it was said to slip off at once, since a step ended beyond the tip."""
    path = rod_under_pin([(1.0, -0.03), (1.01, 0.47)], offset=0.03, EA=1e5, GA=2e4, EI=1.0, length=1.0)
    assert path.outcome == (CONTACT, SLIPPED)
    fine = np.linspace((1.0, -0.03), (1.01, 0.47), 300)
    closed = rod_under_pin(fine, offset=0.03, EA=1e5, GA=2e4, EI=1.0, length=1.0).arc_position
    assert np.nanmin(closed) < 1.0
    assert path.slip_off == pytest.approx(np.isfinite(closed).sum() / 299, abs=1 / 299)


@pytest.mark.slow
def test_a_pin_that_all_but_slides_into_the_clamp_is_lost_within_bounds():
    """It passes the clamp .05 % of the length above: strains grow without bound, and steps shrink without end."""
    path = rod_under_pin([[0.25, 0.0], [-0.209, 0.001]], EA=3e4, GA=2.5e5, EI=1.0, length=1.0)
    assert path.outcome[-1] is LOST
    assert path.iterations[-1] < 5000


@pytest.mark.parametrize(
    ("call", "change", "message"),
    [
        (rod_under_pin, {"EA": 0.0}, "EA = 0.0: must be positive"),
        (rod_under_pin, {"GA": np.nan}, "GA = nan: must be positive"),
        (rod_under_pin, {"EI": np.inf}, "EI = inf: must be positive and finite"),
        (rod_under_pin, {"offset": -0.1}, "offset = -0.1: must be finite and not negative"),
        (rod_under_pin, {"points": [[0.8, np.nan]]}, "points"),
        (rod_under_pin, {"points": [[0.8, 0.1]]}, "must start below the rod"),
        (rod_under_pin, {"friction": -0.1}, "friction = -0.1: must be finite and not negative"),
        (rod_under_pin, {"offset": 0.1}, "must start below the rod"),
        (rod_under_pin, {"radius": -1.0}, "radius = -1.0: must be finite and not negative"),
        (elastica_under_pin, {"points": [[0.5, np.nan]]}, "points"),
        (elastica_under_pin, {"EI": -1.0}, "EI = -1.0: must be positive"),
    ],
)
def test_bad_input(call, change, message):
    given = {rod_under_pin: {"points": [[0.8, 0.0]], **KS}, elastica_under_pin: {"points": [[0.5, 0.1]]}}
    with pytest.raises(ValueError, match=message):
        call(**{**given[call], **change})
