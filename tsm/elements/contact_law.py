"""Contact laws: force, tangent and energy of a contact inside an element in closed form, for one structure and for many."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tsm.elements.properties import Array, Properties

UPPER = [(a, b) for a in range(7) for b in range(a, 7)]
"""The 28 entries of the upper triangle of a matrix over ``dx, dy, theta_i, theta_j, F_x, F_y, xi``, row by row."""


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """A contact law.

    Every function takes the constants `Properties` of the touched element first. ``x`` are the element's six displacements,
    ``lever = x_i - x_c`` the vector from the contacting node to the element's end i, ``xi`` in [0, 1] the position on the element,
    ``force`` the force on the beam, ``side`` +1 where the node comes from the right and -1 from the left, ``offset`` the distance of the
    contact surface from the axis.

    Attributes
    ----------
    response : callable
        ``(p, x, lever, xi, force, side, offset) -> (gradient, tangent)`` over element (6), node (2) and the contact's unknowns. The
        tangent is the derivative of the gradient. A law with unknowns adds both to the beam's; a law without unknowns replaces the beam's.
    energy : callable
        ``(p, x, lever, xi, force, side, offset) -> float``: contribution of the contact to the strain energy in equilibrium.
    coupling : Coupling or None
        Further functions of a law whose force and arc position are unknowns; None if the force follows from the displacements.
    """

    response: Callable[[Properties, Any, Any, Any, Any, float, float], tuple[Array, Array]]
    energy: Callable[[Properties, Any, Any, Any, Any, float, float], float]
    coupling: Coupling | None = None

    @property
    def unknowns(self) -> int:
        """Unknowns of a closed contact: force (2) and arc position, or none."""
        return 3 if self.coupling else 0


@dataclass(frozen=True, kw_only=True)
class Coupling:
    """A contact law with unknowns, for many contacts at a time and for two contacts on one element.

    Attributes
    ----------
    jet : callable
        ``(p, x, xi, force, side, offset) -> (gradient, hessian)`` of the same law for many contacts, of shapes (7, m) over ``dx, dy,
        theta_i, theta_j, F_x, F_y, xi`` and (28, m), `UPPER`. See `mixed_contact.jet`.
    dent : callable
        ``(p, xi, eta) -> number``: deflection of the element at xi by a unit force at eta.
    crossing : callable
        ``(p, (xi, eta), force, force) -> (gradient, tangent)``: coupling of two contacts on one element, over force (2) and arc position
        of the first contact, then of the second. The arguments are numbers, or arrays over many elements with ``xi <= eta``.
    """

    jet: Callable[[Properties, Any, Any, Any, Any, Any], tuple[Array, Array]]
    dent: Callable[[Properties, Any, Any], Any]
    crossing: Callable[[Properties, tuple[Any, Any], Any, Any], tuple[Array, Array]]
