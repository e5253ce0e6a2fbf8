"""The parts of the difference of beams and solid sum to it."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.budget import PARTS, TIMES, Budget, error_budget
from comparisons.models.options import ModelError
from comparisons.scene import load_scene
from comparisons.show import budget_plot
from comparisons.show.budget_plot import plot_budget, write_budget


@pytest.fixture(scope="module", params=["ks-cantilever", pytest.param("ks-face", marks=pytest.mark.slow)])
def budget(request: pytest.FixtureRequest) -> Budget:
    return error_budget(load_scene(request.param))


def test_parts_sum_to_the_difference(budget: Budget, stated) -> None:
    """The largest rest is of the arc position at t = .75, where large parts cancel."""
    rest = max(np.abs(budget.rest(quantity)).max() for quantity in budget.total)
    assert rest < 0.015
    stated(f"budget.rest-{budget.scene}", rest)


def test_the_material_law_is_the_largest_part_of_the_force(budget: Budget) -> None:
    parts = budget.parts["contact_force"]
    largest = {name: np.abs(values).max() for name, values in parts.items()}
    assert max(largest, key=lambda name: largest[name]) == "material law"
    assert largest["TSM mesh"] < 2e-6
    assert largest["TSM theory"] < 1e-8
    assert largest["solid mesh"] < 5e-5
    assert largest["penalty"] < 2e-6
    assert largest["load steps"] < 1e-8


def test_the_solid_of_the_rods_law_is_the_rod_within_its_bar(budget: Budget) -> None:
    """.1 % in the force and .05 % in the arc position."""
    assert np.abs(budget.parts["contact_force"]["solid beside the rod"]).max() < 1e-3
    assert np.abs(budget.parts["arc_position"]["solid beside the rod"]).max() < 5e-4


def test_budget_is_drawn_and_written(budget: Budget, tmp_path: Path) -> None:
    plot_budget(budget, tmp_path / "budget.png", tmp_path / "budget.svg")
    write_budget(budget, tmp_path / "budget.json")
    data = json.loads((tmp_path / "budget.json").read_text())
    assert data["parts"] == PARTS
    assert len(data["rows"]) == 3 * len(TIMES)
    for row in data["rows"]:
        rest = row["total"] - sum(row["parts"].values())
        assert row["rest_over_total"] == pytest.approx(rest / row["total"], abs=1e-12)
    drawn = (tmp_path / "budget.svg").read_text()
    assert (tmp_path / "budget.png").stat().st_size > 1e4
    assert "</svg>" in drawn


def test_nothing_of_the_picture_is_cut_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """The limits reach around bars whose last part is thin, and the legend has every part."""
    kept: list[Any] = []
    monkeypatch.setattr(budget_plot, "save", lambda fig, *_: kept.append(fig))
    parts = {name: np.full(4, 1e-12 if name == "load steps" else 1e-3) for name in PARTS}
    names = ("contact_force long-name->beam", "clamp_moment beam.end", "arc_position", "support_force")
    plot_budget(
        Budget(
            scene="made-up", total=dict.fromkeys(names, np.full(4, 6e-3)), parts=dict.fromkeys(names, parts)
        )
    )
    (fig,) = kept
    fig.canvas.draw()
    for axes in fig.axes[: len(names)]:
        assert axes.get_ylim()[1] > 0.6
        assert axes.get_ylim()[0] < 0.0
    assert {text.get_text() for text in fig.legends[0].get_texts()} == {"difference", *PARTS}
    for text in (*fig.legends[0].get_texts(), *(axes.title for axes in fig.axes), *fig.texts):
        box = text.get_window_extent()
        assert 0.0 <= box.x0 <= box.x1 <= fig.bbox.width, text
        assert 0.0 <= box.y0 <= box.y1 <= fig.bbox.height, text


@pytest.mark.slow
def test_a_frame_has_one_with_supports_in_place_of_contacts() -> None:
    scene = load_scene("portal-frame")
    found = error_budget(replace(scene, beams=tuple(replace(beam, mesh=(12, 1)) for beam in scene.beams)))
    assert {name.partition(" ")[0] for name in found.total} == {"support_force", "clamp_moment"}
    for quantity, total in found.total.items():
        rest = total - sum(found.parts[quantity].values())
        assert np.isfinite(total).all()
        assert np.abs(rest).max() < 0.1 * np.abs(total).max()


@pytest.mark.slow
def test_a_pair_that_touches_late_has_one_from_there_on() -> None:
    late = load_scene("ks-cantilever")
    pin = replace(late.pins[0], start=(0.8, -0.2), displacement=(0.0, 0.5))
    beam = replace(late.beams[0], mesh=(12, 1))
    found = error_budget(replace(late, beams=(beam,), pins=(pin,)))
    assert np.isnan(found.total["contact_force"]).tolist() == [True, False, False, False]


def test_scenes_without_a_budget_say_why() -> None:
    scene = load_scene("ks-cantilever")
    pin = replace(scene.pins[0], start=(0.8, -0.5), displacement=(0.0, 0.1))
    with pytest.raises(ModelError, match="have no force"):
        error_budget(replace(scene, pins=(pin,)))
