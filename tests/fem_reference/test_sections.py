"""What a result tells: section forces and face strains against statics, stresses, columns and a picture."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import fem_reference as fr
from tests.fem_reference.conftest import CLAMP, EI, PAIR, STRIP, B, H, loads, make_problem, rotation


@pytest.fixture(scope="module", params=[0.0, 0.9])
def turned(request):
    """A biot-linear strip in a turned scene, bent far by a pin."""
    end, *path = np.array([[1.0, 0.0], [0.8, 0.0], [0.6, 0.4]]) @ rotation(request.param).T
    scene = make_problem(end=tuple(end), path=tuple(map(tuple, path)), material="biot-linear")
    return fr.solve(scene, loads(4))


def test_section_forces_are_those_of_statics(turned):
    """The pin's force alone gives f and M on every section between clamp and contact; both vanish beyond."""
    forces, contact = fr.section_forces(turned, STRIP, -1), turned.contacts[PAIR]
    p, pin, arc = contact.vector[-1], turned.model.problem.pins[0].position(1.0), contact.arc_position[-1]
    axis = fr.axis_stations(turned, STRIP)
    line = [np.interp(forces.stations, axis, x) for x in fr.axis_line(turned, STRIP, -1).T]
    arm = pin[:, None] - line
    M, scale = arm[0] * p[1] - arm[1] * p[0], np.hypot(*p)
    inner = (forces.stations < arc - 0.06) & (forces.stations > 0.1)
    beyond = forces.stations > arc + 0.06
    c, s = np.cos(forces.rotation[inner]), np.sin(forces.rotation[inner])
    for found, expected in (
        (forces.force[inner], p + 0 * forces.force[inner]),
        (forces.force[beyond], 0),
        (forces.N[inner], c * p[0] + s * p[1]),
        (forces.V[inner], c * p[1] - s * p[0]),
    ):
        np.testing.assert_allclose(found, expected, atol=2e-3 * scale)
    np.testing.assert_allclose(forces.M[inner], M[inner], atol=1e-3 * np.abs(M).max())
    np.testing.assert_allclose(forces.M[beyond], 0, atol=1e-4 * np.abs(M).max())


def test_the_j_integral_is_the_tangential_force(turned):
    """It vanishes between clamp and contact, where the bending part alone is more than half of the contact force, and in the free tail."""
    forces = fr.section_forces(turned, STRIP, -1)
    force, arc = turned.contacts[PAIR].force[-1], turned.contacts[PAIR].arc_position[-1]
    inner = (forces.stations > 0.03) & (forces.stations < arc - 0.03)
    assert (forces.M**2 / (2 * EI)).max() > 0.5 * force
    assert np.abs(forces.material_force[inner]).max() < 1e-4 * force
    assert abs(forces.material_force[inner].mean()) < 1e-5 * force
    assert np.abs(forces.material_force[forces.stations > arc + 0.03]).max() < 1e-6 * force


@pytest.mark.parametrize("angle", [0.0, 0.9])
def test_nodal_stress_is_the_bending_stress(angle):
    """Small deflection by 1e-4: ``M y / I`` on the face, along the strip."""
    Q = rotation(angle)
    path = tuple(map(tuple, np.array([[0.8, 0.0], [0.8, 1e-4]]) @ Q.T))
    c, s = map(float, Q[:, 0])
    result = fr.solve(make_problem(path=path, end=(c, s)), loads(1))
    xx, yy, xy = fr.nodal_stress(result, 0).T
    along, across = (c * c * xx + s * s * yy + 2 * c * s * xy, s * s * xx + c * c * yy - 2 * c * s * xy)
    x, y = (result.mesh_points @ Q).T
    bottom = (np.abs(y + H / 2) < 1e-9) & (x > 0.19) & (x < 0.69)
    expected = 12 * result.contacts[PAIR].force[0] * (0.8 - x[bottom]) * 0.01 / (B * H**3)
    np.testing.assert_allclose(along[bottom], expected, rtol=5e-3)
    assert fr.fibre_stress(result, 0) == pytest.approx(along, abs=2e-3 * np.abs(along).max())
    assert np.abs(across[bottom]).max() < 0.02 * expected.max()


def test_result_has_a_line_columns_and_a_picture():
    ks = fr.solve(make_problem(), loads(5))
    n = len(ks.mesh_points)
    assert repr(ks).startswith("<Result COMPLETED: 5 load parameters, the last 1; ")
    assert (ks.displacement.shape, ks.unknowns) == ((5, n, 2), 2 * n - 6)
    assert {name: cells.shape for name, cells in ks.mesh_cells.items()} == {"quad9": (100, 9)}
    columns = ks.table()
    assert {values.shape for values in columns.values()} == {(5,)}
    assert columns[f"{CLAMP}.moment"] is ks.supports[CLAMP].moment
    assert columns[f"{PAIR}.force_y"] == pytest.approx(-columns[f"{CLAMP}.force_y"], abs=1e-9)
    assert f"<td>{STRIP}.tip_x</td>" in ks._repr_html_()
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = ks.plot(figure.subplots(), shown=2)
    undeformed, first, last = (item.get_paths() for item in axes.collections)
    assert len(undeformed) == len(first) == len(last) == 100
    corners = ks.mesh_cells["quad9"][-1, :4]
    places = ks.mesh_points + ks.displacement[-1]
    assert last[-1].vertices[:-1:2] == pytest.approx(places[corners])
