"""An element that is registered is right wherever elements are asked for."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.accuracy import solve_to
from comparisons.models import solve
from comparisons.scene import load_scene
from tsm.elements import MIXED

KIND = replace(MIXED, name="new", sheared=False, colour="#AA3377", marker="x")
KS = replace(load_scene("ks-cantilever"), load_parameters=8)


@pytest.fixture(autouse=True)
def registered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(tsm.ELEMENTS, KIND.name, KIND)


def test_accuracy_grades_its_mesh_by_its_order_and_keeps_the_promise():
    stiff = replace(KS.beams[0], shear_modulus=1e9 * KS.beams[0].youngs_modulus, poissons_ratio=None)
    rigid = replace(KS, beams=(stiff,), load_parameters=4)
    answer = solve_to(rigid, 1e-5, element=KIND.name)
    exact = solve(rigid, "rod").contacts["pin->cantilever"].force
    force = answer.response.contacts["pin->cantilever"].force
    assert answer.reached
    assert np.abs(force - exact).max() <= 1e-5 * exact.max()
