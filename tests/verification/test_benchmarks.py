"""Classical problems of large displacements, each with its source."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from comparisons.claims.problems.frames import LEE_UNIT, lee_limit, lee_scene, toggle_limits, toggle_scene
from comparisons.exact.elastica import three_point_bending_limit
from comparisons.scene import load_scene
from tests.verification.structures import cantilever, divided, limit_points, moved, raised, swapped

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


@pytest.mark.parametrize(
    ("load", "deflection"), [(1, 0.3017207738), (2, 0.4934574804), (5, 0.7137915236), (10, 0.8106090249)]
)
def test_tip_load(load, deflection):
    """Dead load on the tip of an elastica: deflection over length (Bisshopp & Drucker 1945; digits by elliptic integrals)."""
    errors = []
    for elements in (5, 10, 20):
        result = tsm.solve(
            cantilever(
                section=STIFF,
                elements=elements,
                element="mixed",
                load=tsm.Load(beam="b", end="end", force=(0.0, float(load))),
            ),
            np.arange(1, 6) / 5,
        )
        errors.append(abs(result.tips["b"][-1, 1] / deflection - 1))
    assert errors[-1] <= 1e-6
    assert errors[0] > 12 * errors[1]


def test_lees_frame(stated):
    """Limit load P L^2/EI = 18.557 (Lee, Manuel & Rossow 1968; Simo & Vu-Quoc 1986 give 18.532 kN/10); snaps through and back."""
    found = [limit_points(divided(lee_scene(), n), 0.3, 120)[0] * 0.1 * LEE_UNIT for n in (4, 8, 16)]
    assert found[-1] == pytest.approx(lee_limit(), rel=1e-6)
    stated("lee.mixed", found[-1])
    assert found[-1] == pytest.approx(18.557, rel=1e-3)  # the literature's
    assert np.diff(found) == pytest.approx(0, abs=3e-3)
    order = np.log2((found[0] - found[1]) / (found[1] - found[2]))
    assert 3.3 < order < 4.7


def test_williams_toggle(stated):
    """Both limit points, 33.87 near v = .235 and 31.28 near v = .39 (Wood & Zienkiewicz 1977, by finite elements)."""
    found = [limit_points(divided(toggle_scene(), n), 0.01, 60) for n in (8, 16)]
    assert found[-1] == pytest.approx(toggle_limits(), rel=1e-5)
    stated("toggle.mixed", *found[-1])
    assert found[-1] == pytest.approx([33.87, 31.28], rel=1e-3)  # the literature's
    assert found[0] == pytest.approx(found[1], rel=1e-3)


def test_toggle_by_displacement_control_meets_its_own_arc_length_path():
    """Pushing the apex down and reading the reaction gives the same two limits."""
    result = tsm.solve(divided(load_scene("williams-toggle"), 16), np.arange(1, 601) / 600)
    force = 2 * result.supports["right.end"].force[:, 1]
    turns = np.flatnonzero(np.diff(np.sign(np.diff(force)))) + 1
    assert force[turns] == pytest.approx(limit_points(divided(toggle_scene(), 16), 0.01, 60), rel=1e-4)


@pytest.mark.slow
def test_three_point_bending_has_its_limit():
    """Frictionless three-point bending, half span a: greatest P a^2/EI = 1.66795 at d/a = .476378 (elastica in closed form)."""
    half = cantilever(raised(1.0, 0.7), section=STIFF, length=3.0, elements=30, element="mixed")
    t = np.arange(1, 701) / 700
    result = tsm.solve(half, t)
    upward = -result.supports["b.start"].force[:, 1]
    k = int(np.argmax(upward))
    fit = np.polyfit(t[k - 2 : k + 3] * 0.7 - t[k] * 0.7, upward[k - 2 : k + 3], 2)
    top = t[k] * 0.7 - fit[1] / (2 * fit[0])
    exact = three_point_bending_limit()
    assert 2 * upward[k] == pytest.approx(exact.load, rel=1e-4)
    assert top == pytest.approx(exact.displacement, rel=1e-3)


def test_a_frame_does_not_care_where_it_stands():
    """Lee's frame turned by 1 rad, moved, and its beams given from the other end: the same limit load to 1e-10."""
    frame = divided(lee_scene(), 6)
    other = swapped(moved(frame, 1.0, [5.0, -7.0]))
    assert limit_points(other, 0.3, 40) == pytest.approx(limit_points(frame, 0.3, 40), rel=1e-10)
