"""Equilibria of a cantilever under a pin with Coulomb friction, and the events between them."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class FrictionState(StrEnum):
    """State of a contact with friction."""

    OPEN = "open"
    """The pin does not touch the beam, which is straight and free of load."""
    STICK = "stick"
    """The pin holds the point of the beam that it touches; the force lies in the friction cone."""
    SLIP_TO_TIP = "slip to tip"
    """The pin slips towards the tip and drags the beam that way."""
    SLIP_TO_CLAMP = "slip to clamp"
    """The pin slips towards the clamp and drags the beam that way."""
    SLIPPED = "slipped"
    """The pin has left the beam over its free tip; the beam is straight and free of load."""
    LOST = "lost"
    """No equilibrium with this pin is connected with the last one; the results are nan from here on."""
    JAMMED = "jammed"
    """No state of the contact continues the last equilibrium, or more than one; the results are nan from here on."""

    @property
    def sense(self) -> int:
        """Sign of the slip rate: 1 towards the tip, -1 towards the clamp, 0 without slip."""
        return {FrictionState.SLIP_TO_TIP: 1, FrictionState.SLIP_TO_CLAMP: -1}.get(self, 0)

    @property
    def touches(self) -> bool:
        """Whether the pin touches the beam."""
        return self is FrictionState.STICK or self.sense != 0

    @property
    def ends(self) -> bool:
        """Whether the path has no results beyond."""
        return self in (FrictionState.LOST, FrictionState.JAMMED)


@dataclass(frozen=True, kw_only=True)
class FrictionEvent:
    """Change of the state of the contact.

    Attributes
    ----------
    load_parameter : float
        Fraction of the path's length at which the state changes.
    before, after : FrictionState
        States on both sides.
    arc_position : float
        Distance of the contact from the clamp along the undeformed axis.
    magnitude : float
        Contact force at the event.
    """

    load_parameter: float
    before: FrictionState
    after: FrictionState
    arc_position: float
    magnitude: float


@dataclass(frozen=True, kw_only=True)
class FrictionPath:
    """States of a cantilever at `s` positions of a pin with friction.

    Without contact the beam is straight, `arc_position` is nan and the forces are zero.

    Attributes
    ----------
    load_parameter : ndarray, shape (s,)
        Fraction of the length of the pin's path.
    state : tuple of FrictionState
        State of the contact at every position. At an event it is the state after the event.
    force : ndarray, shape (s, 2)
        Force of the pin on the beam.
    magnitude, tangential, normal : ndarray, shape (s,)
        Contact force, its component along the mean tangent towards the tip, and its component away from the pin.
    arc_position : ndarray, shape (s,)
        Distance of the contact from the clamp along the undeformed axis.
    clamp_force : ndarray, shape (s, 2)
        Force of the clamp on the beam.
    clamp_moment : ndarray, shape (s,)
        Moment of the clamp on the beam, anticlockwise positive.
    tip : ndarray, shape (s, 2)
        Position of the free tip.
    tip_rotation : ndarray, shape (s,)
        Rotation of the section at the tip [rad].
    work : ndarray, shape (s,)
        Work of the pin since the start.
    stored : ndarray, shape (s,)
        Strain energy.
    dissipated : ndarray, shape (s,)
        Energy lost in slip, the integral of `mu F_n |v|`.
    released : ndarray, shape (s,)
        Strain energy lost where the pin leaves the beam over its tip.
    events : tuple of FrictionEvent
        Changes of state in the order of the load parameter.
    """

    load_parameter: Array
    state: tuple[FrictionState, ...]
    force: Array
    magnitude: Array
    tangential: Array
    normal: Array
    arc_position: Array
    clamp_force: Array
    clamp_moment: Array
    tip: Array
    tip_rotation: Array
    work: Array
    stored: Array
    dissipated: Array
    released: Array
    events: tuple[FrictionEvent, ...]
