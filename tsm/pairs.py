"""Beams and contact pairs in the numbering of a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tsm.elements import ClosedForm, ContactLaw, ElementType
from tsm.elements.contact_law import Rub
from tsm.elements.properties import Array
from tsm.projection import arc_position
from tsm.state import Grip, Touch
from tsm.structure import Beam, ContactPair, Pin

if TYPE_CHECKING:
    from tsm.groups import ElementGroup


@dataclass(frozen=True, kw_only=True)
class BeamModel:
    """A beam's place in the model."""

    beam: Beam  # what the user stated
    first: int  # global number of its first element; its elements follow one another
    nodes: Array  # global node numbers from start to end; shape (elements + 1,)
    lengths: list[float]  # undeformed lengths of its elements
    arcs: list[float]  # arc positions of its nodes
    kind: ElementType  # type of its elements

    @property
    def last(self) -> int:
        """Global number of its last element."""
        return self.first + self.beam.elements - 1


@dataclass(frozen=True, kw_only=True)
class PairModel:
    """A contact pair's place in the model."""

    pair: ContactPair  # what the user stated
    target: BeamModel  # the touched beam
    element_type: ElementType  # its element type
    group: ElementGroup  # group of its elements
    side: float  # +1 where the node comes from the right, -1 from the left
    pin: Pin | None  # the control node that touches, or None where a beam's end does
    node: int  # global number of the beam's end that touches, -1 for a pin
    # position of its unknowns (force x and y, arc position, of exact elements the angle) in the border, -1
    # without
    slot: int

    @property
    def cuts(self) -> bool:
        """Whether the contact cuts the touched element."""
        return self.group.internal

    @property
    def law(self) -> ContactLaw:
        """Contact law of a touched element in closed form."""
        assert isinstance(self.element_type, ClosedForm), "an exact element is cut instead"
        return self.element_type.contact

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

    def rub(self, touch: Touch) -> Rub:
        """State of the friction for the contact law, the travel counted from the element's start."""
        grip, lean = touch.grip, self.lean(touch.grip) if touch.grip else 0.0
        start = self.target.arcs[touch.element - self.target.first]
        beam, radius = self.target.beam, self.pair.radius
        rub = Rub(lean, None, beam.section.EI / beam.length**3, self.pair.offset - radius, radius)
        if grip is None or grip.held is None:
            return rub
        held = grip.held
        return rub._replace(held=held.arc - start, path=held.stretch, shear=held.shear, slope=held.direction)

    @property
    def slots(self) -> slice:
        """Positions of its unknowns among the contacts' unknowns."""
        return slice(self.slot, self.slot + self.element_type.contact_unknowns)
