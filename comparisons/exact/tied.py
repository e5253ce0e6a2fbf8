"""A Reissner rod whose tip is tied to a point that moves along a path.

Clamp at the origin, undeformed rod along +x; the tip turns freely, so the internal force n is constant and the moment ends at zero:

    theta(s) = int_0^s m,   m(s) = int_s^1 r' x n,   r' = (1 + N/EA) d1 + (Q/GA) d2,   N = n.d1,  Q = n.d2

with lengths in units of the rod's length L, forces in EI/L^2, moments in EI/L. Collocation at Gauss points turns both integrals into
matrices; the unknowns are theta at the points and n, the equations those above and `int_0^1 r' = tip`. The solution is analytic, so
the error falls faster than any power of the number of points. A compressed rod buckles sideways within a thousandth of its length,
and a long step would miss that: a step is halved unless the prediction along the tangent to the path is small, the corrections fall
monotonically from a smaller first one, and the determinant of the derivative keeps its sign (it changes where stability is lost).
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.checks import require_positive
from comparisons.exact.outcome import Outcome
from comparisons.exact.reissner import Flexibility

Array = NDArray[np.float64]

_POINTS = 48
_SMALLEST_STEP = 1e-9
_PREDICTION = 0.1  # rad, or a part of the force


@dataclass(frozen=True, kw_only=True)
class TiedPath:
    """States of the rod at the `s` given positions of its tip; nan where no equilibrium was found (`Outcome.LOST`).

    Attributes
    ----------
    outcome : tuple of Outcome
        `CONTACT`, or `LOST` from the first position on that no stable equilibrium connected with the straight rod reaches.
    force : ndarray, shape (s, 2)
        Force on the tip.
    clamp_force : ndarray, shape (s, 2)
        Force of the clamp on the rod.
    clamp_moment : ndarray, shape (s,)
        Moment of the clamp on the rod, anticlockwise positive: `-(tip x force)`.
    tip : ndarray, shape (s, 2)
        Position of the tip.
    tip_rotation : ndarray, shape (s,)
        Rotation of the section at the tip [rad].
    iterations : ndarray of int, shape (s,)
        Newton iterations spent since the position before, rejected steps included.
    unknowns : ndarray, shape (s, points + 2)
        Rotations at the collocation points and the force in units of `EI/length^2`.
    flexibility : Flexibility
        Of the rod.
    length : float
        Undeformed length.
    """

    outcome: tuple[Outcome, ...]
    force: Array
    clamp_force: Array
    clamp_moment: Array
    tip: Array
    tip_rotation: Array
    iterations: NDArray[np.int64]
    unknowns: Array
    flexibility: Flexibility
    length: float

    def shape(self, k: int, n: int) -> Array:
        """Position and rotation `x, y, theta` at `n` equal distances along the undeformed axis, clamp and tip included.

        Returns
        -------
        ndarray, shape (n, 3)
        """
        tangent = _tangents(self.unknowns[k], self.flexibility).tangent
        moment = _GRID.from_right @ _cross(tangent, self.unknowns[k, -2:])
        values = np.column_stack([self.length * tangent, moment])
        return np.asarray(_integrals(2.0 * np.linspace(0.0, 1.0, n) - 1.0, _GRID) @ values)


class _Grid(NamedTuple):
    """Gauss points on (0, 1) with weights, and the integrals from 0 to every point and from every point to 1."""

    coefficients: Array
    weights: Array
    from_left: Array
    from_right: Array


def _grid(points: int) -> _Grid:
    x, w = legendre.leggauss(points)
    degree = np.arange(points)
    coefficients = (2 * degree[:, None] + 1) / 2.0 * legendre.legvander(x, points - 1).T * w
    bare = _Grid(coefficients, w / 2.0, np.zeros(0), np.zeros(0))
    left = _integrals(x, bare)
    return bare._replace(from_left=left, from_right=w / 2.0 - left)


def _integrals(x: Array, grid: _Grid) -> Array:
    """Return the matrix from values at the points to the integrals from 0 to `(1 + x)/2`: `P_k` has `(P_k+1 - P_k-1)/(2 k + 1)`."""
    points = len(grid.weights)
    P = legendre.legvander(x, points)
    primitive = np.column_stack([x + 1.0, (P[:, 2:] - P[:, :-2]) / (2 * np.arange(1, points) + 1)])
    return np.asarray(primitive @ grid.coefficients / 2.0)


_GRID = _grid(_POINTS)


class _Tangents(NamedTuple):
    """At the collocation points: `r'` (n, 2), its derivative in theta (n, 2) and in the force (n, 2, 2)."""

    tangent: Array
    turned: Array
    by_force: Array


def _tangents(z: Array, flexibility: Flexibility) -> _Tangents:
    a, b = flexibility.stretch, flexibility.shear
    theta, force = z[:-2], z[-2:]
    d1 = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    d2 = np.stack([-d1[:, 1], d1[:, 0]], axis=1)
    N, Q = (d1 @ force)[:, None], (d2 @ force)[:, None]
    return _Tangents(
        tangent=(1.0 + a * N) * d1 + b * Q * d2,
        turned=(a - b) * Q * d1 + (1.0 + (a - b) * N) * d2,
        by_force=a * d1[:, :, None] * d1[:, None, :] + b * d2[:, :, None] * d2[:, None, :],
    )


def _cross(left: Array, right: Array) -> Array:
    return np.asarray(left[..., 0] * right[..., 1] - left[..., 1] * right[..., 0])


def _residual(z: Array, tip: Array, flexibility: Flexibility) -> tuple[Array, Array]:
    """Residual (n + 2,) and its derivative."""
    force = z[-2:]
    state = _tangents(z, flexibility)
    twice = _GRID.from_left @ _GRID.from_right
    torque = _cross(state.tangent, force)
    torque_by_force = _cross(np.moveaxis(state.by_force, 1, 2), force)
    torque_by_force += np.stack([-state.tangent[:, 1], state.tangent[:, 0]], axis=1)
    n = len(z) - 2
    matrix = np.empty((n + 2, n + 2))
    matrix[:n, :n] = np.eye(n) - twice * _cross(state.turned, force)
    matrix[:n, n:] = -twice @ torque_by_force
    matrix[n:, :n] = _GRID.weights * state.turned.T
    matrix[n:, n:] = np.tensordot(_GRID.weights, state.by_force, 1)
    return np.concatenate([z[:-2] - twice @ torque, _GRID.weights @ state.tangent - tip]), matrix


def _size(change: Array, z: Array) -> float:
    """Largest change of a rotation, or of the force over itself."""
    return float(max(np.abs(change[:-2]).max(), np.hypot(*change[-2:]) / (1.0 + np.hypot(*z[-2:]))))


def _stability(matrix: Array) -> float:
    """Sign of the determinant: it changes where the energy stops being least among neighbours with the same tip."""
    return float(np.linalg.slogdet(matrix)[0])


def _follow(z: Array, start: Array, end: Array, flexibility: Flexibility) -> tuple[Array | None, int]:
    """Unknowns with the tip at `end` from those with it at `start`, None if the step is too long, and iterations."""
    _, matrix = _residual(z, start, flexibility)
    stability = _stability(matrix)
    ahead = np.zeros(len(z))
    ahead[-2:] = end - start
    allowed = _PREDICTION
    change = np.asarray(np.linalg.solve(matrix, ahead), dtype=np.float64)
    for iteration in range(12):
        size = _size(change, z)
        if not size <= allowed:
            return None, iteration
        z = z + change
        if size < 1e-11:
            return (z if _stability(matrix) == stability else None), iteration
        allowed = size / 2.0
        residual, matrix = _residual(z, end, flexibility)
        if not np.all(np.isfinite(matrix)) or _stability(matrix) == 0.0:
            return None, iteration + 1
        change = np.asarray(-np.linalg.solve(matrix, residual), dtype=np.float64)
    return None, iteration + 1


def _advance(z: Array, start: Array, end: Array, flexibility: Flexibility) -> tuple[Array | None, int]:
    """Unknowns after a straight piece of the tip's path, None if not reached, and Newton iterations."""
    done, step, spent = 0.0, 1.0, 0
    while done < 1.0:
        following = min(done + step, 1.0)
        here, there = (start + part * (end - start) for part in (done, following))
        found, iterations = _follow(z, here, there, flexibility)
        spent += iterations
        if found is not None:
            z, done, step = found, following, 2.0 * step
        else:
            step = (following - done) / 2.0
            if step < _SMALLEST_STEP:
                return None, spent
    return z, spent


def rod_with_tied_tip(points: ArrayLike, *, EA: float, GA: float, EI: float, length: float) -> TiedPath:
    """Equilibrium of a clamped Reissner rod at every vertex of the path along which its tip is moved.

    Parameters
    ----------
    points : array_like, shape (s, 2)
        Vertices of the path, joined by straight lines. The first must be the undeformed tip `(length, 0)`.
    EA, EI, length : float
        Stretch and bending stiffness, undeformed length.
    GA : float
        Shear stiffness `GA_e`; `inf` is rigid.

    Returns
    -------
    TiedPath

    Raises
    ------
    ValueError
        If a stiffness or the length is not positive, or the path is not finite or does not start at the undeformed tip.

    Examples
    --------
    >>> path = rod_with_tied_tip([[1.0, 0.0], [1.0, 1e-6]], EA=1e4, GA=np.inf, EI=1.0, length=1.0)
    >>> round(1e6 * float(path.force[1, 1]), 6)
    3.0
    """
    points = np.asarray(points, dtype=np.float64)
    require_positive(EA=EA, EI=EI, length=length)
    if not GA > 0.0:
        raise ValueError(f"GA = {GA}: must be positive")
    if points.ndim != 2 or points.shape[1] != 2 or len(points) == 0 or not np.all(np.isfinite(points)):
        raise ValueError(f"points, shape {points.shape}: must be finite and of shape (s, 2), s >= 1")
    if np.hypot(*(points[0] - [length, 0.0])) > 1e-12 * length:
        raise ValueError(f"points[0] = {points[0]}: must be the undeformed tip, ({length}, 0)")
    flexibility = Flexibility(stretch=EI / length**2 / EA, shear=EI / length**2 / GA)
    states: list[Array | None] = [np.zeros(_POINTS + 2)]
    iterations = [0]
    for start, end in pairwise(points / length):
        state, spent = (None, 0) if states[-1] is None else _advance(states[-1], start, end, flexibility)
        states.append(state)
        iterations.append(spent)
    return _collect(points, states, iterations, flexibility, EI, length)


def _collect(
    points: Array,
    states: list[Array | None],
    iterations: list[int],
    flexibility: Flexibility,
    EI: float,
    length: float,
) -> TiedPath:
    """Quantities in the caller's units."""
    z = np.array([np.full(_POINTS + 2, np.nan) if state is None else state for state in states])
    force = z[:, -2:] * EI / length**2
    tip = np.where(np.isnan(force), np.nan, points)
    moment = [_GRID.from_right @ _cross(_tangents(one, flexibility).tangent, one[-2:]) for one in z]
    return TiedPath(
        outcome=tuple(Outcome.LOST if state is None else Outcome.CONTACT for state in states),
        force=force,
        clamp_force=-force,
        clamp_moment=-_cross(tip, force),
        tip=tip,
        tip_rotation=np.array(moment) @ _GRID.weights,
        iterations=np.array(iterations, dtype=np.int64),
        unknowns=z,
        flexibility=flexibility,
        length=length,
    )
