"""VTU and PVD files: what is read back is what was computed."""

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

from comparisons.export import pin_grid, write_series, write_vtu
from comparisons.models import solve
from comparisons.options import Options
from comparisons.response import Response
from comparisons.scene import ContactSpec, load_scene

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
    (tmp_path / f"{response.model}-0009.vtu").write_text("older")
    (tmp_path / "other-0009.vtu").write_text("not ours")
    bodies = write_series(tmp_path, response, SCENE)
    root = ET.parse(tmp_path / f"{response.model}.pvd").getroot()  # noqa: S314 our own file
    entries = [(float(item.attrib["timestep"]), item.attrib["file"]) for item in root.iter("DataSet")]
    assert [t for t, _ in entries] == [t for t in SCENE.times for _ in range(2)]
    assert {name for _, name in entries} | {"other-0009.vtu", f"{response.model}.pvd"} == {
        path.name for path in tmp_path.iterdir()
    }
    assert [path.name for path in bodies] == [f"{response.model}-{k:04d}.vtu" for k in (1, 2, 3)]
    assert pyvista.get_reader(tmp_path / f"{response.model}.pvd").time_values == sorted(SCENE.times)
