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
from comparisons.response import OPEN, SLIPS, Grid, Response
from comparisons.scene import built_in_scenes, load_scene, read_scene
from comparisons.show import render
from comparisons.show.export import write_series
from comparisons.show.view import Series, film, read_series, solved_series
from comparisons.show.view.bodies import panel
from tests.comparisons.show.specimen import SPECIMEN

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


@pytest.mark.slow
def test_beams_and_solid_show_the_same_body_and_stress(series: list[Series]) -> None:
    beams, solid = (panel(one.blocks(2), "") for one in series)
    stresses = []
    for one, faces in zip(series, (("right", "left"), (-0.01, 0.01)), strict=True):
        right, left = (face_stress(one.blocks(2)["cantilever"], face) for face in faces)
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
    beams = panel(series[0].blocks(2), "")
    right, left = beams.points[0], beams.points[4]
    assert np.hypot(*(left - right)) == pytest.approx(0.02)
    moment = -responses[0].supports["cantilever.start"].moment[2]
    assert beams.stress[0] - beams.stress[4] == pytest.approx(2 * moment * 0.01 / (0.02**4 / 12), rel=1e-9)


def test_supports_forces_between_beams_and_their_states_are_drawn() -> None:
    scene = replace(load_scene("double-beam-friction"), load_parameters=4)
    response = solve(scene, "tsm")
    found = panel(solved_series(response, scene, "t").blocks(3), "t")
    assert found.states.tolist() == [SLIPS[1], SLIPS[-1], OPEN]
    assert np.hypot(*found.forces.T)[:2] == pytest.approx(
        [response.contacts[pair].force[3] for pair in ("pin->upper", "upper.end->lower")]
    )
    centres = found.supports.reshape(2, -1, 2).mean(axis=1)
    assert centres == pytest.approx(np.array([[0.0, 0.0], [0.0, -0.2]]), abs=0.03)
    still = replace(scene.pins[0], start=(0.8, 0.4), displacement=(0.0, 0.1))
    assert (
        OPEN
        in panel(solved_series(solve(replace(scene, pins=(still,)), "tsm"), scene, "t").blocks(0), "t").states
    )


def test_a_curved_and_tapered_ribbon_has_the_heights_of_its_ends() -> None:
    scene = read_scene(SPECIMEN, "specimen")
    blocks = solved_series(solve(scene, "tsm"), scene, "t").blocks(0)
    one = panel({"hook": blocks["hook"]}, "t")
    sections = one.points.reshape(-1, 5, 2)
    heights = np.hypot(*(sections[:, -1] - sections[:, 0]).T)
    assert heights[[0, -1]] == pytest.approx([6.0, 2.0])
    assert np.all(np.diff(heights) < 1e-9)
    # the first section is clamped: across the tangent of the arc
    across = sections[0, -1] - sections[0, 0]
    assert across @ scene.beam("hook").tangent(0.0) == pytest.approx(0.0, abs=0.02)
    assert len(panel(blocks, "t").supports) > len(one.supports) == 0


@pytest.mark.parametrize("factor", ["0", "-1", "many", "inf"])
def test_a_factor_must_be_a_positive_number(factor: str, tmp_path: Path, capsys: Output) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["view", "ks-cantilever", "--scale", factor, "--out", str(tmp_path / "out")])
    assert "--scale" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_files_give_the_same_film(responses: list[Response], series: list[Series], tmp_path: Path) -> None:
    for response in responses:
        write_series(writable_folder(tmp_path / response.model), response, SCENE)
    read = read_series(tmp_path)
    assert [one.title for one in read] == ["tsm", "solid"]
    direct, stored = film(series), film(read)
    assert direct.scale.label == stored.scale.label == "axial stress [N/m^2]"
    assert direct.scale.arrow == stored.scale.arrow
    assert direct.scale.extent == pytest.approx(stored.scale.extent)
    assert direct.scale.stress == pytest.approx(stored.scale.stress)
    for one, other in zip(direct.frames, stored.frames, strict=True):
        for a, b in zip(one, other, strict=True):
            assert a.title == b.title
            np.testing.assert_allclose(a.points, b.points, atol=1e-9)
            np.testing.assert_allclose(a.stress, b.stress, rtol=1e-9, atol=1e-6)
            np.testing.assert_allclose(a.forces, b.forces, atol=1e-12)
            np.testing.assert_allclose(a.supports, b.supports, atol=1e-12)
            assert a.states.tolist() == b.states.tolist()


@pytest.mark.slow
def test_picture_and_motion(tmp_path: Path, capsys: Output) -> None:
    scene = tmp_path / "mine.toml"
    scene.write_text(
        built_in_scenes()["ks-cantilever"].replace("load_parameters = 50", "load_parameters = 3")
    )
    out = tmp_path / "out"
    assert main(["view", str(scene), "--mesh", "16x1", "--out", str(out)]) == 0
    assert sorted(path.name for path in out.iterdir()) == [".crossval", "view.gif", "view.png"]
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


@pytest.mark.parametrize("broken", ["empty", "not a PVD", "not a VTM", "not a VTU", "no VTU"])
def test_a_broken_folder_is_one_line(broken: str, tmp_path: Path, capsys: Output) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    if broken != "empty":
        write_series(folder, solve(SCENE, "tsm"), SCENE)
    if broken == "not a PVD":
        (folder / "tsm.pvd").write_text("<VTKFile>")
    if broken == "not a VTM":
        (folder / "tsm-0002.vtm").write_text("<VTKFile><DataSet name='a'/></VTKFile>")
    if broken == "not a VTU":
        (folder / "tsm-0002-0.vtu").write_text("nothing")
    if broken == "no VTU":
        (folder / "tsm-0002-0.vtu").unlink()
    assert main(["view", str(folder), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1, error
    assert str(folder) in error
    assert not list((tmp_path / "out").iterdir())
