r"""Equilibrium linearised about a state: Newton corrections, rates, and the index.

The unknowns are displacements and contact forces. U and H are the factors of the gaps' derivatives, see
`fem_reference.contact`; ``C = 1 / eps`` is the flexibility of a contact, or zero where augmented Lagrangian steps remove the
penetration. The motion of the pin alone changes ``U^T u`` by p. With the gap residual r,

    K du - sum U (lam H (U^T du + p) + e_1 dlam) = -R,     e_1 . (U^T du + p) + C dlam = -r.

Only the stiffness K of the bodies is factorised; a contact adds the three columns of U.
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
    """Changes of the displacements ``(n, 2)`` and of the forces of the closed contacts ``(c,)``."""

    u: Floats
    forces: Floats

    @property
    def size(self) -> float:
        """Largest component of the displacements [m]."""
        return float(np.abs(self.u).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class Tangent:
    """Factorised stiffness of the bodies at a state, with the columns of the closed contacts.

    Parameters
    ----------
    model, at
        The model and the state of linearisation.
    factors
        Factorised stiffness of every body.
    U, Y
        Columns ``(m, 3 c)`` of the closed contacts over the unknowns, and ``K^-1 U``.
    """

    model: Model
    state: State
    factors: tuple[Factor, ...]
    U: Floats
    Y: Floats

    def correction(self, R: Floats) -> Correction | None:
        """Newton correction for the residual ``R`` ``(m,)``; None if the contact equations are singular."""
        r = np.concatenate([touch.gap_residual * _FIRST for touch in self.state.closed] or [np.zeros(0)])
        return self._correction(self._respond(R, np.zeros_like(r), r, augmented=False))

    def rate(self, before: float, after: float) -> Correction | None:
        """Change per load parameter with the mean velocity of the pins between two load parameters."""
        p = np.concatenate(
            [_pin_motion(touch, before, after) for touch in self.state.closed] or [np.zeros(0)]
        )
        R = -self.model.expansion.T @ self.model.load.ravel()
        return self._correction(self._respond(R, p, np.zeros_like(p), augmented=True))

    def inverse(self, right: Floats) -> Floats | None:
        """Product ``(m,)`` of the inverse Hessian and ``right``; None if the Hessian is singular."""
        zero = np.zeros(self.U.shape[1])
        response = self._respond(-right, zero, zero, augmented=True)
        return None if response is None else response[0]

    def solve(self, right: Floats) -> Floats:
        """Solve ``K x = right`` without the contacts; ``right`` is ``(m,)`` or ``(m, c)``."""
        return _solve(self.model, self.factors, right)

    def _respond(self, R: Floats, p: Floats, r: Floats, *, augmented: bool) -> tuple[Floats, Floats] | None:
        """Changes ``Y z - K^-1 R`` of the unknowns and dlam of the contact forces; None if singular.

        z holds dlam and the two other components of ``lam H (U^T du + p)`` of each contact.
        """
        y, closed = self.solve(R) if R.any() else R, self.state.closed
        if not closed:
            return -y, np.zeros(0)
        A = block_diag(*(touch.force * touch.curvature - np.outer(_FIRST, _FIRST) for touch in closed))
        C = [0.0 if augmented and _removed(touch.pair) else 1 / touch.pair.penalty for touch in closed]
        flexibility = np.concatenate([[c, 1.0, 1.0] for c in C])
        matrix = np.diag(flexibility) - A @ (self.U.T @ self.Y)
        try:
            z = np.linalg.solve(matrix, A @ (p - self.U.T @ y) - r)
        except np.linalg.LinAlgError:
            return None
        return self.Y @ z - y, z[::3]

    def _correction(self, response: tuple[Floats, Floats] | None) -> Correction | None:
        return None if response is None else Correction(u=self.expanded(response[0]), forces=response[1])

    def expanded(self, unknowns: Floats) -> Floats:
        """Displacements ``(n, 2)`` from the unknowns ``(m,)``."""
        return np.asarray((self.model.expansion @ unknowns).reshape(-1, 2))

    def index(self, force_tolerance: float = 0.0) -> int:
        """Number of negative eigenvalues of the energy's Hessian over the admissible displacements.

        A closed contact is a spring ``eps`` along its gap, or a constraint where the penetration is removed. A contact
        with a force of at most ``force_tolerance`` [N] may be open or closed. If the index depends on this choice, the
        result is -1.
        """
        loaded = [touch.force > force_tolerance for touch in self.state.closed]
        index = self._count([True] * len(loaded))
        return index if all(loaded) or self._count(loaded) == index else -1

    def _count(self, chosen: list[bool]) -> int:
        """Index with a subset of the closed contacts.

        The Hessian is the Schur complement of a bordered matrix with K in the upper left and a diagonal D in the lower right.
        With the spectral decomposition ``-lam H = sum m v v^T`` of a contact, each term borders K by the column
        ``sqrt |m| U v`` with the diagonal entry ``-sign m``. The gap's column has the diagonal entry -C. By Haynsworth's
        theorem the index is ``negatives(K) + negatives(D - U^T K^-1 U) - negatives(D)``, where -C counts as negative even
        if it is zero.
        """
        negatives = sum(factor.negatives() for factor in self.factors)
        blocks, D = [], list[float]()
        for touch, included in zip(self.state.closed, chosen, strict=True):
            columns, signs = _bordering_columns(touch)
            blocks.append(columns if included else columns[:, :0])
            D += signs if included else []
        if not D:
            return negatives
        T = block_diag(*blocks)
        S = (
            np.diag(np.where(np.isneginf(D), _flexibilities(self.state, chosen), D))
            - T.T @ (self.U.T @ self.Y) @ T
        )
        scale = 1 / np.sqrt(np.maximum(np.abs(S).max(axis=0), np.finfo(float).tiny))
        values = np.linalg.eigvalsh(scale[:, None] * (S + S.T) / 2 * scale)
        return negatives + int((values < 0).sum()) - int((np.array(D) < 0).sum())


def _bordering_columns(touch: Touch) -> tuple[Floats, list[float]]:
    """Bordering columns ``(3, k)`` in the basis of U, and the signs of their diagonal entries; -inf for the gap."""
    values, vectors = np.linalg.eigh(-touch.force * touch.curvature[1:, 1:])
    columns = np.zeros((3, 3))
    columns[0, 0] = 1.0
    columns[1:, 1:] = vectors * np.sqrt(np.abs(values))
    return columns, [-np.inf, *(-1.0 if value > 0 else 1.0 for value in values)]


def _flexibilities(state: State, chosen: list[bool]) -> Floats:
    """Diagonal entries -C of the gaps' columns of the chosen contacts, each followed by two zeros, ``(3 k,)``."""
    pairs = [touch.pair for touch, included in zip(state.closed, chosen, strict=True) if included]
    return np.concatenate([[0.0 if _removed(pair) else -1 / pair.penalty, 0.0, 0.0] for pair in pairs])


def _removed(pair: Pair) -> bool:
    """Whether augmented Lagrangian steps remove the penetration."""
    return pair.contact.penetration is not None


def _pin_motion(touch: Touch, before: float, after: float) -> Floats:
    """Change p ``(3,)`` of ``U^T u`` per load parameter by the motion of the pin alone."""
    pair, state = touch.pair, touch.projection
    if not isinstance(pair.node, Pin):
        return np.zeros(3)
    velocity = (pair.node.position(after) - pair.node.position(before)) / (after - before)
    return np.array([pair.contact.sign * state.normal @ velocity, -state.tangent @ velocity, 0.0])


def linearise(model: Model, state: State) -> Tangent | None:
    """Linearise equilibrium at a state; None if the stiffness of a body is singular or not finite."""
    factors = []
    for body, part in model.bodies_and_nodes():
        K = body.tangent(state.u[part])
        factor = factorise(K, body.stiffness.band) if np.all(np.isfinite(K.data)) else None
        if factor is None:
            return None
        factors.append(factor)
    closed = state.closed
    U = np.zeros((model.unknowns, 0))
    if closed:
        U = np.asarray(model.expansion.T @ np.hstack([touch.slopes for touch in closed]))
    Y = _solve(model, tuple(factors), U) if closed else U
    if not np.all(np.isfinite(Y)):
        return None
    return Tangent(model=model, state=state, factors=tuple(factors), U=U, Y=Y)


def _solve(model: Model, factors: tuple[Factor, ...], right: Floats) -> Floats:
    """Solve ``K x = right`` body by body."""
    parts, start = [], 0
    for body, factor in zip(model.bodies, factors, strict=True):
        size = body.expansion.shape[1]
        parts.append(factor.solve(right[start : start + size]))
        start += size
    return np.concatenate(parts)
