"""Pareto fronts and fits on data whose answer is known."""

import numpy as np
import pytest

from comparisons.cost.fits import convergence, pareto, power_law

N = np.array([5.0, 10.0, 20.0, 40.0, 80.0])


def test_front_of_random_points_is_what_nothing_beats() -> None:
    points = np.random.default_rng(0).random((60, 2)).round(1)
    front = pareto(*points.T)
    beaten = [any((other <= point).all() and (other < point).any() for other in points) for point in points]
    assert {tuple(points[k]) for k in front} == {
        tuple(point) for point, is_beaten in zip(points, beaten, strict=True) if not is_beaten
    }
    assert list(points[front, 0]) == sorted(set(points[front, 0]))


def test_front_leaves_out_what_is_not_known() -> None:
    assert pareto([np.nan, 1.0, 2.0], [0.0, np.nan, 0.5]) == [2]
    assert pareto([], []) == []


def test_power_law() -> None:
    fit = power_law(list(N), list(3.0 * N**1.5))
    assert fit is not None
    assert (fit.exponent, fit.factor) == pytest.approx((1.5, 3.0), rel=1e-12)
    assert (fit.first, fit.last, fit.points) == (5.0, 80.0, 5)
    assert fit.scatter < 1e-12


@pytest.mark.parametrize("y", [[1.0, 2.0], [1.0, 0.0, 2.0]])
def test_no_law_through_two_points_or_zero(y: list[float]) -> None:
    assert power_law([1.0, 2.0, 4.0][: len(y)], y) is None


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_order_of_the_finest_four(order: float) -> None:
    fit = convergence(list(N), list(7.0 * N**-order), 0.0)
    assert fit is not None
    assert -fit.exponent == pytest.approx(order, rel=1e-12)
    assert (fit.first, fit.last, fit.points) == (10.0, 80.0, 4)


def test_order_is_not_taken_from_the_floor_or_coarse_meshes() -> None:
    error = N**-4.0
    error[0] = 1.1e-4  # by chance
    error[4] = error[3] / 1.5  # round-off
    fit = convergence(list(N), list(error), 0.0)
    assert fit is not None
    assert (fit.first, fit.last, fit.points) == (10.0, 40.0, 3)
    assert -fit.exponent == pytest.approx(4.0, rel=1e-12)


def test_no_order_below_the_uncertainty() -> None:
    assert convergence(list(N), list(N**-4.0), 1e-4) is None
    assert convergence(list(N), list(N**1.0), 0.0) is None
    assert convergence(list(N), [0.1, 0.01, np.nan, np.nan, np.nan], 0.0) is None
