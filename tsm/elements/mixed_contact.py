"""Contact law with the force as an unknown. It does not divide by a distance to a node, so it has no critical area.

The unknowns are the force F on the beam and the material position xi in [0, 1] of the contact on the element.
The contact adds to the energy of the touched element the Lagrangian ::

    L = -F . (p(xi) - x_c) - C(xi) F.F/2

    p(xi) = x_i + xi d + w(xi) perp(d) + sigma offset m(phi)
    w(xi) = xi (1 - xi) ((1 - xi) tan s_i - xi tan s_j)
    s_i, s_j = end slopes of the centre line from the chord d, the rotations plus the shear strain
    phi = slope angle of the loaded centre line at xi, m its left normal
    sigma = -side: -1 for a node from the right (side 1), +1 for one from the left (side -1)
    C(xi) = l0^3/(3 EI (1 + Phi)) (z^3 + Phi/4 z^2 + Phi (1 + Phi)/4 z),  z = xi (1 - xi)

p is a point of the centre line or surface, without the deflection ``C F`` by the contact force itself. Three
conditions hold where L is stationary:

- the node lies on the deflected centre line, ``p + C F = x_c``;
- the force is normal to the mean of the two tangents at the contact, ``F . p' + C' F.F/2 = 0``;
- the beam carries the nodal loads that are equivalent to F.

C and w vanish at both ends of the element, so a beam node is a point like any other. The functions ``tan
s_i`` and ``tan s_j`` in w make the slope continuous from element to element, up to the true shear kink.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.curve import Curve
from tsm.elements.properties import Array, Properties
from tsm.elements.varied import derivatives, plain, varied

# element displacements (6), node (2), force (2), xi  ->  dx, dy, theta_i, theta_j, F_x, F_y, xi
_REDUCE = np.zeros((7, 11))
_REDUCE[0, [0, 3]] = _REDUCE[1, [1, 4]] = -1, 1
_REDUCE[[2, 3, 4, 5, 6], [2, 5, 8, 9, 10]] = 1
"""The seven quantities of a contact from the eleven unknowns."""
# the upper triangle of a matrix over them, row by row, spread over the eleven
_PRODUCTS = np.einsum("ai,bj->abij", _REDUCE, _REDUCE).reshape(7, 7, 121)
_SPREAD = np.array([_PRODUCTS[a, b] + (a != b) * _PRODUCTS[b, a] for a in range(7) for b in range(a, 7)])
_LEVER = np.zeros((11, 11))
_LEVER[[0, 8, 1, 9], [8, 0, 9, 1]] = 1
_LEVER[[6, 8, 7, 9], [8, 6, 9, 7]] = -1
"""Second derivatives of ``F . (x_i - x_c)``."""


def response(
    p: Properties, x: Any, lever: Any, xi: Any, force: Any, side: float, offset: float
) -> tuple[Array, Array]:
    """Gradient (11,) of the Lagrangian by element, node, force and arc position, and its Hessian, see `ContactLaw`."""
    gradient, hessian = _sharp(p, x, xi, force)
    tangent = -(hessian @ _SPREAD).reshape(11, 11) - _LEVER
    if offset:
        dx, dy, theta_i, theta_j, *loads, place = varied((x[3] - x[0], x[4] - x[1], x[2], x[5], *force, xi))
        surface = _surface(p, (0.0, 0.0, theta_i, dx, dy, theta_j), place, loads)
        gradient = gradient - side * offset * plain(surface)
        tangent = tangent + _REDUCE.T @ (side * offset * derivatives(surface)) @ _REDUCE
    Fx, Fy = force
    full = -(gradient @ _REDUCE) + np.array([-Fx, -Fy, 0, 0, 0, 0, Fx, Fy, -lever[0], -lever[1], 0])
    full[10] /= p.l0
    tangent[10] /= p.l0
    tangent[:, 10] /= p.l0
    return full, tangent


def _sharp(p: Properties, x: Any, xi: Any, force: Any) -> tuple[Array, Array]:
    """Derivatives (7,) of ``F . (p - x_i) + C F.F/2`` without offset by ``dx, dy, theta_i, theta_j``, force and xi.

    The second ones (28,) are the upper triangle, row by row.
    """
    curve = Curve(p, x)
    dx, dy, (Fx, Fy) = curve.dx, curve.dy, force
    C, dC, ddC = compliance(p, xi)
    w, (wx, wy, wi, wj, ws) = curve.deflection_slope(xi)
    hxx, hxy, hxi, hxj, hxs, hyy, hyi, hyj, hys, hii, hij, his, hjj, hjs, hss = curve.deflection_bend(xi)
    a, half = Fy * dx - Fx * dy, (Fx * Fx + Fy * Fy) / 2
    gradient = np.array(
        [
            xi * Fx + a * wx + w * Fy,
            xi * Fy + a * wy - w * Fx,
            a * wi,
            a * wj,
            xi * dx - w * dy + C * Fx,
            xi * dy + w * dx + C * Fy,
            Fx * dx + Fy * dy + a * ws + dC * half,
        ]
    )
    hessian = np.array(
        [
            a * hxx + 2 * wx * Fy, a * hxy + wy * Fy - wx * Fx, a * hxi + wi * Fy, a * hxj + wj * Fy,
            xi - wx * dy, w + wx * dx, Fx + a * hxs + ws * Fy,
            a * hyy - 2 * wy * Fx, a * hyi - wi * Fx, a * hyj - wj * Fx,
            -w - wy * dy, xi + wy * dx, Fy + a * hys - ws * Fx,
            a * hii, a * hij, -wi * dy, wi * dx, a * his,
            a * hjj, -wj * dy, wj * dx, a * hjs,
            C, 0.0 * C, dx - ws * dy + dC * Fx,
            C, dy + ws * dx + dC * Fy,
            a * hss + ddC * half,
        ]
    )  # fmt: skip
    return gradient, hessian


def _surface(p: Properties, x: Any, xi: Any, force: Any) -> Array:
    """Gradient (7, ...) of ``F . m(phi + psi)``, to second order in the slope psi of the load's own dent; in the order of `_sharp`.

    `m` is the unit normal at the slope angle phi of the unloaded curve, ``psi = b F.m`` with ``b = C'/(2
    l0)``; with ``A = F.m``, ``T = F.t`` the expression is ``A - b A T - b^2 A^3/2``, whose derivative in b
    vanishes, as it must, where the force is normal to the loaded curve.
    """
    phi, by = Curve(p, x).slope_angle(xi)
    b, db = (value / (2 * p.l0) for value in compliance(p, xi)[1:])
    c, s = np.cos(phi), np.sin(phi)
    A, T = force[1] * c - force[0] * s, force[0] * c + force[1] * s
    bA = b * A
    by_phi = -T - b * (A * A - T * T) + 1.5 * bA * bA * T
    px, py, pi, pj, ps = (by_phi * part for part in by)
    # with the force: m = (-s, c), t = (c, s)
    along, across = -bA, 1 - b * T - 1.5 * bA * bA
    fx, fy = along * c - across * s, along * s + across * c
    return np.array([px, py, pi, pj, fx, fy, ps - db * A * (T + bA * A)])


def cross_compliance(p: Properties, xi: Any, eta: Any) -> tuple[Any, Any, Any]:
    """Deflection at xi by a unit force at eta, both ends clamped.

    Simply supported, less what clamping takes away: with ``x = min, b = 1 - max`` of both, ``z = xi (1 -
    xi)``, ``m = 1 - 2 xi`` (z', m' at eta)::

        C12 = l0^3/(12 EI) (2 x b (1 + Phi/2 - b^2 - x^2) - z z' (3 + m m'/(1 + Phi)))

    Returns the value, and its derivatives in xi and eta.
    """
    if np.any(np.real(xi) > np.real(eta)):
        C, d_eta, d_xi = cross_compliance(p, eta, xi)
        return C, d_xi, d_eta
    x, b, h, k = xi, 1 - eta, 1 + p.Phi / 2, 1 / (1 + p.Phi)
    z, m, ze, me = xi * (1 - xi), 1 - 2 * xi, eta * (1 - eta), 1 - 2 * eta
    scale = p.l0**3 / (12 * p.EI)
    return (
        scale * (2 * x * b * (h - b * b - x * x) - z * ze * (3 + k * m * me)),
        scale * (2 * b * (h - b * b - 3 * x * x) - ze * (3 * m + k * me * (m * m - 2 * z))),
        scale * (-2 * x * (h - 3 * b * b - x * x) - z * (3 * me + k * m * (me * me - 2 * ze))),
    )


def energy(p: Properties, x: Any, _lever: Any, xi: Any, force: Any, side: float, offset: float) -> float:
    """Value of the Lagrangian where it is stationary in F, the contribution of the contact to the strain energy.

    It is ``L - F . dL/dF``. Arguments as for `response`.
    """
    Fx, Fy = force
    C, dC, _ = compliance(p, xi)
    value = C * (Fx * Fx + Fy * Fy) / 2
    if offset:
        phi, _ = Curve(p, x).slope_angle(xi)
        A, T = Fy * np.cos(phi) - Fx * np.sin(phi), Fx * np.cos(phi) + Fy * np.sin(phi)
        bA = dC / (2 * p.l0) * A
        value -= side * offset * bA * (T + bA * A)
    return float(value)


def compliance(p: Properties, xi: Any) -> tuple[Any, Any, Any]:
    """Deflection at xi by a unit force there, both ends clamped, and its two derivatives in xi."""
    scale = p.l0**3 / (3 * p.EI * (1 + p.Phi))
    z, dz = xi * (1 - xi), 1 - 2 * xi
    linear, square = p.Phi * (1 + p.Phi) / 4, p.Phi / 4
    slope, bend = 3 * z * z + 2 * square * z + linear, 6 * z + 2 * square
    return (
        scale * z * (z * z + square * z + linear),
        scale * slope * dz,
        scale * (bend * dz * dz - 2 * slope),
    )
