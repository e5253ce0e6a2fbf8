"""How friction holds a contact: slip one way or the other, or stick at a place."""

from numpy.polynomial import Polynomial

from comparisons.frozen import Value


class UnknownFrictionError(ValueError):
    """The friction of an answer at a load parameter cannot be computed; `wrong` if the answer is to blame."""

    def __init__(self, reason: str, *, wrong: bool = False) -> None:
        super().__init__(reason)
        self.wrong = wrong


class Hold(Value):
    """The place at which a contact began to stick, with lengths in units of the layout."""

    load_parameter: float
    arc_position: float  #: s*.
    stretch: float  #: A*.
    shear: float  #: psi*.
    direction: float  #: phi*.
    #: c as functions of the load parameter, each from a load parameter on.
    areas: tuple[tuple[float, Polynomial], ...] = ()

    def area(self, t: float) -> float:
        """Return c at a load parameter."""
        return next((float(area(t)) for begin, area in reversed(self.areas) if begin <= t), 0.0)


class Grip(Value):
    """How a contact with friction is held."""

    friction: float  #: Coefficient of friction.
    slip: int  #: The sign sigma of the slip rate; 0 in stick.
    hold: Hold | None = None  #: Where the stick began; None in slip.


LOOSE = Grip(friction=0.0, slip=1)
"""A contact that slips without friction, as at a touch, where there is no force yet."""
