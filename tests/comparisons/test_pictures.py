"""Stress panels and the pictures made of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from comparisons.compare import DRAWN
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import load_scene
from comparisons.show import render
from comparisons.show.panel import Panel, Scale
from comparisons.show.plot import plot_shapes
from comparisons.show.render import render_panels
from comparisons.show.stress import LAYERS, beam_panel, solid_panel

SCENE = replace(load_scene("ks-cantilever"), load_parameters=4)


@pytest.fixture(scope="module")
def beams() -> Response:
    return solve(SCENE, "tsm", Options(elements=20))


@pytest.fixture(scope="module")
def panels(beams: Response) -> list[Panel]:
    solid = solve(SCENE, "solid", Options(mesh=(24, 2)))
    return [beam_panel(beams, SCENE, [1, 3], "beams"), solid_panel(solid, SCENE, [1, 3], "solid")]


def test_beam_stress_at_the_clamp_is_that_of_bending(beams: Response) -> None:
    panel = beam_panel(beams, SCENE, [3], "beams")
    N, M = (beams.grid(3).point_data[name][0] for name in ("N", "M"))
    edges = [abs(N / 4e-4 - sign * M * 0.01 / (0.02**4 / 12)) for sign in (-1.0, 1.0)]
    assert [panel.stress[0], panel.stress[LAYERS]] == pytest.approx(edges, rel=1e-6)
    assert panel.points[[0, LAYERS]] == pytest.approx(np.array([[0.0, -0.01], [0.0, 0.01]]), abs=1e-4)


def test_beams_and_solid_show_the_same_stress(panels: list[Panel]) -> None:
    # the strains reach 3 %: Cauchy stress and the solid's material law differ by a few percent from the section forces
    assert panels[0].stress.max() == pytest.approx(panels[1].stress.max(), rel=0.1)
    for panel in panels:
        assert panel.quads.max() == len(panel.points) - 1
        corners = panel.points[panel.quads]
        d1, d2 = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
        area = 0.5 * (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])
        assert np.all(area > 0.0)
        assert area.sum() == pytest.approx(2 * 0.02, rel=0.01)


def test_a_round_pin_has_its_true_radius_beside_the_beam() -> None:
    """In the picture of both models the pin touches the face, as far as the solid's penalty lets it through."""
    pin = replace(SCENE.pins[0], start=(0.6, -0.06), displacement=(0.0, 0.1), radius=0.05)
    scene = replace(SCENE, pins=(pin,), contacts=(replace(SCENE.contacts[0], surface="face"),))
    drawn = [
        beam_panel(solve(scene, "tsm", Options(elements=20)), scene, [3], "beams"),
        solid_panel(solve(scene, "solid", Options(mesh=(48, 2))), scene, [3], "solid"),
    ]
    for panel in drawn:
        assert panel.radii.tolist() == [0.05]
        assert not panel.forces.any()
        nearest = [np.hypot(*(panel.points - centre).T).min() for centre in panel.pins]
        assert nearest == pytest.approx([0.05], abs=2e-3)
        scale = Scale.of([panel], "stress")
        assert scale.centre[1] - scale.extent[1] <= panel.pins[0, 1] - 0.05


def test_shapes_are_drawn_in_both_formats(beams: Response, tmp_path: Path) -> None:
    paths = [tmp_path / "shapes.png", tmp_path / "shapes.svg"]
    plot_shapes(SCENE, {"TSM mixed": beams, "exact rod": solve(SCENE, "rod")}, *paths)
    assert imread(paths[0]).std() > 0.05
    assert "<svg" in paths[1].read_text()
    assert sorted(tmp_path.glob("[!.]*")) == paths


def test_every_model_is_drawn_and_an_exact_element_has_no_marks(beams: Response, tmp_path: Path) -> None:
    models = {run.label.split(",")[0] for run in DRAWN}
    assert models == {"solid", "TSM timoshenko", "TSM mixed", "TSM exact", "exact rod"}
    exact = solve(SCENE, "tsm", Options(element="exact", elements=1))
    path = tmp_path / "shapes.svg"
    marks = []
    for element, response in (("mixed", beams), ("exact", exact)):
        plot_shapes(SCENE, {f"TSM {element}": response, "exact rod": solve(SCENE, "rod")}, path)
        marks.append(path.read_text().count("<use "))
    assert marks[0] >= marks[1] + 4 * 21


def coloured(path: Path) -> float:
    """Share of pixels that are not grey."""
    rgb = imread(path)[..., :3]
    return float(np.mean(np.ptp(rgb, axis=2) > 0.1))


@pytest.mark.slow
def test_side_by_side_picture_is_rendered_or_drawn(panels: list[Panel], tmp_path: Path) -> None:
    render_panels(panels, "stress", tmp_path / "both.png")
    assert list(tmp_path.glob("[!.]*")) == [tmp_path / "both.png"]
    assert coloured(tmp_path / "both.png") > 0.01
    height, width = imread(tmp_path / "both.png").shape[:2]
    assert width > 1.5 * height


def test_matplotlib_stands_in_where_rendering_dies(
    panels: list[Panel], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(render.sys, "executable", "/bin/false")
    sentence = render_panels(panels, "stress", tmp_path / "both.png")
    assert sentence is not None
    assert "matplotlib" in sentence
    assert coloured(tmp_path / "both.png") > 0.01
