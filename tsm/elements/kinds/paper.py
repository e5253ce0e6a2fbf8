"""The elements of the paper, corrected and as printed. Their contact force is a stiffness times a deflection and normal to the chord.

The basic system is simply supported on the chord, with the element edge forces ``S = [N, M_i, M_j, Y_c]``
([P] (3)). The contact point has the distances a and b from the ends, measured on the chord as parts of l0.
The nodal forces are ``U = J S``, with J the transposed derivative of the basic deformations. The tangent is
``J (dS/dv) J^T + dJ S + J (dS/da) da``. [P] does not state its last part, which makes Newton's method
quadratic while the node slides. The tangent is not symmetric.

The stiffness has powers of a and b in its denominators. The paper calls the loss of accuracy beside a node
the critical area.

The second element has another basic system, a cantilever clamped at end i. Its frame has x along the tangent
at end i and y across it. The element edge forces ``[Y_j, Y_c, M_j]`` belong to the deflections y_j of end j
and y_c of the contact point and to the rotation of end j, all measured from the tangent at end i ([P] (7),
Fig. 4). [P] prints no J. To first order in the rotations, this frame is the frame of the chord turned by
theta_i, so that ::

    [y_j, y_c, theta_j]_cantilever = T [theta_i, theta_j, y_c]_chord,    T = [[-l0, 0, 0], [-a, 0, 1], [-1, 1, 0]]

and ``S = T^T K T v``. In exact arithmetic this is the element of [P] (5); only the round-off differs.
Transformation and stiffness are therefore applied one after the other, as the basic system states them, and
not multiplied out.

The matrices as printed are to see what their misprints do, see tsm/elements/errata.md. Each is the corrected
matrix except for the misprinted entries, which mix dimensions: what these elements do depends on the unit of
length. Lengths on the chord are measured as in the corrected elements, as parts of l0, so that the misprints
are the only difference.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tsm.elements.beam import linear_coefficients
from tsm.elements.contact_law import ContactLaw
from tsm.elements.element_type import ClosedForm
from tsm.elements.properties import Array, Properties, from_chord
from tsm.elements.varied import STEP, derivatives, plain, varied

Matrix = Callable[[Properties, Any], Array]
"""Matrix at a given ``xi = a/l0``: the stiffness of a basic system, or T."""

ElementForce = Callable[[Properties, Any, Array], tuple[Array, Array, Array]]
"""Element force equation: from ``xi`` and ``v = [theta_i, theta_j, y_c]`` to ``S = [M_i, M_j, Y_c]``, dS/dv, dS/da."""

INSIDE = 1e-15
"""Least distance of a contact point from the ends of the element, over its length: at the ends K is infinite."""

# element displacements (6), node (2)  ->  r = x_c - x_i, chord d, theta_i, theta_j
_REDUCE = np.zeros((6, 8))
_REDUCE[0, [0, 6]] = _REDUCE[1, [1, 7]] = -1, 1
_REDUCE[2, [0, 3]] = _REDUCE[3, [1, 4]] = -1, 1
_REDUCE[4, 2] = _REDUCE[5, 5] = 1


def euler_bernoulli(p: Properties, xi: Any) -> Array:
    """Matrix of [P] (5)-(6), corrected, over ``[theta_i, theta_j, y_c]``.

    `timoshenko` at ``Psi = 0``; ``M_i-theta_j`` is ``-EI/l0``. The shear number of the element is not read.
    """
    l0, k = p.l0, p.EI / p.l0
    a, b = xi * l0, (1 - xi) * l0
    iy, jy = l0 * l0 / (a * a * b), l0 * l0 / (a * b * b)
    return k * np.array(
        [
            [4 + 3 * b / a, -1, -3 * iy],
            [-1, 4 + 3 * a / b, 3 * jy],
            [-3 * iy, 3 * jy, 3 * iy * jy],
        ]
    )


def timoshenko(p: Properties, xi: Any) -> Array:
    """Matrix of [P] (9)-(12), corrected, over ``[theta_i, theta_j, y_c]``.

    ``M_i-theta_j`` is ``(9 Psi (l0^2 - ab) - Omega) k_c``; as printed it mixes dimensions. ``Psi = 0`` gives
    the Euler-Bernoulli element (5)-(6).
    """
    l0 = p.l0
    Psi = p.Phi * l0 * l0 / 12
    a, b = xi * l0, (1 - xi) * l0
    z, square = a * b, 108 * Psi * Psi
    omega = _omega(p, xi)
    kc = p.EI / (l0 * omega)
    ij = 9 * Psi * (l0 * l0 - z) - omega
    iy, jy = -3 * l0 * (b * l0 + 6 * Psi), 3 * l0 * (a * l0 + 6 * Psi)
    return kc * np.array(
        [
            [4 * omega + 3 * z * b * b - square, ij, iy],
            [ij, 4 * omega + 3 * z * a * a - square, jy],
            [iy, jy, 3 * l0 * l0 * (l0 * l0 + 12 * Psi) / z],
        ]
    )


def _omega(p: Properties, xi: Any) -> Any:
    Psi, z = p.Phi * p.l0 * p.l0 / 12, xi * p.l0 * ((1 - xi) * p.l0)
    return z * z + 3 * Psi * (p.l0 * p.l0 + z) + 36 * Psi * Psi


def cantilever(p: Properties, xi: Any) -> Array:
    """Matrix of [P] (7)-(8), corrected, over ``[y_j, y_c, theta_j]``.

    The brackets of [P] (7) times ``k_b = 3 EI/(l a^3 b^3)``, with ``-a^2 l (a + 3b)`` for Y_j-y_c and
    ``+a^2 b l^2`` for Y_c-theta_j. The shear number of the element is not read.
    """
    l0, k = p.l0, 3 * p.EI
    a, b = xi * l0, (1 - xi) * l0
    jc = -(a + 3 * b) / (a * b**3)
    jt = -(a + 2 * b) / (l0 * b * b)
    ct = l0 / (a * b * b)
    return k * np.array(
        [
            [(a + 4 * b) / (l0 * b**3), jc, jt],
            [jc, l0**3 / (a * b) ** 3, ct],
            [jt, ct, (3 * a + 4 * b) / (3 * l0 * b)],
        ]
    )


def transformation(p: Properties, xi: Any) -> Array:
    """Matrix T that takes the deformations of the beam simply supported on the chord to the deformations of the cantilever."""
    return np.array([[-p.l0, 0, 0], [-xi * p.l0, 0, 1], [-1, 1, 0]])


def euler_bernoulli_as_printed(p: Properties, xi: Any) -> Array:
    """Matrix of [P] (5)-(6): ``(9 l0^2 - a^2 b^2)/(a^2 b^2) k_a`` for M_i-theta_j."""
    K, l0, a, b = euler_bernoulli(p, xi), p.l0, xi * p.l0, (1 - xi) * p.l0
    K[0, 1] = K[1, 0] = (9 * l0 * l0 / (a * b) ** 2 - 1) * p.EI / l0
    return K


def cantilever_as_printed(p: Properties, xi: Any) -> Array:
    """Matrix of [P] (7)-(8): ``k_b = 3 EI/(a^3 b^3)``, ``-a^2 b`` for Y_c-theta_j.

    Without the ``1/l`` that k_b lacks, Y_j-y_c is right as printed, Y_c-theta_j has the wrong sign and lacks
    a length, and the others have a length too much.
    """
    misprint = [[p.l0, 1, p.l0], [1, p.l0, -1 / p.l0], [p.l0, -1 / p.l0, p.l0]]
    return np.array(misprint) * cantilever(p, xi)


def timoshenko_as_printed(p: Properties, xi: Any) -> Array:
    """Matrix of [P] (9)-(12): ``(9 (l0^2 - b Psi) - Omega) k_c`` for M_i-theta_j."""
    K, l0, omega = timoshenko(p, xi), p.l0, _omega(p, xi)
    printed = 9 * (l0 * l0 - (1 - xi) * l0 * p.Phi * l0 * l0 / 12)
    K[0, 1] = K[1, 0] = (printed - omega) * p.EI / (l0 * omega)
    return K


def force_equation(stiffness: Matrix, basis: Matrix | None = None) -> ElementForce:
    """Element force equation of a stiffness, over other deformations than v where there is a `basis` T."""

    def at(p: Properties, xi: Any, v: Array) -> tuple[Array, Array]:
        K = stiffness(p, xi)
        if basis is None:
            return K @ v, K
        T = basis(p, xi)
        return (K @ (T @ v)) @ T, T.T @ K @ T

    def element_force(p: Properties, xi: Any, v: Array) -> tuple[Array, Array, Array]:
        along, _ = at(p, xi.real + 1j * STEP, v.real)
        return *at(p, xi, v), along.imag / (STEP * p.l0)

    return element_force


def response(
    element_force: ElementForce, p: Properties, x: Any, lever: Any, side: float, offset: float
) -> tuple[Array, Array]:
    """Forces (8,) on an element (6) and the node (2) that touches it, and their exact tangent, see `ContactLaw`."""
    moved = (-lever[0], -lever[1], x[3] - x[0], x[4] - x[1], x[2], x[5])
    rx, ry, du, dv, theta_i, theta_j = varied(moved)
    dx, dy, *turned = from_chord(p, (0.0, 0.0, theta_i, du, dv, theta_j))
    square = dx * dx + dy * dy
    length = np.sqrt(square)
    tx, ty, xi = dx / length, dy / length, (dx * rx + dy * ry) / square
    if not INSIDE <= xi[-1].real <= 1 - INSIDE:
        xi = np.clip(xi.real, INSIDE, 1 - INSIDE) + 1j * xi.imag
    v = np.array([*turned, tx * ry - ty * rx + side * offset])
    S, K, slope = element_force(p, plain(xi), plain(v))
    steps = S.real[:, None] + 1j * (K.real @ v.imag + np.outer(p.l0 * slope, xi.imag))
    steps[:, -1] = S
    M_i, M_j, Y = steps
    N = p.EA / p.l0 * (2 * (p.dx0 * du + p.dy0 * dv) + du * du + dv * dv) / (length + p.l0)
    across = (M_i + M_j) / length + Y * xi
    forces = np.array([-Y * ty, Y * tx, N * tx + across * ty, N * ty - across * tx, M_i, M_j])
    return plain(forces) @ _REDUCE, _REDUCE.T @ derivatives(forces) @ _REDUCE


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


def _both(
    name: str,
    where: str,
    misprints: str,
    *matrices: Matrix,
    basis: Matrix | None = None,
    marker: str,
    **more: Any,
) -> tuple[ClosedForm, ClosedForm]:
    """The element with the first matrix, corrected, and with the second one, as printed."""
    shared = {"coefficients": linear_coefficients, **more}
    laws = (law(force_equation(stiffness, basis)) for stiffness in matrices)
    one = ClosedForm(name=name, source=f"{where}, corrected", contact=next(laws), marker=marker, **shared)
    source = f"{where} with its {misprints}"
    other = ClosedForm(name=f"{name}-as-printed", source=source, contact=next(laws), variant=True, **shared)
    return one, other


TIMOSHENKO, _TIMOSHENKO = _both(
    "timoshenko", "[P] (9)-(12)", "misprints", timoshenko, timoshenko_as_printed, colour="#0072B2", marker="^"
)
EULER_BERNOULLI_SIMPLE, _SIMPLE = _both(
    "euler-bernoulli-simple", "[P] (5)-(6)", "misprint", euler_bernoulli, euler_bernoulli_as_printed,
    sheared=False, colour="#D55E00", marker="o",
)  # fmt: skip
EULER_BERNOULLI_CANTILEVER, _CANTILEVER = _both(
    "euler-bernoulli-cantilever", "[P] (7)-(8)", "misprints", cantilever, cantilever_as_printed,
    basis=transformation, sheared=False, colour="#E69F00", marker="s",
)  # fmt: skip
PAPER = (TIMOSHENKO, EULER_BERNOULLI_SIMPLE, EULER_BERNOULLI_CANTILEVER)

ELEMENTS = (*PAPER, _TIMOSHENKO, _SIMPLE, _CANTILEVER)
