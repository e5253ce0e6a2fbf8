"""A Reissner rod under a pin with Coulomb friction.

The clamp is at the origin and the undeformed rod lies along +x. The unknowns `(F_x, F_y, m_0, s)` are the force on the rod, the
moment of the section at the clamp and the arc position of the contact. Between clamp and contact the rod carries the constant
force F, at the contact the moment `side h F_t` of the friction on the face; the tail is free of load. Lengths are in units of
the rod's length L, forces in EI/L^2, moments in EI/L.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from comparisons.exact.checks import require_positive, require_stiffness
from comparisons.exact.friction_law import Array, Contact, Observed, Real
from comparisons.exact.friction_path import follow
from comparisons.exact.friction_result import FrictionPath
from comparisons.exact.reissner import Flexibility
from comparisons.exact.section import Section, integrate, tangent

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(30)
_GAUSS, _WEIGHTS = (_GAUSS + 1.0) / 2.0, _WEIGHTS / 2.0


@dataclass(frozen=True, kw_only=True)
class Surface:
    """Where a pin that does not turn touches a rod.

    Attributes
    ----------
    offset : float
        Distance of the rod's face from its axis, half the height; zero for contact with the axis [length].
    radius : float
        Radius of the pin; zero is a sharp one [length].

    Raises
    ------
    ValueError
        If a length is negative or not finite.
    """

    offset: float = 0.0
    radius: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("offset", self.offset), ("radius", self.radius)):
            if not (np.isfinite(value) and value >= 0.0):
                raise ValueError(f"{name} = {value}: must be finite and not negative")


@dataclass(frozen=True, kw_only=True)
class RodEquations:
    """Equations of the rod; `offset` and `radius` in lengths of the rod, `side` 1 for a pin on its right and -1 on its left."""

    flexibility: Flexibility
    offset: float
    radius: float
    side: int

    @property
    def reach(self) -> float:
        """Distance of the pin's centre from the axis."""
        return self.offset + self.radius

    def contact(self, z: Array, pin: Real) -> Contact:
        """Residual and quantities of the contact at unknowns (..., 4)."""
        Fx, Fy, moment, s = np.moveaxis(z, -1, 0)
        zero = np.zeros_like(s)
        end = integrate(Section(zero, zero, zero, moment), (Fx, Fy), s, self.flexibility)
        c, d = np.cos(end.theta), np.sin(end.theta)
        before = tangent(end.theta, (Fx, Fy), self.flexibility)
        bx, by = (before[0] + c) / 2.0, (before[1] + d) / 2.0
        a = np.sqrt(bx**2 + by**2)
        tx, ty = bx / a, by / a
        shear = np.arctan((by * c - bx * d) / (bx * c + by * d))
        tangential, normal = Fx * tx + Fy * ty, self.side * (Fy * tx - Fx * ty)
        couple, reach = self.side * self.offset * tangential, self.side * self.reach
        x, y = end.x + reach * ty - pin[0], end.y - reach * tx - pin[1]
        return Contact(
            residual=np.stack([x, y, end.moment - couple], axis=-1),
            cone=np.stack([tangential, normal], axis=-1),
            force=np.stack([Fx, Fy], axis=-1),
            tangential=tangential,
            normal=normal,
            arc=s,
            factor=a + self.side * self.offset * couple / 2.0,
            roll=self.side * (self.offset * shear + self.radius * (end.theta + shear)),
        )

    def exists(self, z: Real) -> bool:
        """Whether the contact is not behind the clamp."""
        return bool(z[3] > 0.0)

    def touching(self, x: float, sense: int, friction: float) -> Real:  # noqa: ARG002  the elastica's unknowns depend on them
        """Unknowns (4,) of the straight rod with a pin at x."""
        return np.array([0.0, 0.0, 0.0, x])

    def observe(self, z: Real) -> Observed:
        """Force, clamp moment, stored energy, position and rotation at the contact."""
        Fx, Fy, moment, s = z
        lengths, zero = s * np.append(_GAUSS, 1.0), np.zeros(len(_GAUSS) + 1)
        part = integrate(
            Section(zero, zero, zero, zero + moment), (zero + Fx, zero + Fy), lengths, self.flexibility
        )
        c, d = np.cos(part.theta), np.sin(part.theta)
        N, Q = Fx * c + Fy * d, Fy * c - Fx * d
        density = part.moment**2 + self.flexibility.stretch * N**2 + self.flexibility.shear * Q**2
        return Observed(
            force=np.array([Fx, Fy]),
            clamp_moment=-moment,
            energy=float(s * (_WEIGHTS @ density[:-1]) / 2.0),
            position=np.array([part.x[-1], part.y[-1]]),
            rotation=float(part.theta[-1]),
        )


def rod_with_friction(
    points: ArrayLike,
    *,
    friction: float,
    EA: float,
    GA: float,
    EI: float,
    length: float,
    surface: Surface | None = None,
    side: int | None = None,
) -> FrictionPath:
    """Equilibrium of a clamped Reissner rod under a pin with Coulomb friction at every vertex of the pin's path.

    Parameters
    ----------
    points : array_like, shape (s, 2)
        Vertices of the path of the pin's point or centre, joined by straight lines. The first must not be inside the rod.
        Without `side`, a path that starts below the rod, or on it and then rises, belongs to a pin on the right of the rod.
    friction : float
        Coefficient of friction mu.
    EA, GA : float
        Stretch stiffness and shear stiffness `GA_e`; `inf` is rigid. A rod that cannot stretch is `elastica_with_friction`.
    EI : float
        Bending stiffness.
    length : float
        Undeformed length.
    surface : Surface, optional
        Face of the rod and radius of the pin; a sharp pin on the axis by default.
    side : int, optional
        1 for a pin on the right of the rod, -1 on its left; by default the beginning of the path decides.

    Returns
    -------
    FrictionPath

    Raises
    ------
    ValueError
        If a stiffness or the length is not positive, the friction is negative, the path is not finite, or its start is
        inside the rod.

    Examples
    --------
    >>> path = rod_with_friction(
    ...     [[1.0, 0.0], [0.0, 2 / np.pi]], friction=0.3, EA=3e4, GA=1e4, EI=1.0, length=1.0
    ... )
    >>> [event.after.value for event in path.events]
    ['slip to clamp', 'stick', 'slip to tip']
    """
    require_positive(EI=EI, length=length)
    require_stiffness(EA=EA, GA=GA)
    surface = surface or Surface()
    flexibility = Flexibility(stretch=EI / length**2 / EA, shear=EI / length**2 / GA)

    def equations(side: int) -> RodEquations:
        return RodEquations(
            flexibility=flexibility,
            offset=surface.offset / length,
            radius=surface.radius / length,
            side=side,
        )

    return follow(equations, points, friction, EI=EI, length=length, side=side)
