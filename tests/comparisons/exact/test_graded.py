"""Graded Gauss points: integrals of a boundary layer known in closed form, and the symmetry that the rod's Hessian relies on."""

import numpy as np
import pytest

from comparisons.exact.graded import graded_grid

GRADINGS = [1e-9, 1.0, 4.0, 9.0]


@pytest.mark.parametrize("grading", GRADINGS)
def test_the_matrix_and_its_adjoint_integrate_from_both_ends(grading: float) -> None:
    grid = graded_grid(64, grading)
    values = np.exp(-3.0 * grid.arcs)
    left = -np.expm1(-3.0 * grid.arcs) / 3.0
    np.testing.assert_allclose(grid.from_left @ values, left, rtol=1e-11, atol=1e-14)
    from_right = grid.from_left.T @ (grid.weights * values) / grid.weights
    np.testing.assert_allclose(from_right, -np.expm1(-3.0) / 3.0 - left, atol=1e-13)
    assert grid.weights @ values == pytest.approx(-np.expm1(-3.0) / 3.0, rel=1e-13)


def test_a_layer_of_a_ten_thousandth_needs_grading() -> None:
    errors = []
    for grading in (1e-9, 7.0):
        grid = graded_grid(64, grading)
        arcs = np.array([1e-6, 1e-4, 1e-3, 1.0])
        found = grid.integrals(arcs) @ np.exp(-1e4 * grid.arcs)
        errors.append(np.abs(1e4 * found + np.expm1(-1e4 * arcs)).max())
    assert errors[1] < 1e-10
    assert errors[0] > 1e-2
