"""What an exact solution states along the path of a pin: states of contact, events, and the states of the rod in the units of the input."""

from collections.abc import Callable
from enum import StrEnum
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.contact import Cantilever, Real
from comparisons.frozen import Value

_RULES: dict[str, Callable[[float], bool]] = {
    "positive": lambda x: x > 0.0,
    "positive and finite": lambda x: 0.0 < x < inf,
    "finite and not negative": lambda x: 0.0 <= x < inf,
}


class Outcome(StrEnum):
    """State of contact between a pin and a beam; without contact the beam is straight and free of load."""

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


class Event(Value):
    """Change of the state of contact."""

    load_parameter: float  #: Fraction of the path's length at which the state changes.
    before: Outcome  #: State before it.
    after: Outcome  #: State after it.
    arc_position: float  #: Distance of the contact from the clamp along the undeformed axis.
    magnitude: float  #: Contact force at the event.


class RodPath(Value):
    """States of the rod at `s` positions of the pin.

    Without contact the rod is straight, `arc_position` is nan and the forces are zero. Where the path has ended (`Outcome.ends`) all
    arrays are nan.
    """

    load_parameter: Real  #: Fraction of the length of the pin's path (s,).
    outcome: tuple[Outcome, ...]  #: State of contact at every position; at an event, the state after it.
    force: Real  #: Force of the pin on the rod (s, 2).
    tangential: Real  #: Component of the force along the mean tangent towards the tip (s,).
    normal: Real  #: Component of the force away from the pin (s,).
    arc_position: Real  #: Distance of the contact from the clamp along the undeformed axis (s,).
    #: Moment of the clamp on the rod, anticlockwise positive (s,); the force of the clamp is that of the pin, reversed.
    clamp_moment: Real
    tip: Real  #: Position of the free tip (s, 2).
    work: Real  #: Work of the pin since the start (s,).
    dissipated: Real  #: Energy lost in slip, the integral of `mu F_n |v|` (s,); zero without friction.
    iterations: NDArray[np.int64]  #: Newton iterations since the previous position, with rejected steps (s,).
    events: tuple[Event, ...]  #: Changes of state in the order of the load parameter.
    unknowns: Real  #: Unknowns of `rod` (s, 4).
    rod: Cantilever  #: `comparisons.exact.contact.Cantilever`.
    length: float  #: Undeformed length.

    @property
    def magnitude(self) -> Real:
        """Contact force, shape (s,)."""
        return np.asarray(np.hypot(*self.force.T))

    @property
    def slip_off(self) -> float:
        """Fraction of the path's length at which the pin first leaves the rod over its tip; nan without slip-off."""
        return next((item.load_parameter for item in self.events if item.after is Outcome.SLIPPED), np.nan)

    def shape(self, k: int, n: int) -> Real:
        """Position and rotation `x, y, theta` (n, 3) at `n` equal distances along the undeformed axis from the clamp to the tip."""
        axis = _axis(self.rod, self.outcome[k], self.unknowns[k], np.linspace(0.0, 1.0, n))
        return axis * [self.length, self.length, 1.0]


class Row(NamedTuple):
    """A state at a position of the pin in the units of `Cantilever`, with work and dissipation, and the iterations since the start."""

    t: float
    state: Outcome
    z: Real
    energies: Real | tuple[float, float] = (0.0, 0.0)
    iterations: int = 0


Change = tuple[float, Outcome, Outcome, Real]
"""Load parameter of a change of state, the states before and after it, and the unknowns (4,)."""


def collected(rod: Cantilever, rows: list[Row], changes: list[Change], EI: float, length: float) -> RodPath:
    """Return the states and their changes in the units of the input."""
    unit, energy = EI / length**2, EI / length
    t, outcome, unknowns, energies, iterations = zip(*rows, strict=True)
    touches = np.array([state.touches for state in outcome])
    lost = np.where([state.ends for state in outcome], np.nan, 0.0)
    z = np.where(touches[:, None], unknowns, [0.0, 0.0, 0.0, 1.0])
    contact, (work, dissipated) = rod.contact(z, np.zeros(2)), energy * np.array(energies).T
    return RodPath(
        load_parameter=np.array(t),
        outcome=outcome,
        force=unit * (z[:, :2] + lost[:, None]),
        tangential=unit * (contact.tangential + lost),
        normal=unit * (contact.normal + lost),
        arc_position=length * np.where(touches, z[:, 3], np.nan),
        clamp_moment=-energy * (z[:, 2] + lost),
        tip=length * np.array([_axis(rod, *one, np.ones(1))[0, :2] for one in zip(outcome, z, strict=True)]),
        work=work + lost,
        dissipated=dissipated + lost,
        iterations=np.diff(iterations, prepend=0),
        events=tuple(
            Event(
                load_parameter=float(t),
                before=before,
                after=after,
                arc_position=length * float(z[3]),
                magnitude=unit * float(np.hypot(*z[:2])),
            )
            for t, before, after, z in changes
        ),
        unknowns=z,
        rod=rod,
        length=length,
    )


def _axis(rod: Cantilever, outcome: Outcome, z: Real, arcs: Real) -> Real:
    """Position and rotation (n, 3) at arc positions (n,) of a rod of length 1; behind the contact it is straight."""
    if not outcome.touches:
        return np.outer(np.full(len(arcs), np.nan) if outcome.ends else arcs, [1.0, 0.0, 0.0])
    part, tail = rod.sections(z, np.minimum(arcs, z[3]) / z[3]), np.maximum(arcs - z[3], 0.0)
    x, y = part.x + tail * np.cos(part.theta), part.y + tail * np.sin(part.theta)
    return np.column_stack([x, y, part.theta])


def require(rule: str, **values: float) -> None:
    """Raise `ValueError` naming the first value that breaks a rule."""
    for name, value in values.items():
        if not _RULES[rule](value):
            raise ValueError(f"{name} = {value}: must be {rule}")


def vertices(points: ArrayLike) -> tuple[Real, Real]:
    """Return the vertices (s, 2) of a path, and the fractions of its length there."""
    pins = np.asarray(points, dtype=np.float64)
    if pins.ndim != 2 or pins.shape[1] != 2 or not len(pins) or not np.all(np.isfinite(pins)):
        raise ValueError(f"points, shape {pins.shape}: must be finite and of shape (s, 2), s >= 1")
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(pins, axis=0).T))])
    return pins, np.asarray(way / (way[-1] or 1.0))
