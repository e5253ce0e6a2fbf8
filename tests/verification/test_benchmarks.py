"""Classical problems of large displacements, each with its source."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from comparisons.claims.problems.frames import LEE_LIMIT, LEE_UNIT, TOGGLE_LIMITS, lee_scene, toggle_scene
from tests.verification.structures import cantilever, divided, limit_points, moved, swapped

STIFF = tsm.Section(EA=1e8, GA=1e8, EI=1.0)


def fitted_order(errors, ratio=2.0):
    return float(np.log(errors[0] / errors[-1]) / np.log(ratio) / (len(errors) - 1))


@pytest.mark.parametrize("turns", [1, 2])
def test_roll_up(turns, stated):
    """An end moment 2 pi n EI/L bends a cantilever into n full circles (Bathe & Bolourchi 1979); in between a circular arc."""
    errors = []
    for elements in (10 * turns, 20 * turns, 40 * turns):
        moment = 2 * np.pi * turns
        t = np.arange(1, 21) / 20
        result = tsm.solve(
            cantilever(
                section=STIFF,
                elements=elements,
                element="mixed",
                load=tsm.Load(beam="b", end="end", moment=moment),
            ),
            t,
        )
        angle = moment * t
        exact = np.stack([np.sin(angle) / angle, (1 - np.cos(angle)) / angle], axis=1)
        errors.append(np.abs(result.tips["b"] - exact).max())
    assert fitted_order(errors) == pytest.approx(4.0, abs=0.05)
    stated(f"mixed.roll-up-{turns}", errors[-1])
    stated(f"mixed.roll-up-order-{turns}", fitted_order(errors))


def test_lees_frame(stated):
    """Limit load P L^2/EI = 18.557 (Lee, Manuel & Rossow 1968; Simo & Vu-Quoc 1986 give 18.532 kN/10); snaps through and back."""
    found = [limit_points(divided(lee_scene(), n), 0.3, 120)[0] * 0.1 * LEE_UNIT for n in (4, 8, 16)]
    assert found[-1] == pytest.approx(LEE_LIMIT, rel=1e-6)
    stated("lee.mixed", found[-1])
    assert found[-1] == pytest.approx(18.557, rel=1e-3)  # the literature's
    assert np.diff(found) == pytest.approx(0, abs=3e-3)
    order = np.log2((found[0] - found[1]) / (found[1] - found[2]))
    assert 3.3 < order < 4.7


def test_williams_toggle(stated):
    """Both limit points, 33.87 near v = .235 and 31.28 near v = .39 (Wood & Zienkiewicz 1977, by finite elements)."""
    found = [limit_points(divided(toggle_scene(), n), 0.01, 60) for n in (8, 16)]
    assert found[-1] == pytest.approx(TOGGLE_LIMITS, rel=1e-5)
    stated("toggle.mixed", *found[-1])
    assert found[-1] == pytest.approx([33.87, 31.28], rel=1e-3)  # the literature's
    assert found[0] == pytest.approx(found[1], rel=1e-3)


def test_a_frame_does_not_care_where_it_stands():
    """Lee's frame turned by 1 rad, moved, and its beams given from the other end: the same limit load to 1e-10."""
    frame = divided(lee_scene(), 6)
    other = swapped(moved(frame, 1.0, [5.0, -7.0]))
    assert limit_points(other, 0.3, 40) == pytest.approx(limit_points(frame, 0.3, 40), rel=1e-10)
