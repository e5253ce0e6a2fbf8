"""A Reissner rod under a pin that moves along a path.

The clamp is at the origin and the undeformed rod lies along +x. A frictionless pin below it pushes to +y.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.checks import path_points, require_positive, require_stiffness
from comparisons.exact.outcome import Outcome
from comparisons.exact.path_following import Rod, State, advance, first_state
from comparisons.exact.reissner import COMPLEX_STEP, Flexibility, loaded_part, normal, position

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class RodPath:
    """States of the rod at `s` positions of the pin.

    Without contact the rod is straight, `arc_position` is nan and all other arrays are zero. Without equilibrium
    (`Outcome.LOST`) all arrays are nan.

    Attributes
    ----------
    outcome : tuple of Outcome
        Contact state at every position.
    force : ndarray, shape (s, 2)
        Force of the pin on the rod.
    magnitude : ndarray, shape (s,)
        Contact force `F >= 0`.
    arc_position : ndarray, shape (s,)
        Distance of the contact from the clamp along the undeformed axis.
    clamp_force : ndarray, shape (s, 2)
        Force of the clamp on the rod.
    clamp_moment : ndarray, shape (s,)
        Moment of the clamp on the rod, anticlockwise positive.
    tip : ndarray, shape (s, 2)
        Position of the free tip.
    tip_rotation : ndarray, shape (s,)
        Rotation of the section at the tip [rad].
    iterations : ndarray of int, shape (s,)
        Newton iterations since the previous position, including rejected steps.
    slip_off : float
        Fraction of the path's length at which the pin first leaves the rod over its tip; nan without slip-off.
    unknowns : ndarray, shape (s, 2)
        `(q, ell / length)` of `comparisons.exact.reissner`.
    flexibility : Flexibility
        Flexibility of the rod.
    length : float
        Undeformed length.
    """

    outcome: tuple[Outcome, ...]
    force: Array
    magnitude: Array
    arc_position: Array
    clamp_force: Array
    clamp_moment: Array
    tip: Array
    tip_rotation: Array
    iterations: NDArray[np.int64]
    slip_off: float
    unknowns: Array
    flexibility: Flexibility
    length: float

    def shape(self, k: int, n: int) -> Array:
        """Position and rotation `x, y, theta` at `n` equal distances along the undeformed axis from the clamp to the tip.

        Returns
        -------
        ndarray, shape (n, 3)
        """
        arc = np.linspace(0.0, 1.0, n)
        straight = np.stack([self.length * arc, np.zeros(n), np.zeros(n)], axis=1)
        if self.outcome[k] is not Outcome.CONTACT:
            return straight if self.outcome[k] is not Outcome.LOST else np.full((n, 3), np.nan)
        q, ell = self.unknowns[k]
        whole = loaded_part(q, ell, self.flexibility)
        s = whole.arc.real
        fraction = _fraction_at(np.maximum(s - arc, 0.0) / s, q, ell, self.flexibility)
        part = loaded_part(q, ell, self.flexibility, fraction)
        theta = (whole.direction - part.lag).real
        end = theta[-1]
        tail = np.outer(np.maximum(arc - s, 0.0), [np.cos(end), np.sin(end)])
        points = (position(whole) - position(part)).real + tail
        return np.column_stack([self.length * points, theta])


def _fraction_at(share: Array, q: float, ell: float, flexibility: Flexibility) -> Array:
    """Return the fraction of `psi` at which the part from the pin has a share of the whole loaded arc."""
    whole = loaded_part(q, ell, flexibility).arc.real
    fraction = share.copy()
    for _ in range(50):
        arc = loaded_part(q, ell, flexibility, fraction + 1j * COMPLEX_STEP).arc
        change = (share * whole - arc.real) * COMPLEX_STEP / arc.imag
        fraction = fraction + change
        if np.max(np.abs(change)) < 1e-9:
            break
    return fraction


def rod_under_pin(
    points: ArrayLike, *, EA: float, GA: float, EI: float, length: float, offset: float = 0.0
) -> RodPath:
    """Equilibrium of a clamped Reissner rod under a frictionless pin at every vertex of the pin's path.

    Parameters
    ----------
    points : array_like, shape (s, 2)
        Vertices of the path, joined by straight lines. The first is the start of the pin and must not be inside or above
        the rod.
    EA, GA : float
        Stretch stiffness and shear stiffness `GA_e`; `inf` is rigid.
    EI : float
        Bending stiffness.
    length : float
        Undeformed length.
    offset : float
        Distance of the pin from the axis, along the contact force (half the height for contact with the surface).

    Returns
    -------
    RodPath

    Raises
    ------
    ValueError
        If a stiffness or the length is not positive, the path is not finite, or its start is not outside the rod.

    Examples
    --------
    >>> path = rod_under_pin([[1.0, 0.0], [0.0, 2 / np.pi]], EA=np.inf, GA=np.inf, EI=1.0, length=1.0)
    >>> round(float(path.magnitude[1]), 12), round(float(path.arc_position[1]), 12)
    (8.182128140184, 0.89572169201)
    """
    require_positive(EI=EI, length=length)
    require_stiffness(EA=EA, GA=GA)
    if not (np.isfinite(offset) and offset >= 0.0):
        raise ValueError(f"offset = {offset}: must be finite and not negative")
    flexibility = Flexibility(stretch=EI / length**2 / EA, shear=EI / length**2 / GA)
    rod = Rod(flexibility, offset / length)
    pins = path_points(points) / length
    distance = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(pins, axis=0).T))])
    states, iterations, slip_off = [first_state(rod, pins[0])], [0], np.nan
    for k, (start, end) in enumerate(pairwise(pins)):
        state, spent, slip = advance(rod, states[-1], start, end)
        states.append(state)
        iterations.append(spent)
        if not np.isnan(slip) and np.isnan(slip_off):
            slip_off = float((distance[k] + slip * (distance[k + 1] - distance[k])) / distance[-1])
    return _collect(states, iterations, slip_off, flexibility, EI, length)


def _collect(
    states: list[State],
    iterations: list[int],
    slip_off: float,
    flexibility: Flexibility,
    EI: float,
    length: float,
) -> RodPath:
    """Return the path in the units of the input."""
    outcome = tuple(state.outcome for state in states)
    z = np.array([state.unknowns for state in states])
    contact = np.array([item is Outcome.CONTACT for item in outcome])
    free = np.where([item is Outcome.LOST for item in outcome], np.nan, 0.0)
    q, ell = np.where(contact[:, None], z, [0.0, 1.0]).T
    part = loaded_part(q, ell, flexibility)
    arc = np.where(contact, part.arc.real, np.nan)
    rotation = np.where(contact, (part.direction - part.slip).real, free)
    magnitude = np.where(contact, np.maximum(part.force.real, 0.0) * EI / length**2, free)
    force = magnitude[:, None] * normal(part).real
    tail = (1.0 - arc)[:, None] * np.stack([np.cos(rotation), np.sin(rotation)], axis=1)
    straight = np.stack([1.0 + free, free], axis=1)
    return RodPath(
        outcome=outcome,
        force=force,
        magnitude=magnitude,
        arc_position=length * arc,
        clamp_force=-force,
        clamp_moment=np.where(contact, -(part.force * part.along).real * EI / length, free),
        tip=length * np.where(contact[:, None], position(part).real + tail, straight),
        tip_rotation=rotation,
        iterations=np.array(iterations, dtype=np.int64),
        slip_off=slip_off,
        unknowns=z,
        flexibility=flexibility,
        length=length,
    )
