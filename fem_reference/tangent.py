r"""Equilibrium linearised about a state: corrections, rates along the load parameter, and the index.

The unknowns are displacements and contact forces; with U and H of the gaps' derivatives, ``C = 1 / eps`` (zero where
augmented Lagrangian steps remove the penetration) and p the change of ``U^T u`` that is the pin's own,

    K du - sum U (lam H (U^T du + p) + e_1 dlam) = -R,     e_1 . (U^T du + p) + C dlam = -miss.

The sparse matrices that are factorised are the bodies' own, K; a contact enters through the three columns of U.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from fem_reference.arrays import Floats
from fem_reference.contact import Pair
from fem_reference.factor import Factor, factorise
from fem_reference.model import Model
from fem_reference.problem import Pin
from fem_reference.state import State, Touch

_FIRST = np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True, kw_only=True, eq=False)
class Correction:
    """Corrections of the displacements ``(n, 2)`` and of the closed contacts' forces."""

    u: Floats
    forces: Floats

    @property
    def size(self) -> float:
        """Largest displacement [m]."""
        return float(np.abs(self.u).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class Tangent:
    """The bodies' factorised stiffness at a state, with the columns of its closed contacts.

    Parameters
    ----------
    model, at
        What is linearised, and where.
    factors
        Factorised stiffness of every body.
    U, Y
        Columns of the closed contacts over the unknowns, and ``K^-1 U``, ``(m, 3 c)``.
    """

    model: Model
    at: State
    factors: tuple[Factor, ...]
    U: Floats
    Y: Floats

    def correction(self, R: Floats) -> Correction | None:
        """Newton's correction for the residual ``R`` ``(m,)``; None if the contacts leave it undetermined."""
        miss = np.concatenate([touch.mismatch * _FIRST for touch in self.at.closed] or [np.zeros(0)])
        return self._correction(self._respond(R, np.zeros_like(miss), miss, augmented=False))

    def rate(self, before: float, after: float) -> Correction | None:
        """Change per load parameter, with the pins' mean velocity between two load parameters."""
        p = np.concatenate([_own_motion(touch, before, after) for touch in self.at.closed] or [np.zeros(0)])
        R = -self.model.expansion.T @ self.model.load.ravel()
        return self._correction(self._respond(R, p, np.zeros_like(p), augmented=True))

    def inverse(self, right: Floats) -> Floats | None:
        """Product ``(m,)`` of the inverse Hessian and ``right``; None if it is singular."""
        none = np.zeros(self.U.shape[1])
        found = self._respond(-right, none, none, augmented=True)
        return None if found is None else found[0]

    def solve(self, right: Floats) -> Floats:
        """Solve with the bodies' own stiffness: ``right`` is ``(m,)`` or ``(m, c)``."""
        return _solve(self.model, self.factors, right)

    def _respond(
        self, R: Floats, p: Floats, miss: Floats, *, augmented: bool
    ) -> tuple[Floats, Floats] | None:
        """Unknowns ``Y z - K^-1 R`` and forces dlam; z is dlam and ``lam H (U^T du + p)`` of each contact."""
        y, closed = self.solve(R) if R.any() else R, self.at.closed
        if not closed:
            return -y, np.zeros(0)
        A = block_diag(*(touch.force * touch.curvature - np.outer(_FIRST, _FIRST) for touch in closed))
        C = [0.0 if augmented and _removed(touch.pair) else 1 / touch.pair.penalty for touch in closed]
        flexibility = np.concatenate([[c, 1.0, 1.0] for c in C])
        matrix = np.diag(flexibility) - A @ (self.U.T @ self.Y)
        try:
            z = np.linalg.solve(matrix, A @ (p - self.U.T @ y) - miss)
        except np.linalg.LinAlgError:
            return None
        return self.Y @ z - y, z[::3]

    def _correction(self, found: tuple[Floats, Floats] | None) -> Correction | None:
        return None if found is None else Correction(u=self.expanded(found[0]), forces=found[1])

    def expanded(self, unknowns: Floats) -> Floats:
        """Displacements ``(n, 2)`` from unknowns."""
        return np.asarray((self.model.expansion @ unknowns).reshape(-1, 2))

    def index(self, weak: float = 0.0) -> int:
        """Number of negative eigenvalues of the energy's Hessian over the displacements that the supports admit.

        A contact is a spring ``eps`` along its gap, or a constraint where the penetration is removed. One that pushes with
        no more than ``weak`` [N] can open or close: -1 if both do not have the same index.
        """
        sure = [touch.force > weak for touch in self.at.closed]
        found = self._count([True] * len(sure))
        return found if all(sure) or self._count(sure) == found else -1

    def _count(self, chosen: list[bool]) -> int:
        """Index with the chosen ones of the closed contacts.

        ``-lam H`` of a contact is split into its eigenvectors, ``sum m v v^T``, and each, scaled by ``sqrt |m|``, borders K
        by a column ``U v`` over ``-sign m``; the gap's column stands over -C. By Haynsworth's theorem the index is
        ``negatives(K) + negatives(D - U^T K^-1 U) - negatives(D)``, -C counted as negative even if it is zero.
        """
        negatives = sum(factor.negatives() for factor in self.factors)
        blocks, D = [], list[float]()
        for touch, taken in zip(self.at.closed, chosen, strict=True):
            columns, signs = _border(touch)
            blocks.append(columns if taken else columns[:, :0])
            D += signs if taken else []
        if not D:
            return negatives
        T = block_diag(*blocks)
        S = (
            np.diag(np.where(np.isneginf(D), _flexibilities(self.at, chosen), D))
            - T.T @ (self.U.T @ self.Y) @ T
        )
        scale = 1 / np.sqrt(np.maximum(np.abs(S).max(axis=0), np.finfo(float).tiny))
        values = np.linalg.eigvalsh(scale[:, None] * (S + S.T) / 2 * scale)
        return negatives + int((values < 0).sum()) - int((np.array(D) < 0).sum())


def _border(touch: Touch) -> tuple[Floats, list[float]]:
    """Columns ``(3, k)`` that border K in the basis of U, and the signs under them; -inf under the gap's."""
    values, vectors = np.linalg.eigh(-touch.force * touch.curvature[1:, 1:])
    columns = np.zeros((3, 3))
    columns[0, 0] = 1.0
    columns[1:, 1:] = vectors * np.sqrt(np.abs(values))
    return columns, [-np.inf, *(-1.0 if value > 0 else 1.0 for value in values)]


def _flexibilities(at: State, chosen: list[bool]) -> Floats:
    """``-C`` under the gaps' columns of the chosen contacts, and what is not used under the others, ``(3 k,)``."""
    taken = [touch.pair for touch, one in zip(at.closed, chosen, strict=True) if one]
    return np.concatenate([[0.0 if _removed(pair) else -1 / pair.penalty, 0.0, 0.0] for pair in taken])


def _removed(pair: Pair) -> bool:
    return pair.contact.penetration is not None


def _own_motion(touch: Touch, before: float, after: float) -> Floats:
    """Change of ``U^T u`` per load parameter by the pin's motion alone, ``(3,)``: its gap's, and along the curve."""
    pair, at = touch.pair, touch.projection
    if not isinstance(pair.node, Pin):
        return np.zeros(3)
    velocity = (pair.node.position(after) - pair.node.position(before)) / (after - before)
    return np.array([pair.contact.sign * at.normal @ velocity, -at.tangent @ velocity, 0.0])


def linearise(model: Model, at: State) -> Tangent | None:
    """Factorise the tangent at a state; None if a body's own stiffness is singular or not finite."""
    factors = []
    for body, part in model.each():
        K = body.tangent(at.u[part])
        factor = factorise(K, body.stiffness.band) if np.all(np.isfinite(K.data)) else None
        if factor is None:
            return None
        factors.append(factor)
    closed = at.closed
    U = np.zeros((model.unknowns, 0))
    if closed:
        U = np.asarray(model.expansion.T @ np.hstack([touch.slopes for touch in closed]))
    Y = _solve(model, tuple(factors), U) if closed else U
    if not np.all(np.isfinite(Y)):
        return None
    return Tangent(model=model, at=at, factors=tuple(factors), U=U, Y=Y)


def _solve(model: Model, factors: tuple[Factor, ...], right: Floats) -> Floats:
    parts, start = [], 0
    for body, factor in zip(model.bodies, factors, strict=True):
        size = body.expansion.shape[1]
        parts.append(factor.solve(right[start : start + size]))
        start += size
    return np.concatenate(parts)
