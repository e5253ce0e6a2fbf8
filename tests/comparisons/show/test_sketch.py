"""The drawing of a scene: its legend, the true radius of pins, the values of loads, the symbols of supports."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.scene import LoadSpec, PinSpec, Scene, SupportSpec, load_scene, read_scene
from comparisons.show import sketch
from comparisons.show.symbols import NAMES, support_name, support_symbol, turned
from tests.comparisons.show.specimen import SPECIMEN

KS = load_scene("ks-face")
DRUM = PinSpec(name="pin", start=(0.5, -0.06), displacement=(0.0, 0.2), radius=0.05)


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Draw a scene and return its figure."""
    kept = []
    monkeypatch.setattr(sketch, "save", lambda fig, _: kept.append(fig))

    def draw(scene: Scene) -> Any:
        sketch.draw(scene, Path("unused.png"))
        fig = kept.pop()
        fig.canvas.draw()
        return fig

    return draw


def legend(fig: Any) -> list[str]:
    return [text.get_text() for text in fig.legends[0].get_texts()]


def words(fig: Any) -> list[str]:
    return [text.get_text() for text in fig.axes[0].texts]


def test_the_legend_names_what_is_drawn_and_nothing_else(drawn: Any) -> None:
    assert legend(drawn(KS)) == [
        "beam, height to scale", "side of contact: face of the beam", "clamped", "pin, a point", "path of a pin",
    ]  # fmt: skip
    rubbed = replace(KS, pins=(DRUM,), contacts=(replace(KS.contacts[0], friction=0.2),))
    found = legend(drawn(rubbed))
    assert "side of contact: face of the beam, friction 0.2" in found
    assert "pin of radius 0.05 m, to scale" in found
    frame = legend(drawn(load_scene("lees-frame")))
    assert {"pinned", "roller, free in x", "motion of a support"} < set(frame)


def test_a_round_pin_has_its_true_radius(drawn: Any) -> None:
    fig = drawn(replace(KS, pins=(DRUM,)))
    start, end = (patch for patch in fig.axes[0].patches if hasattr(patch, "radius"))
    assert start.radius == end.radius == 0.05
    assert start.center == pytest.approx((0.5, -0.06))
    assert end.center == pytest.approx((0.5, 0.14))


def test_loads_have_values_with_units(drawn: Any) -> None:
    tip = LoadSpec(beam="cantilever", end="end", force=(3.0, -4.0), moment=-1.5)
    assert {"5 N", "1.5 N m"} <= set(words(drawn(replace(KS, loads=(tip,)))))
    assert "400 N" in words(drawn(load_scene("portal-frame")))
    assert "54 cm" in words(drawn(load_scene("lees-frame")))


def test_curved_and_tapered_beams_springs_hinges_and_loads_along_a_beam(drawn: Any) -> None:
    scene = read_scene(SPECIMEN, "specimen")
    fig = drawn(scene)
    assert {
        "hinge", "spring of 3.5 N/mm in x", "spring of 100 N mm/rad in rotation", "force per length, arrows not to scale",
        "pin of radius 12 mm, to scale", "force, arrow not to scale",
    } < set(legend(fig))  # fmt: skip
    hook = scene.beam("hook")
    weight = 9810 * 7.8e-9 * 10 * 4 * hook.length
    assert {"0.01 N/mm", "2 N", "1 N (stage 2)", f"weight {weight:.4g} N"} <= set(words(fig))
    outline = fig.axes[0].patches[0].get_path().vertices
    radius = hook.length / 1.6
    reach = np.hypot(*(outline - [50.0, -np.sqrt(radius**2 - 50.0**2)]).T) - radius
    assert [np.abs(reach).max(), np.abs(reach).min()] == pytest.approx([3.0, 1.0], abs=1e-9)
    assert fig.axes[0].get_ylim()[1] > np.array(hook.place(0.5))[1]


def test_the_path_of_a_pin_goes_on_through_the_stages(drawn: Any) -> None:
    fig = drawn(read_scene(SPECIMEN, "specimen"))
    end = [patch for patch in fig.axes[0].patches if hasattr(patch, "radius")][-1]
    assert end.center == pytest.approx((220.0, -6.0))


@pytest.mark.parametrize("name", ["lees-frame", "double-beam-friction", "sleeve"])
def test_nothing_is_cut_off(name: str, drawn: Any) -> None:
    """Every word of axes and legend lies within the picture."""
    fig = drawn(load_scene(name))
    texts = [*fig.axes[0].texts, *fig.legends[0].get_texts(), fig.axes[0].title, fig.axes[0].xaxis.label]
    for text in texts:
        box = text.get_window_extent()
        assert box.x0 >= 0.0, text
        assert box.y0 >= 0.0, text
        assert box.x1 <= fig.bbox.width, text
        assert box.y1 <= fig.bbox.height, text


FRAME = """
scene = { name = "frame", units = "N, m", load_parameters = 1, gravity = [0, -9.81] }
beam = [
  { name = "left-column", start = [0, 0], end = [0, 3], clamped = ["start"], width = 0.1, height = 0.15, youngs_modulus = 2.1e11, poissons_ratio = 0.3, density = 7850 },
  { name = "girder", start = [0, 3], end = [5, 3], width = 0.1, height = 0.2, youngs_modulus = 2.1e11, poissons_ratio = 0.3, density = 7850 },
  { name = "right-column", start = [5, 0], end = [5, 3], clamped = ["start"], width = 0.1, height = 0.15, youngs_modulus = 2.1e11, poissons_ratio = 0.3, density = 7850 },
]
load = [
  { beam = "girder", force_per_length = [0, -20000], part = [0.2, 0.6] },
  { beam = "left-column", end = "end", force = [5000, 0] },
  { beam = "right-column", end = "end", force = [0, 3000] },
]
"""


@pytest.mark.parametrize("name", ["frame", "sleeve", "heavy-strip", "double-beam-friction"])
def test_labels_lie_apart_within_the_axes(name: str, drawn: Any) -> None:
    fig = drawn(read_scene(FRAME, name) if name == "frame" else load_scene(name))
    (axes,) = fig.axes
    boxes = [text.get_window_extent() for text in axes.texts if text.get_text()]
    assert len(boxes) > 1
    for k, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:k]), axes.texts[k]
        assert axes.bbox.fully_containsx(box.x0), axes.texts[k]
        assert axes.bbox.fully_containsx(box.x1), axes.texts[k]
        assert axes.bbox.fully_containsy(box.y0), axes.texts[k]
        assert axes.bbox.fully_containsy(box.y1), axes.texts[k]
    if name == "frame":
        (pulling,) = [text for text in axes.texts if text.get_text() == "3000 N"]
        assert pulling.xy[1] > 3.0  # beyond the end, and not inside the column


def test_every_support_has_a_name_and_a_symbol_of_its_own() -> None:
    up = np.array([0.0, 1.0])
    seen = set()
    for held, name in NAMES.items():
        support = SupportSpec(beam="b", end="start", fixed=held)
        assert support_name(support) == name
        segments = support_symbol(held, up)
        assert np.abs(segments).max() < 1.7
        seen.add(segments.tobytes())
    assert len(seen) == len(NAMES)


def test_a_symbol_lies_behind_the_node() -> None:
    """The ground of a clamp is on the side away from the beam."""
    clamp = ("x", "y", "rotation")
    for angle in np.linspace(0.0, 6.0, 7):
        away = np.array([np.cos(angle), np.sin(angle)])
        assert (support_symbol(clamp, away) @ away).max() < 1e-12
    assert turned(np.array([[[0.0, 1.0], [1.0, 0.0]]]), np.array([1.0, 0.0])) == pytest.approx(
        np.array([[[1.0, 0.0], [0.0, -1.0]]])
    )


def test_the_file_has_the_width_of_paper_and_letters_of_ten_points(tmp_path: Path) -> None:
    sketch.draw(KS, tmp_path / "scene.svg")
    width = re.search(r'width="([\d.]+)pt"', (tmp_path / "scene.svg").read_text())
    assert width
    assert float(width[1]) * 25.4 / 72 == pytest.approx(160, abs=0.5)
