r"""Coulomb friction at a closed contact: slip, tangential force, their derivatives, and the return mapping.

The tangential force T acts on the strip along the unit tangent t of the contact curve, and on the node against it. In
virtual work ``T t . W du`` it is conjugate to the slip rate

    d xi = -t . W du = rho d zeta - s R d theta,

the tangential velocity of the node's surface relative to the material point that it touches. The node does not turn; theta is
the angle of t, s the side and R the radius of the pin. Hence a sharp pin sticks to a coordinate zeta, and a strip rolls on a
round pin that sticks. Over a load step the slip is measured along the deformed curve from the last accepted state n,

    xi - xi_n = (rho_n + rho) (zeta - zeta_n) / 2 - s R (theta - theta_n).

A contact sticks, ``xi = xi_n`` with the multiplier T, or it slips in the direction sigma, ``T = sigma mu lam``. Both are equations
of the Newton iteration beside the gap's. The return mapping of the augmented Lagrangian method (Alart and Curnier, Comput.
Methods Appl. Mech. Eng. 92 (1991), 353-375, section 4) chooses between them where the iteration has converged: a T beyond the
cone ``|T| <= mu lam`` returns to it and slips, a slip against its T sticks. No penalty is left in T and in the slip.

With the columns ``y = (dg/du, W^T t, W'^T n, W'^T t)^T du`` and the notation of `fem_reference.contact`,

    d zeta  = -(rho y_1 + d y_2) / D,
    d theta = (y_2 + k d zeta) / rho,
    d rho   = y_3 + t . r'' d zeta,
    d (W^T t) = W'^T t d zeta + W^T n d theta.

The last line makes the tangent unsymmetric, as does ``sigma mu`` in slip.
"""

from dataclasses import dataclass, replace

import numpy as np

from fem_reference.arrays import Array, Floats
from fem_reference.checks import Point
from fem_reference.contact import Pair
from fem_reference.curve import Projection

COLUMNS = 4
"""Number of columns of a closed contact with friction."""


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Friction at a contact: the present equation and force, and what the last accepted state left."""

    # 0 where the contact sticks; 1 or -1 where the node slips along the strip's tangent or against it
    direction: int = 0
    force: float = 0.0  # tangential force T on the strip along t; zero if open [N]
    # zeta, tangent, stretch: coordinate [m], unit tangent and stretch rho of the contact curve at the last
    # accepted state
    zeta: float
    tangent: Point
    stretch: float
    last_force: float = 0.0  # tangential force there [N]
    slip: float = 0.0  # slip, dissipated: sum of the slips [m], and the dissipated energy [J] up to there
    dissipated: float = 0.0

    def opened(self) -> "Friction":
        """Return the friction of the contact after opening."""
        return replace(self, direction=0, force=0.0)


def friction_at(at: Projection) -> Friction:
    """Friction of a contact whose first accepted state has the projection ``at``."""
    return Friction(zeta=float(at.zeta), tangent=_point(at.tangent), stretch=float(at.stretch))


def settled(pair: Pair, at: Projection, friction: Friction, *, closed: bool) -> Friction:
    """Friction after a state was accepted: its slip and its dissipated energy are added, and slip counts from there.

    The energy is ``(T_n + T) (xi - xi_n) / 2`` in slip, see `force_before_slip` for T_n.
    """
    slip = float(slip_increment(pair, at, friction)) if closed and friction.direction else 0.0
    begin = force_before_slip(friction, friction.last_force)
    return replace(
        friction,
        zeta=float(at.zeta),
        tangent=_point(at.tangent),
        stretch=float(at.stretch),
        last_force=friction.force,
        slip=friction.slip + slip,
        dissipated=friction.dissipated + (begin + friction.force) * slip / 2,
    )


def force_before_slip(friction: Friction, last: float) -> float:
    """Tangential force at which a present slip began since a state with the force ``last`` [N].

    It is that force, or the present one where the contact has turned in between: it slips only after that.
    """
    return friction.force if friction.direction * last < 0 else last


def _point(vector: Floats) -> Point:
    return float(vector[0]), float(vector[1])


def slip_increment(pair: Pair, at: Projection, friction: Friction) -> Array:
    """Slip ``xi - xi_n`` of a projection since the last accepted state [m]; the strip turns less than half a turn."""
    x, y = friction.tangent
    sine, cosine = x * at.tangent[1] - y * at.tangent[0], x * at.tangent[0] + y * at.tangent[1]
    turn = 2 * np.arctan(sine / (1 + cosine))
    length = (friction.stretch + at.stretch) / 2 * (at.zeta - friction.zeta)
    return np.asarray(length - pair.contact.sign * pair.radius * turn)


def slip_residual(pair: Pair, at: Projection, friction: Friction, normal_force: float) -> float:
    """Residual of the friction's equation: the slip [m] in stick, ``T - sigma mu lam`` [N] in slip."""
    if friction.direction:
        return friction.force - friction.direction * pair.contact.friction * normal_force
    return float(slip_increment(pair, at, friction))


def stretch_column(pair: Pair, at: Projection) -> Array:
    """Column ``W'^T t`` ``(2 n, 1)`` beside those of `Pair.gap_derivatives`."""
    column: Array = pair.carrier.nodal_forces(at.basis[1:2], at.tangent[None]).reshape(-1, 1)
    return column


def motion_gradients(at: Projection) -> tuple[Array, Array, Array]:
    """Derivatives of zeta [m], theta and rho with respect to the columns' motions y, each ``(4,)``."""
    d = -at.distance
    along, across, stretching = np.eye(COLUMNS)[1:]
    zeta = -(at.stretch * along + d * across) / (at.stretch**2 + d * at.bend)
    return zeta, (across + at.bend * zeta) / at.stretch, stretching + at.stretch_slope * zeta


def slip_gradient(pair: Pair, at: Projection, friction: Friction) -> Array:
    """Derivative ``(4,)`` of `slip_increment` with respect to the columns' motions y."""
    zeta, theta, stretch = motion_gradients(at)
    rolled = pair.contact.sign * pair.radius * theta
    gradient: Array = (friction.stretch + at.stretch) / 2 * zeta + (at.zeta - friction.zeta) / 2 * stretch
    return gradient - rolled


def force_curvature(pair: Pair, at: Projection) -> Array:
    """Matrix G ``(4, 4)`` of the derivative ``U G U^T du`` of the force's direction ``W^T t`` [1/m]."""
    zeta, theta, _ = motion_gradients(at)
    G = np.zeros((COLUMNS, COLUMNS), dtype=zeta.dtype)
    G[0] = -pair.contact.sign * theta  # W^T n = -s dg/du
    G[3] = zeta
    return G


def mapped(friction: Friction, slip: float, largest_force: float, allowed: tuple[float, float]) -> Friction:
    """Return mapping of a converged friction; the same one where its equation holds.

    ``friction``: friction with the converged force. ``slip``: slip since the last accepted state [m].
    ``largest_force``: radius ``mu lam`` of the cone [N]. ``allowed``: slip [m] against the force, and force
    [N] beyond the cone, that are round-off.
    """
    if friction.direction:
        return replace(friction, direction=0) if friction.direction * slip < -allowed[0] else friction
    if abs(friction.force) <= largest_force + allowed[1]:
        return friction
    direction = 1 if friction.force > 0 else -1
    return replace(friction, direction=direction, force=direction * largest_force)
