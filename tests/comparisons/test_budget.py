"""The parts of the difference of beams and solid sum to it."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.budget import PARTS, TIMES, Budget, budget_rows, error_budget
from comparisons.models.options import ModelError
from comparisons.scene import load_scene

# not public: the figure before it is a file, for the room that its texts take
from comparisons.show import budget_plot

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


def test_nothing_of_the_picture_is_cut_off(monkeypatch):
    """The limits reach around bars whose last part is thin, and the legend has every part."""
    kept = []
    monkeypatch.setattr(budget_plot, "save", lambda fig, *_: kept.append(fig))
    parts = {name: np.full(4, 1e-12 if name == "load steps" else 1e-3) for name in PARTS}
    names = ("contact_force long-name->beam", "clamp_moment beam.end", "arc_position", "support_force")
    total = dict.fromkeys(names, np.full(4, 6e-3))
    budget_plot.plot_budget(Budget(scene="made-up", total=total, parts=dict.fromkeys(names, parts)))
    (fig,) = kept
    fig.canvas.draw()
    for axes in fig.axes[: len(names)]:
        assert axes.get_ylim()[0] < 0.0
        assert axes.get_ylim()[1] > 0.6
    texts = fig.legends[0].get_texts()
    assert {text.get_text() for text in texts} == {"difference", *PARTS}
    for text in (*texts, *(axes.title for axes in fig.axes), *fig.texts):
        box = text.get_window_extent()
        assert 0.0 <= box.x0 <= box.x1 <= fig.bbox.width, text
        assert 0.0 <= box.y0 <= box.y1 <= fig.bbox.height, text


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
    assert np.isnan(found.total["contact_force"]).tolist() == [True, False, False, False]
    assert np.abs(found.rest("contact_force")[1:]).max() < 0.11, "on a coarse mesh"


def test_scenes_without_a_budget_say_why():
    pin = replace(KS.pins[0], start=(0.8, -0.5), displacement=(0.0, 0.1))
    with pytest.raises(ModelError, match="have no force"):
        error_budget(replace(KS, pins=(pin,)))
