import numpy as np
import pytest

from fem_reference.mesh import discretise


@pytest.mark.parametrize("mesh", [(2, 1), (5, 2), (4, 3)])
def test_cells_are_anticlockwise_quads_with_midsides_and_centre(strip, mesh):
    d = discretise(strip(mesh=mesh))
    x = d.nodes[d.cells]
    edges = np.roll(x[:, :4], -1, axis=1) - x[:, :4]
    cross = (
        edges[:, :, 0] * np.roll(edges, -1, axis=1)[:, :, 1]
        - edges[:, :, 1] * np.roll(edges, -1, axis=1)[:, :, 0]
    )
    assert np.all(cross > 0)
    np.testing.assert_allclose(x[:, 4:8], x[:, :4] + edges / 2, atol=1e-15)
    np.testing.assert_allclose(x[:, 8], x[:, :4].mean(axis=1), atol=1e-15)


def test_weights_sum_to_the_volume_and_columns_order_the_nodes(strip):
    d = discretise(strip(mesh=(7, 3)))
    assert d.weights.sum() == pytest.approx(1 * 0.02 * 0.02, rel=1e-14)
    assert sorted(d.columns.ravel()) == list(range(len(d.nodes)))
    grid = d.nodes[d.columns]
    np.testing.assert_allclose(grid[:, :, 0], np.linspace(0, 1, 15)[:, None] + np.zeros(7), atol=1e-15)
    np.testing.assert_allclose(grid[:, :, 1], np.linspace(-0.01, 0.01, 7) + np.zeros((15, 1)), atol=1e-15)


@pytest.mark.parametrize("rows", [1, 2, 4])
def test_section_weights_integrate_cubics(strip, rows):
    d = discretise(strip(mesh=(2, rows)))
    y = d.nodes[d.columns[0], 1]
    for power, mean in ((0, 1.0), (1, 0.0), (2, 1 / 3), (3, 0.0)):
        assert d.section_weights @ (y / 0.01) ** power == pytest.approx(mean, abs=1e-15)


def test_gradients_are_exact_for_biquadratic_fields(strip):
    d = discretise(strip(mesh=(3, 2)))
    x, y = d.nodes.T
    at_nodes = (d.nodal_gradients @ (x**2 * y + y**2)[d.cells][:, :, None]).reshape(len(d.cells), 2, 9)
    xc, yc = x[d.cells], y[d.cells]
    np.testing.assert_allclose(at_nodes[:, 0], 2 * xc * yc, atol=1e-13)
    np.testing.assert_allclose(at_nodes[:, 1], xc**2 + 2 * yc, atol=1e-12)
