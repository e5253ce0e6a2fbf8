"""VTU and PVD files: what is read back is what was computed."""

import contextlib
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

from comparisons.cli import main
from comparisons.files import OutputError
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import ContactSpec, load_scene
from comparisons.show.export import pin_grid, write_series, write_vtu
from comparisons.show.listing import digest, with_digests

SCENE = replace(load_scene("ks-cantilever"), load_parameters=3)
ROUND_TRIP = {"rtol": 1e-12, "atol": 1e-12}


@pytest.fixture(scope="module", params=["tsm", "solid", "rod"])
def response(request: pytest.FixtureRequest) -> Response:
    options = {"tsm": Options(elements=4), "solid": Options(mesh=(12, 2))}
    return solve(SCENE, request.param, options.get(request.param))


def test_vtu_reads_back_in_meshio_and_pyvista(response: Response, tmp_path: Path) -> None:
    for name, grid in (("body.vtu", response.grid(2)), ("pin.vtu", pin_grid(response, SCENE, 2))):
        write_vtu(tmp_path / name, grid)
        back, view = meshio.read(tmp_path / name), pyvista.read(tmp_path / name)
        for points in (back.points, view.points):
            np.testing.assert_allclose(points[:, :2], grid.points, **ROUND_TRIP)
            assert not points[:, 2].any()
        (kind, cells), (block,) = next(iter(grid.cells.items())), back.cells
        assert block.type == kind
        np.testing.assert_array_equal(block.data, cells)
        np.testing.assert_array_equal(view.cells.reshape(len(cells), -1)[:, 1:], cells)
        for field, values in grid.point_data.items():
            for read in (back.point_data[field], view.point_data[field]):
                columns = read[:, : values.shape[1]] if values.ndim == 2 else read
                np.testing.assert_allclose(columns, values, **ROUND_TRIP)


def test_fields_of_each_model(response: Response) -> None:
    expected = {
        "tsm": {
            "displacement",
            "deformed",
            "rotation",
            "N",
            "V",
            "M",
            "beam",
            "arc",
            "height",
            "axial_stress_right",
            "axial_stress_left",
        },
        "solid": {"displacement", "deformed", "cauchy_stress", "axial_stress"},
        "rod": {"displacement", "deformed"},
    }
    assert set(response.grid(0).point_data) == expected[response.model]


def test_files_state_the_index(response: Response, tmp_path: Path) -> None:
    unstable = replace(response, index=np.array([0, 0, 2]))
    write_series(tmp_path, unstable, SCENE)
    found = [pyvista.read(tmp_path / f"{response.model}-000{k}.vtu").point_data["index"] for k in (1, 2, 3)]
    assert [set(values.tolist()) for values in found] == [{0}, {0}, {2}]
    write_series(tmp_path, replace(response, index=None), SCENE)
    assert "index" not in pyvista.read(tmp_path / f"{response.model}-0001.vtu").point_data


def test_quads_are_in_vtk_order(tmp_path: Path) -> None:
    solid = solve(SCENE, "solid", Options(mesh=(12, 2)))
    write_vtu(tmp_path / "solid.vtu", solid.grid(0))
    view = pyvista.read(tmp_path / "solid.vtu")
    assert set(view.celltypes) == {pyvista.CellType.BIQUADRATIC_QUAD}
    # VTK integrates its own biquadratic cells: a wrong order of points gives another area
    assert view.compute_cell_sizes()["Area"] == pytest.approx(np.full(24, 0.02 / 24), rel=1e-12)


def test_pin_force_balances_the_clamp_and_points_away_from_the_pin(response: Response) -> None:
    pin = pin_grid(response, SCENE, 0)
    force = pin.point_data["contact_force"][0]
    assert np.hypot(*force) == pytest.approx(response.contacts["pin->cantilever"].force[0], rel=1e-9)
    assert force[1] > 0.0
    assert pin.points + pin.point_data["displacement"] == pytest.approx(
        np.array([SCENE.pins[0].position(1 / 3)])
    )


def test_force_of_one_of_several_pairs_is_normal_to_the_axis() -> None:
    response = solve(SCENE, "tsm")
    idle = ContactSpec(node="cantilever.end", beam="other", side="left")
    other = replace(SCENE.beams[0], name="other", start=(0.0, -1.0), end=(1.0, -1.0))
    several = replace(SCENE, beams=(*SCENE.beams, other), contacts=(*SCENE.contacts, idle))
    one, alone = (pin_grid(response, scene, 2).point_data["contact_force"][0] for scene in (several, SCENE))
    assert one == pytest.approx(alone, abs=1e-3 * np.hypot(*alone))  # chords of the drawn line


def test_series_lists_its_files_and_removes_older_ones(response: Response, tmp_path: Path) -> None:
    longer = replace(SCENE, load_parameters=4)
    write_series(tmp_path, solve(longer, response.model), longer)
    (tmp_path / "other-0009.vtu").write_text("not ours")
    bodies = write_series(tmp_path, response, SCENE)
    entries = listed(tmp_path / f"{response.model}.pvd")
    assert [t for t, _ in entries] == [t for t in SCENE.times for _ in range(2)]
    assert {name for _, name in entries} | {"other-0009.vtu", f"{response.model}.pvd"} == {
        path.name for path in tmp_path.iterdir()
    }
    assert [path.name for path in bodies] == [f"{response.model}-{k:04d}.vtu" for k in (1, 2, 3)]
    assert pyvista.get_reader(tmp_path / f"{response.model}.pvd").time_values == sorted(SCENE.times)


def listed(pvd: Path) -> list[tuple[float, str]]:
    root = ET.parse(pvd).getroot()  # noqa: S314 our own file
    return [(float(item.attrib["timestep"]), item.attrib["file"]) for item in root.iter("DataSet")]


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_two_models_share_a_folder(tmp_path: Path) -> None:
    beams, solid = solve(SCENE, "tsm"), solve(SCENE, "solid", Options(mesh=(12, 2)))
    write_series(tmp_path, beams, SCENE)
    alone = contents(tmp_path)
    write_series(tmp_path, solid, SCENE)
    assert contents(tmp_path).items() > alone.items()
    both = {name for model in ("tsm", "solid") for _, name in listed(tmp_path / f"{model}.pvd")}
    assert both == {name for name in contents(tmp_path) if name.endswith(".vtu")}
    assert len(both) == 12


@pytest.mark.parametrize(
    "name", ["pin-head.vtu", "tsm-mine.vtu", "pin-0001.vtu", "tsm-0009.vtu", "tsm-pin-0044.vtu"]
)
def test_a_file_beside_the_series_stays(name: str, tmp_path: Path) -> None:
    beams = solve(SCENE, "tsm")
    write_series(tmp_path, beams, SCENE)
    (tmp_path / name).write_text("mine")
    write_series(tmp_path, beams, SCENE)
    assert (tmp_path / name).read_text() == "mine"


@pytest.mark.parametrize("name", ["tsm-0002.vtu", "tsm-pin-0003.vtu", "tsm.pvd"])
@pytest.mark.parametrize("before", [False, True])
def test_a_file_in_the_way_ends_the_run_before_anything_is_written(
    name: str, before: bool, tmp_path: Path
) -> None:
    """A file of somebody else's, or one of ours that was changed since."""
    beams = solve(SCENE, "tsm")
    if before:
        write_series(tmp_path, beams, SCENE)
    (tmp_path / name).write_text("mine")
    there = contents(tmp_path)
    with pytest.raises(OutputError, match=f"{name}: is there already, and is not as crossval wrote it"):
        write_series(tmp_path, beams, SCENE)
    assert contents(tmp_path) == there


def test_a_listed_file_that_was_changed_outlives_a_shorter_series(tmp_path: Path) -> None:
    write_series(tmp_path, solve(SCENE, "tsm"), SCENE)
    (tmp_path / "tsm-0003.vtu").write_text("mine")
    shorter = replace(SCENE, load_parameters=2)
    write_series(tmp_path, solve(shorter, "tsm"), shorter)
    assert (tmp_path / "tsm-0003.vtu").read_text() == "mine"
    assert not (tmp_path / "tsm-pin-0003.vtu").exists()


def test_a_list_cannot_reach_outside_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "d"
    folder.mkdir()
    outside = tmp_path / "tsm-0003.vtu"
    outside.write_text("mine")
    pvd = with_digests("<a/>", {"../tsm-0003.vtu": digest(outside)})
    (folder / "tsm.pvd").write_text(pvd)
    write_series(folder, solve(SCENE, "tsm"), SCENE)
    assert outside.read_text() == "mine"


def test_a_run_goes_on_where_another_was_ended_among_its_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After every number of moves."""
    beams, longer = solve(SCENE, "tsm"), replace(SCENE, load_parameters=4)
    more = solve(longer, "tsm")
    move = Path.replace
    for number in range(11):
        folder = tmp_path / str(number)
        folder.mkdir()
        write_series(folder, beams, SCENE)
        left = iter([True] * number)

        def ended(self: Path, target: Path, left: Iterator[bool] = left, folder: Path = folder) -> Path:
            if Path(target).parent == folder and self.suffix in (".vtu", ".pvd") and not next(left, False):
                raise MemoryError
            return move(self, target)

        monkeypatch.setattr(Path, "replace", ended)
        with contextlib.suppress(MemoryError):
            write_series(folder, more, longer)
        monkeypatch.setattr(Path, "replace", move)
        assert {name for _, name in listed(folder / "tsm.pvd")} <= contents(folder).keys()
        write_series(folder, beams, SCENE)
        names = {"tsm.pvd", *(name for _, name in listed(folder / "tsm.pvd"))}
        assert contents(folder).keys() == names
        assert len(names) == 7


def test_the_command_leaves_what_is_in_the_way(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Before anything is computed."""
    (tmp_path / "tsm-0007.vtu").write_text("mine")
    assert main(["solve", "ks-cantilever", "--model", "tsm", "--vtk", str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith(f"crossval: {tmp_path}/tsm-0007.vtu: is there already")
    assert contents(tmp_path) == {"tsm-0007.vtu": b"mine"}
