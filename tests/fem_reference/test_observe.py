import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import fem_reference as fr
from tests.fem_reference.conftest import CLAMP, PAIR, STRIP, rotation


def test_axis_line_runs_from_the_clamp_to_the_tip(ks_axis):
    line, stations = fr.axis_line(ks_axis, STRIP, -1), fr.axis_stations(ks_axis, STRIP)
    # By Poisson's effect of the curvature the mean lies up to nu kappa h^2 / 24 above the clamped middle.
    kappa = -ks_axis.supports[CLAMP].moment[-1] / ks_axis.model.problem.strips[0].bending_stiffness
    assert line[0, 0] == pytest.approx(0, abs=1e-12)
    assert 0.4 < line[0, 1] / (0.3 * kappa * 0.02**2 / 24) < 1.0
    np.testing.assert_allclose(line[-1], ks_axis.tips[STRIP][-1], atol=1e-15)
    lengths = np.hypot(*np.diff(line, axis=0).T)
    assert lengths.sum() == pytest.approx(1, abs=1e-3)
    np.testing.assert_allclose(np.diff(stations), 0.01, atol=1e-14)


def test_mesh_and_displacement_are_in_the_global_frame(ks_axis):
    n = len(ks_axis.mesh_points)
    assert ks_axis.displacement.shape == (50, n, 2)
    assert {name: cells.shape for name, cells in ks_axis.mesh_cells.items()} == {"quad9": (100, 9)}
    assert ks_axis.unknowns == 2 * n - 6
    deformed = ks_axis.mesh_points + ks_axis.displacement[-1]
    mesh = ks_axis.model.bodies[0].mesh
    np.testing.assert_allclose(mesh.sections @ deformed, fr.axis_line(ks_axis, STRIP, -1), atol=1e-15)


@pytest.mark.parametrize("angle", [0.0, 0.9])
def test_nodal_stress_is_the_bending_stress(problem, angle):
    """Small deflection by 1e-4: ``M y / I`` on the face, along the strip."""
    path = tuple(map(tuple, np.array([[0.8, 0.0], [0.8, 1e-4]]) @ rotation(angle).T))
    c, s = rotation(angle)[:, 0]
    result = fr.solve(problem(path=path, end=(float(c), float(s))), np.array([1.0]))
    xx, yy, xy = fr.nodal_stress(result, 0).T
    along = c * c * xx + s * s * yy + 2 * c * s * xy
    mesh, force = result.model.bodies[0].mesh, result.contacts[PAIR].force[0]
    bottom = mesh.edges["right"][20:120:2]
    x = mesh.nodes[bottom, 0]
    expected = 12 * force * (0.8 - x) * 0.01 / 0.02**4
    np.testing.assert_allclose(along[bottom][x < 0.7], expected[x < 0.7], rtol=5e-3)
    assert fr.fibre_stress(result, 0) == pytest.approx(along, abs=2e-3 * np.abs(along).max())
    across = s * s * xx + c * c * yy - 2 * c * s * xy
    assert np.abs(across[bottom][x < 0.7]).max() < 0.02 * expected.max()


def test_result_prints_in_a_line(ks_axis):
    assert repr(ks_axis).startswith("<Result COMPLETED: 50 load parameters, the last 1; ")


def test_result_has_columns_and_a_picture(ks_axis):
    columns = ks_axis.table()
    assert {values.shape for values in columns.values()} == {(50,)}
    assert columns[f"{CLAMP}.moment"] is ks_axis.supports[CLAMP].moment
    assert columns[f"{PAIR}.force_y"] == pytest.approx(-columns[f"{CLAMP}.force_y"], abs=1e-9)
    assert f"<td>{STRIP}.tip_x</td>" in ks_axis._repr_html_()
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = ks_axis.plot(figure.subplots(), shown=2)
    undeformed, first, last = (item.get_paths() for item in axes.collections)
    assert len(undeformed) == len(first) == len(last) == 100
    corners = ks_axis.mesh_cells["quad9"][-1, :4]
    assert last[-1].vertices[:-1:2] == pytest.approx(
        (ks_axis.mesh_points + ks_axis.displacement[-1])[corners]
    )
