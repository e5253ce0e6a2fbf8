"""A Reissner rod under a pin that moves along a path, without or with Coulomb friction.

The clamp is at the origin and the undeformed rod lies along +x. A pin below it pushes to +y.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.checks import require_not_negative, require_positive
from comparisons.exact.contact import Cantilever
from comparisons.exact.follow import Event, Standing, follow
from comparisons.exact.outcome import Outcome
from comparisons.exact.section import Flexibility

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class RodPath:
    """States of the rod at `s` positions of the pin.

    Without contact the rod is straight, `arc_position` is nan and the forces are zero. Where the path has ended (`Outcome.ends`) all
    arrays are nan.

    Attributes
    ----------
    load_parameter : ndarray, shape (s,)
        Fraction of the length of the pin's path.
    outcome : tuple of Outcome
        State of contact at every position. At an event it is the state after the event.
    force : ndarray, shape (s, 2)
        Force of the pin on the rod.
    tangential, normal : ndarray, shape (s,)
        Component of the force along the mean tangent towards the tip, and its component away from the pin.
    arc_position : ndarray, shape (s,)
        Distance of the contact from the clamp along the undeformed axis.
    clamp_moment : ndarray, shape (s,)
        Moment of the clamp on the rod, anticlockwise positive; the force of the clamp is that of the pin, reversed.
    tip : ndarray, shape (s, 2)
        Position of the free tip.
    work, dissipated : ndarray, shape (s,)
        Work of the pin since the start, and energy lost in slip, the integral of `mu F_n |v|`; zero without friction.
    stored, released : ndarray, shape (s,)
        Strain energy, and strain energy lost where the pin leaves the rod over its tip.
    iterations : ndarray of int, shape (s,)
        Newton iterations since the previous position, including rejected steps.
    events : tuple of Event
        Changes of state in the order of the load parameter.
    unknowns : ndarray, shape (s, 4)
        Unknowns of `rod`, `comparisons.exact.contact.Cantilever`.
    length : float
        Undeformed length.
    """

    load_parameter: Array
    outcome: tuple[Outcome, ...]
    force: Array
    tangential: Array
    normal: Array
    arc_position: Array
    clamp_moment: Array
    tip: Array
    work: Array
    dissipated: Array
    stored: Array
    released: Array
    iterations: NDArray[np.int64]
    events: tuple[Event, ...]
    unknowns: Array
    rod: Cantilever
    length: float

    @property
    def magnitude(self) -> Array:
        """Contact force, shape (s,)."""
        return np.asarray(np.hypot(*self.force.T))

    @property
    def slip_off(self) -> float:
        """Fraction of the path's length at which the pin first leaves the rod over its tip; nan without slip-off."""
        return next((item.load_parameter for item in self.events if item.after is Outcome.SLIPPED), np.nan)

    def shape(self, k: int, n: int) -> Array:
        """Position and rotation `x, y, theta` at `n` equal distances along the undeformed axis from the clamp to the tip.

        Returns
        -------
        ndarray, shape (n, 3)
        """
        return _axis(self.rod, self.outcome[k], self.unknowns[k], np.linspace(0.0, 1.0, n)) * [
            self.length,
            self.length,
            1.0,
        ]


def _axis(rod: Cantilever, outcome: Outcome, z: Array, arcs: Array) -> Array:
    """Position and rotation (n, 3) at arc positions (n,) of a rod of length 1; behind the contact it is straight."""
    if not outcome.touches:
        return np.outer(np.full(len(arcs), np.nan) if outcome.ends else arcs, [1.0, 0.0, 0.0])
    s = z[3]
    part = rod.sections(z, np.minimum(arcs, s) / s)
    tail = np.maximum(arcs - s, 0.0)
    return np.column_stack(
        [part.x + tail * np.cos(part.theta), part.y + tail * np.sin(part.theta), part.theta]
    )


def rod_under_pin(
    points: ArrayLike,
    *,
    EA: float,
    GA: float,
    EI: float,
    length: float,
    friction: float = 0.0,
    offset: float = 0.0,
    radius: float = 0.0,
) -> RodPath:
    """Equilibrium of a clamped Reissner rod under a pin at every vertex of the pin's path.

    Parameters
    ----------
    points : array_like, shape (s, 2)
        Vertices of the path of the pin's centre, joined by straight lines. The first is the start of the pin and must not be inside or
        above the rod.
    EA, GA : float
        Stretch stiffness and shear stiffness `GA_e`; `inf` is rigid.
    EI : float
        Bending stiffness.
    length : float
        Undeformed length.
    friction : float
        Coefficient of friction mu.
    offset : float
        Distance of the rod's face from its axis, half the height; zero for contact with the axis.
    radius : float
        Radius of the pin, which does not turn; zero is a sharp one.

    Returns
    -------
    RodPath

    Raises
    ------
    ValueError
        If a stiffness or the length is not positive, another number is negative, the path is not finite, or its start is not outside the
        rod.

    Examples
    --------
    >>> path = rod_under_pin([[1.0, 0.0], [0.0, 2 / np.pi]], EA=np.inf, GA=np.inf, EI=1.0, length=1.0)
    >>> round(float(path.magnitude[1]), 12), round(float(path.arc_position[1]), 12)
    (8.182128140184, 0.89572169201)
    >>> path = rod_under_pin([[1.0, 0.0], [0.0, 2 / np.pi]], EA=3e4, GA=1e4, EI=1.0, length=1.0, friction=0.3)
    >>> [event.after.value for event in path.events]
    ['slip to clamp', 'stick', 'slip to tip']
    """
    require_positive(EI=EI, length=length)
    require_positive(infinite=True, EA=EA, GA=GA)
    require_not_negative(friction=friction, offset=offset, radius=radius)
    pins = vertices(points)
    unit = EI / length**2
    rod = Cantilever(
        flexibility=Flexibility(stretch=unit / EA, shear=unit / GA),
        face=offset / length,
        radius=radius / length,
        friction=friction,
    )
    path = follow(rod, pins / length, fractions(pins))
    return collect(rod, list(path), EI=EI, length=length)


def vertices(points: ArrayLike) -> Array:
    """Return the vertices (s, 2) of a path."""
    pins = np.asarray(points, dtype=np.float64)
    if pins.ndim != 2 or pins.shape[1] != 2 or not len(pins) or not np.all(np.isfinite(pins)):
        raise ValueError(f"points, shape {pins.shape}: must be finite and of shape (s, 2), s >= 1")
    return pins


def fractions(points: Array) -> Array:
    """Fractions of a path's length at its vertices."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    return np.asarray(way / (way[-1] or 1.0))


def collect(rod: Cantilever, path: list[Standing], *, EI: float, length: float) -> RodPath:
    """Return the states in the units of the input."""
    unit, energy = EI / length**2, EI / length
    outcome = tuple(one.state for one in path)
    touches = np.array([state.touches for state in outcome])
    lost = np.where([state.ends for state in outcome], np.nan, 0.0)
    z = np.where(touches[:, None], [one.z for one in path], [0.0, 0.0, 0.0, 1.0])
    contact = rod.contact(z, np.zeros(2))

    def column(name: str) -> Array:
        return energy * (np.array([getattr(one, name) for one in path]) + lost)

    return RodPath(
        load_parameter=np.array([one.t for one in path]),
        outcome=outcome,
        force=unit * (z[:, :2] + lost[:, None]),
        tangential=unit * (contact.tangential + lost),
        normal=unit * (contact.normal + lost),
        arc_position=length * np.where(touches, z[:, 3], np.nan),
        clamp_moment=-energy * (z[:, 2] + lost),
        tip=length * np.array([_axis(rod, *one, np.ones(1))[0, :2] for one in zip(outcome, z, strict=True)]),
        work=column("work"),
        dissipated=column("dissipated"),
        stored=energy * (np.array([rod.energy(row) for row in z]) + lost),
        released=column("released"),
        iterations=np.diff([one.iterations for one in path], prepend=0),
        events=tuple(
            replace(event, arc_position=length * event.arc_position, magnitude=unit * event.magnitude)
            for event in path[-1].events
        ),
        unknowns=z,
        rod=rod,
        length=length,
    )
