"""The parts of the difference of beams and solid sum to it."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.models.model import ModelError
from comparisons.scene import load_scene
from comparisons.suite.budget import PARTS, TIMES, budget_rows, error_budget

KS = load_scene("ks-cantilever")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ks-cantilever", "ks-face"])
def test_parts_sum_to_the_difference(name, stated):
    """The largest rest is of the arc position at t = .75; the solid of the rod's law is the rod within .1 % and .05 %."""
    budget = error_budget(load_scene(name))
    rest = max(np.abs(budget.rest(quantity)).max() for quantity in budget.total)
    assert rest < 0.015
    stated(f"budget.rest-{name}", rest)
    largest = {part: np.abs(values).max() for part, values in budget.parts["contact_force"].items()}
    assert list(largest) == list(PARTS)
    assert max(largest, key=lambda part: largest[part]) == "material law"
    bars = {"TSM mesh": 2e-6, "TSM theory": 1e-8, "solid mesh": 5e-5, "penalty": 2e-6, "load steps": 1e-8}
    for part, bar in (bars | {"solid beside the rod": 1e-3}).items():
        assert largest[part] < bar
    assert np.abs(budget.parts["arc_position"]["solid beside the rod"]).max() < 5e-4
    rows = list(budget_rows(budget))
    assert len(rows) == 3 * len(TIMES)
    for row in rows:
        rest = row["total"] - sum(row["parts"].values())
        assert row["rest_over_total"] == pytest.approx(rest / row["total"], abs=1e-12)


@pytest.mark.slow
def test_a_frame_has_one_with_supports_in_place_of_contacts():
    scene = load_scene("portal-frame")
    found = error_budget(replace(scene, beams=tuple(replace(beam, mesh=(12, 1)) for beam in scene.beams)))
    assert {name.partition(" ")[0] for name in found.total} == {"support_force", "clamp_moment"}
    for quantity, total in found.total.items():
        rest = total - sum(found.parts[quantity].values())
        assert np.isfinite(total).all()
        assert np.abs(rest).max() < 0.1 * np.abs(total).max()


def test_a_pair_that_touches_late_has_one_from_there_on():
    pin = replace(KS.pins[0], start=(0.8, -0.2), displacement=(0.0, 0.5))
    found = error_budget(replace(KS, beams=(replace(KS.beams[0], mesh=(12, 1)),), pins=(pin,)))
    for quantity in ("contact_force", "arc_position"):
        assert np.isnan(found.total[quantity]).tolist() == [True, False, False, False]
    assert np.abs(found.rest("contact_force")[1:]).max() < 0.11, "on a coarse mesh"


def test_scenes_without_a_budget_say_why():
    pin = replace(KS.pins[0], start=(0.8, -0.5), displacement=(0.0, 0.1))
    with pytest.raises(ModelError, match="have no force"):
        error_budget(replace(KS, pins=(pin,)))
