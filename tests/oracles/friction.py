"""The elastica with EI = 1 under a pin with Coulomb friction, by the first integral.

With the force `F (-sin beta, cos beta)` at the angle `wc` to the normal, `F_t = -F sin wc` and `F_n = F cos wc`, and in slip
`wc = -sigma atan mu`. The unknowns are `q` and `ell` of `tests.oracles.elastica`, and wc. With the exact rod of the product it shares the
law of friction and the search for events, but no equation of the beam.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from comparisons.exact import FrictionPath

# the march along a path, which takes the equations of any cantilever
from comparisons.exact.friction_law import Array, Contact, Observed, Real
from comparisons.exact.friction_path import follow
from tests.oracles.elastica import Loaded, loaded


@dataclass(frozen=True, kw_only=True)
class Elastica:
    """Equations of the elastica; a pin on its left, side -1, is the mirror image."""

    side: int
    reach: float = 0.0

    def contact(self, z: Array, pin: Real) -> Contact:
        """Residual and quantities of the contact at unknowns (..., 3)."""
        q, ell, wc = np.moveaxis(z, -1, 0)
        part = loaded(q, ell, wc)
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
        part = Loaded(*(value.real for value in loaded(*z)))
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


def elastica_with_friction(points: ArrayLike, *, friction: float, length: float = 1.0) -> FrictionPath:
    """Return the equilibria at the vertices of the pin's path; a pin that touches the straight beam slips, since that cannot stretch."""
    return follow(lambda side: Elastica(side=side), points, friction, EI=1.0, length=length)
