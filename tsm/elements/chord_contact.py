"""The contact elements of the paper, in which the contact force is a stiffness times a deflection and normal to the chord.

The basic system is simply supported on the chord, with the element edge forces ``S = [N, M_i, M_j, Y_c]`` ([P] (3)). The contact point
has the distances a and b from the ends, measured on the chord as parts of l0. The nodal forces are ``U = J S``, with J the transposed
derivative of the basic deformations. The tangent is ``J (dS/dv) J^T + dJ S + J (dS/da) da``. [P] does not state its last part, which
makes Newton's method quadratic while the node slides. The tangent is not symmetric.

The stiffness has powers of a and b in its denominators. The paper calls the loss of accuracy beside a node the critical area. The other
basic system is in `cantilever`, the matrices with the paper's misprints are in `as_printed`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tsm.elements.contact_law import ContactLaw
from tsm.elements.properties import Array, Properties, chord_rotation, unwind

Stiffness = Callable[[Properties, Any], tuple[Array, Array]]
"""Matrix of a basic system and its derivative in a, at a given ``xi = a/l0``."""

ElementForce = Callable[[Properties, Any, Array], tuple[Array, Array, Array]]
"""Element force equation: from ``xi`` and ``v = [theta_i, theta_j, y_c]`` to ``S = [M_i, M_j, Y_c]``, dS/dv, dS/da."""

INSIDE = 1e-15
"""Least distance of a contact point from the ends of the element, over its length: at the ends K is infinite."""

# element displacements (6), node (2)  ->  r = x_c - x_i, chord d, theta_i, theta_j
_REDUCE = np.zeros((6, 8))
_REDUCE[0, [0, 6]] = _REDUCE[1, [1, 7]] = -1, 1
_REDUCE[2, [0, 3]] = _REDUCE[3, [1, 4]] = -1, 1
_REDUCE[4, 2] = _REDUCE[5, 5] = 1


def response(
    element_force: ElementForce, p: Properties, x: Any, lever: Any, side: float, offset: float
) -> tuple[Array, Array]:
    """Forces and exact tangent of an element together with the node that touches it.

    ``lever``: ``x_i - x_c``, from the contacting node to the element's end i. ``side``: +1 where the node
    comes from the right, -1 from the left. ``offset``: distance of the contact surface from the axis. Returns
    ``force`` (8,), on the element (6) and the node (2); ``tangent`` (8, 8), its derivative.
    """
    (dx, dy), (rx, ry) = (p.dx0 + (x[3] - x[0]), p.dy0 + (x[4] - x[1])), (-lever[0], -lever[1])
    length = np.sqrt(dx * dx + dy * dy)
    t = np.array([dx, dy]) / length
    n = np.array([-t[1], t[0]])
    turn = chord_rotation(p.dx0 * dy - p.dy0 * dx, p.dx0 * dx + p.dy0 * dy)
    y = n[0] * rx + n[1] * ry
    xi = (dx * rx + dy * ry) / (dx * dx + dy * dy)
    if not INSIDE <= xi.real <= 1 - INSIDE:
        xi = min(max(xi.real, INSIDE), 1 - INSIDE)
    du, dv = x[3] - x[0], x[4] - x[1]
    elongation = (2 * (p.dx0 * du + p.dy0 * dv) + du * du + dv * dv) / (length + p.l0)
    deformation = np.array([unwind(x[2] - turn), unwind(x[5] - turn), y + side * offset])
    S, K, slope = element_force(p, xi, deformation)
    N = p.EA / p.l0 * elongation

    B = np.zeros((3, 6), dtype=S.dtype)
    B[:2, 2:4] = -n / length
    B[0, 4] = B[1, 5] = 1
    B[2, :2], B[2, 2:4] = n, -xi * n
    stretch = np.zeros(6, dtype=S.dtype)
    stretch[2:4] = t
    slide = np.zeros(6, dtype=S.dtype)
    slide[:2], slide[2:4] = t / length, (y * n - xi * length * t) / length**2

    nn, tn = np.outer(n, n), np.outer(t, n)
    tn = tn + tn.T
    geometric = np.zeros((6, 6), dtype=S.dtype)
    geometric[2:4, 2:4] = (
        N / length * nn + (S[0] + S[1]) / length**2 * tn + S[2] * (xi * tn / length - y * nn / length**2)
    )
    geometric[:2, 2:4] = -S[2] / length * np.outer(t, n)
    geometric[2:4, :2] = geometric[:2, 2:4].T

    force = N * stretch + S @ B
    tangent = p.EA / p.l0 * np.outer(stretch, stretch) + B.T @ K @ B + geometric
    tangent += np.outer(slope @ B, p.l0 * slide)
    return force @ _REDUCE, _REDUCE.T @ tangent @ _REDUCE


def law(element_force: ElementForce) -> ContactLaw:
    """Contact law of an element force equation: the force is normal to the chord and follows from the displacements."""

    def respond(
        p: Properties, x: Any, lever: Any, _xi: Any, _force: Any, side: float, offset: float
    ) -> tuple[Array, Array]:
        try:
            with np.errstate(all="ignore"):
                return response(element_force, p, x, lever, side, offset)
        except ArithmeticError:
            # plain numbers raise where arrays overflow or divide by zero
            return np.full(8, np.nan), np.full((8, 8), np.nan)

    def energy(p: Properties, x: Any, lever: Any, xi: Any, force: Any, side: float, offset: float) -> float:
        """Energy of the spring between node and element, ``(F.F)^2/(2 F.K F)``."""
        gradient, tangent = respond(p, x, lever, xi, force, side, offset)
        F = gradient[6:8]
        return float(F @ F) ** 2 / (2 * float(F @ tangent[6:8, 6:8] @ F) or 1.0)

    return ContactLaw(response=respond, energy=energy)


def simply_supported(stiffness: Stiffness) -> ElementForce:
    """Element force equation of a matrix over ``[theta_i, theta_j, y_c]``."""

    def element_force(p: Properties, xi: Any, deformation: Array) -> tuple[Array, Array, Array]:
        K, dK = stiffness(p, xi)
        return K @ deformation, K, dK @ deformation

    return element_force


def euler_bernoulli(p: Properties, xi: Any) -> tuple[Array, Array]:
    """Matrix of [P] (5)-(6), corrected, over ``[theta_i, theta_j, y_c]`` and its derivative in a.

    `timoshenko` at ``Psi = 0``; ``M_i-theta_j`` is ``-EI/l0``. The shear number of the element is not read.
    """
    l0, k = p.l0, p.EI / p.l0
    a, b = xi * l0, (1 - xi) * l0
    iy, jy = l0 * l0 / (a * a * b), l0 * l0 / (a * b * b)
    K = np.array(
        [
            [4 + 3 * b / a, -1, -3 * iy],
            [-1, 4 + 3 * a / b, 3 * jy],
            [-3 * iy, 3 * jy, 3 * iy * jy],
        ]
    )
    diy, djy = iy * (1 / b - 2 / a), jy * (2 / b - 1 / a)
    dK = np.array(
        [
            [-3 * l0 / (a * a), 0, -3 * diy],
            [0, 3 * l0 / (b * b), 3 * djy],
            [-3 * diy, 3 * djy, 3 * (diy * jy + iy * djy)],
        ]
    )
    return k * K, k * dK


def timoshenko(p: Properties, xi: Any) -> tuple[Array, Array]:
    """Matrix of [P] (9)-(12), corrected, over ``[theta_i, theta_j, y_c]`` and its derivative in a.

    ``M_i-theta_j`` is ``(9 Psi (l0^2 - ab) - Omega) k_c``; as printed it mixes dimensions. ``Psi = 0`` gives the
    Euler-Bernoulli element (5)-(6).
    """
    l0, EI = p.l0, p.EI
    Psi = p.Phi * l0 * l0 / 12
    a, b = xi * l0, (1 - xi) * l0
    z, dz = a * b, b - a
    omega = z * z + 3 * Psi * (l0 * l0 + z) + 36 * Psi * Psi
    kc = EI / (l0 * omega)
    dkc = -kc / omega * (2 * z + 3 * Psi) * dz
    dOmega = (2 * z + 3 * Psi) * dz
    square = 108 * Psi * Psi
    yy = 3 * l0 * l0 * (l0 * l0 + 12 * Psi)
    N = np.array(
        [
            [
                4 * omega + 3 * z * b * b - square,
                9 * Psi * (l0 * l0 - z) - omega,
                -3 * l0 * (b * l0 + 6 * Psi),
            ],
            [
                9 * Psi * (l0 * l0 - z) - omega,
                4 * omega + 3 * z * a * a - square,
                3 * l0 * (a * l0 + 6 * Psi),
            ],
            [-3 * l0 * (b * l0 + 6 * Psi), 3 * l0 * (a * l0 + 6 * Psi), yy / z],
        ]
    )
    dij = -9 * Psi * dz - dOmega
    dN = np.array(
        [
            [4 * dOmega + 3 * b * b * (dz - 2 * a), dij, 3 * l0 * l0],
            [dij, 4 * dOmega + 3 * a * a * (dz + 2 * b), 3 * l0 * l0],
            [3 * l0 * l0, 3 * l0 * l0, -yy / (z * z) * dz],
        ]
    )
    return kc * N, dkc * N + kc * dN
