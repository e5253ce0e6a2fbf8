"""VTU and PVD files: what is read back is what was computed."""

import contextlib
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

from comparisons.files import WRITTEN, OutputError
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import load_scene, read_scene
from comparisons.show.export import CONTACTS, HINGES, SUPPORTS, blocks, field_units, write_series
from comparisons.show.vtu import grid_text
from tests.comparisons.show.specimen import SPECIMEN

SCENE = replace(load_scene("ks-cantilever"), load_parameters=3)


@pytest.fixture(scope="module", params=["tsm", "solid", "rod"])
def response(request: pytest.FixtureRequest) -> Response:
    options = {"tsm": Options(elements=4), "solid": Options(mesh=(12, 2))}
    return solve(SCENE, request.param, options.get(request.param))


def test_every_block_reads_back_in_meshio_and_pyvista(response: Response, tmp_path: Path) -> None:
    for name, grid in blocks(response, SCENE, 2).items():
        file = tmp_path / "block.vtu"
        file.write_text(grid_text(grid, field_units(SCENE)))
        back, view = meshio.read(file), pyvista.read(file)
        for points in (back.points, view.points):
            np.testing.assert_array_equal(points[:, :2], grid.points)
            assert not points[:, 2].any()
        (kind, cells), (block,) = next(iter(grid.cells.items())), back.cells
        assert block.type == kind
        np.testing.assert_array_equal(block.data, cells)
        np.testing.assert_array_equal(view.cells.reshape(len(cells), -1)[:, 1:], cells)
        assert set(view.point_data) == set(back.point_data) == set(grid.point_data), name
        for field, values in grid.point_data.items():
            for read in (back.point_data[field], view.point_data[field]):
                columns = read.reshape(len(values), -1)
                np.testing.assert_array_equal(columns[:, : values[0].size].reshape(values.shape), values)


def test_fields_of_each_model(response: Response) -> None:
    always = {"displacement", "deformed", "index"}
    expected = {
        "tsm": always
        | {"rotation", "N", "V", "M", "arc", "height", "axial_stress_right", "axial_stress_left"},
        "solid": always | {"stress_xx", "stress_yy", "stress_xy", "von_mises", "axial_stress"},
        "rod": always - {"index"},
    }
    found = blocks(response, SCENE, 0)
    assert set(found["cantilever"].point_data) == expected[response.model]
    assert list(found) == ["cantilever", CONTACTS, SUPPORTS]


@pytest.mark.slow
def test_the_page_names_the_fields() -> None:
    """The table of docs/how-to/paraview.md, in a scene with friction."""
    page = (Path(__file__).parents[2] / "docs/how-to/paraview.md").read_text()
    rows = re.findall(r"^\| ([^|]+) \|[^|]+\| (`displacement`[^|]+)\|$", page, re.MULTILINE)
    stated = {name.strip("`"): set(re.findall(r"`(\w+)`", fields)) for name, fields in rows}
    scene = replace(load_scene("ks-friction"), load_parameters=2)
    hinged = read_scene(SPECIMEN, "specimen")
    assert stated[HINGES] == set(blocks(solve(hinged, "tsm"), hinged, 0)[HINGES].point_data)
    for model in ("tsm", "solid"):
        found = blocks(solve(scene, model), scene, 0)
        assert stated[f"a beam's name, model `{model}"] == set(found["cantilever"].point_data)
        assert all(stated[name] == set(found[name].point_data) for name in (CONTACTS, SUPPORTS))


def test_springs_and_hinges_are_points_with_their_forces(tmp_path: Path) -> None:
    scene = read_scene(SPECIMEN, "specimen")
    response = solve(scene, "tsm")
    found = pyvista.read(write_series(tmp_path, response, scene)[-1])
    assert found.keys() == ["hook", "flat", "link", CONTACTS, SUPPORTS, HINGES]
    data = found[SUPPORTS].point_data
    assert data["held"].tolist() == [[1, 1, 1], [1, 1, 1], [2, 0, 2]]
    top = response.axis_line("link", len(response.load_parameter) - 1)[1][-1]
    assert data["reaction_force"][2, :2] == pytest.approx([-3.5 * (top[0] - 140.0), 0.0])
    turned = found["link"].point_data["rotation"][-1]
    assert data["reaction_moment"][2] == pytest.approx(-100.0 * turned)
    for name in ("flat", "link"):
        assert response.axis_line(name, 0)[1][0] == pytest.approx(
            blocks(response, scene, 0)[HINGES].point_data["deformed"][0]
        )
    # the undeformed hook is an arc
    radius = scene.beam("hook").length / 1.6
    centre = np.array([50.0, -np.sqrt(radius**2 - 50.0**2)])
    assert np.hypot(*(found["hook"].points[:, :2] - centre).T) == pytest.approx(radius, rel=1e-9)


def test_a_load_parameter_has_named_blocks_with_units(tmp_path: Path) -> None:
    """One block for each beam, with its own points; VTK reads units from every array and from the whole."""
    frame = load_scene("portal-frame")
    frame = replace(frame, load_parameters=1, loads=(replace(frame.loads[0], force=(40.0, 0.0)),))
    (file,) = write_series(tmp_path, solve(frame, "solid", Options(mesh=(6, 1))), frame)
    found = pyvista.read(file)
    assert found.keys() == ["left", "girder", "right", SUPPORTS]
    for beam in frame.beams:
        points = found[beam.name].points[:, :2]
        middle = (np.array(beam.start) + beam.end) / 2
        assert points.mean(axis=0) == pytest.approx(middle)
        assert np.ptp(points, axis=0).max() == pytest.approx(beam.length)
    assert "von_mises [N/mm^2]" in found.field_data["units"]
    assert "reaction_moment [N mm]" in found.field_data["units"]
    array = found["left"].GetPointData().GetArray("stress_yy")
    assert array.GetInformation().Get(array.UNITS_LABEL()) == "N/mm^2"
    reaction = found[SUPPORTS].point_data["reaction_force"].sum(axis=0)
    assert reaction == pytest.approx([-40.0, 0.0, 0.0], abs=1e-6)


def test_stress_has_named_components(tmp_path: Path) -> None:
    """Bending of a vertical column is stress_yy; the von Mises stress is that of plane stress."""
    frame = replace(load_scene("portal-frame"), load_parameters=10)
    data = blocks(solve(frame, "solid", Options(mesh=(20, 2))), frame, 0)["left"].point_data
    assert np.abs(data["stress_yy"]).max() > 20.0 * np.abs(data["stress_xx"]).max()
    xx, yy, xy = (data[f"stress_{name}"] for name in ("xx", "yy", "xy"))
    principal = np.linalg.eigvalsh(np.stack([xx, xy, xy, yy], axis=-1).reshape(-1, 2, 2))
    a, b = principal.T
    assert data["von_mises"] == pytest.approx(np.sqrt(((a - b) ** 2 + a**2 + b**2) / 2), rel=1e-12)


def test_quads_are_in_vtk_order(tmp_path: Path) -> None:
    solid = solve(SCENE, "solid", Options(mesh=(12, 2)))
    (tmp_path / "solid.vtu").write_text(grid_text(solid.grid(0), {}))
    view = pyvista.read(tmp_path / "solid.vtu")
    assert set(view.celltypes) == {pyvista.CellType.BIQUADRATIC_QUAD}
    # VTK integrates its own biquadratic cells: a wrong order of points gives another area
    assert view.compute_cell_sizes()["Area"] == pytest.approx(np.full(24, 0.02 / 24), rel=1e-12)


def test_pin_force_balances_the_clamp_and_points_away_from_the_pin(response: Response) -> None:
    pin = blocks(response, SCENE, 0)[CONTACTS]
    force = pin.point_data["contact_force"][0]
    assert np.hypot(*force) == pytest.approx(response.contacts["pin->cantilever"].force[0], rel=1e-9)
    assert force[1] > 0.0
    assert pin.points + pin.point_data["displacement"] == pytest.approx(
        np.array([SCENE.pins[0].position(1 / 3)])
    )


@pytest.mark.slow_at("solid")
@pytest.mark.parametrize("model", ["tsm", "solid"])
def test_forces_between_beams_balance_the_supports(model: str) -> None:
    """Beams that touch: what acts on the lower beam is what its clamp carries, at the tip of the upper beam too."""
    scene = replace(load_scene("double-beam-friction"), load_parameters=4)
    found = blocks(solve(scene, model), scene, 3)
    contacts, supports = found[CONTACTS].point_data, found[SUPPORTS].point_data
    on_lower = contacts["contact_force"][1:].sum(axis=0)
    assert contacts["contact_force"][1, 1] < 0.0
    assert on_lower == pytest.approx(-supports["reaction_force"][1], rel=1e-6)
    touching = found[CONTACTS].points[1] + contacts["displacement"][1]
    assert found[CONTACTS].points[1] == pytest.approx((1.0, 0.0))
    assert touching == pytest.approx(contacts["deformed"][1])
    assert contacts["slip"][1] == -1.0


@pytest.mark.slow_at("solid")
def test_series_lists_its_files_and_removes_older_ones(response: Response, tmp_path: Path) -> None:
    longer = replace(SCENE, load_parameters=4)
    write_series(tmp_path, solve(longer, response.model), longer)
    (tmp_path / "other-0009.vtu").write_text("of another program")
    sets = write_series(tmp_path, response, SCENE)
    entries = listed(tmp_path / f"{response.model}.pvd")
    assert [t for t, _ in entries] == list(SCENE.times)
    assert all_files(tmp_path, response.model) | {"other-0009.vtu"} == contents(tmp_path).keys()
    assert [path.name for path in sets] == [f"{response.model}-{k:04d}.vtm" for k in (1, 2, 3)]
    assert pyvista.get_reader(tmp_path / f"{response.model}.pvd").time_values == sorted(SCENE.times)


def listed(pvd: Path) -> list[tuple[float, str]]:
    root = ET.parse(pvd).getroot()  # noqa: S314 our own file
    return [(float(item.attrib["timestep"]), item.attrib["file"]) for item in root.iter("DataSet")]


def all_files(folder: Path, model: str) -> set[str]:
    """The list of a series, the sets of blocks in it, and their blocks."""
    sets = [name for _, name in listed(folder / f"{model}.pvd")]
    root = [ET.parse(folder / name).getroot() for name in sets]  # noqa: S314 our own files
    return {f"{model}.pvd", *sets, *(item.attrib["file"] for one in root for item in one.iter("DataSet"))}


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name != WRITTEN}


@pytest.mark.parametrize(
    "name", ["pin-head.vtu", "tsm-mine.vtu", "pin-0001.vtu", "tsm-0009.vtm", "tsm-0009-0.vtu"]
)
def test_a_file_beside_the_series_stays(name: str, tmp_path: Path) -> None:
    beams = solve(SCENE, "tsm")
    write_series(tmp_path, beams, SCENE)
    (tmp_path / name).write_text("mine")
    write_series(tmp_path, beams, SCENE)
    assert (tmp_path / name).read_text() == "mine"


@pytest.mark.parametrize("name", ["tsm-0002.vtm", "tsm-0003-1.vtu", "tsm.pvd"])
@pytest.mark.parametrize("before", [False, True])
def test_a_file_in_the_way_ends_the_run_before_anything_is_written(
    name: str, before: bool, tmp_path: Path
) -> None:
    """A file of somebody else's, or one that crossval wrote and that was changed since."""
    beams = solve(SCENE, "tsm")
    if before:
        write_series(tmp_path, beams, SCENE)
    (tmp_path / name).write_text("mine")
    there = contents(tmp_path)
    with pytest.raises(OutputError, match=f"{name}: is there already, and is not as crossval wrote it"):
        write_series(tmp_path, beams, SCENE)
    assert contents(tmp_path) == there


@pytest.mark.slow
def test_a_run_goes_on_where_another_was_ended_among_its_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After every number of moves."""
    beams, longer = solve(SCENE, "tsm"), replace(SCENE, load_parameters=4)
    more = solve(longer, "tsm")
    move = Path.replace
    for number in range(21):
        folder = tmp_path / str(number)
        folder.mkdir()
        write_series(folder, beams, SCENE)
        left = iter([True] * number)

        def ended(self: Path, target: Path, left: Iterator[bool] = left, folder: Path = folder) -> Path:
            if (
                Path(target).parent == folder
                and self.suffix in (".vtu", ".vtm", ".pvd")
                and not next(left, False)
            ):
                raise MemoryError
            return move(self, target)

        monkeypatch.setattr(Path, "replace", ended)
        with contextlib.suppress(MemoryError):
            write_series(folder, more, longer)
        monkeypatch.setattr(Path, "replace", move)
        assert all_files(folder, "tsm") <= contents(folder).keys()
        write_series(folder, beams, SCENE)
        assert contents(folder).keys() == all_files(folder, "tsm")
        assert len(contents(folder)) == 1 + 3 * 4
