"""Contact laws: force, tangent and energy of a contact inside an element in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tsm.elements.properties import Array, Properties
from tsm.elements.varied import derivatives, plain, varied

Vector = tuple[Any, Any]


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
    # ``(p, xi, eta) -> (3,)``: deflection of the element at xi by a unit force at eta, and its derivatives in both, of a law
    # whose force and arc position are unknowns; None if the force follows from the displacements
    cross: Callable[[Properties, Any, Any], tuple[Any, Any, Any]] | None = None

    @property
    def unknowns(self) -> int:
        """Unknowns of a closed contact: force (2) and arc position, or none."""
        return 3 if self.cross else 0


def crossing(
    law: ContactLaw, p: Properties, places: tuple[float, float], forces: tuple[Vector, Vector]
) -> tuple[Array, Array]:
    """Coupling of two contacts on one element: gradient and Hessian of ``-C F_1 . F_2`` over force (2) and arc position of both."""
    assert law.cross is not None, "the law has unknowns"
    Fx, Fy, xi, Gx, Gy, eta = varied((*forces[0], places[0], *forces[1], places[1]))
    C, *slopes = law.cross(p, xi, eta)
    one, other = ((Fx * Gx + Fy * Gy) * slope / p.l0 for slope in slopes)
    gradient = -np.array([C * Gx, C * Gy, one, C * Fx, C * Fy, other])
    hessian = derivatives(gradient)
    hessian[:, 2::3] /= p.l0
    return plain(gradient), hessian
