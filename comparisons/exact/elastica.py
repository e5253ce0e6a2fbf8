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
from scipy.special import elliprd, elliprf

from comparisons.exact.checks import require_positive
from comparisons.exact.contact import Cantilever
from comparisons.exact.follow import Event, Standing
from comparisons.exact.outcome import Outcome
from comparisons.exact.rod import RodPath, collect, fractions
from comparisons.exact.section import Flexibility

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
    """

    outcome: Outcome
    tangent_angle: float
    arc_position: float
    magnitude: float
    force: Array
    clamp_moment: float
    tip: Array


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
    )


def elastica_along(points: ArrayLike, *, EI: float = 1.0, length: float = 1.0) -> RodPath:
    """Equilibria of the elastica at the vertices (s, 2) of a pin's path; a pin that has slipped off stays off above the straight beam.

    They are those of a rod without stretch and shear, whose contact has the force, the place and the clamp moment of `ElasticaState`.
    The slip-off is at the first vertex at which the pin has left the beam.
    """
    pins, path, events = np.asarray(points, dtype=np.float64), list[Standing](), tuple[Event, ...]()
    rod = Cantilever(flexibility=Flexibility(stretch=0.0, shear=0.0), face=0.0, radius=0.0, friction=0.0)
    t, outcome = fractions(pins), Outcome.OPEN
    for when, (x, y) in zip(t, pins, strict=True):
        before, state = outcome, elastica_under_pin(float(x), float(y), EI=EI, length=length)
        if y <= 0.0 or before is not Outcome.SLIPPED:
            outcome = state.outcome
        if outcome is Outcome.SLIPPED and outcome is not before:
            events += (
                Event(
                    load_parameter=float(when), before=before, after=outcome, arc_position=1.0, magnitude=0.0
                ),
            )
        z = (
            np.array(
                [*state.force * length**2, -state.clamp_moment * length, state.arc_position * EI / length]
            )
            / EI
        )
        path.append(Standing(state=outcome, z=z, events=events))
    return collect(rod, path, t, EI=EI, length=length)
