"""Floor of the unbalanced force against the distance from a node: slopes, units, input."""

from __future__ import annotations

import numpy as np
import pytest

from comparisons.claims.paper import turned_frame
from comparisons.claims.paper.force_floor import force_floor

RATIOS = 10.0 ** -np.arange(1, 14)


def slope(element, end, ratios=RATIOS, **options):
    floors = [force_floor(element, float(ratio), end=end, samples=25, **options) for ratio in ratios]
    return np.polyfit(np.log10(ratios), np.log10(floors), 1)[0]


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize(
    ("element", "expected", "within"),
    [
        ("euler-bernoulli-simple", -3, 0.3),
        ("euler-bernoulli-cantilever", -3, 0.3),
        (turned_frame.NAME, -3, 0.3),
        ("timoshenko", -1, 0.2),
        ("mixed", 0, 0.1),
        ("mixed-no-bow", 0, 0.1),
    ],
)
def test_slope(element, expected, within, end):
    assert slope(element, end) == pytest.approx(expected, abs=within)


def test_timoshenko_is_euler_bernoulli_until_the_distance_falls_below_the_shear_length():
    """``sqrt(Psi)`` = 1e-3 of the element: the same cubic floor above, a linear one below."""
    above = [
        force_floor(name, 1e-2, Psi=1e-6, samples=200) for name in ("timoshenko", "euler-bernoulli-simple")
    ]
    assert above[0] == pytest.approx(above[1], rel=0.25)
    assert slope("timoshenko", "start", 10.0 ** -np.arange(4, 13), Psi=1e-6) == pytest.approx(-1, abs=0.2)


def test_mixed_has_the_floor_of_mid_element_everywhere():
    middle = force_floor("mixed", 0.5)
    for end in ("start", "end"):
        for ratio in (0.0, 1e-300, 1e-16, 1e-8, 1e-2):
            assert force_floor("mixed", ratio, end=end) <= 1.5 * middle


@pytest.mark.parametrize("elements", [10, 100, 1000])
def test_the_size_is_the_contact_stiffness_times_the_last_bit_of_a_coordinate(elements):
    """``3 EI/b^3`` times ``eps L/10`` (half a last bit, root mean square, of coordinates up to L), in EI/L^2."""
    ratio = 1e-4
    expected = 3 / ratio**3 * np.finfo(float).eps * elements / 10 * elements**2
    floor = force_floor("euler-bernoulli-simple", ratio, elements=elements, samples=200)
    assert 0.5 < floor / expected < 2


def test_input_is_checked():
    for arguments, field in (
        (("spring", 0.1), "element"),
        (("mixed", 1.5), "ratio"),
        (("mixed", float("nan")), "ratio"),
    ):
        with pytest.raises(ValueError, match=field):
            force_floor(*arguments)
    with pytest.raises(ValueError, match="end"):
        force_floor("mixed", 0.1, end="middle")
    for option in ({"Psi": 0.0}, {"elements": 0}, {"samples": 0}):
        with pytest.raises(ValueError, match=next(iter(option))):
            force_floor("mixed", 0.1, **option)
