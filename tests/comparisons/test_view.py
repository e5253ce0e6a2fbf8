"""``crossval view``: the motion in a window or as files, from a scene or from what a command wrote."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from comparisons.cli import main
from comparisons.files import writable_folder
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Grid, Response
from comparisons.scene import built_in_scenes, load_scene
from comparisons.show import render
from comparisons.show.export import write_series
from comparisons.show.view import Series, film, read_series, solved_series
from comparisons.show.view.bodies import panel

SCENE = replace(load_scene("ks-cantilever"), load_parameters=3)
Output = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def responses() -> list[Response]:
    return [solve(SCENE, "tsm", Options(elements=10)), solve(SCENE, "solid", Options(mesh=(24, 2)))]


@pytest.fixture(scope="module")
def series(responses: list[Response]) -> list[Series]:
    return [solved_series(response, SCENE, response.model) for response in responses]


def face_stress(grid: Grid, face: str | float) -> Any:
    """Axial stress on a face, named or by its undeformed height, at two places."""
    if isinstance(face, str):
        on, name = np.full(len(grid.points), fill_value=True), f"axial_stress_{face}"
    else:
        on, name = abs(grid.points[:, 1] - face) < 1e-9, "axial_stress"
    return np.interp([0.2, 0.4], grid.points[on, 0], grid.point_data[name][on])


def test_beams_and_solid_show_the_same_body_and_stress(series: list[Series]) -> None:
    beams, solid = (panel(one.body(2), one.pins(2), "") for one in series)
    stresses = []
    for one, faces in zip(series, (("right", "left"), (-0.01, 0.01)), strict=True):
        right, left = (face_stress(one.body(2), face) for face in faces)
        stresses.append((right - left) / 2)
    assert stresses[0] == pytest.approx(stresses[1], rel=0.02)
    assert beams.pins == pytest.approx(solid.pins)
    assert beams.forces == pytest.approx(solid.forces, rel=0.01)
    for one in (beams, solid):
        corners = one.points[one.quads]
        d1, d2 = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
        area = 0.5 * (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])
        assert np.all(area > 0.0)
        assert area.sum() == pytest.approx(0.02, rel=0.01)


def test_the_ribbon_has_the_height_and_the_bending_stress(
    responses: list[Response], series: list[Series]
) -> None:
    beams = panel(series[0].body(2), series[0].pins(2), "")
    right, left = beams.points[0], beams.points[4]
    assert np.hypot(*(left - right)) == pytest.approx(0.02)
    moment = -responses[0].supports["cantilever.start"].moment[2]
    assert beams.stress[0] - beams.stress[4] == pytest.approx(2 * moment * 0.01 / (0.02**4 / 12), rel=1e-9)


def test_the_ribbon_follows_the_axis(responses: list[Response], series: list[Series]) -> None:
    """Its middle is the cubic between the nodes: within 3e-4 of the axis with 10 elements."""
    beams = panel(series[0].body(2), series[0].pins(2), "")
    middle = beams.points.reshape(10, 9, 5, 2)[:, :, 2]
    _, axis = responses[0].axis_line("cantilever", 2)
    for e in range(10):
        at = np.linspace(0, 1, 9) * 10 + 10 * e
        exact = np.stack([np.interp(at, np.arange(101), axis[:, i]) for i in (0, 1)], axis=-1)
        assert np.abs(middle[e] - exact).max() < 5e-4


def test_files_give_the_same_film(responses: list[Response], series: list[Series], tmp_path: Path) -> None:
    for response in responses:
        write_series(writable_folder(tmp_path / response.model), response, SCENE)
    read = read_series(tmp_path)
    assert [one.title for one in read] == ["tsm", "solid"]
    ours, theirs = film(series, "stress"), film(read, "stress")
    assert ours.scale.half == pytest.approx(theirs.scale.half)
    assert ours.scale.stress == pytest.approx(theirs.scale.stress)
    for one, other in zip(ours.frames, theirs.frames, strict=True):
        for a, b in zip(one, other, strict=True):
            assert a.title == b.title
            np.testing.assert_allclose(a.points, b.points, atol=1e-9)
            np.testing.assert_allclose(a.stress, b.stress, rtol=1e-9, atol=1e-6)
            np.testing.assert_allclose(a.forces, b.forces, atol=1e-12)


def test_picture_and_motion(tmp_path: Path, capsys: Output) -> None:
    scene = tmp_path / "mine.toml"
    scene.write_text(
        built_in_scenes()["ks-cantilever"].replace("load_parameters = 50", "load_parameters = 3")
    )
    out = tmp_path / "out"
    assert main(["view", str(scene), "--mesh", "16x1", "--out", str(out)]) == 0
    assert sorted(path.name for path in out.iterdir()) == ["view.gif", "view.png"]
    with Image.open(out / "view.gif") as motion:
        assert motion.n_frames == 3
        frames = []
        for k in range(3):
            motion.seek(k)
            frames.append(np.asarray(motion.convert("RGB"), float))
    assert all(np.abs(a - b).max() > 50 for a, b in pairwise(frames))
    said = capsys.readouterr()
    assert str(out / "view.png") in said.out
    assert said.err.startswith("solving: TSM\nsolving: solid\ndrawing ")


def test_without_opengl_matplotlib_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Output
) -> None:
    monkeypatch.setattr(render.sys, "executable", "/bin/false")
    write_series(writable_folder(tmp_path / "tsm"), solve(SCENE, "tsm"), SCENE)
    assert main(["view", str(tmp_path), "--out", str(tmp_path / "out")]) == 0
    assert "matplotlib" in capsys.readouterr().err
    with Image.open(tmp_path / "out" / "view.gif") as motion:
        assert motion.n_frames == 3


def test_a_window_where_there_is_a_display(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: Output
) -> None:
    write_series(writable_folder(tmp_path / "tsm"), solve(SCENE, "tsm"), SCENE)
    monkeypatch.setenv("DISPLAY", ":0")
    shown = []
    monkeypatch.setattr("comparisons.show.view.show", lambda found: shown.append(found) or True)
    assert main(["view", str(tmp_path)]) == 0
    assert len(shown[0].frames) == 3
    monkeypatch.setattr("comparisons.show.view.show", lambda _: False)
    assert main(["view", str(tmp_path)]) == 2
    assert "no window could be opened" in capsys.readouterr().err


@pytest.mark.parametrize("broken", ["empty", "not a PVD", "not a VTU", "no VTU"])
def test_a_broken_folder_is_one_line(broken: str, tmp_path: Path, capsys: Output) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    if broken != "empty":
        write_series(folder, solve(SCENE, "tsm"), SCENE)
    if broken == "not a PVD":
        (folder / "tsm.pvd").write_text("<VTKFile>")
    if broken == "not a VTU":
        (folder / "tsm-0002.vtu").write_text("nothing")
    if broken == "no VTU":
        (folder / "tsm-0002.vtu").unlink()
    assert main(["view", str(folder), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1, error
    assert str(folder) in error
    assert not list((tmp_path / "out").iterdir())


def test_a_solid_that_cannot_state_the_scene_is_left_out(tmp_path: Path, capsys: Output) -> None:
    scene = tmp_path / "rigid.toml"
    scene.write_text(
        built_in_scenes()["ks-printed-shear"].replace("load_parameters = 50", "load_parameters = 2")
    )
    assert main(["view", str(scene), "--out", str(tmp_path / "out")]) == 0
    assert "solid: left out, " in capsys.readouterr().err
    assert (tmp_path / "out" / "view.gif").is_file()
