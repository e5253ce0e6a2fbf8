"""The drawing of a scene: its legend, the true radius of pins, the values of loads, the symbols of supports."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from comparisons.cli import main
from comparisons.scene import LoadSpec, PinSpec, Scene, load_scene, to_toml
from tests.comparisons.report.specimen import SPECIMEN

KS = load_scene("ks-face")
DRUM = PinSpec(name="pin", start=(0.5, -0.06), displacement=(0.0, 0.2), radius=0.05)
Draw = Callable[[Scene], Any]


@pytest.fixture
def drawn(in_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Draw:
    """Draw a scene by the command and return its figure."""
    kept, save = [], Figure.savefig

    def keep(fig: Any, *more: Any, **options: Any) -> None:
        kept.append(fig)
        save(fig, *more, **options)

    monkeypatch.setattr(Figure, "savefig", keep)

    def draw(scene: Scene) -> Any:
        Path("s.toml").write_text(to_toml(scene))
        assert main(["check", "s.toml", "--out", "scene.svg"]) == 0
        fig = kept.pop()
        fig.canvas.draw()
        return fig

    return draw


def legend(fig: Any) -> list[str]:
    return [text.get_text() for text in fig.legends[0].get_texts()]


def words(fig: Any) -> set[str]:
    return {text.get_text() for text in fig.axes[0].texts}


def discs(fig: Any) -> list[Any]:
    return [patch for patch in fig.axes[0].patches if hasattr(patch, "radius")]


def test_a_round_pin_has_its_true_radius_and_loads_have_values_with_units(drawn):
    tip = LoadSpec(beam="cantilever", end="end", force=(3.0, -4.0), moment=-1.5)
    rubbed = replace(KS.contacts[0], friction=0.2)
    fig = drawn(replace(KS, pins=(DRUM,), contacts=(rubbed,), loads=(tip,)))
    told = {"side of contact: face of the beam, friction 0.2", "pin of radius 0.05 m, to scale"}
    assert told < set(legend(fig))
    assert {"5 N", "1.5 N m"} <= words(fig)
    start, end = discs(fig)
    assert start.radius == end.radius == 0.05
    assert [*start.center, *end.center] == pytest.approx([0.5, -0.06, 0.5, 0.14])


def test_curved_and_tapered_beams_springs_hinges_stages_and_loads_along_a_beam(drawn):
    fig = drawn(SPECIMEN)
    assert {
        "hinge", "spring of 3.5 N/mm in x", "spring of 100 N mm/rad in rotation", "force per length, arrows not to scale",
        "pin of radius 12 mm, to scale", "force, arrow not to scale",
    } < set(legend(fig))  # fmt: skip
    hook = SPECIMEN.beam("hook")
    weight = 9810 * 7.8e-9 * 10 * 4 * hook.length
    assert {"0.01 N/mm", "2 N", "1 N (stage 2)", f"weight {weight:.4g} N"} <= words(fig)
    assert discs(fig)[-1].center == pytest.approx((220.0, -6.0)), "the path goes on through the stages"
    outline = fig.axes[0].patches[0].get_path().vertices
    radius = hook.length / 1.6
    reach = np.hypot(*(outline - [50.0, -np.sqrt(radius**2 - 50.0**2)]).T) - radius
    assert [np.abs(reach).max(), np.abs(reach).min()] == pytest.approx([3.0, 1.0], abs=1e-9)
    assert fig.axes[0].get_ylim()[1] > hook.place(0.5)[1]


@pytest.mark.parametrize("name", ["frame", "sleeve", "double-beam-friction"])
def test_labels_lie_apart_and_nothing_is_cut_off(name, drawn):
    fig = drawn(load_scene(str(Path(__file__).with_name("frame.toml")) if name == "frame" else name))
    (axes,) = fig.axes
    labels = [text for text in axes.texts if text.get_text()]
    boxes = [text.get_window_extent() for text in labels]
    assert len(boxes) > 1
    for k, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:k]), labels[k]
        assert all(axes.bbox.fully_contains(*corner) for corner in box.corners()), labels[k]
    for text in (*fig.legends[0].get_texts(), axes.title, axes.xaxis.label):
        assert all(fig.bbox.contains(*corner) for corner in text.get_window_extent().corners()), text
    if name == "frame":
        (pulling,) = [text for text in labels if text.get_text() == "3000 N"]
        assert pulling.xy[1] > 3.0  # beyond the end, and not inside the column


def test_the_ground_of_a_clamp_is_on_the_side_away_from_the_beam(drawn):
    away = np.array([np.cos(3.0), np.sin(3.0)])
    beam = replace(KS.beams[0], start=(0.0, 0.0), end=tuple(away))
    tip = LoadSpec(beam=beam.name, end="end", moment=1.0)
    fig = drawn(replace(KS, beams=(beam,), pins=(), contacts=(), loads=(tip,)))
    behind = np.concatenate(fig.axes[0].collections[0].get_segments()) @ away
    assert behind.max() < 1e-9
    assert behind.min() < -0.005
