r"""Equilibrium linearised about a state: Newton corrections, rates, and the index.

The unknowns are displacements, contact forces and tie forces. U has the columns of closed contacts and end sections, see
`fem_reference.contact` and `fem_reference.end_section`. In these columns the curvature of a gap times its force, and of a
rotation times its moment, is a block of A, and the gradient of a constraint is a column of N. The flexibility C of a
contact is ``1 / eps``, or zero where augmented Lagrangian steps remove the penetration; that of a tie is zero or a spring's. The motion of the
pin alone changes ``U^T u`` by p. With the constraint residual r,

    K du - U A (U^T du + p) - U N dlam = -R,     M^T (U^T du + p) + C dlam = -r.

Without friction M is N, A is symmetric and C diagonal; see `fem_reference.friction` for the others. Only the stiffness K of
the bodies is factorised, which is symmetric; the equations in the columns are solved by elimination with row exchanges. A strip without a clamp has an anchor in K, four springs on its start's
section, whose stiffness in A cancels it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.border import Border, block_diagonal, build_border
from fem_reference.end_section import ROTATION
from fem_reference.factor import Factor
from fem_reference.model import Model
from fem_reference.problem import Pin
from fem_reference.stages import increment
from fem_reference.state import State, section_forces, tie_residuals
from fem_reference.touch import Touch


@dataclass(frozen=True, kw_only=True, eq=False)
class Correction:
    """Changes of the displacements ``(n, 2)`` and of the forces ``(c,)`` of the closed contacts, then of the ties."""

    u: Floats
    forces: Floats

    @property
    def size(self) -> float:
        """Largest component of the displacements [m]."""
        return float(np.abs(self.u).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class Tangent:
    """Factorised stiffness of the bodies at a state, with the columns of closed contacts and end sections."""

    model: Model  # model, state: the model and the state of linearisation
    state: State
    factors: tuple[Factor, ...]  # factorised stiffness of every body
    # U, V: columns ``(m, k)`` of the closed contacts and end sections over the unknowns, and the first half
    # of their solution ``K^-1 U``, see `fem_reference.factor.Factor`
    U: Floats
    V: Floats
    border: Border  # curvatures and constraints over the columns

    @cached_property
    def W(self) -> Floats:
        """Flexibility ``U^T K^-1 U`` ``(k, k)`` of the columns."""
        return _product(self.model, self.factors, self.V, self.V)

    def correction(self, R: Floats) -> Correction | None:
        """Newton correction for the residual ``R`` ``(m,)``; None if the constraint equations are singular."""
        r = np.concatenate(
            [
                [touch.gap_residual for touch in self.state.closed],
                [touch.slip_residual for touch in self.state.rubbing],
                tie_residuals(self.model, self.state),
            ]
        )
        return self._correction(self._respond(R, np.zeros(self.U.shape[1]), r, augmented=False))

    def rate(self, before: float, after: float) -> Correction | None:
        """Change per load parameter with the mean velocity of the pins between two load parameters."""
        model, state = self.model, self.state
        p = np.concatenate(
            [*(pin_motion(touch, before, after) for touch in state.closed), np.zeros(model.columns.shape[1])]
        )
        r = np.array(
            [
                *(0.0 for _ in state.contact_forces),
                *(-increment(tie.rates, before, after) for tie in model.ties),
            ]
        )
        load = increment(model.loads, before, after)
        if model.sections:
            actions = np.outer(increment(model.moments, before, after), np.eye(3)[ROTATION])
            load = load + section_forces(model, self.state, actions)
        return self._correction(self._respond(-(model.restriction @ load.ravel()), p, r, augmented=True))

    def inverse(self, right: Floats) -> Floats | None:
        """Product ``(m,)`` of the inverse Hessian and ``right``; None if the Hessian is singular."""
        border = self.border
        response = self._respond(-right, np.zeros(len(border.A)), np.zeros(border.N.shape[1]), augmented=True)
        return None if response is None else response[0]

    def _respond(self, R: Floats, p: Floats, r: Floats, *, augmented: bool) -> tuple[Floats, Floats] | None:
        """Changes ``K^-1 (U z - R)`` of the unknowns and dlam of the constraint forces; None if singular.

        With ``z = A (U^T du + p) + N dlam`` and ``W = U^T K^-1 U`` the remaining equations are
        ``(I - A W) z - N dlam = A (p - U^T K^-1 R)`` and ``M^T W z + C dlam = -r - M^T (p - U^T K^-1 R)``.
        """
        model, factors, border = self.model, self.factors, self.border
        half = _by_body(model, [factor.half for factor in factors], R) if R.any() else R
        rests = [factor.rest for factor in factors]
        k = len(border.A)
        if not k:
            return _by_body(model, rests, -half), np.zeros(0)
        A, M, W = border.A, border.M, self.W
        C = np.where(border.removed, 0.0, border.C) if augmented else border.C
        matrix = np.empty((k + C.size, k + C.size))
        matrix[:k, :k], matrix[:k, k:] = np.eye(k) - A @ W, -border.N
        matrix[k:, :k], matrix[k:, k:] = M.T @ W, np.diag(C) + border.coupling
        known = p - _product(model, factors, self.V, half)
        right = np.concatenate([A @ known, -r - M.T @ known])
        scale = 1 / np.maximum(np.abs(matrix).max(axis=1), np.finfo(float).tiny)
        try:
            z = np.linalg.solve(scale[:, None] * matrix, scale * right)
        except np.linalg.LinAlgError:
            return None
        return _by_body(model, rests, self.V @ z[:k] - half), z[k:]

    def _correction(self, response: tuple[Floats, Floats] | None) -> Correction | None:
        return None if response is None else Correction(u=self.expanded(response[0]), forces=response[1])

    def expanded(self, unknowns: Floats) -> Floats:
        """Displacements ``(n, 2)`` from the unknowns ``(m,)``."""
        return np.asarray((self.model.expansion @ unknowns).reshape(-1, 2))

    def index(self, force_tolerance: float = 0.0) -> int:
        """Number of negative eigenvalues of the energy's Hessian over the admissible displacements.

        A closed contact is a spring ``eps`` along its gap, or a constraint where the penetration is removed. A contact
        with a force of at most ``force_tolerance`` [N] may be open or closed. If the index depends on this choice, the
        result is -1. With friction the Hessian is not symmetric and the result is -1: stability is not judged.
        """
        if self.state.rubbing:
            return -1
        loaded = [touch.force > force_tolerance for touch in self.state.closed]
        index = self._count([True] * len(loaded))
        return index if all(loaded) or self._count(loaded) == index else -1

    def _count(self, chosen: list[bool]) -> int:
        """Index with a subset of the closed contacts.

        The Hessian is the Schur complement of a bordered matrix with K in the upper left and a diagonal D in the lower right.
        With the spectral decomposition ``-A = sum m v v^T``, each term borders K by the column ``sqrt |m| U v`` with the
        diagonal entry ``-sign m``. A constraint's column has the diagonal entry -C. By Haynsworth's theorem the index is
        ``negatives(K) + negatives(D - U^T K^-1 U) - negatives(D)``, where -C counts as negative even if it is zero.
        """
        negatives = sum(factor.negatives() for factor in self.factors)
        border = self.border.of_contacts(chosen)
        if not border.blocks:
            return negatives
        spectra = [np.linalg.eigh(-block) for block in border.blocks]
        columns = block_diagonal([vectors * np.sqrt(np.abs(values)) for values, vectors in spectra])
        signs = np.where(np.concatenate([values for values, _ in spectra]) > 0, -1.0, 1.0)
        T = np.hstack([border.N, columns])
        D = np.concatenate([np.where(border.removed, 0.0, -border.C), signs])
        S = np.diag(D) - T.T @ (self.W) @ T
        scale = 1 / np.sqrt(np.maximum(np.abs(S).max(axis=0), np.finfo(float).tiny))
        eigenvalues = np.linalg.eigvalsh(scale[:, None] * (S + S.T) / 2 * scale)
        negatives += int((eigenvalues < 0).sum())
        return negatives - len(border.C) - int((signs < 0).sum())


def pin_motion(touch: Touch, before: float, after: float) -> Floats:
    """Change p ``(3,)`` or ``(4,)`` of ``U^T u`` per load parameter by the motion of the pin alone."""
    pair, state = touch.pair, touch.projection
    p = np.zeros(touch.slopes.shape[1])
    if isinstance(pair.node, Pin):
        velocity = (pair.node.position(after) - pair.node.position(before)) / (after - before)
        p[:2] = pair.contact.sign * state.normal @ velocity, -state.tangent @ velocity
    return p


def linearise(model: Model, state: State) -> Tangent | None:
    """Linearise equilibrium at a state; None if the stiffness of a body is singular or not finite."""
    factors = []
    for body, part in model.bodies_and_nodes():
        factor = body.factorised(state.u[part])
        if factor is None:
            return None
        factors.append(factor)
    columns = np.hstack([*(touch.slopes for touch in state.closed), model.columns])
    U = np.asarray(model.restriction @ columns)
    V = _by_body(model, [factor.half for factor in factors], U) if U.size else U
    border = build_border(model, state)
    if not (np.all(np.isfinite(V)) and np.all(np.isfinite(border.A)) and np.all(np.isfinite(border.N))):
        return None
    return Tangent(model=model, state=state, factors=tuple(factors), U=U, V=V, border=border)


def _by_body(model: Model, solutions: Sequence[Callable[[Floats], Floats]], right: Floats) -> Floats:
    """Apply one of the ``solutions`` to the unknowns of every body."""
    parts = zip(solutions, model.unknowns_of_bodies, strict=True)
    return np.concatenate([solution(right[part]) for solution, part in parts])


def _product(model: Model, factors: Sequence[Factor], a: Floats, b: Floats) -> Floats:
    """Sum of the products ``a^T K^-1 b`` of all bodies from the halves."""
    parts = zip(factors, model.unknowns_of_bodies, strict=True)
    return np.asarray(sum(factor.product(a[part], b[part]) for factor, part in parts))
