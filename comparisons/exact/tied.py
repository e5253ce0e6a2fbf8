"""A Reissner rod whose tip is hinged to a point that moves along a path.

The clamp is at the origin and the undeformed rod lies along +x. The internal force n is constant, and the moment vanishes at the
tip:

    theta(s) = int_0^s m,   m(s) = int_s^1 r' x n,   r' = (1 + N/EA) d1 + (Q/GA) d2,   N = n.d1,  Q = n.d2

with lengths in units of the rod's length L, forces in EI/L^2 and moments in EI/L. The unknowns are m at Gauss points, where both
integrals are matrices, and n. The equations are the two integrals and `int_0^1 (r' - e1) = tip - e1`. The difference to e1 keeps the
digits of the stretch, which is about 1e-7 for a slender rod. The equations are the stationarity conditions of the energy

    Pi(m, n) = 1/2 int m^2 - int (N + N^2/2 EA + Q^2/2 GA) + n.tip

The energy is a maximum in n for every m. A state is stable at a fixed tip if this maximum is a minimum in m, that is, if and only
if the Hessian has exactly two negative eigenvalues. The solution is analytic, so that the error decreases faster than any power of
the number of points. A taut rod bends in a layer `1/sqrt(n)` at the clamp; the points are graded towards the clamp accordingly.

A compressed rod buckles sideways within a thousandth of its length, which a long step could pass over. Therefore a step is
shortened until the prediction along the tangent to the path is small. It is halved unless the first correction is small, every
later correction is at most half the previous one, and the Hessian at every iterate belongs to a stable state.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.checks import path_points, require_positive, require_stiffness
from comparisons.exact.graded import GradedGrid, graded_grid
from comparisons.exact.outcome import Outcome
from comparisons.exact.reissner import Flexibility

Array = NDArray[np.float64]

_POINTS = 64
_SMALLEST_STEP = 1e-14  # relative to the completed fraction of a piece of the path, or to 1e-12 if larger
_PREDICTION = 0.1  # rotation [rad] or relative change of the force
_CORRECTION = 0.05  # the same measure


@dataclass(frozen=True, kw_only=True)
class TiedPath:
    """States of the rod at `s` positions of its tip; nan without equilibrium (`Outcome.LOST`).

    Attributes
    ----------
    outcome : tuple of Outcome
        `CONTACT`, or `LOST` from the first position that has no stable equilibrium connected with the straight rod.
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
        Newton iterations since the previous position, including rejected steps.
    unknowns : ndarray, shape (s, points + 2)
        Moments at the Gauss points in units of `EI/length` and the force in units of `EI/length^2`.
    flexibility : Flexibility
        Flexibility of the rod.
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
        """Position and rotation `x, y, theta` at `n` equal distances along the undeformed axis from the clamp to the tip.

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
    """Dimensionless rod with the grid of its moments."""

    flexibility: Flexibility
    grid: GradedGrid


def _rod(flexibility: Flexibility) -> _Rod:
    """Grade the grid so that the bending layer of a rod stretched to twice its length is resolved."""
    slenderness = min(flexibility.stretch**-0.5, 1e6) if flexibility.stretch > 0.0 else 1e6
    return _Rod(flexibility, graded_grid(_POINTS, float(np.log1p(slenderness / 12.0))))


class _Fields(NamedTuple):
    """Fields at the Gauss points.

    `strain` is `r' - e1` (n, 2), `turned` its derivative in theta (n, 2) and `by_force` its derivative in n (n, 2, 2). `torque` is
    `r' x n` (n,) and `stiffening` its derivative in theta. The derivative of `r' x n` in n is `turned`.
    """

    strain: Array
    turned: Array
    by_force: Array
    torque: Array
    stiffening: Array


def _fields(z: Array, rod: _Rod) -> _Fields:
    """Evaluate the fields at the unknowns `z` (n + 2,)."""
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
    """Whether a Hessian belongs to a stable state; rows are scaled, since EA and EI differ by orders of magnitude."""
    largest = np.abs(hessian).max(axis=1)
    if not np.all(np.isfinite(hessian)) or largest.min() == 0.0:
        return False
    scale = 1.0 / np.sqrt(largest)
    values = np.linalg.eigvalsh(scale[:, None] * hessian * scale)
    return bool(values[1] < 0.0 < values[2])


def _size(change: Array, z: Array, rod: _Rod) -> float:
    """Largest change of a rotation [rad], or relative change of the force if larger."""
    rotation = np.abs(rod.grid.from_left @ change[:-2]).max()
    return float(max(rotation, np.hypot(*change[-2:]) / (1.0 + np.hypot(*z[-2:]))))


def _correct(z: Array, displacement: Array, rod: _Rod) -> tuple[Array | None, int]:
    """Unknowns at a displacement of the tip from nearby ones, None if the step is rejected, and Newton iterations."""
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
    """Unknowns at the end of a straight piece of the tip's path, None if not reached, and Newton iterations."""
    done, step, spent = 0.0, 1.0, 0
    right = np.zeros(len(z))
    right[-2:] = start - end
    while done < 1.0:
        _, hessian = _equations(z, start + done * (end - start), rod)
        if step < _SMALLEST_STEP * max(done, 1e-12) or not _stable(hessian):
            return None, spent
        tangent = np.asarray(np.linalg.solve(hessian, right), dtype=np.float64)
        step = min(step, _PREDICTION / max(_size(tangent, z, rod), _PREDICTION))
        following = done + step if step < 1.0 - done else 1.0
        predicted, displacement = z + (following - done) * tangent, start + following * (end - start)
        corrected, iterations = _correct(predicted, displacement, rod)
        spent += iterations
        if corrected is not None:
            z, done, step = corrected, following, 2.0 * step
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
    require_positive(EA=EA, EI=EI, length=length)
    require_stiffness(GA=GA)
    points = path_points(points)
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
    """Return the path in the units of the input."""
    z = np.array([np.full(_POINTS + 2, np.nan) if state is None else state for state in states])
    force = z[:, -2:] * EI / length**2
    tip = np.where(np.isnan(force), np.nan, points)
    return TiedPath(
        outcome=tuple(Outcome.LOST if state is None else Outcome.CONTACT for state in states),
        force=force,
        clamp_force=-force,
        clamp_moment=(0.0 - np.array([_fields(state, rod).torque for state in z]) @ rod.grid.weights)
        * EI
        / length,
        tip=tip,
        tip_rotation=z[:, :-2] @ rod.grid.weights,
        iterations=np.array(iterations, dtype=np.int64),
        unknowns=z,
        flexibility=rod.flexibility,
        length=length,
    )
