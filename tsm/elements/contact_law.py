"""Contact laws: force, tangent and energy of a contact inside an element in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from tsm.elements.properties import Array, Properties

UPPER = [(a, b) for a in range(7) for b in range(a, 7)]
"""The 28 entries of the upper triangle of a matrix over ``dx, dy, theta_i, theta_j, F_x, F_y, xi``, row by row."""


class Surface(NamedTuple):
    """Where a contact meets a beam."""

    side: float  # +1 where the node comes from the right, -1 from the left
    offset: float  # distance of the contacting node from the axis


class Rub(NamedTuple):
    """State of a contact with friction."""

    lean: float  # ``sigma mu side`` in slip, with the sign sigma of the slip rate; 0 in stick
    held: float | None  # arc position at which the stick began, from the element's start; None in slip
    unit: float  # stiffness ``EI/L^2/L`` that makes the row of a stick a force
    face: float = 0.0  # distance of the face, on which friction acts, from the axis; ``offset - radius``
    radius: float = 0.0  # radius of a round pin, which does not turn
    # path, shear, slope: where the contact is held: length of the face per arc position, shear angle and
    # slope angle, see `Friction.hold`. Without face and radius they do not matter
    path: float = 1.0
    shear: float = 0.0
    slope: float = 0.0
    # change of the mean tangent by other contacts on the element, the sum of `Friction.tilt` times their
    # forces. Only `Friction.split` and `Friction.slip` take it; `Friction.crossing` has its part in the
    # rows
    tilt: tuple[Any, Any] = (0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """A contact law.

    Every function takes the constants `Properties` of the touched element first. ``x`` are the element's six displacements,
    ``lever = x_i - x_c`` the vector from the contacting node to the element's end i, ``xi`` in [0, 1] the position on the element,
    ``force`` the force on the beam, ``side`` +1 where the node comes from the right and -1 from the left, ``offset`` the distance of the
    contact surface from the axis.
    """

    # ``(p, x, lever, xi, force, side, offset) -> (gradient, tangent)`` over element (6), node (2) and the
    # contact's unknowns. The tangent is the derivative of the gradient. A law with unknowns adds both to
    # the beam's; a law without unknowns replaces the beam's
    response: Callable[[Properties, Any, Any, Any, Any, float, float], tuple[Array, Array]]
    # ``(p, x, lever, xi, force, side, offset) -> float``: contribution of the contact to the strain energy
    # in equilibrium
    energy: Callable[[Properties, Any, Any, Any, Any, float, float], float]
    # further functions of a law whose force and arc position are unknowns; None if the force follows from
    # the displacements
    coupling: Coupling | None = None

    @property
    def unknowns(self) -> int:
        """Unknowns of a closed contact: force (2) and arc position, or none."""
        return 3 if self.coupling else 0


@dataclass(frozen=True, kw_only=True)
class Coupling:
    """A contact law with unknowns: two contacts on one element, and friction."""

    # ``(p, xi, eta) -> number``: deflection of the element at xi by a unit force at eta
    dent: Callable[[Properties, Any, Any], Any]
    # ``(p, (xi, eta), force, force) -> (gradient, tangent)``: coupling of two contacts on one element, over
    # force (2) and arc position of the first contact, then of the second
    crossing: Callable[[Properties, tuple[Any, Any], Any, Any], tuple[Array, Array]]
    friction: Friction | None = None  # the law with friction; None if the law has none


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Coulomb friction in a contact law whose force and arc position are unknowns."""

    # ``(p, x, lever, xi, force, surface, rub) -> (residual, tangent)`` as `ContactLaw.response`, without a
    # symmetric tangent
    response: Callable[[Properties, Any, Any, Any, Any, Surface, Rub], tuple[Array, Array]]
    # ``(p, x, xi, force, surface, rub) -> (F_t, F_n, s)``: forces along the beam and across it, and the arc
    # position from the element's start
    split: Callable[[Properties, Any, Any, Any, Surface, Rub], tuple[Any, Any, Any]]
    # ``(p, x, xi, force, surface, rub) -> form (11,)``: slip rate as a linear form, ``F_t`` times which is
    # the dissipated power
    slip: Callable[[Properties, Any, Any, Any, Surface, Rub], Array]
    # ``(p, x, xi, force, surface, rub) -> Rub``: state of a stick that begins here
    hold: Callable[[Properties, Any, Any, Any, Surface, Rub], Rub]
    # as `ContactLaw.energy`, of the arguments of `response`
    energy: Callable[[Properties, Any, Any, Any, Any, Surface, Rub], float]
    # ``(p, (xi, eta), force, force, (rub, rub)) -> (residual, tangent)`` as `Coupling.crossing`
    crossing: Callable[[Properties, tuple[Any, Any], Any, Any, tuple[Rub, Rub]], tuple[Array, Array]]
    # ``(p, xi, eta) -> number``: change of the mean tangent at xi by a unit force at eta
    tilt: Callable[[Properties, Any, Any], Any]
