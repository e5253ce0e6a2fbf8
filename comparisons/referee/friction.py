"""Coulomb friction at a contact: the rows of slip and stick, and the couple of a face.

With the direction t of the face and its angle phi, its left normal n, the part ``a = t . (r'_- + r'_+)/2`` of the mean tangent, the
section's rotation theta from its undeformed direction, the natural curvature kappa0 and the whole one ``k = theta' + kappa0``, and
``lever``, the radius of the circle whose envelope is the face, and ``roll = R`` to the right of the beam, minus these values to its left::

    F_t = F . t,  F_n = side F . n           tangential and normal force on the beam, side = 1 for a node on the right
    m_- - m_+ = C = lever F_t                couple on the section, since F acts on the face
    v = A s' + lever psi' + roll phi'        slip rate, A = a + lever k and psi = phi - theta - kappa0 s
    slip:   F_t = sigma mu F_n,  sigma = sign v
    stick:  v = 0,  or (A + A*)/2 (s - s*) + lever (psi - psi*) + roll (phi - phi*) = c

The power of the node is the rate of the strain energy and ``F_t v``. Starred values are those where the stick began, and c is the error of the
trapezium of v, which `rolling` finds along the path; where the height tapers
the lever in stick is the mean of the two. Without a taper t is along the mean tangent. The couple, and the row ``n . (r'_- + r'_+)/2 =
-offset'`` of phi, take the place of the two conditions of stationarity in arc position and phi, which hold without friction only.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

if TYPE_CHECKING:
    from comparisons.referee.layout import Layout, Part, Touch
    from comparisons.referee.rods import Flexibility

Array = NDArray[np.float64]

_STEP = 1e-30
"""Imaginary step of the derivatives, which have no error of subtraction."""


@dataclass(frozen=True, kw_only=True)
class Hold:
    """The place at which a contact began to stick, with lengths in the scene's units.

    Attributes
    ----------
    load_parameter : float
        Where the stick began.
    arc_position : float
        Arc position s*.
    stretch : float
        A*.
    shear, direction : float
        The angles psi* and phi*.
    areas : tuple of (float, Polynomial)
        c as a function of the load parameter, each from a load parameter on.
    """

    load_parameter: float
    arc_position: float
    stretch: float
    shear: float
    direction: float
    areas: tuple[tuple[float, Polynomial], ...] = ()

    def area(self, t: float) -> float:
        """Return c at a load parameter."""
        return next((float(area(t)) for begin, area in reversed(self.areas) if begin <= t), 0.0)


@dataclass(frozen=True, kw_only=True)
class Grip:
    """How a contact with friction is held.

    Attributes
    ----------
    friction : float
        Coefficient of friction.
    slip : int
        The sign sigma of the slip rate; 0 in stick.
    hold : Hold or None
        Where the stick began; None in slip.
    """

    friction: float
    slip: int
    hold: Hold | None = None


LOOSE = Grip(friction=0.0, slip=1)
"""A contact that slips without friction, as at a touch, where there is no force yet."""


class Local(NamedTuple):
    """Friction of a contact as a function of the rotation of its section, the forces of the parts, phi, the moment before it, and s."""

    row: Any
    couple: Any
    direction: Any
    stretch: Any


class Rows(NamedTuple):
    """Values of `Local`, and their derivatives (3, 8) without that of A."""

    values: Local
    derivatives: Array


UNKNOWNS = 8
"""Number of the arguments of `Local`: theta, two forces before and two behind, phi, m, s."""


def rows(layout: "Layout", touch: "Touch", parts: "tuple[Part, Part]", given: Array) -> Rows:
    """Return the row of slip or stick, the couple, and the row of the direction, at the values `given` (8,) of the unknowns."""
    derivatives = np.empty((3, UNKNOWNS))
    for k in range(UNKNOWNS):
        turned = given.astype(complex)
        turned[k] += 1j * _STEP
        derivatives[:, k] = np.imag(_local(layout, touch, parts, turned)[:3]) / _STEP
    return Rows(_local(layout, touch, parts, given), derivatives)


def _local(layout: "Layout", touch: "Touch", parts: "tuple[Part, Part]", given: Any) -> Local:
    """Evaluate the equations of the module, real or complex."""
    assert touch.grip is not None, "only a contact with friction has these rows"
    theta, phi, m, s = given[0], given[5], given[6], given[7]
    rod = parts[0].rod
    flexible, frame = rod.flexibility(s), rod.frame(s)
    before, behind = given[1:3], given[3:5]
    if not rod.uniform:
        before, behind = parts[0].local(before, s), parts[1].local(behind, s)
    mean = (_tangent(flexible, frame, theta, before) + _tangent(flexible, frame, theta, behind)) / 2.0
    force = parts[0].axes @ (given[1:3] - given[3:5])
    lever = touch.lever(s)
    aligned = mean[1] * np.cos(phi) - mean[0] * np.sin(phi)
    if touch.slope:
        x, y = np.cos(phi), np.sin(phi)
        a, aligned = mean[0] * x + mean[1] * y, aligned + touch.slope
        drag = force[0] * x + force[1] * y
        push = touch.right * (force[1] * x - force[0] * y)
    else:
        a = (mean[0] ** 2 + mean[1] ** 2) ** 0.5
        drag = (force[0] * mean[0] + force[1] * mean[1]) / a
        push = touch.right * (force[1] * mean[0] - force[0] * mean[1]) / a
    couple = lever * drag
    stretch = a + lever * (m - couple / 2.0) / flexible.EI + lever * rod.curvature
    hold = touch.grip.hold
    if hold is None:
        return Local(drag - touch.grip.slip * touch.grip.friction * push, couple, aligned, stretch)
    row = (stretch + hold.stretch) / 2.0 * (s - hold.arc_position / layout.length)
    row = row - hold.area(layout.load_parameter) / layout.length
    if touch.angle >= 0:
        turned = theta + rod.curvature * s
        if touch.slope:
            lever = (lever + touch.lever(hold.arc_position / layout.length)) / 2.0
        row = row + lever * _wrapped(phi - turned - hold.shear) + touch.roll * (phi - hold.direction)
    return Local(row, couple, aligned, stretch)


def _tangent(flexible: "Flexibility", frame: Any, theta: Any, n: Any) -> Any:
    """``r'`` under a force in the frame of the undeformed tangent: ``(1 + N/EA) d1 + (Q/GA) d2``."""
    c, s = np.cos(theta), np.sin(theta)
    along = 1.0 + flexible.stretch * (n[0] * c + n[1] * s)
    across = flexible.shear * (n[1] * c - n[0] * s)
    return frame @ np.array([along * c - across * s, along * s + across * c])


def _wrapped(angle: Any) -> Any:
    """Angle less the multiple of 2 pi next to it; phi is measured from the axes of the scene, theta from the undeformed beam."""
    return angle - 2.0 * math.pi * round(float(np.real(angle)) / (2.0 * math.pi))
