r"""Equilibrium linearised about a state: Newton corrections, rates, and the index.

The unknowns are displacements, contact forces and tie forces. U has the columns of closed contacts and end sections, see
`fem_reference.contact.contact` and `fem_reference.contact.end_section`. In these columns the curvature of a gap times its force, and of a
rotation times its moment, is a block of A, and the gradient of a constraint is a column of N. The flexibility C of a
contact is ``1 / eps``, or zero where augmented Lagrangian steps remove the penetration; that of a tie is zero or a spring's. The motion of the
pin alone changes ``U^T u`` by p. With the constraint residual r,

    K du - U A (U^T du + p) - U N dlam = -R,     M^T (U^T du + p) + C dlam = -r.

Without slip C is diagonal; without friction M is N and A symmetric, too, see `fem_reference.contact.friction`. Only the stiffness K of
the bodies is factorised, which is symmetric; the equations in the columns are solved by elimination with row exchanges. A strip without a clamp has an anchor in K, four springs on its start's
section, whose stiffness in A cancels it.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem_reference.contact.contact import Touch
from fem_reference.contact.end_section import COLUMNS, ROTATION
from fem_reference.contact.friction import slip_gradient, stiffness
from fem_reference.statement.arrays import Floats
from fem_reference.statement.loads import increment
from fem_reference.statement.problem import Pin
from fem_reference.system.state import State

if TYPE_CHECKING:
    from fem_reference.solid.factor import Factor


@dataclass(frozen=True, kw_only=True, eq=False)
class Correction:
    """Change of a state."""

    u: Floats  # change of the displacements ``(n, 2)`` [m]
    forces: Floats  # change of the forces of the constraints ``(c,)``, see `State.forces`
    t: float = 0.0  # change of the load parameter


@dataclass(frozen=True, kw_only=True, eq=False)
class Border:
    """Curvatures and constraints over the columns U: 4 of each closed contact, then 4 of each end section."""

    A: Floats  # curvatures ``(k, k)``: the Hessian without constraints is ``K - U A U^T``
    N: Floats  # directions ``(k, c)`` of the constraints' forces ``U N``: gaps, friction, then ties
    M: Floats  # gradients ``(k, c)`` of the constraints ``U M``. They differ from N for friction only
    C: Floats  # flexibilities ``(c, c)`` [m/N]; of a contact that slips 1, and ``-sigma mu`` at its normal force
    rates: Floats  # the same for changes along the path, on which augmented Lagrangian steps remove a contact's flexibility


def build_border(state: State) -> Border:
    """Curvatures and constraints of the closed contacts, ties, dead moments and anchors of a state."""
    model, closed, rubbing = state.model, state.closed, state.rubbing
    sections = zip(model.sections, state.poses, state.actions[:, ROTATION], strict=True)
    blocks = [
        *map(stiffness, closed),
        *(
            moment * pose.curvature + section.anchor_stiffness * np.eye(COLUMNS)
            for section, pose, moment in sections
        ),
    ]
    k, first = COLUMNS * len(blocks), len(closed)
    N, gaps = np.zeros((len(blocks), COLUMNS, len(state.forces))), np.arange(first)
    N[gaps, 0, gaps] = 1.0
    for number, tie in enumerate(model.ties, first + len(rubbing)):
        for section, sign in ((tie.section, 1.0), (tie.other, -1.0)):
            if section is not None:
                N[first + section, :, number] += sign * state.poses[section].gradient[:, tie.component]
    M, soft = N.copy(), [1 / touch.pair.penalty for touch in closed]
    C = np.diag([*soft, *[0.0] * len(rubbing), *(tie.flexibility for tie in model.ties)])
    for number, touch in enumerate(rubbing, first):
        contact = closed.index(touch)
        N[contact, 1, number] = 1.0
        if touch.direction:
            C[number, number], C[number, contact] = 1.0, -touch.direction * touch.pair.contact.friction
        else:
            M[contact, :, number] = slip_gradient(touch)
    rates = C.copy()
    rates[[number for number, touch in enumerate(closed) if touch.augmented]] = 0.0
    A, each = np.zeros((len(blocks), COLUMNS, len(blocks), COLUMNS)), np.arange(len(blocks))
    A[each, :, each] = np.reshape(blocks, (-1, COLUMNS, COLUMNS))
    return Border(A=A.reshape(k, k), N=N.reshape(k, len(C)), M=M.reshape(k, len(C)), C=C, rates=rates)


@dataclass(frozen=True, kw_only=True, eq=False)
class Tangent:
    """Factorised stiffness of the bodies at a state, with the columns of closed contacts and end sections."""

    state: State  # the state of linearisation
    factor: "Factor"  # factorised stiffness of the bodies
    V: Floats  # first half ``(m, k)`` of ``K^-1 U`` for the columns over the unknowns, see `Factor`
    border: Border  # curvatures and constraints over the columns

    @cached_property
    def W(self) -> Floats:
        """Flexibility ``U^T K^-1 U`` ``(k, k)`` of the columns."""
        return self.factor.product(self.V, self.V)

    def correction(self) -> Correction | None:
        """Newton correction for the residuals of the state; None if the constraint equations are singular."""
        state = self.state
        return self._correction(state.reduced, np.zeros(len(self.W)), state.residuals, self.border.C)

    def rate(self, before: float, after: float) -> Correction | None:
        """Change per load parameter with the mean velocity of the pins between two load parameters."""
        state, model = self.state, self.state.model
        moving = [pin_motion(touch, before, after) for touch in state.closed]
        p = np.concatenate([*moving, np.zeros(model.columns.shape[1])])
        ties = [-increment(tie.rates, before, after) for tie in model.ties]
        r = np.append(np.zeros(len(state.closed) + len(state.rubbing)), ties)
        load = increment(model.loads, before, after)
        if model.sections:
            load = load + state.nodal_forces(
                np.outer(increment(model.moments, before, after), np.eye(3)[ROTATION])
            )
        return self._correction(-(model.restriction @ load.ravel()), p, r, self.border.rates)

    def inverse(self, right: Floats) -> Floats | None:
        """Product ``(m,)`` of the inverse Hessian and ``right``; None if the Hessian is singular."""
        k, c = self.border.N.shape
        response = self._respond(-right, np.zeros(k), np.zeros(c), self.border.rates)
        return None if response is None else response[0]

    def _respond(self, R: Floats, p: Floats, r: Floats, C: Floats) -> tuple[Floats, Floats] | None:
        """Changes ``K^-1 (U z - R)`` of the unknowns and dlam of the constraint forces; None if singular.

        With ``z = A (U^T du + p) + N dlam`` and ``W = U^T K^-1 U`` the remaining equations are
        ``(I - A W) z - N dlam = A (p - U^T K^-1 R)`` and ``M^T W z + C dlam = -r - M^T (p - U^T K^-1 R)``.
        """
        A, N, M, W = self.border.A, self.border.N, self.border.M, self.W
        k, factor = len(A), self.factor
        half = factor.half(R) if R.any() else R
        matrix = np.concatenate([np.hstack([np.eye(k) - A @ W, -N]), np.hstack([M.T @ W, C])])
        known = p - factor.product(self.V, half)
        right = np.concatenate([A @ known, -r - M.T @ known])
        scale = 1 / np.abs(matrix).max(axis=1, initial=np.finfo(float).tiny)
        try:
            z = np.linalg.solve(scale[:, None] * matrix, scale * right)
        except np.linalg.LinAlgError:
            return None
        return factor.rest(self.V @ z[:k] - half), z[k:]

    def _correction(self, R: Floats, p: Floats, r: Floats, C: Floats) -> Correction | None:
        found = self._respond(R, p, r, C)
        return found and Correction(u=self.state.model.displacements(found[0]), forces=found[1])

    def index(self, force_tolerance: float = 0.0) -> int:
        """Number of negative eigenvalues of the energy's Hessian over the admissible displacements.

        A closed contact is a spring ``eps`` along its gap, or a constraint where the penetration is removed. One that sticks
        is held at its material point besides: ``t . W du = 0``. A contact with a force of at most ``force_tolerance`` [N] may
        be open or closed. If the index depends on this choice, the result is -1. A slip has no energy: the result is -1.
        """
        if any(touch.direction for touch in self.state.rubbing):
            return -1
        loaded = np.array([touch.force > force_tolerance for touch in self.state.closed], dtype=bool)
        index = self._count(loaded | True)
        return index if loaded.all() or self._count(loaded) == index else -1

    def _count(self, chosen: NDArray[np.bool_]) -> int:
        """Index with the contacts ``chosen`` among the closed ones.

        A larger matrix has the unknowns du, ``y = U^T du`` with its multiplier z, and the forces of the constraints. The Hessian is one
        of its Schur complements. By Haynsworth's theorem the other one, S, counts the Hessian's negative eigenvalues, and one for every
        multiplier. Where contacts stick, S is symmetric but for their penetration, which moves their force off the node.
        """
        A, N = self.border.A.copy(), self.border.N
        rubs = np.array([touch.rubs for touch in self.state.closed], dtype=bool)
        kept = np.concatenate([chosen, chosen[rubs], np.ones(len(self.state.model.ties), dtype=bool)])
        A[np.flatnonzero(np.repeat(~chosen, COLUMNS))] = 0.0
        N, C = N[:, kept], self.border.rates[np.ix_(kept, kept)]
        (k, c), one = N.shape, np.eye(len(A))
        S = np.block([[-A, one, -N], [one, -self.W, np.zeros((k, c))], [-N.T, np.zeros((c, k)), -C]])
        tiny = np.finfo(float).tiny
        units = np.sqrt(np.abs(np.diag(self.W)) + tiny)  # of y; those of z are their inverse
        forces = 1 / np.abs(np.vstack([units[:, None] * N, np.sqrt(C)])).max(axis=0, initial=tiny)
        scale = np.concatenate([units, 1 / units, forces])
        negatives = int((np.linalg.eigvalsh(scale[:, None] * (S + S.T) / 2 * scale) < 0).sum())
        return negatives + self.factor.negatives() - int(k + c)


def pin_motion(touch: Touch, before: float, after: float) -> Floats:
    """Change p ``(4,)`` of ``U^T u`` per load parameter by the motion of the pin alone."""
    pair, at, p = touch.pair, touch.at, np.zeros(COLUMNS)
    if isinstance(pair.node, Pin):
        velocity = (pair.node.position(after) - pair.node.position(before)) / (after - before)
        p[:2] = pair.contact.sign * at.normal @ velocity, -at.tangent @ velocity
    return p


def linearise(state: State) -> Tangent | None:
    """Linearise equilibrium at a state; None if the stiffness is singular or not finite."""
    model = state.model
    K = np.zeros((model.unknowns, 1 + max(body.stiffness.width for body in model.bodies))).T
    for body, F in zip(model.bodies, state.gradients, strict=True):
        band = body.band(F)
        K[: len(band), body.unknowns] = band
    # a statement alone does without LAPACK, whose import takes long
    from fem_reference.solid.factor import factorise

    factor = factorise(K)
    if factor is None:
        return None
    U = model.restriction @ np.hstack([*(touch.columns for touch in state.closed), model.columns])
    V = factor.half(U) if U.size else U
    border = build_border(state)
    if not all(np.all(np.isfinite(part)) for part in (V, border.A, border.N)):
        return None
    return Tangent(state=state, factor=factor, V=V, border=border)
