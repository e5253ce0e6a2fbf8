"""The elastica, an inextensible, shear-rigid cantilever, in closed form.

The clamp is at the origin and the undeformed beam lies along +x. A frictionless pin below it pushes to +y. The part between
clamp and pin carries the constant force `F (-sin tc, cos tc)`, normal to the tangent at the pin. The tail beyond the pin is
straight. With `u = tc - theta` the first integral of the moment equation is `EI theta'^2 = 2 F sin u`. With
`lam = sqrt(EI / 2F)` it follows

    I0 = int_0^tc du/sqrt(sin u),   I1 = int_0^tc cos u/sqrt(sin u) du = 2 sqrt(sin tc),   I2 = int_0^tc sqrt(sin u) du
    s = lam I0,   x = lam (cos tc I1 + sin tc I2),   y = lam (sin tc I1 - cos tc I2)

so that the polar angle of the pin is `tc - arctan(I2/I1)`. It grows with `tc` up to the fold at `fold_angle()`, where the pin
is a little behind the clamp. The branch below the fold starts at the straight beam.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.special import ellipj, elliprd, elliprf

from comparisons.exact.checks import require_positive
from comparisons.exact.outcome import Outcome

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ElasticaState:
    """Equilibrium of the elastica under a pin.

    Attributes
    ----------
    outcome : Outcome
        State of contact. Without contact the beam is straight and all forces are zero; without an equilibrium that is connected with it, `LOST`, as well.
    tangent_angle : float
        Angle `tc` of the tangent at the pin and of the tail [rad].
    arc_position : float
        Distance `s` of the pin from the clamp along the axis; nan without contact.
    magnitude : float
        Contact force `F >= 0`.
    force : ndarray, shape (2,)
        Force of the pin on the beam.
    clamp_moment : float
        Moment of the clamp on the beam, anticlockwise positive: `-(r x force)`.
    tip : ndarray, shape (2,)
        Position of the free tip.
    length : float
        Length of the beam.
    """

    outcome: Outcome
    tangent_angle: float
    arc_position: float
    magnitude: float
    force: Array
    clamp_moment: float
    tip: Array
    length: float

    def shape(self, n: int) -> Array:
        """Points of the axis at `n` equal distances from the clamp to the tip.

        Between clamp and pin `sqrt(sin u)` is the lemniscate sine of `(s - arc)/(2 lam)`.

        Returns
        -------
        ndarray, shape (n, 2)
        """
        arc = np.linspace(0.0, self.length, n)
        if self.magnitude == 0.0:
            return np.stack([arc, np.zeros(n)], axis=1)
        tc, lam = self.tangent_angle, self.arc_position / _integrals(self.tangent_angle)[0]
        from_pin = np.maximum(self.arc_position - arc, 0.0)
        sn, cn, dn, _ = ellipj(from_pin / (np.sqrt(2.0) * lam), 0.5)
        u = np.arctan2((sn / dn) ** 2 / 2.0, cn / dn**2)
        tail = np.maximum(arc - self.arc_position, 0.0)
        tangent = np.array([np.cos(tc), np.sin(tc)])
        pin = self.tip - (self.length - self.arc_position) * tangent
        return np.asarray(pin + np.outer(tail, tangent) - lam * _chord(tc, u), dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class ElasticaPath:
    """Equilibria at `s` positions of a pin; the arrays have the states' values, see `ElasticaState`.

    `load_parameter` (s,) is the fraction of the path's length, `slip_off` that of the first position at which the pin has left the beam
    over its tip, or nan. There are no iterations.
    """

    states: tuple[ElasticaState, ...]
    load_parameter: Array
    outcome: tuple[Outcome, ...]
    force: Array
    arc_position: Array
    clamp_moment: Array
    tip: Array
    iterations: NDArray[np.int64]
    slip_off: float

    def shape(self, k: int, n: int) -> Array:
        """Points (n, 2) of the axis at a position."""
        return self.states[k].shape(n)


def _integrals(u: NDArray[np.float64] | float) -> tuple[Array, Array, Array]:
    """Return `I0, I1, I2` for `0 <= u <= pi` by Carlson's symmetric elliptic integrals of `z = sqrt(sin u)`."""
    sine = np.abs(np.sin(u))
    below = np.cos(u) ** 2 / (1.0 + sine)
    z = np.sqrt(sine)
    first, second = (
        2.0 * z * elliprf(below, 1.0 + sine, 1.0),
        2.0 / 3.0 * z**3 * elliprd(below, 1.0 + sine, 1.0),
    )
    whole_first, whole_second = 4.0 * elliprf(0.0, 2.0, 1.0), 4.0 / 3.0 * elliprd(0.0, 2.0, 1.0)
    beyond = np.asarray(u) > np.pi / 2
    return (
        np.where(beyond, whole_first - first, first),
        2.0 * z,
        np.where(beyond, whole_second - second, second),
    )


def _chord(tc: float, u: NDArray[np.float64] | float) -> Array:
    """Vector (..., 2) from the point with `theta = tc - u` to the pin, in units of `lam`."""
    _, I1, I2 = _integrals(u)
    c, s = np.cos(tc), np.sin(tc)
    return np.stack([c * I1 + s * I2, s * I1 - c * I2], axis=-1)


def _polar_angle(tc: float) -> float:
    """Polar angle of the pin seen from the clamp."""
    _, I1, I2 = _integrals(tc)
    return tc - float(np.arctan2(I2, I1))


@cache
def fold_angle() -> float:
    """Tangent angle `tc` of the largest polar angle of the pin, at the end of the branch from the straight beam.

    Root of `1 + 2 k^2 + k cot tc = 0` with `k = I2/I1`, where the derivative of `tc - arctan k` vanishes.

    Examples
    --------
    >>> round(fold_angle(), 9)
    2.983418482
    """

    def slope(tc: float) -> float:
        _, I1, I2 = _integrals(tc)
        k = float(I2 / I1)
        return float(1.0 + 2.0 * k**2 + k / np.tan(tc))

    return float(brentq(slope, 2.0, 3.1, xtol=1e-15))


def _straight(outcome: Outcome, length: float, arc_position: float = np.nan) -> ElasticaState:
    """Return the beam without load."""
    return ElasticaState(
        outcome=outcome,
        tangent_angle=0.0,
        arc_position=arc_position,
        magnitude=0.0,
        force=np.zeros(2),
        clamp_moment=0.0,
        tip=np.array([length, 0.0]),
        length=length,
    )


def elastica_under_pin(x: float, y: float, *, EI: float = 1.0, length: float = 1.0) -> ElasticaState:
    """Equilibrium of the elastica under a frictionless pin at `(x, y)`.

    The state is on the branch from the straight beam, `0 < tc < fold_angle()`, on which `y/x` increases. It depends only on
    the position of the pin. A pin that has never touched the beam is `SLIPPED` too if it is beyond the tip.

    Parameters
    ----------
    x, y : float
        Position of the pin. On the straight beam it is in contact without force.
    EI, length : float
        Bending stiffness and length.

    Returns
    -------
    ElasticaState
        With outcome `CONTACT`, `OPEN` (below the straight beam), `SLIPPED` (`s > length`) or `LOST` (beyond the fold).

    Raises
    ------
    ValueError
        If a number is not finite, or `EI` or `length` is not positive.

    Examples
    --------
    >>> state = elastica_under_pin(0.0, 2 / np.pi)
    >>> round(state.magnitude, 12), round(state.arc_position, 12), round(state.clamp_moment, 12)
    (8.182128140184, 0.89572169201, -3.14159265359)
    """
    require_positive(EI=EI, length=length)
    for name, value in (("x", x), ("y", y)):
        if not np.isfinite(value):
            raise ValueError(f"{name} = {value}: must be finite")
    if y == 0.0 and 0.0 < x <= length:
        return _straight(Outcome.CONTACT, length, x)
    if y <= 0.0:
        return _straight(Outcome.OPEN, length)
    polar, fold = float(np.arctan2(y, x)), fold_angle()
    if polar >= _polar_angle(fold):
        return _straight(Outcome.LOST, length)
    tc = float(brentq(lambda angle: _polar_angle(angle) - polar, polar, fold, xtol=1e-300, rtol=1e-15))
    I0, I1, I2 = map(float, _integrals(tc))
    lam = float(np.hypot(x, y)) / float(np.hypot(I1, I2))
    s = lam * I0
    if s > length:
        return _straight(Outcome.SLIPPED, length)
    tangent, normal = np.array([np.cos(tc), np.sin(tc)]), np.array([-np.sin(tc), np.cos(tc)])
    F = EI / (2.0 * lam**2)
    return ElasticaState(
        outcome=Outcome.CONTACT,
        tangent_angle=tc,
        arc_position=s,
        magnitude=F,
        force=F * normal,
        clamp_moment=-F * lam * I1,
        tip=np.array([x, y]) + (length - s) * tangent,
        length=length,
    )


def elastica_along(points: ArrayLike, *, EI: float = 1.0, length: float = 1.0) -> ElasticaPath:
    """Equilibria of the elastica at the vertices (s, 2) of a pin's path; a pin that has slipped off stays off above the straight beam."""
    pins, states = np.asarray(points, dtype=np.float64), list[ElasticaState]()
    for x, y in pins:
        left = y > 0.0 and states and states[-1].outcome is Outcome.SLIPPED
        states.append(states[-1] if left else elastica_under_pin(float(x), float(y), EI=EI, length=length))
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(pins, axis=0).T))])
    t, slipped = way / (way[-1] or 1.0), [state.outcome is Outcome.SLIPPED for state in states]
    return ElasticaPath(
        states=tuple(states),
        load_parameter=t,
        outcome=tuple(state.outcome for state in states),
        force=np.array([state.force for state in states]),
        arc_position=np.array([state.arc_position for state in states]),
        clamp_moment=np.array([state.clamp_moment for state in states]),
        tip=np.array([state.tip for state in states]),
        iterations=np.zeros(len(states), dtype=np.int64),
        slip_off=float(t[slipped.index(True)]) if any(slipped) else np.nan,
    )
