"""A Reissner rod whose tip is tied to a point that moves along a path.

Clamp at the origin, undeformed rod along +x; the tip turns freely, so the internal force n is constant and the moment ends at zero:

    theta(s) = int_0^s m,   m(s) = int_s^1 r' x n,   r' = (1 + N/EA) d1 + (Q/GA) d2,   N = n.d1,  Q = n.d2

with lengths in units of the rod's length L, forces in EI/L^2, moments in EI/L. At Gauss points both integrals are matrices; the
unknowns are m at the points and n, the equations those above and `int_0^1 (r' - e1) = tip - e1` (differences, since a slender rod's
axial force is its stretch, 1e-7 L, times EA). They make an energy stationary, at a saddle point:

    Pi(m, n) = 1/2 int m^2 - int (N + N^2/2 EA + Q^2/2 GA) + n.tip

For every m the energy is largest in n. Where the rod is stable this largest value is least in m; with n held it need not be. So the
state is stable among its neighbours with the same tip if and only if the Hessian has just two negative eigenvalues. The
solution is analytic, so the error falls faster than any power of the number of points; a taut rod bends in a layer
`1/sqrt(n)` at the clamp, where a slender rod therefore has more of them.

A compressed rod buckles sideways within a thousandth of its length, and a long step would miss that: a step is shortened until the
prediction along the tangent to the path is small, and halved unless the first correction is smaller, every other at most half
of the one before, and the Hessian at every iterate that of a stable state.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.checks import require_positive
from comparisons.exact.graded import GradedGrid, graded_grid
from comparisons.exact.outcome import Outcome
from comparisons.exact.reissner import Flexibility

Array = NDArray[np.float64]

_POINTS = 64
_SMALLEST_STEP = 1e-14  # part of what is done of a piece of the path, of 1e-12 at least
_PREDICTION = 0.1  # rad, or a part of the force
_CORRECTION = 0.05


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
        Moments at the Gauss points in units of `EI/length` and the force in units of `EI/length^2`.
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
        rod = _rod(self.flexibility)
        moment = self.unknowns[k, :-2]
        tangent = _fields(self.unknowns[k], rod).strain + np.array([1.0, 0.0])
        values = np.column_stack([self.length * tangent, moment])
        return np.asarray(rod.grid.integrals(np.linspace(0.0, 1.0, n)) @ values)


class _Rod(NamedTuple):
    """Dimensionless rod and where its moments are."""

    flexibility: Flexibility
    grid: GradedGrid


def _rod(flexibility: Flexibility) -> _Rod:
    """Grade the points so that a rod stretched to twice its length bends over as many of them as 1/12 of even ones."""
    slenderness = min(flexibility.stretch**-0.5, 1e6) if flexibility.stretch > 0.0 else 1e6
    return _Rod(flexibility, graded_grid(_POINTS, float(np.log1p(slenderness / 12.0))))


class _Fields(NamedTuple):
    """At the Gauss points: `r' - e1` (n, 2), its derivatives in theta (n, 2) and in n (n, 2, 2); `r' x n` (n,) and its derivative in theta.

    The derivative of `r' x n` in n is that of r' in theta.
    """

    strain: Array
    turned: Array
    by_force: Array
    torque: Array
    stiffening: Array


def _fields(z: Array, rod: _Rod) -> _Fields:
    a, b = rod.flexibility.stretch, rod.flexibility.shear
    theta, force = rod.grid.from_left @ z[:-2], z[-2:]
    d1 = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    d2 = np.stack([-d1[:, 1], d1[:, 0]], axis=1)
    N, Q = d1 @ force, d2 @ force
    stretch = 1.0 + (a - b) * N
    turn = np.stack([-2.0 * np.sin(theta / 2.0) ** 2, d1[:, 1]], axis=1)
    return _Fields(
        strain=turn + (a * N)[:, None] * d1 + (b * Q)[:, None] * d2,
        turned=((a - b) * Q)[:, None] * d1 + stretch[:, None] * d2,
        by_force=a * d1[:, :, None] * d1[:, None, :] + b * d2[:, :, None] * d2[:, None, :],
        torque=Q * stretch,
        stiffening=(a - b) * Q**2 - N * stretch,
    )


def _equations(z: Array, displacement: Array, rod: _Rod) -> tuple[Array, Array]:
    """Gradient (n + 2,) and Hessian of the energy with the tip displaced by `displacement`."""
    weights, left = rod.grid.weights, rod.grid.from_left
    fields = _fields(z, rod)
    n = len(weights)
    gradient, hessian = np.empty(n + 2), np.empty((n + 2, n + 2))
    gradient[:n] = weights * z[:n] - left.T @ (weights * fields.torque)
    gradient[n:] = displacement - weights @ fields.strain
    hessian[:n, :n] = np.diag(weights) - (left.T * (weights * fields.stiffening)) @ left
    hessian[:n, n:] = -left.T @ (weights[:, None] * fields.turned)
    hessian[n:, :n] = hessian[:n, n:].T
    hessian[n:, n:] = -np.tensordot(weights, fields.by_force, 1)
    return gradient, hessian


def _stable(hessian: Array) -> bool:
    """Whether the energy is least in the moments for the given tip; rows are scaled, since EA and EI are far apart."""
    largest = np.abs(hessian).max(axis=1)
    if not np.all(np.isfinite(hessian)) or largest.min() == 0.0:
        return False
    scale = 1.0 / np.sqrt(largest)
    values = np.linalg.eigvalsh(scale[:, None] * hessian * scale)
    return bool(values[1] < 0.0 < values[2])


def _size(change: Array, z: Array, rod: _Rod) -> float:
    """Largest change of a rotation, or of the force over itself."""
    rotation = np.abs(rod.grid.from_left @ change[:-2]).max()
    return float(max(rotation, np.hypot(*change[-2:]) / (1.0 + np.hypot(*z[-2:]))))


def _correct(z: Array, displacement: Array, rod: _Rod) -> tuple[Array | None, int]:
    """Unknowns for a displacement of the tip from nearby ones, None if they are too far off, and Newton iterations."""
    allowed = _CORRECTION
    for iteration in range(1, 13):
        gradient, hessian = _equations(z, displacement, rod)
        if not _stable(hessian):
            return None, iteration
        change = np.asarray(-np.linalg.solve(hessian, gradient), dtype=np.float64)
        size = _size(change, z, rod)
        if not size <= allowed:
            return None, iteration
        z = z + change
        if size < 1e-11:
            return z, iteration
        allowed = size / 2.0
    return None, iteration


def _advance(z: Array, start: Array, end: Array, rod: _Rod) -> tuple[Array | None, int]:
    """Unknowns after a straight piece of the tip's displacement, None if not reached, and Newton iterations."""
    done, step, spent = 0.0, 1.0, 0
    ahead = np.zeros(len(z))
    ahead[-2:] = start - end
    while done < 1.0:
        _, hessian = _equations(z, start + done * (end - start), rod)
        if step < _SMALLEST_STEP * max(done, 1e-12) or not _stable(hessian):
            return None, spent
        tangent = np.asarray(np.linalg.solve(hessian, ahead), dtype=np.float64)
        step = min(step, _PREDICTION / max(_size(tangent, z, rod), _PREDICTION))
        following = done + step if step < 1.0 - done else 1.0
        found, iterations = _correct(z + (following - done) * tangent, start + following * (end - start), rod)
        spent += iterations
        if found is not None:
            z, done, step = found, following, 2.0 * step
        else:
            step = (following - done) / 2.0
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
    rod = _rod(flexibility)
    states: list[Array | None] = [np.zeros(_POINTS + 2)]
    iterations = [0]
    for start, end in pairwise(points / length - [1.0, 0.0]):
        state, spent = (None, 0) if states[-1] is None else _advance(states[-1], start, end, rod)
        states.append(state)
        iterations.append(spent)
    return _collect(points, states, iterations, rod, EI, length)


def _collect(
    points: Array,
    states: list[Array | None],
    iterations: list[int],
    rod: _Rod,
    EI: float,
    length: float,
) -> TiedPath:
    """Quantities in the caller's units."""
    z = np.array([np.full(_POINTS + 2, np.nan) if state is None else state for state in states])
    force = z[:, -2:] * EI / length**2
    tip = np.where(np.isnan(force), np.nan, points)
    return TiedPath(
        outcome=tuple(Outcome.LOST if state is None else Outcome.CONTACT for state in states),
        force=force,
        clamp_force=-force,
        clamp_moment=(0.0 - np.array([_fields(one, rod).torque for one in z]) @ rod.grid.weights)
        * EI
        / length,
        tip=tip,
        tip_rotation=z[:, :-2] @ rod.grid.weights,
        iterations=np.array(iterations, dtype=np.int64),
        unknowns=z,
        flexibility=rod.flexibility,
        length=length,
    )
