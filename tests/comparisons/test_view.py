"""Pictures and motions: bodies with their stress, pins, forces and supports."""

from dataclasses import replace
from itertools import chain, pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from PIL import Image

from comparisons.answer import Response
from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.report.export import HINGES, blocks, read_series, solved_series, write_series
from comparisons.report.panel import Panel, mises_panels, panel  # what is drawn, before it is pixels
from comparisons.report.render import film
from comparisons.scene import load_scene, to_toml
from tests.comparisons.report.specimen import SPECIMEN

SCENE = replace(load_scene("ks-cantilever"), load_parameters=3)


@pytest.fixture(scope="module")
def responses() -> list[Response]:
    return [solve(SCENE, "tsm", Options(elements=20)), solve(SCENE, "solid", Options(mesh=(24, 2)))]


def area(one: Panel) -> float:
    """Area of the quadrilaterals, none of which is turned inside out."""
    corners = one.quads
    d1, d2 = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    areas = 0.5 * (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])
    assert np.all(areas > 0.0)
    return float(areas.sum())


def test_beams_and_solid_show_the_same_bodies_and_stress(responses):
    beams, solid = responses
    (*mises, apart), wide = mises_panels(beams, solid, SCENE, 1.0)
    # the strains reach 3 %: Cauchy stress and the solid's material law differ by a few percent from the section forces
    assert mises[0].stress.max() == pytest.approx(mises[1].stress.max(), rel=0.1)
    assert wide == 3.0
    assert [area(one) for one in (*mises, apart)] == pytest.approx([wide * 0.02] * 3, rel=0.01)
    # both have nearly the same stress at the same place of the body, and where the solid has more the difference is negative
    high = mises[1].stress > 0.5 * mises[1].stress.max()
    share = (apart.stress / mises[1].stress)[high]
    assert np.abs(share).max() < 0.12
    assert share[np.argmax(mises[1].stress[high])] < 0.0
    grids = [blocks(one, SCENE, 2) for one in responses]
    axial = [panel(grid, "") for grid in grids]
    assert [area(one) for one in axial] == pytest.approx([0.02] * 2, rel=0.01)
    assert axial[0].pins == pytest.approx(axial[1].pins)
    assert axial[0].forces == pytest.approx(axial[1].forces, rel=0.01)
    own, other = (grid["cantilever"] for grid in grids)
    at, data = [0.2, 0.4], other.point_data["axial_stress"]
    right, left = (
        np.interp(at, own.points[:, 0], own.point_data[f"axial_stress_{name}"]) for name in ("right", "left")
    )
    below, above = (abs(other.points[:, 1] - y) < 1e-9 for y in (-0.01, 0.01))
    below, above = (np.interp(at, other.points[on, 0], data[on]) for on in (below, above))
    assert right - left == pytest.approx(below - above, rel=0.02)


def test_supports_hinges_and_the_heights_of_curved_beams_are_drawn():
    whole = blocks(solve(SPECIMEN, "tsm"), SPECIMEN, 0)
    unhinged = {name: grid for name, grid in whole.items() if name != HINGES}
    assert len(panel(whole, "t").supports) > len(panel(unhinged, "t").supports) > 0
    quads = panel({"hook": whole["hook"]}, "t").quads.reshape(-1, 4, 4, 2)  # four layers, four corners
    across = np.concatenate([quads[:, -1, 3] - quads[:, 0, 0], quads[-1:, -1, 2] - quads[-1:, 0, 1]])
    heights = np.hypot(*across.T)
    assert heights[[0, -1]] == pytest.approx([6.0, 2.0])
    assert np.all(np.diff(heights) < 1e-9)
    # the first section is clamped: across the tangent of the arc
    assert across[0] @ SPECIMEN.beam("hook").tangent(0.0) == pytest.approx(0.0, abs=0.02)


def coloured(path: Path) -> float:
    """Share of pixels that are not grey."""
    return float(np.mean(np.ptp(imread(path)[..., :3], axis=2) > 0.1))


@pytest.mark.slow
def test_motions_are_drawn(in_folder, capsys):
    coarse = replace(SCENE, beams=tuple(replace(beam, mesh=(16, 1)) for beam in SCENE.beams))
    Path("mine.toml").write_text(to_toml(coarse))
    assert main(["view", "mine.toml", "--out", "out"]) == 0
    assert sorted(path.name for path in Path("out").iterdir()) == [".crossval", "view.gif", "view.png"]
    assert coloured(Path("out/view.png")) > 0.01
    frames = []
    with Image.open("out/view.gif") as motion:
        for k in range(motion.n_frames):
            motion.seek(k)
            frames.append(np.asarray(motion.convert("RGB"), float))
    assert len(frames) == 3
    assert all(np.abs(a - b).max() > 50 for a, b in pairwise(frames))
    said = capsys.readouterr()
    assert "out/view.png" in said.out
    assert said.err.startswith("solving: TSM\nsolving: solid\ndrawing ")


def test_files_give_the_same_motion(responses, tmp_path):
    for response in responses:
        (tmp_path / response.model).mkdir()
        write_series(tmp_path / response.model, response, SCENE)
    stored = film(read_series(tmp_path))
    direct = film([solved_series(response, SCENE, response.model) for response in responses])
    assert stored.scales[0].label == "axial stress [N/m^2]"
    assert stored.scales[0].arrow == direct.scales[0].arrow
    for one, other in zip(chain(*direct.frames), chain(*stored.frames), strict=True):
        assert (one.title, one.states.tolist()) == (other.title, other.states.tolist())
        for name, close in (("quads", 1e-9), ("stress", 1e-6), ("forces", 1e-12), ("supports", 1e-12)):
            relative = 1e-9 if name == "stress" else 0.0
            np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=relative, atol=close)


BROKEN = [("tsm.pvd", "<VTKFile>"), ("tsm-0002.vtm", "<VTKFile><DataSet name='a'/></VTKFile>"), ("tsm-0002-0.vtu", "nothing"), ("tsm-0002-0.vtu", None), ("none", "")]  # fmt: skip


@pytest.mark.parametrize(("name", "text"), BROKEN)
def test_a_broken_folder_is_one_line(name, text, responses, tmp_path, capsys):
    folder, out = tmp_path / "folder", tmp_path / "out"
    folder.mkdir()
    if text != "":
        write_series(folder, responses[0], SCENE)
        (folder / name).unlink() if text is None else (folder / name).write_text(text)
    assert main(["view", str(folder), "--out", str(out)]) == 2
    (error,) = capsys.readouterr().err.splitlines()
    assert str(folder) in error
    assert not list(out.iterdir())
