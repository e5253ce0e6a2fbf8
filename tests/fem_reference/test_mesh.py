import tracemalloc

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.body import build_body, discretise
from fem_reference.model import build
from fem_reference.strip import ELEMENTS, solution_cost


def test_weights_sum_to_the_volume_and_edges_order_the_nodes(strip):
    d = discretise(strip(mesh=(7, 3)))
    assert d.weights.sum() == pytest.approx(1 * 0.02 * 0.02, rel=1e-14)
    np.testing.assert_allclose(d.stations, np.linspace(0, 1, 15), atol=1e-15)
    x, y = np.linspace(0, 1, 15), np.linspace(-0.01, 0.01, 7)
    for name, line in {"right": (x, -0.01), "left": (x, 0.01), "start": (0.0, y), "end": (1.0, y)}.items():
        expected = np.stack(np.broadcast_arrays(*line), 1)
        np.testing.assert_allclose(d.nodes[d.edges[name]], expected, atol=1e-15)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("rows", [1, 2, 3, 4])
def test_section_means_are_those_of_polynomials(strip, rows, element):
    """Exact for cubics with Q2, for straight lines with Q1."""
    d = discretise(strip(mesh=(2, rows), element=element))
    means = ((0, 1.0), (1, 0.0), (2, 1 / 3), (3, 0.0))[: 2 if element == "Q1" else 4]
    for power, mean in means:
        np.testing.assert_allclose(d.sections @ (d.nodes[:, 1] / 0.01) ** power, mean, atol=1e-15)
    np.testing.assert_allclose(d.sections @ d.nodes[:, 0], d.stations, atol=1e-15)


@pytest.mark.parametrize("element", ELEMENTS)
def test_grading_is_the_ratio_of_last_to_first_element(strip, element):
    d = discretise(strip(mesh=(6, 1), grading=8.0, element=element))
    lengths = np.diff(d.stations[:: 1 if element == "Q1" else 2])
    np.testing.assert_allclose(lengths[1:] / lengths[:-1], 8 ** (1 / 5), rtol=1e-12)
    assert (d.stations[0], d.stations[-1]) == (0.0, 1.0)
    assert d.weights.sum() == pytest.approx(0.02 * 0.02, rel=1e-14)


@pytest.mark.parametrize(
    ("mesh", "rule"),
    [
        ((100_000, 1), r"must need at most 2 GiB, needs about 3\.[3-6]"),
        ((10**12, 1), "must need at most 2 GiB"),
        ((10**400, 1), "must be two whole numbers"),
        ((2, 500), "must need at most 1e\\+11 operations a factorisation"),
    ],
)
def test_mesh_too_large_for_memory_or_time_costs_one_line(strip, mesh, rule):
    with pytest.raises(ValueError, match=r"^Strip\('cantilever'\)\.mesh = .*" + rule) as caught:
        strip(mesh=mesh)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("mesh", [(30, 1), (20, 4)])
def test_estimated_cost_is_that_of_the_band(strip, mesh, element):
    body = build_body(strip(mesh=mesh, element=element))
    m, width = body.expansion.shape[1], body.stiffness.width
    work = solution_cost(mesh, element)[1]
    assert m * width**2 == pytest.approx(work, rel=0.05)


def test_memory_is_what_was_estimated(strip):
    mesh = (1000, 2)
    strip(mesh=(2, 1))
    tracemalloc.start()
    build(fr.SolidProblem(strips=(strip(mesh=mesh),)))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0.3 < peak / solution_cost(mesh, "Q2")[0] < 1.1
