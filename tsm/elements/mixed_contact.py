"""Contact with the force as an unknown: no division by a distance to a node, so no critical area.

A contact adds to the energy of the touched element, with the unknown force F on the beam and the unknown
material position xi in [0, 1] of the contact on the element, the Lagrangian ::

    L = -F . (p(xi) - x_c) - C(xi) F.F/2

    p(xi) = x_i + xi d + w(xi) perp(d) + sigma offset m(phi)
    w(xi) = xi (1 - xi) ((1 - xi) tan s_i - xi tan s_j)
    s_i, s_j = end slopes of the centre line from the chord d, the rotations less the shear strain
    phi = slope angle of the loaded centre line at xi, m its normal, sigma = +-1 the side of the surface
    C(xi) = l0^3/(3 EI (1 + Phi)) (z^3 + Phi/4 z^2 + Phi (1 + Phi)/4 z),  z = xi (1 - xi)

Its stationarity says: the point lies on the deflected centre line (or surface), ``p + C F = x_c``; the force is
normal to the mean of the two tangents at the contact, ``F . p' + C' F.F/2 = 0``; and the beam carries the load
that is equivalent to F. `C` and `w` vanish at both ends, so a node of the beam is a point like any other. The
tangents of `s_i` make the curve continuous in slope from element to element (up to the true shear kink).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.curve import Curve
from tsm.elements.properties import Array, Properties

# element displacements (6), node (2), force (2), xi  ->  dx, dy, theta_i, theta_j, F_x, F_y, xi
_REDUCE = np.zeros((7, 11))
_REDUCE[0, [0, 3]] = _REDUCE[1, [1, 4]] = -1, 1
_REDUCE[[2, 3, 4, 5, 6], [2, 5, 8, 9, 10]] = 1
# second derivatives of a = F . perp(d) and of F . (x_i - x_c)
_HESSIAN_A = np.zeros((7, 7))
_HESSIAN_A[[0, 5], [5, 0]] = 1
_HESSIAN_A[[1, 4], [4, 1]] = -1
_HESSIAN_LEVER = np.zeros((11, 11))
_HESSIAN_LEVER[[0, 8, 1, 9], [8, 0, 9, 1]] = 1
_HESSIAN_LEVER[[6, 8, 7, 9], [8, 6, 9, 7]] = -1


UNKNOWNS = 3


def response(
    p: Properties, x: Any, lever: Any, xi: Any, force: Any, side: float, offset: float
) -> tuple[Array, Array]:
    """Gradient and Hessian of the contact's Lagrangian.

    Parameters
    ----------
    p : Properties
        Constants of the touched element.
    x : sequence of 6 numbers
        Its displacements.
    lever : sequence of 2 numbers
        ``x_i - x_c``, from the contacting node to the element's end i.
    xi : number
        Material position on the element.
    force : sequence of 2 numbers
        Force on the beam.
    side : float
        +1 where the node comes from the right, -1 from the left.
    offset : float
        Distance of the contact surface from the axis.

    Returns
    -------
    gradient : ndarray, shape (11,)
        With respect to element (6), node (2), force (2) and arc position ``xi l0``.
    tangent : ndarray, shape (11, 11)
        Its derivative, symmetric.
    """
    curve = Curve(p, x)
    dx, dy, (Fx, Fy) = curve.dx, curve.dy, force
    C, dC, ddC, dddC = compliance(p, xi)
    w, w_gradient, w_hessian = curve.deflection(xi)
    a = Fy * dx - Fx * dy
    a_gradient = np.array([Fy, -Fx, 0, 0, -dy, dx, 0])

    gradient = w * a_gradient + a * w_gradient
    gradient += np.array([xi * Fx, xi * Fy, 0, 0, xi * dx + C * Fx, xi * dy + C * Fy, 0])
    gradient[6] += Fx * dx + Fy * dy + dC * (Fx * Fx + Fy * Fy) / 2

    cross = np.outer(w_gradient, a_gradient)
    hessian = a * w_hessian + cross + cross.T + w * _HESSIAN_A
    hessian[[0, 1, 4, 5], [4, 5, 0, 1]] += xi
    hessian[[4, 5], [4, 5]] += C
    hessian[6, :6] += np.array([Fx, Fy, 0, 0, dx + dC * Fx, dy + dC * Fy])
    hessian[:6, 6] = hessian[6, :6]
    hessian[6, 6] += ddC * (Fx * Fx + Fy * Fy) / 2
    if offset:
        on_surface = _surface(curve, xi, force, (dC, ddC, dddC), p.l0)
        gradient -= side * offset * on_surface[0]
        hessian -= side * offset * on_surface[1]

    full = gradient @ _REDUCE
    full[:2] += force
    full[6:8] -= force
    full[8:10] += lever
    tangent = _REDUCE.T @ hessian @ _REDUCE + _HESSIAN_LEVER
    full[10] /= p.l0
    tangent[10] /= p.l0
    tangent[:, 10] /= p.l0
    return -full, -tangent


def _surface(curve: Curve, xi: Any, force: Any, dC: tuple[Any, Any, Any], l0: Any) -> tuple[Array, Array]:
    """Gradient and Hessian of ``F . m(phi + b F.m(phi))``, to first order in the slope ``b F.m`` of the load's own dent.

    `m` is the unit normal at the slope angle phi of the unloaded curve and ``b = C'/(2 l0)``, the rotation
    at a unit force; ``A = F.m``, ``T = F.(tangent)``, so that the expression is ``A - b A T``.
    """
    phi, phi_gradient, phi_hessian = curve.slope_angle(xi)
    b, db, ddb = (value / (2 * l0) for value in dC)
    c, s = np.cos(phi), np.sin(phi)
    Fx, Fy = force
    A, T = Fy * c - Fx * s, Fx * c + Fy * s
    normal = np.array([0, 0, 0, 0, -s, c, 0])
    tangent = np.array([0, 0, 0, 0, c, s, 0])
    slide = np.array([0, 0, 0, 0, 0, 0, 1.0])

    by_phi = -T - b * (A * A - T * T)
    by_force = normal - b * (T * normal + A * tangent)
    gradient = by_phi * phi_gradient + by_force - db * A * T * slide

    mixed = -tangent - 2 * b * (A * normal - T * tangent) - db * (A * A - T * T) * slide
    slid = -db * (T * normal + A * tangent)
    upper = (
        np.outer(phi_gradient, mixed)
        + np.outer(slid, slide)
        - b * np.outer(tangent, normal)
        - ddb * A * T / 2 * np.outer(slide, slide)
    )
    hessian = (
        (-A + 4 * b * A * T) * np.outer(phi_gradient, phi_gradient) + by_phi * phi_hessian + upper + upper.T
    )
    return gradient, hessian


def compliance(p: Properties, xi: Any) -> tuple[Any, Any, Any, Any]:
    """Deflection at xi by a unit force there, both ends clamped, and its three derivatives in xi."""
    scale = p.l0**3 / (3 * p.EI * (1 + p.Phi))
    z, dz = xi * (1 - xi), 1 - 2 * xi
    linear, square = p.Phi * (1 + p.Phi) / 4, p.Phi / 4
    slope, bend = 3 * z * z + 2 * square * z + linear, 6 * z + 2 * square
    return (
        scale * z * (z * z + square * z + linear),
        scale * slope * dz,
        scale * (bend * dz * dz - 2 * slope),
        scale * 6 * dz * (dz * dz - bend),
    )
