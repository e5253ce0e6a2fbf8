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

With the columns ``y = (dg/du, W^T t, W'^T n, W'^T t)^T du`` and the notation of `fem_reference.contact.contact`,

    d zeta  = -(rho y_1 + d y_2) / D,
    d theta = (y_2 + k d zeta) / rho,
    d rho   = y_3 + t . r'' d zeta,
    d (W^T t) = W'^T t d zeta + W^T n d theta.

The last line makes the tangent unsymmetric, as does ``sigma mu`` in slip.
"""

from dataclasses import replace

import numpy as np

from fem_reference.contact.contact import Touch
from fem_reference.contact.curve import Projection
from fem_reference.statement.arrays import Floats


def slip(touch: Touch) -> float:
    """Slip ``xi - xi_n`` since the last accepted state, also where the contact is open; zero without friction [m]."""
    at, begin = touch.at, touch.begin
    if begin is None:
        return 0.0
    (c, s), (a, b) = begin.tangent, at.tangent
    rolled = touch.pair.contact.sign * touch.pair.radius * np.arctan2(c * b - s * a, c * a + s * b)
    return float((begin.stretch + at.stretch) / 2 * (at.zeta - begin.zeta) - rolled)


def slip_residual(touch: Touch) -> float:
    """Residual of the friction's equation: the slip [m] in stick, ``T - sigma mu lam`` [N] in slip."""
    if touch.direction:
        return touch.tangential - touch.direction * touch.largest_tangential
    return slip(touch)


def _motion_gradients(at: Projection) -> tuple[Floats, Floats, Floats]:
    """Derivatives of zeta [m], theta and rho with respect to the columns' motions y, each ``(4,)``."""
    along, across, stretching = np.eye(4)[1:]
    zeta = (at.distance * across - at.stretch * along) / (at.stretch**2 - at.distance * at.bend)
    return zeta, (across + at.bend * zeta) / at.stretch, stretching + at.stretch_slope * zeta


def slip_gradient(touch: Touch) -> Floats:
    """Derivative ``(4,)`` of `slip` with respect to the columns' motions y."""
    at, begin = touch.at, touch.begin
    assert begin is not None, "a contact that rubs has friction"
    zeta, theta, stretch = _motion_gradients(at)
    rolled = touch.pair.contact.sign * touch.pair.radius * theta
    return (begin.stretch + at.stretch) / 2 * zeta + (at.zeta - begin.zeta) / 2 * stretch - rolled


def stiffness(touch: Touch) -> Floats:
    """Derivative of the contact force in the columns: ``lam H`` and ``T G``, where ``U G U^T du`` changes ``W^T t``."""
    block = touch.force * touch.curvature
    if touch.rubs:
        zeta, theta, _ = _motion_gradients(touch.at)
        block[0] -= touch.tangential * touch.pair.contact.sign * theta
        block[3] += touch.tangential * zeta
    return block


def mapped(touch: Touch, allowed: tuple[float, float]) -> Touch:
    """Return mapping of a converged contact; ``allowed`` are the slip [m] and the force [N] that are round-off."""
    if touch.direction:
        return replace(touch, direction=0) if touch.direction * slip(touch) < -allowed[0] else touch
    if abs(touch.tangential) <= touch.largest_tangential + allowed[1]:
        return touch
    direction = 1 if touch.tangential > 0 else -1
    return replace(touch, direction=direction, tangential=direction * touch.largest_tangential)


def slipping(touch: Touch) -> Touch:
    """Return the contact with slip as it has slid since the last accepted state."""
    return replace(touch, direction=int(np.sign(slip(touch))))


def settled(touch: Touch) -> Touch:
    """Return the contact after its state was accepted: slip counts from there."""
    if touch.begin is None:
        return touch
    added = slip(touch) if touch.closed and touch.direction else 0.0
    return replace(touch, begin=touch.at, slipped=touch.slipped + added)
