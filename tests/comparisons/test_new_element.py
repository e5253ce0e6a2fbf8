"""An element that is registered is right wherever elements are asked for: accuracy, figures, comparisons of cost."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.accuracy import solve_to
from comparisons.cases import Case
from comparisons.models import TSM, solve
from comparisons.models.options import Options
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


def test_figures_and_labels_have_it():
    options = Options(element=KIND.name, elements=10)
    assert TSM.run_label(options) == "TSM new, 10 elements"
    assert Case(scene=KS, model=TSM.name, options=options).label == "tsm new 10"
    assert (TSM.styles()["TSM new"].colour, TSM.styles()["TSM new"].marker) == ("#AA3377", "x")
