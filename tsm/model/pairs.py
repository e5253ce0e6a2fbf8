"""Beams and contact pairs in the numbering of a model, and the equations of a contact.

Friction acts on a face at the distance ``lever`` from the axis, and a round pin of radius ``roll`` rolls on
it; both are positive on the right. With the mean tangent T, its direction t at the angle phi, the section's
angle theta, the shear angle ``psi = phi - theta`` and the mean turn theta'::

    F_t = F . t,   F_n = side F . n                     force on the beam along T and across it
    C = lever F_t                                       couple on the axis
    v = A s' + lever psi' + roll phi'                   slip rate, A = |T| + lever theta' the length of the face per arc position
    slip:   F_t = sigma mu F_n
    stick:  (A + A*)/2 (s - s*) + lever (psi - psi*) + roll (phi - phi*) = 0

What friction dissipates is ``F_t v``: the power of the node less that of the strain energy. The starred
values are those in the held place. On the axis, under a sharp pin, the row is ``s = s*``. What the mean of A
leaves out where a contact rolls, `tsm.path.energy` takes into the held place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from tsm.elements import ClosedForm, ContactLaw, Integrated
from tsm.elements.contact_law import Vector
from tsm.elements.properties import unwind
from tsm.model.mesh import BeamModel
from tsm.model.projection import arc_position
from tsm.model.state import Grip, Place, Touch, Traction
from tsm.statement.pin import Pin
from tsm.statement.structure import ContactPair


class Here(NamedTuple):
    """What a contact sees of its beam, in numbers or in arrays with complex steps."""

    arc: Any  # arc position on the beam
    tangent: Vector  # mean tangent T, per undeformed length
    # shear, direction: psi, the angle from the section's normal to T; phi, the angle of T; both, as the mean
    # theta', matter with friction only
    shear: Any
    direction: Any
    turn: Any  # mean theta', per undeformed length


@dataclass(frozen=True, kw_only=True)
class PairModel:
    """A contact pair's place in the model."""

    pair: ContactPair  # what the user stated
    target: BeamModel  # the touched beam
    side: float  # +1 where the node comes from the right, -1 from the left
    pin: Pin | None  # the control node that touches, or None where a beam's end does
    node: int  # global number of the beam's end that touches, -1 for a pin
    # position of its unknowns (force x and y, arc position, of exact elements the angle) in the border, -1
    # without
    slot: int

    @property
    def cuts(self) -> bool:
        """Whether the contact cuts the touched element."""
        return isinstance(self.target.kind, Integrated)

    @property
    def law(self) -> ContactLaw:
        """Contact law of a touched element in closed form."""
        assert isinstance(self.target.kind, ClosedForm), "an exact element is cut instead"
        return self.target.kind.contact

    @property
    def reach(self) -> float:
        """Offset of the contact surface from the axis, at the start where it varies, positive to the right of the beam's direction."""
        return self.side * self.pair.offset

    @property
    def steep(self) -> float:
        """Derivative of the offset by the arc position, positive where the surface on the right moves away from the axis."""
        if self.pair.end_offset is None:
            return 0.0
        return self.side * (self.pair.end_offset - self.pair.offset) / self.target.beam.length

    def reach_at(self, arc: float) -> float:
        """Offset at an arc position, positive to the right of the beam's direction."""
        return self.reach + self.steep * arc if self.steep else self.reach

    @property
    def rubs(self) -> bool:
        """Whether the contact has friction."""
        return self.pair.friction > 0

    @property
    def lever(self) -> float:
        """Distance of the face, on which friction acts, from the axis, positive to the right."""
        return self.side * (self.pair.offset - self.pair.radius)

    @property
    def roll(self) -> float:
        """Radius of a round pin, positive on the right."""
        return self.side * self.pair.radius

    def lean(self, grip: Grip) -> float:
        """Tangent of the angle from the normal to the contact force in slip, positive clockwise; 0 in stick."""
        return grip.slip * self.pair.friction * self.side

    def arc_position(self, touch: Touch) -> float:
        """Distance of a contact along the undeformed axis from the beam's start."""
        return arc_position(self.target, touch.element, touch.xi)

    def moved(self, touch: Touch, change: Sequence[Any]) -> Touch:
        """Touch after a change of its unknowns: force (2), arc position and, of exact elements, angle."""
        dFx, dFy, ds, *turned = change
        return replace(
            touch,
            xi=touch.xi + ds / self.target.lengths[touch.element - self.target.first],
            force=(touch.force[0] + dFx, touch.force[1] + dFy),
            angle=touch.angle + sum(turned),
        )

    def face(self, here: Here) -> tuple[Vector, Vector]:
        """Normal of the contact surface, to the right, and its direction times ``|T|``.

        The surface is the envelope of circles with the offset o as radius about the points of the axis. With
        the direction t of T, its right normal n, ``S = o'/|T|`` and ``C = sqrt(1 - S^2)``, its normal is ``C
        n - S t`` and its direction ``C t + S n``.
        """
        Tx, Ty = here.tangent
        size = (Tx * Tx + Ty * Ty) ** 0.5
        S = self.steep / size
        C = (1 - S * S) ** 0.5
        return ((C * Ty - S * Tx) / size, (-C * Tx - S * Ty) / size), (C * Tx + S * Ty, C * Ty - S * Tx)

    def rows(self, grip: Grip | None, force: Any, here: Here, unit: float) -> tuple[Any, Any, Any]:
        """Vector from the axis to the surface, and the last row: the force is normal to the surface, leans, or sticks.

        With the lean c, which is 0 without friction, ``F . (T - c n)``; in stick `unit` times `slid`.
        """
        (Fx, Fy), (x, y), (Tx, Ty) = force, (0.0, 0.0), here.tangent
        if self.pair.offset:
            reach, ((nx, ny), (Tx, Ty)) = self.reach_at(here.arc), self.face(here)
            x, y = reach * nx, reach * ny
        if grip is not None and grip.held is not None:
            return x, y, unit * self.slid(self.place(here), grip.held)
        lean = self.lean(grip) if grip else 0.0
        return x, y, (Fx - lean * Fy) * Tx + (Fy + lean * Fx) * Ty

    def place(self, here: Here) -> Place:
        """Where a contact with friction lies."""
        Tx, Ty = here.tangent
        size = (Tx * Tx + Ty * Ty) ** 0.5
        return Place(here.arc, here.shear, here.direction, size + self.lever * here.turn)

    def slid(self, here: Place, held: Place) -> Any:
        """Path of the face along the node since it was held, by the trapezium, see the module's text."""
        rolled = self.lever * (here.shear - held.shear) + self.roll * unwind(here.direction - held.direction)
        return (here.stretch + held.stretch) / 2 * (here.arc - held.arc) + rolled

    def traction(self, force: Any, here: Here) -> Traction:
        """Force along the mean tangent and across it, and where the contact lies."""
        (Fx, Fy), (Tx, Ty) = force, here.tangent
        size, place = (Tx * Tx + Ty * Ty) ** 0.5, Place(*(float(value) for value in self.place(here)))
        return Traction(
            float((Fx * Tx + Fy * Ty) / size), self.side * float((Fy * Tx - Fx * Ty) / size), place
        )

    @property
    def slots(self) -> slice:
        """Positions of its unknowns among the contacts' unknowns."""
        return slice(self.slot, self.slot + self.target.kind.contact_unknowns)
