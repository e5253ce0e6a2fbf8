"""Friction of a contact that cuts an exact element: the couple on the axis, and the row of slip or stick.

With the mean tangent before and after the contact, its direction t at the angle phi, its left normal n, the section's angle theta, the
mean curvature k, ``lever = side h/2`` of the face and ``roll = side R`` of a round pin::

    F_t = F . t,   F_n = side F . n                     tangential and normal force on the beam
    C = lever F_t                                       couple on the axis, m_+ = m_- - C
    v = A s' + lever psi' + roll phi'                   slip rate, psi = phi - theta, A = |mean tangent| + lever k
    slip:   F_t = sigma mu F_n
    stick:  (A + A*)/2 (s - s*) + lever (psi - psi*) + roll (phi - phi*) = 0

The power of the pin is that of the strain energy and ``F_t v``, so couple and slip rate belong together. The starred values are those
at the last equilibrium. On the axis, under a sharp pin, the row is ``s = s*``. What the mean of A leaves out where a contact rolls, `tsm.energy`
takes into the held angle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.properties import Array, cosine, sine
from tsm.rods.contact_rows import Explicit
from tsm.state import Grip, Place

if TYPE_CHECKING:
    from tsm.pairs import PairModel

Tangents = tuple[rod.Tangent, rod.Tangent]
Pair = tuple[Any, Any]


class Mean(NamedTuple):
    """Mean tangent at a contact."""

    t: Pair  # unit vector
    stretch: Any  # length of the mean tangent vector, for a unit of arc
    shear: Any  # angle psi from the section's normal


class Forms(NamedTuple):
    """Linear forms over the unknowns of an element, each of shape (n,)."""

    row: Array  # derivative of the row of slip or stick
    couple: Array  # derivative of the couple on the axis
    slip: Array  # slip rate


class Rubbing(NamedTuple):
    """Contact with friction at a configuration."""

    pair: PairModel  # the contact pair
    force: Pair  # force on the beam
    bend: float  # 1/EI
    curvature: float  # natural curvature
    mean: Mean  # mean tangent
    place: Place  # where it lies
    tangential: Any  # tangential, normal: force along the mean tangent, and across it away from the node
    normal: Any

    @property
    def couple(self) -> Any:
        """Couple on the axis."""
        return self.pair.lever * self.tangential

    def residual(self, grip: Grip, stiffness: float) -> Any:
        """Row of slip, or of stick times a stiffness."""
        if grip.held is None:
            (x, y), (tx, ty) = leaned(self.force, self.pair.lean(grip)), self.mean.t
            return 2 * self.mean.stretch * (x * tx + y * ty)
        here, held = self.place, grip.held
        slid = (here.stretch + held.stretch) / 2 * (here.arc - held.arc)
        slid = slid + self.pair.lever * (here.shear - held.shear)
        return stiffness * (slid + self.pair.roll * (here.direction - held.direction))

    def differentiate(
        self,
        grip: Grip,
        stiffness: float,
        tangents: Tangents,
        selectors: Array,
        moment: Array,
        explicit: Explicit | None = None,
    ) -> Forms:
        """Derivatives.

        ``tangents``: tangent vectors before and after the contact. ``selectors`` (6, n): derivatives of the
        section's angle, the internal force before (2), the contact force (2), and the arc position.
        ``moment`` (n,): derivative of the moment before the contact. ``explicit``: further derivatives of the
        tangent vectors and of the curvature.
        """
        pair, (fx, fy), (tx, ty), stretch = self.pair, self.force, self.mean.t, self.mean.stretch
        before, after = tangents
        (xx, xy, yy), (ax, ay, aa) = before.compliance, after.compliance
        by = [
            [before.turned[0] + after.turned[0], xx + ax, xy + ay, -ax, -ay],
            [before.turned[1] + after.turned[1], xy + ay, yy + aa, -ay, -aa],
        ]
        vector = np.array(by) / 2 @ selectors[:5]
        if explicit is not None:
            vector = vector + explicit.vector / 2
        direction, arc = (tx * vector[1] - ty * vector[0]) / stretch, selectors[5]
        shear = direction - selectors[0]
        couple = pair.lever * ((fy * tx - fx * ty) * direction + tx * selectors[3] + ty * selectors[4])
        longer = tx * vector[0] + ty * vector[1] + pair.lever * self.bend * (moment - couple / 2)
        if explicit is not None:
            longer = longer + pair.lever * explicit.turn
        angles = pair.lever * shear + pair.roll * direction
        slip = self.place.stretch * arc + angles
        if grip.held is None:
            lean = pair.lean(grip)
            x, y = leaned(self.force, lean)
            row = 2 * (x * vector[0] + y * vector[1])
            row = row + 2 * stretch * ((tx + lean * ty) * selectors[3] + (ty - lean * tx) * selectors[4])
        else:
            row = (self.place.stretch + grip.held.stretch) / 2 * arc + angles
            row = stiffness * (row + longer * ((self.place.arc - grip.held.arc) / 2))
        return Forms(row, couple, slip)


def rubbing(
    pair: PairModel, force: Pair, tangents: Tangents, angle: Any, bend: float, curvature: float = 0.0
) -> Rubbing:
    """Contact with friction whose arc position and moment are left open."""
    before, after = tangents
    x, y = (before.vector[0] + after.vector[0]) / 2, (before.vector[1] + after.vector[1]) / 2
    stretch = (x * x + y * y) ** 0.5
    t, (c, s) = (x / stretch, y / stretch), (cosine(angle), sine(angle))
    shear = np.arctan((c * y - s * x) / (c * x + s * y))
    here = Place(0.0, shear, angle + shear, stretch)
    tangential = force[0] * t[0] + force[1] * t[1]
    normal = pair.side * (force[1] * t[0] - force[0] * t[1])
    return Rubbing(pair, force, bend, curvature, Mean(t, stretch, shear), here, tangential, normal)


def placed(contact: Rubbing, arc: Any, moment: Any) -> Rubbing:
    """Contact at an arc position, with the moment before it."""
    lever = contact.pair.lever
    turn = contact.bend * (moment - lever * contact.tangential / 2) + contact.curvature
    stretch = contact.mean.stretch + lever * turn
    return contact._replace(place=contact.place._replace(arc=arc, stretch=stretch))


def leaned(force: Pair, lean: float) -> Pair:
    """Force turned against its lean, times ``sqrt(1 + lean^2)``: in slip it is normal to the tangent."""
    return force[0] - lean * force[1], force[1] + lean * force[0]
