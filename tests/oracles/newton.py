"""Newton's method with derivatives by complex steps, and the path of equilibria along a parameter, which the oracles share."""

from collections.abc import Callable

import numpy as np

from tests.oracles.elastica import COMPLEX_STEP, Array

State = tuple[float, Array, Array]
"""A parameter, unknowns (n,) and their rates."""


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def newton(residual: Callable[[Array], Array], z: Array, allowed: float = 1.0) -> tuple[Array, Array] | None:
    """Return unknowns (n,) from nearby ones, and the matrix of the residual's derivatives there; None far from a root.

    The residual has a column for every column of unknowns (n, c). A correction over the largest unknown, at least 1, must be at most half
    the one before, and the first at most `allowed`.
    """
    for _ in range(14):
        matrix = residual(z[:, None] + 1j * COMPLEX_STEP * np.eye(len(z))).imag / COMPLEX_STEP
        if not np.all(np.isfinite(matrix)) or np.linalg.det(matrix) == 0.0:
            return None
        change = -np.linalg.solve(matrix, residual(z[:, None] + 0j).real[:, 0])
        size = float(np.abs(change).max() / max(1.0, np.abs(z).max()))
        if not size <= allowed:
            return None
        z, allowed = z + change, size / 2.0
        if size < 1e-10:  # the toggle's slender bars leave 1e-11 by round-off
            return z, matrix
    return None


def advanced(residual: Callable[[Array, float], Array], last: State, t: float) -> State:
    """Return the state at a parameter by Newton's method from another one, in halves where it is far."""
    before, z, rates = last
    found = newton(lambda z: residual(z, t), z + (t - before) * rates)
    if found is None:
        assert abs(t - before) > 1e-9, f"no equilibrium beyond {before:g}"
        return advanced(residual, advanced(residual, last, (before + t) / 2.0), t)
    z, matrix = found
    moves = residual(z[:, None] + 0j, t + 1j * COMPLEX_STEP)[:, 0].imag / COMPLEX_STEP
    return t, z, np.linalg.solve(matrix, -moves)
