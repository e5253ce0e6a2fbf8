"""The way of a contact to a beam node at a fixed tolerance."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.claims.paper.approach import NEAREST, Approach, approaches
from comparisons.claims.paper.critical_area import SCENE
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene


def ways(element: str, tolerance: float, start: float = 4.2) -> tuple[Approach, ...]:
    scene = load_scene(SCENE)
    scene = replace(scene, pins=(replace(scene.pins[0], start=(start, 0.0)),))
    return approaches(to_structure(scene, element=element), tolerance)


def test_mixed_comes_as_near_as_the_search_goes_at_every_tolerance():
    for tolerance in (1e-6, 1e-9, 1e-12):
        found = ways("mixed", tolerance)
        assert [way.node for way in found] == [4.25, 4.5]
        assert all(way.smallest <= NEAREST for way in found)


@pytest.mark.slow
def test_the_critical_area_grows_with_the_sharpness_of_the_tolerance():
    """``b^-3`` and ``b^-1``: a tolerance 1e4 times sharper widens it by about 20 and 1e4."""
    for element, factor in (("euler-bernoulli-simple", 1e4 ** (1 / 3)), ("timoshenko", 1e4)):
        loose, sharp = (ways(element, tolerance)[0].smallest for tolerance in (1e-7, 1e-11))
        assert factor / 6 < sharp / loose < 6 * factor


def test_the_way_ends_where_the_pin_slips_off():
    """Section 4.1: the exact rod slips off a pin at 4.2 m at 1.4716026278 m."""
    last = ways("mixed", 1e-10)[-1]
    assert 1.8 * last.load_parameter[-1] == pytest.approx(1.4716026278, rel=2e-5)
    assert np.all(np.diff(last.load_parameter) > 0)
    assert np.all(np.diff(last.ratio) < 0)
