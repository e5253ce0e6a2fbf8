"""The elastica, an inextensible, shear-rigid cantilever, under a pin with Coulomb friction, by its first integral.

The clamp is at the origin and the undeformed beam lies along +x. Between clamp and pin the beam carries the constant force
`F (-sin beta, cos beta)`, which makes the angle `wc = beta - tc` with the normal at the pin, where the tangent has the angle tc.
Hence `F_t = -F sin wc` and `F_n = F cos wc`, and in slip `wc = -sigma atan mu`. The tail is straight. With `u = tc - theta`

    EI theta'^2 = 2 F (sin(u + wc) - sin wc),   lam = sqrt(EI/2F)
    s, x, y = lam int_0^tc {1, cos, sin}(tc - u) du / sqrt(sin(u + wc) - sin wc)

The substitution `u = A sin^2(psi/2)`, `A = pi - 2 wc`, makes the integrands analytic as in `comparisons.exact.reissner`. The
unknowns are `q = psi(clamp)^2`, `ell = lam psi(clamp)` and wc.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from comparisons.exact.checks import require_positive
from comparisons.exact.elastica import LimitPoint
from comparisons.exact.friction_law import Array, Contact, Observed, Real
from comparisons.exact.friction_path import follow, require_friction
from comparisons.exact.friction_result import FrictionPath
from comparisons.exact.reissner import COMPLEX_STEP, sinc

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(40)
_GAUSS, _WEIGHTS = (_GAUSS + 1.0) / 2.0, _WEIGHTS / 2.0


class LoadedElastica(NamedTuple):
    """Force, tangent angle at the pin, arc position, position x, y of the pin, and stored energy; arrays (...)."""

    force: Array
    angle: Array
    arc: Array
    x: Array
    y: Array
    energy: Array


def loaded_elastica(q: Array, ell: Array, wc: Array) -> LoadedElastica:
    """Integrate from the pin to the clamp at unknowns (...), which may be complex, `EI = 1`."""
    q, ell, wc = (np.asarray(value, dtype=np.complex128)[..., None] for value in (q, ell, wc))
    A, psi, force = np.pi - 2.0 * wc, np.sqrt(q) * _GAUSS, q / (2.0 * ell**2)
    lower, upper = A * np.sin(psi / 2.0) ** 2 / 2.0, A * np.cos(psi / 2.0) ** 2 / 2.0
    rate = np.sqrt(2.0) * ell * _WEIGHTS / np.sqrt(sinc(lower) * sinc(upper))
    angle = A * np.sin(np.sqrt(q) / 2.0) ** 2
    theta = angle - 2.0 * lower
    energy = force * 2.0 * np.sin(lower) * np.sin(upper)
    return LoadedElastica(
        force=force[..., 0],
        angle=angle[..., 0],
        arc=rate.sum(axis=-1),
        x=(rate * np.cos(theta)).sum(axis=-1),
        y=(rate * np.sin(theta)).sum(axis=-1),
        energy=(rate * energy).sum(axis=-1),
    )


@dataclass(frozen=True, kw_only=True)
class ElasticaEquations:
    """Equations of the elastica; a pin on its left, side -1, is the mirror image."""

    side: int
    reach: float = 0.0

    def contact(self, z: Array, pin: Real) -> Contact:
        """Residual and quantities of the contact at unknowns (..., 3)."""
        q, ell, wc = np.moveaxis(z, -1, 0)
        part = loaded_elastica(q, ell, wc)
        beta = part.angle + wc
        return Contact(
            residual=np.stack([part.x - pin[0], self.side * part.y - pin[1]], axis=-1),
            cone=np.stack([-np.sin(wc), np.cos(wc)], axis=-1),
            force=part.force[..., None] * np.stack([-np.sin(beta), self.side * np.cos(beta)], axis=-1),
            tangential=-part.force * np.sin(wc),
            normal=part.force * np.cos(wc),
            arc=part.arc,
            factor=np.ones_like(part.arc),
            roll=np.zeros_like(part.arc),
        )

    def exists(self, z: Real) -> bool:
        """Whether the curve has a length, no more than one inflection, and a force that is not a pull."""
        q, ell, wc = z
        return bool(abs(q) < 4.0 * np.pi**2 and ell > 0.0 and abs(wc) < np.pi / 2.0)

    def touching(self, x: float, sense: int, friction: float) -> Real:
        """Unknowns (3,) of the straight beam with a pin at x that slips in a sense."""
        wc = -sense * np.arctan(friction)
        return np.array([0.0, x * np.sqrt(np.cos(wc) / (np.pi - 2.0 * wc)), wc])

    def observe(self, z: Real) -> Observed:
        """Force, clamp moment, stored energy, position and rotation at the pin."""
        part = LoadedElastica(*(value.real for value in loaded_elastica(*z)))
        beta = part.angle + z[2]
        force = part.force * np.array([-np.sin(beta), self.side * np.cos(beta)])
        x, y = float(part.x), float(self.side * part.y)
        return Observed(
            force=force,
            clamp_moment=float(y * force[0] - x * force[1]),
            energy=float(part.energy),
            position=np.array([x, y]),
            rotation=float(self.side * part.angle),
        )


def elastica_with_friction(
    points: ArrayLike, *, friction: float, EI: float = 1.0, length: float = 1.0
) -> FrictionPath:
    """Equilibrium of the elastica under a pin with Coulomb friction at every vertex of the pin's path.

    A pin that touches the straight beam slips, because the beam cannot stretch: in the sense of the pin's velocity along the
    beam, or towards the tip where the pin rises square to the beam.

    Parameters
    ----------
    points : array_like, shape (s, 2)
        Vertices of the path of the pin, joined by straight lines.
    friction : float
        Coefficient of friction mu.
    EI, length : float
        Bending stiffness and length.

    Returns
    -------
    FrictionPath

    Raises
    ------
    ValueError
        If a number is not positive, the friction is negative, or the path is not finite.

    Examples
    --------
    >>> path = elastica_with_friction([[1.0, 0.0], [0.0, 2 / np.pi]], friction=0.2)
    >>> round(float(path.magnitude[1]), 11), round(float(path.arc_position[1]), 12)
    (7.63911331058, 0.858197305534)
    """
    require_positive(EI=EI, length=length)
    return follow(lambda side: ElasticaEquations(side=side), points, friction, EI=EI, length=length)


class FrictionalLimit(NamedTuple):
    """Limit points of three-point bending while the beam is drawn in between the supports, and while it is pushed back."""

    drawn_in: LimitPoint
    pushed_back: LimitPoint


def frictional_three_point_limit(
    friction: float, *, half_span: float = 1.0, EI: float = 1.0
) -> FrictionalLimit:
    """Largest load V of one support of a long beam over two supports with friction, and the deflection at which it occurs.

    Each half is a cantilever under a pin at `half_span`. With `X = x/lam` and the direction beta of the force,
    `V = EI cos(beta) X^2 / (2 half_span^2)`. The beam slides over the supports from outside to inside while it is drawn in, so
    that there `wc = -atan mu`, and `wc = atan mu` while it is pushed back. The load at mid-span is `2 V`.

    Raises
    ------
    ValueError
        If the friction is negative, or `half_span` or `EI` is not positive.

    Examples
    --------
    >>> limit = frictional_three_point_limit(0.2)
    >>> round(limit.drawn_in.load, 12), round(limit.drawn_in.displacement, 9)
    (0.948651379547, 0.52208948)
    """
    require_friction(friction)
    require_positive(half_span=half_span, EI=EI)
    return FrictionalLimit(*(_limit(sign * np.arctan(friction), half_span, EI) for sign in (-1.0, 1.0)))


def _limit(wc: float, half_span: float, EI: float) -> LimitPoint:
    """Limit point at a constant angle between force and normal."""

    def load(q: complex) -> tuple[complex, complex]:
        part = loaded_elastica(np.asarray(q), np.asarray(1.0), np.asarray(wc))
        return complex(np.cos(part.angle + wc) * part.force * part.x**2), complex(part.y / part.x)

    q = float(brentq(lambda q: load(q + 1j * COMPLEX_STEP)[0].imag / COMPLEX_STEP, 1e-3, 2.0, xtol=1e-15))
    V, ratio = load(q)
    return LimitPoint(float(EI * V.real / half_span**2), float(half_span * ratio.real))
