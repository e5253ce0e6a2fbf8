"""VTU and PVD files: what is read back is what was computed, and no file of a user is replaced."""

import re
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

from comparisons.answer import Response
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.report.export import CONTACTS, HINGES, SUPPORTS, blocks, write_series
from comparisons.scene import load_scene
from tests.comparisons.report.specimen import SPECIMEN
from tests.comparisons.test_faults import listed

SCENE, RUBBED = (replace(load_scene(name), load_parameters=3) for name in ("ks-cantilever", "ks-friction"))
PAGE = (Path(__file__).parents[2] / "docs/how-to/paraview.md").read_text()
ROWS = re.findall(r"^\| ([^|]+) \|[^|]+\| (`displacement`[^|]+)\|$", PAGE, re.MULTILINE)
STATED = {name.strip("`"): set(re.findall(r"`(\w+)`", fields)) for name, fields in ROWS}
"""The fields of the blocks, by the table of the page."""
BEAM = "a beam's name, model `{}"


@pytest.fixture(scope="module", params=[("tsm", Options(elements=4)), ("solid", Options(mesh=(12, 2)))])
def written(request, tmp_path_factory) -> tuple[Response, Path]:
    """An answer, and the folder of its series."""
    response, folder = solve(RUBBED, *request.param), tmp_path_factory.mktemp("series")
    write_series(folder, response, RUBBED)
    return response, folder


def test_every_block_reads_back_in_meshio_and_pyvista(written):
    response, folder = written
    found = blocks(response, RUBBED, 0)
    assert list(found) == ["cantilever", CONTACTS, SUPPORTS]
    assert found["cantilever"].point_data.keys() == STATED[BEAM.format(response.model)]
    assert all(found[name].point_data.keys() == STATED[name] for name in (CONTACTS, SUPPORTS))
    for number, grid in enumerate(found.values()):
        file = folder / f"{response.model}-0001-{number}.vtu"
        back, view = meshio.read(file), pyvista.read(file)
        for points in (back.points, view.points):
            np.testing.assert_array_equal(points, np.pad(grid.points, ((0, 0), (0, 1))))
        (kind, cells), (block,) = next(iter(grid.cells.items())), back.cells
        assert block.type == kind
        np.testing.assert_array_equal(block.data, cells)
        np.testing.assert_array_equal(view.cells.reshape(len(cells), -1)[:, 1:], cells)
        assert set(view.point_data) == set(back.point_data) == set(grid.point_data)
        for field, values in grid.point_data.items():
            for read in (back.point_data[field], view.point_data[field]):
                columns = read.reshape(len(values), -1)
                np.testing.assert_array_equal(columns[:, : values[0].size].reshape(values.shape), values)
    pin = found[CONTACTS]
    force = pin.point_data["contact_force"][0]
    assert force == pytest.approx(-response.supports["cantilever.start"].force[0], rel=1e-6)
    assert force[1] > 0.0
    place = np.array([RUBBED.pins[0].position(1 / 3)])
    assert pin.points + pin.point_data["displacement"] == pytest.approx(place)
    if response.model == "solid":
        # VTK integrates its own biquadratic cells: a wrong order of points gives another area
        view = pyvista.read(folder / "solid-0001-0.vtu")
        assert set(view.celltypes) == {pyvista.CellType.BIQUADRATIC_QUAD}
        assert view.compute_cell_sizes()["Area"] == pytest.approx(np.full(24, 0.02 / 24), rel=1e-12)


def test_springs_and_hinges_are_points_with_their_forces(tmp_path):
    response = solve(SPECIMEN, "tsm")
    found = pyvista.read(write_series(tmp_path, response, SPECIMEN)[-1])
    assert found.keys() == ["hook", "flat", "link", CONTACTS, SUPPORTS, HINGES]
    assert set(found[HINGES].point_data.keys()) == STATED[HINGES]
    data = found[SUPPORTS].point_data
    assert data["held"].tolist() == [[1, 1, 1], [1, 1, 1], [2, 0, 2]]
    top = found["link"].point_data
    moved, turned = top["deformed"][-1, 0] - 140.0, top["rotation"][-1]
    assert data["reaction_force"][2, :2] == pytest.approx([-3.5 * moved, 0.0])
    assert data["reaction_moment"][2] == pytest.approx(-100.0 * turned)
    for name in ("flat", "link"):
        assert found[name].point_data["deformed"][0] == pytest.approx(found[HINGES].point_data["deformed"][0])


def test_a_load_parameter_has_named_blocks_with_units_and_components(tmp_path):
    """One block for each beam, with its own points; VTK reads units from every array and from the whole."""
    frame = load_scene("portal-frame")
    frame = replace(frame, load_parameters=1, loads=(replace(frame.loads[0], force=(40.0, 0.0)),))
    (file,) = write_series(tmp_path, solve(frame, "solid", Options(mesh=(20, 2))), frame)
    found = pyvista.read(file)
    assert found.keys() == ["left", "girder", "right", SUPPORTS]
    for beam in frame.beams:
        points = found[beam.name].points[:, :2]
        assert points.mean(axis=0) == pytest.approx((np.array(beam.start) + beam.end) / 2)
        assert np.ptp(points, axis=0).max() == pytest.approx(beam.length)
    assert {"von_mises [N/mm^2]", "reaction_moment [N mm]"} <= set(found.field_data["units"])
    array = found["left"].GetPointData().GetArray("stress_yy")
    assert array.GetInformation().Get(array.UNITS_LABEL()) == "N/mm^2"
    reaction = found[SUPPORTS].point_data["reaction_force"].sum(axis=0)
    assert reaction == pytest.approx([-40.0, 0.0, 0.0], abs=1e-6)
    # bending of a column is stress_yy; the von Mises stress is that of plane stress
    xx, yy, xy = (np.asarray(found["left"].point_data[f"stress_{name}"]) for name in ("xx", "yy", "xy"))
    assert np.abs(yy).max() > 20.0 * np.abs(xx).max()
    a, b = np.linalg.eigvalsh(np.stack([xx, xy, xy, yy], axis=-1).reshape(-1, 2, 2)).T
    von_mises = np.sqrt(((a - b) ** 2 + a**2 + b**2) / 2)
    assert found["left"].point_data["von_mises"] == pytest.approx(von_mises, rel=1e-12)


def test_forces_between_beams_balance_the_supports():
    """What acts on the lower beam is what its clamp carries, at the tip of the upper beam too."""
    scene = replace(load_scene("double-beam-friction"), load_parameters=4)
    found = blocks(solve(scene, "tsm"), scene, 3)
    contacts, supports = found[CONTACTS].point_data, found[SUPPORTS].point_data
    on_lower = contacts["contact_force"][1:].sum(axis=0)
    assert on_lower == pytest.approx(-supports["reaction_force"][1], rel=1e-6)
    assert contacts["slip"][1] == -1.0


def all_files(folder: Path) -> set[str]:
    """The list of the series, the sets of blocks in it, and their blocks."""
    sets = listed(folder / "tsm.pvd")
    return {"tsm.pvd", *sets, *(file for one in sets for file in listed(folder / one))}


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name != ".crossval"}


def test_a_series_removes_what_it_wrote_before_and_leaves_files_of_a_user(tmp_path):
    beams, longer = solve(SCENE, "tsm"), replace(SCENE, load_parameters=4)
    write_series(tmp_path, solve(longer, "tsm"), longer)
    mine = ("pin-head.vtu", "tsm-mine.vtu", "pin-0001.vtu", "tsm-0009.vtm", "tsm-0009-0.vtu")
    for name in mine:
        (tmp_path / name).write_text("mine")
    sets = write_series(tmp_path, beams, SCENE)
    assert pyvista.get_reader(tmp_path / "tsm.pvd").time_values == sorted(SCENE.times)
    assert [path.name for path in sets] == [f"tsm-{k:04d}.vtm" for k in (1, 2, 3)]
    assert contents(tmp_path).keys() == {*all_files(tmp_path), *mine}
    assert all(contents(tmp_path)[name] == b"mine" for name in mine)
