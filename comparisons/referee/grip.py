"""A contact as rows of the equations: the direction of its face, slip or stick by Coulomb's law, and the couple of a face.

With the direction t of the face and its angle phi, its left normal n, the part ``a = t . (r'_- + r'_+)/2`` of the mean tangent, the
section's rotation theta from its undeformed direction beta, the natural curvature kappa0 and the whole one ``k = theta' + kappa0``, and
``lever``, the radius of the circle whose envelope is the face, and ``roll = R`` to the right of the beam, minus these values to its left::

    n . (r'_- + r'_+)/2 = -offset'          direction of the face
    F_t = F . t,  F_n = side F . n           tangential and normal force on the beam, side = 1 for a node on the right
    m_- - m_+ = C = lever F_t                couple on the section, since F acts on the face
    v = A s' + lever psi' + roll phi'        slip rate, A = a + lever k and psi = phi - theta - beta
    slip:   F_t = sigma mu F_n,  sigma = sign v
    stick:  v = 0,  or (A + A*)/2 (s - s*) + lever (psi - psi*) + roll (phi - phi*) = c

The power of the node is the rate of the strain energy and ``F_t v``. Starred values are those where the stick began, and c is the error of the
trapezium of v, which `friction.slip` finds along the path; where the height tapers the lever in stick is the mean of the two. Without a
taper t is along the mean tangent. The couple and the row of phi take the place of the two conditions of stationarity in arc position and
phi, which hold without friction only.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

if TYPE_CHECKING:
    from comparisons.referee.layout import Layout, Part, Touch

Array = NDArray[np.float64]

_STEP = 1e-30
"""Imaginary step of the derivatives, which have no error of subtraction."""


class UnknownFrictionError(ValueError):
    """The friction of an answer at a load parameter cannot be computed; `wrong` if the answer is to blame."""

    def __init__(self, reason: str, *, wrong: bool = False) -> None:
        super().__init__(reason)
        self.wrong = wrong


@dataclass(frozen=True, kw_only=True)
class Hold:
    """The place at which a contact began to stick, with lengths in units of the layout."""

    load_parameter: float
    arc_position: float
    """s*."""
    stretch: float
    """A*."""
    shear: float
    """psi*."""
    direction: float
    """phi*."""
    areas: tuple[tuple[float, Polynomial], ...] = ()
    """c as functions of the load parameter, each from a load parameter on."""

    def area(self, t: float) -> float:
        """Return c at a load parameter."""
        return next((float(area(t)) for begin, area in reversed(self.areas) if begin <= t), 0.0)


@dataclass(frozen=True, kw_only=True)
class Grip:
    """How a contact with friction is held."""

    friction: float
    """Coefficient of friction."""
    slip: int
    """The sign sigma of the slip rate; 0 in stick."""
    hold: Hold | None = None
    """Where the stick began; None in slip."""


LOOSE = Grip(friction=0.0, slip=1)
"""A contact that slips without friction, as at a touch, where there is no force yet."""


class Rows(NamedTuple):
    """Values of the rows, with the derivatives (4, 8) by `numbers`: theta, c before the contact and behind it, phi, m before, and s."""

    numbers: list[int]
    row: float
    couple: float
    direction: float
    stretch: float
    derivatives: Array


def rows(layout: "Layout", touch: "Touch", z: Array, moment: float) -> Rows:
    """Return the rows of a contact at the unknowns z and the moment before it, which has no number."""
    parts = before, behind = layout.beside(touch)
    turn = int(layout.stations[before.last].numbers[2])
    forces = [before.force, before.force + 1, behind.force, behind.force + 1]
    numbers = [turn, *forces, touch.angle, -1, touch.arc]
    given = layout.full(z)[numbers]
    given[6] = moment
    found = np.array(_rows(layout, touch, parts, given[:, None] + 1j * _STEP * np.eye(len(given))))
    row, couple, direction, stretch = np.real(found[:, 0]).tolist()
    return Rows(numbers, row, couple, direction, stretch, np.imag(found) / _STEP)


def _rows(layout: "Layout", touch: "Touch", parts: "tuple[Part, Part]", given: Any) -> tuple[Any, ...]:
    """Evaluate the rows at complex values (8, n)."""
    theta, phi, m, s = given[0], given[5], given[6], given[7]
    (piece, behind), face, grip = (part.piece for part in parts), touch.face, touch.grip
    mean = (piece.tangent(given[1:3], s, theta) + behind.tangent(given[3:5], s, theta)) / 2.0
    force, lever = given[1:3] - given[3:5], face.lever(s)
    cos, sin = np.cos(phi), np.sin(phi)
    aligned = mean[1] * cos - mean[0] * sin + face.tilt
    a = mean[0] * cos + mean[1] * sin if face.slope else (mean[0] ** 2 + mean[1] ** 2) ** 0.5
    x, y = (cos, sin) if face.slope else mean / a
    drag, push = force[0] * x + force[1] * y, face.left * (force[0] * y - force[1] * x)
    couple = lever * drag
    stretch = a + lever * ((m - couple / 2.0) / piece.flexibility(s)[0] + piece.curvature)
    if grip is None or grip.hold is None:
        slip = 0.0 if grip is None else grip.slip * grip.friction
        return drag - slip * push, couple, aligned, stretch
    hold = grip.hold
    row = (stretch + hold.stretch) / 2.0 * (s - hold.arc_position) - hold.area(layout.load_parameter)
    if touch.angle >= 0:
        lever = (lever + face.lever(hold.arc_position)) / 2.0
        row = row + lever * _wrapped(phi - theta - piece.angle(s) - hold.shear)
        row = row - face.left * face.radius * (phi - hold.direction)
    return row, couple, aligned, stretch


def _wrapped(angle: Any) -> Any:
    """Angle less the multiple of 2 pi next to it; phi is measured from the axes of the scene, theta from the undeformed beam."""
    return angle - 2.0 * math.pi * np.round(np.real(angle) / (2.0 * math.pi))
