"""State of contact between a pin and a beam."""

from enum import StrEnum


class Outcome(StrEnum):
    """State of contact; without contact the beam is straight and free of load."""

    OPEN = "open"
    """The pin does not touch the beam."""
    CONTACT = "contact"
    """The pin touches the beam without friction; the force may be zero."""
    STICK = "stick"
    """The pin holds the point of the beam that it touches; the force lies in the friction cone."""
    SLIP_TO_TIP = "slip to tip"
    """The pin slips towards the tip and drags the beam that way."""
    SLIP_TO_CLAMP = "slip to clamp"
    """The pin slips towards the clamp and drags the beam that way."""
    SLIPPED = "slipped"
    """The pin has left the beam over its free tip and has not returned below it."""
    LOST = "lost"
    """No equilibrium with this pin is connected with the last one, at first the straight beam; the results are nan from here on."""
    JAMMED = "jammed"
    """No state of the contact continues the last equilibrium, or more than one; the results are nan from here on."""

    @property
    def sense(self) -> int:
        """Sign of the slip rate: 1 towards the tip, -1 towards the clamp, 0 without slip or friction."""
        return {Outcome.SLIP_TO_TIP: 1, Outcome.SLIP_TO_CLAMP: -1}.get(self, 0)

    @property
    def touches(self) -> bool:
        """Whether the pin touches the beam."""
        return self in (Outcome.CONTACT, Outcome.STICK) or self.sense != 0

    @property
    def ends(self) -> bool:
        """Whether the path has no results beyond."""
        return self in (Outcome.LOST, Outcome.JAMMED)
