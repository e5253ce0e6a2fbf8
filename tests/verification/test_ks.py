"""The Konyukhov-Schweizerhof cantilever at every load parameter against the exact rod, through the scene's own chain."""

from __future__ import annotations

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.scene import load_scene

PAIR = "pin->cantilever"


@pytest.fixture(scope="module", params=["ks-cantilever", "ks-face"])
def scene_and_rod(request):
    scene = load_scene(request.param)
    return scene, solve(scene, "rod")


def errors(response, rod):
    force = np.abs(response.contacts[PAIR].force / rod.contacts[PAIR].force - 1).max()
    arc = np.abs(response.contacts[PAIR].arc_position - rod.contacts[PAIR].arc_position).max()
    moment = np.abs(response.supports["cantilever"].moment / rod.supports["cantilever"].moment - 1).max()
    tip = np.abs(response.tips["cantilever"] - rod.tips["cantilever"]).max()
    return float(force), float(arc), float(moment), float(tip)


@pytest.mark.parametrize(("elements", "bound"), [(5, 1.6e-3), (10, 1e-4), (20, 5e-6), (40, 1e-6)])
def test_mixed(scene_and_rod, elements, bound):
    scene, rod = scene_and_rod
    response = solve(scene, "tsm", Options(elements=elements))
    assert response.completed
    assert response.cutbacks == 0
    assert np.array_equal(response.load_parameter, rod.load_parameter)
    assert max(errors(response, rod)) <= bound


def test_mixed_has_no_floor(scene_and_rod):
    scene, rod = scene_and_rod
    assert max(errors(solve(scene, "tsm", Options(elements=200)), rod)) <= 3e-9


def test_fourth_order_in_every_quantity(scene_and_rod):
    scene, rod = scene_and_rod
    found = [errors(solve(scene, "tsm", Options(elements=n)), rod) for n in (5, 20)]
    orders = np.log2(np.array(found[0]) / np.array(found[1])) / 2
    assert (np.abs(orders - 4) <= 0.4).all(), orders


@pytest.mark.parametrize(("elements", "bound"), [(10, 1e-2), (20, 3e-3), (50, 6e-4)])
def test_the_papers_element_at_the_end(elements, bound):
    scene = load_scene("ks-cantilever")
    response = solve(scene, "tsm", Options(elements=elements, element="timoshenko"))
    rod = solve(scene, "rod")
    assert abs(response.contacts[PAIR].force[-1] / rod.contacts[PAIR].force[-1] - 1) <= bound
