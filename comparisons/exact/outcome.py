"""State of contact between a pin and a beam."""

from enum import StrEnum


class Outcome(StrEnum):
    """State of contact; in every state but `CONTACT` the beam is straight and free of load."""

    OPEN = "open"
    """The pin does not touch the beam."""
    CONTACT = "contact"
    """The pin touches the beam; the force may be zero."""
    SLIPPED = "slipped"
    """The pin has left the beam over its free tip and has not returned below it."""
    LOST = "lost"
    """No equilibrium with this pin is connected with the straight beam; the results are nan."""
