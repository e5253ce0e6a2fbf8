"""The elastica, an inextensible, shear-rigid cantilever, in closed form.

The clamp is at the origin and the undeformed beam lies along +x. A frictionless pin below it pushes to +y. The part between
clamp and pin carries the constant force `F (-sin tc, cos tc)`, normal to the tangent at the pin. The tail beyond the pin is
straight. With `u = tc - theta` the first integral of the moment equation is `EI theta'^2 = 2 F sin u`. With
`lam = sqrt(EI / 2F)` it follows

    I0 = int_0^tc du/sqrt(sin u),   I1 = int_0^tc cos u/sqrt(sin u) du = 2 sqrt(sin tc),   I2 = int_0^tc sqrt(sin u) du
    s = lam I0,   x = lam (cos tc I1 + sin tc I2),   y = lam (sin tc I1 - cos tc I2)

so that the polar angle of the pin is `tc - arctan(I2/I1)`. It grows with `tc` up to the fold at `FOLD`, where the pin
is a little behind the clamp. The branch below the fold starts at the straight beam.
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import beta, betainc

from comparisons.exact.contact import Cantilever, Real
from comparisons.exact.path import Change, Outcome, RodPath, Row, collected, require, vertices
from comparisons.exact.section import Flexibility

FOLD = 2.9834184819066856
"""Tangent angle `tc` of the largest polar angle of the pin, at the end of the branch from the straight beam: the root of
`1 + 2 k^2 + k cot tc = 0` with `k = I2/I1`, where the derivative of `tc - arctan k` vanishes."""


def _integrals(u: Real | float) -> tuple[Real, Real, Real]:
    """Return `I0, I1, I2` for `0 <= u <= pi` by incomplete beta functions of `sin^2(u/2)`."""
    half, sine = np.sin(np.asarray(u) / 2.0) ** 2, np.abs(np.sin(u))
    first, second = (beta(a, a) * betainc(a, a, half) for a in (0.25, 0.75))
    return first / np.sqrt(2.0), 2.0 * np.sqrt(sine), second * np.sqrt(2.0)


def _polar_angle(tc: float) -> float:
    """Polar angle of the pin seen from the clamp, `tc - arctan k`; its derivative vanishes at `FOLD`.

    >>> _, I1, I2 = _integrals(FOLD)
    >>> bool(abs(1.0 + 2.0 * (I2 / I1) ** 2 + I2 / I1 / np.tan(FOLD)) < 1e-12)
    True
    """
    _, I1, I2 = _integrals(tc)
    return tc - float(np.arctan2(I2, I1))


def _state(x: float, y: float) -> tuple[Outcome, Real]:
    """State of contact with a pin at a place, where EI = L = 1, and force, moment at the clamp and arc position."""
    if y <= 0.0:
        touches = y == 0.0 and 0.0 < x <= 1.0
        return Outcome.CONTACT if touches else Outcome.OPEN, np.array([0.0, 0.0, 0.0, x])
    polar = float(np.arctan2(y, x))
    if polar >= _polar_angle(FOLD):
        return Outcome.LOST, np.full(4, np.nan)
    tc = float(brentq(lambda angle: _polar_angle(angle) - polar, polar, FOLD, xtol=1e-300, rtol=1e-15))
    I0, I1, I2 = map(float, _integrals(tc))
    lam = float(np.hypot(x, y)) / float(np.hypot(I1, I2))
    F, s = 1.0 / (2.0 * lam**2), lam * I0
    outcome = Outcome.CONTACT if s <= 1.0 else Outcome.SLIPPED
    return outcome, np.array([-F * np.sin(tc), F * np.cos(tc), F * lam * I1, s])


def elastica_under_pin(points: ArrayLike, *, EI: float = 1.0, length: float = 1.0) -> RodPath:
    """Equilibrium of the elastica under a frictionless pin at every vertex of the pin's path.

    The states are on the branch from the straight beam, `0 < tc < FOLD`, on which `y/x` increases. They depend only on the
    position of the pin, except that a pin which has left the beam stays off it while it is above the straight beam. A pin that has never
    touched the beam is `SLIPPED` too if it is beyond the tip.

    Parameters
    ----------
    points : array_like, shape (s, 2)
        Positions of the pin. On the straight beam it is in contact without force.
    EI, length : float
        Bending stiffness and length.

    Returns
    -------
    RodPath
        A rod without stretch and shear, with outcome `CONTACT`, `OPEN` (below the straight beam), `SLIPPED` (`s > length`, first seen at
        a vertex) or `LOST` (beyond the fold).

    Raises
    ------
    ValueError
        If the path is not finite, or `EI` or `length` is not positive.

    Examples
    --------
    >>> path = elastica_under_pin([(0.0, 2 / np.pi)])
    >>> [round(float(value[0]), 12) for value in (path.magnitude, path.arc_position, path.clamp_moment)]
    [8.182128140184, 0.89572169201, -3.14159265359]
    """
    require("positive and finite", EI=EI, length=length)
    pins, times = vertices(points)
    rows, changes, before = list[Row](), list[Change](), Outcome.OPEN
    for t, (x, y) in zip(times.tolist(), (pins / length).tolist(), strict=True):
        state, z = _state(x, y)
        if before is Outcome.SLIPPED and y > 0.0:
            state = before
        if state is not before:
            changes.append((t, before, state, z))
        rows.append(Row(t, state, z))
        before = state
    return collected(Cantilever(flexibility=Flexibility(0.0, 0.0)), rows, changes, EI, length)
