"""How a pin stands to the beam it meets."""

from enum import StrEnum


class Outcome(StrEnum):
    """Named state of the pair pin - beam; everything but `CONTACT` leaves the beam straight and free of load."""

    OPEN = "open"
    """The pin does not touch the beam."""
    CONTACT = "contact"
    """The pin touches the beam; the force may be zero."""
    SLIPPED = "slipped"
    """The pin has left the beam over its free tip, and is not back below it."""
    LOST = "lost"
    """No equilibrium under the pin is connected with the straight beam; the results are nan."""
