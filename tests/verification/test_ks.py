"""The Konyukhov-Schweizerhof cantilever at every load parameter against the exact rod, through the scene's own chain."""

from __future__ import annotations

import numpy as np
import pytest

from comparisons.errors import errors
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.scene import load_scene

QUANTITIES = ("force", "arc", "moment", "tip")


@pytest.fixture(scope="module", params=["ks-cantilever", "ks-face"])
def scene_and_rod(request):
    scene = load_scene(request.param)
    return scene, solve(scene, "rod")


def errors_of(scene_and_rod, elements):
    """Errors of `mixed` over the path."""
    scene, rod = scene_and_rod
    response = solve(scene, "tsm", Options(elements=elements))
    assert response.completed
    assert response.cutbacks == 0
    return errors(response, rod, scene)["path"]


@pytest.mark.parametrize(
    ("elements", "bound"),
    [(5, 2.6e-4), (10, 1.8e-5), (20, 1.2e-6), (40, 7e-8), pytest.param(200, 3e-9, marks=pytest.mark.slow)],
)
def test_mixed(scene_and_rod, elements, bound, stated):
    """Within these bounds and without a floor."""
    found = errors_of(scene_and_rod, elements)
    assert max(found[name] for name in QUANTITIES) <= bound
    if scene_and_rod[0].name == "ks-cantilever":
        stated(f"ks.mixed-{elements}", found["force"])
        if elements == 10:
            stated("ks.shape-10", found["shape"])


def test_fourth_order_in_every_quantity(scene_and_rod):
    coarse, fine = (errors_of(scene_and_rod, n) for n in (5, 20))
    orders = np.log2([coarse[name] / fine[name] for name in QUANTITIES]) / 2
    assert (np.abs(orders - 4) <= 0.4).all(), orders
