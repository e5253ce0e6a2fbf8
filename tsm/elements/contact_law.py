"""Contact laws: force, tangent and energy of a contact inside an element in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tsm.elements.properties import Array, Properties

Vector = tuple[Any, Any]


class Here(NamedTuple):
    """What a contact sees of its beam, in numbers or in arrays with complex steps."""

    arc: Any  # arc position on the beam
    tangent: Vector  # mean tangent T, per undeformed length
    shear: (
        Any  # psi, the angle from the section's normal to T; this and what follows matter with friction only
    )
    direction: Any  # phi, the angle of T
    turn: Any  # mean theta', per undeformed length


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """A contact law.

    Every function takes the constants `Properties` of the touched element first. ``x`` are the element's six
    displacements, ``lever = x_i - x_c`` the vector from the contacting node to the element's end i, ``xi`` in
    [0, 1] the position on the element, ``force`` the force on the beam, ``side`` +1 where the node comes from
    the right and -1 from the left, ``offset`` the distance of the contact surface from the axis.
    """

    # ``(p, x, lever, xi, force, side, offset) -> (gradient, tangent)`` over element (6), node (2) and the
    # contact's unknowns. The tangent is the derivative of the gradient. A law with unknowns adds both to
    # the beam's; a law without unknowns replaces the beam's
    response: Callable[[Properties, Any, Any, Any, Any, float, float], tuple[Array, Array]]
    # ``(p, x, lever, xi, force, side, offset) -> float``: contribution of the contact to the strain energy
    # in equilibrium
    energy: Callable[[Properties, Any, Any, Any, Any, float, float], float]
    # ``(p, xi, eta) -> (6,)``: deflection of the element at xi by a unit force at eta, and its derivatives as `crossing` takes
    # them, of a law whose force and arc position are unknowns; None if the force follows from the displacements
    cross: Callable[[Properties, Any, Any], tuple[Any, ...]] | None = None
    friction: Friction | None = None  # the same law with friction; None if the law has none

    @property
    def unknowns(self) -> int:
        """Unknowns of a closed contact: force (2) and arc position, or none."""
        return 3 if self.cross else 0


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Coulomb friction in a contact law whose force and arc position are unknowns."""

    # ``(p, x, xi, force, lever, start) -> loaded``: the element, whose end i has the arc position `start`, under a force on its
    # face; `loaded` has ``here``, ``force`` and ``energy``, all with complex steps
    load: Callable[[Properties, Any, Any, Vector, float, float], Any]
    # ``(loaded, lever, rows, l0) -> (residual, tangent)`` as `ContactLaw.response`, without a symmetric tangent
    response: Callable[[Any, Vector, tuple[Any, Any, Any], float], tuple[Array, Array]]
    # ``(value, l0) -> (7,)``: derivatives of what has complex steps by chord (2), end rotations (2), force (2) and arc position
    slip: Callable[[Any, float], Array]


def crossing(
    cross: tuple[Any, ...],
    l0: float,
    forces: tuple[Any, Any],
    slips: tuple[tuple[float, float], tuple[float, float]],
) -> tuple[Array, Array]:
    """Coupling of two contacts on one element, over force (2) and arc position of both: each dents it at the other.

    ``cross``: deflection at the first by a unit force at the second, derivatives in both positions, and the
    second ones. ``slips``: sign of the third row and lean c of the force. Without friction (-1, 0), it is the
    gradient and Hessian of ``-C F_1 . F_2``. In slip (1, c) the row has the slope of the other contact's dent
    across the leaning force ``F' = (F_x - c F_y, F_y + c F_x)``; in stick (0, 0) it has none. The couples on
    a face do not dent the element at the other contact here, and the force along the beam dents it as if it
    were across.
    """
    C, dx, de, dxx, dxe, dee = cross
    slope, bend = (dx / l0, de / l0), ((dxx, dxe), (dxe, dee))
    residual, tangent = np.zeros(6), np.zeros((6, 6))
    for own, other in ((0, 1), (1, 0)):
        row, column, (way, c) = 3 * own, 3 * other, slips[own]
        (Fx, Fy), (Gx, Gy) = forces[own], forces[other]
        dot = (Fx - c * Fy) * Gx + (Fy + c * Fx) * Gy
        residual[row : row + 3] = -C * Gx, -C * Gy, way * slope[own] * dot
        tangent[[row, row + 1], [column, column + 1]] = -C
        for k in range(2):
            tangent[row : row + 3, 3 * k + 2] = (
                -slope[k] * Gx,
                -slope[k] * Gy,
                way * bend[own][k] * dot / l0**2,
            )
        steep = way * slope[own]
        tangent[row + 2, row : row + 2] = steep * (Gx + c * Gy), steep * (Gy - c * Gx)
        tangent[row + 2, column : column + 2] = steep * (Fx - c * Fy), steep * (Fy + c * Fx)
    return residual, tangent
