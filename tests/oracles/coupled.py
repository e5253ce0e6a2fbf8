"""Two cantilevers in contact: a pin pushes the first rod, whose tip pushes the second, until the pin has come to the first one's tip.

Both rods have the same section, L = 1, are clamped at x = 0 and lie along +x, the first at y = 0 and the second at y = spacing. The pin
moves from (pin_x, 0) along +y, so that its depth is y. In the coupled stage both contacts are closed. The first rod carries the force n from its
clamp to the pin and minus the tip force T from the pin to its tip, where the second one carries T. With the force `P = n + T` of the pin
and the arc positions s of the pin and S of the tip, the eight unknowns `m(0), n_x, n_y, s` and `M(0), T_x, T_y, S` satisfy

    r(s) = pin,   P.(r'_- + r'_+) = 0,   m(L) = 0,   r(L) = R(S),   M(S) = 0,   T.(R'_- + R'_+) = 0
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from comparisons.exact import RodPath, rod_under_pin

# the equations of one rod, which the exact answers of the product share
from comparisons.exact.section import Array, Flexibility, Section, integrate, tangent
from comparisons.scene import Scene
from tests.oracles.newton import advanced


class Coupled(NamedTuple):
    """States of the coupled stage at `s` depths of the pin, nan at depths outside of it, and where it begins and ends.

    Forces of the pin on the first rod and of its tip on the second (s, 2), arc positions of both contacts, and the place of the first
    rod's tip (s, 2).
    """

    pin_force: Array
    tip_force: Array
    pin_arc: Array
    tip_arc: Array
    tip: Array
    touch_depth: float
    end_depth: float


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Both rods with L = 1, the pin's place and the distance of the rods."""

    EA: float
    GA: float
    EI: float
    pin_x: float
    spacing: float

    @property
    def flexibility(self) -> Flexibility:
        """Flexibility over EI."""
        return Flexibility(stretch=self.EI / self.EA, shear=self.EI / self.GA)

    def single(self, depths: ArrayLike) -> RodPath:
        """One of the rods under the pin alone, after its undeformed state."""
        points = [[self.pin_x, 0.0], *([self.pin_x, d] for d in np.asarray(depths))]
        return rod_under_pin(points, EA=self.EA, GA=self.GA, EI=self.EI, length=1.0)

    def residual(self, z: Array, depth: float) -> Array:
        """Residual (8, c) of the equations for columns of unknowns (8, c), in units of EI."""
        moment, nx, ny, s, other, Tx, Ty, S = z
        zero, section = np.zeros_like(s), self.flexibility
        pin = integrate(Section(zero, zero, zero, moment), (nx, ny), s, section)
        tip = integrate(pin, (-Tx, -Ty), 1.0 - s, section)
        under = integrate(Section(zero, zero + self.spacing, zero, other), (Tx, Ty), S, section)

        def slide(theta: Array, force: tuple[Array, Array], behind: tuple[Array, Array]) -> Array:
            before, after = tangent(theta, force, section), tangent(theta, behind, section)
            return sum((force[k] - behind[k]) * (before[k] + after[k]) for k in (0, 1))

        slides = slide(pin.theta, (nx, ny), (-Tx, -Ty)), slide(under.theta, (Tx, Ty), (zero, zero))
        gap = tip.x - under.x, tip.y - under.y
        return np.stack([pin.x - self.pin_x, pin.y - depth, tip.moment, under.moment, *slides, *gap])

    def touch(self) -> tuple[float, Array]:
        """Depth at which the first rod's tip touches the second, and the unknowns there."""
        depth = brentq(
            lambda d: self.single([d]).tip[-1, 1] - self.spacing, 1e-9, self.spacing - 1e-9, xtol=1e-15
        )
        one = self.single([depth])
        moment, force = -one.clamp_moment[1] / self.EI, one.force[1] / self.EI
        return float(depth), np.array([moment, *force, one.arc_position[1], 0.0, 0.0, 0.0, one.tip[1, 0]])

    def stage(self, depths: ArrayLike) -> Coupled:
        """Coupled stage at increasing depths."""
        touch, z = self.touch()
        path = [(touch, z, np.zeros(8))]
        while path[-1][1][3] <= 1.0:
            path.append(advanced(self.residual, path[-1], path[-1][0] + 0.05))

        def at(depth: float) -> Array:
            return advanced(self.residual, [state for state in path if state[0] <= depth][-1], depth)[1]

        end = float(brentq(lambda depth: at(depth)[3] - 1.0, path[-2][0], path[-1][0] - 1e-9, xtol=1e-14))
        rows = [at(float(d)) if touch <= d < end else np.full(8, np.nan) for d in np.asarray(depths)]
        _, nx, ny, s, other, Tx, Ty, S = np.array(rows).reshape(-1, 8).T
        under = integrate(Section(0 * S, self.spacing + 0 * S, 0 * S, other), (Tx, Ty), S, self.flexibility)
        tip_force = self.EI * np.stack([Tx, Ty], axis=1)
        return Coupled(
            pin_force=self.EI * np.stack([nx, ny], axis=1) + tip_force,
            tip_force=tip_force,
            pin_arc=s,
            tip_arc=S,
            tip=np.stack([under.x, under.y], axis=1),
            touch_depth=touch,
            end_depth=end,
        )

    def slip_off(self) -> float:
        """Depth at which the pin leaves the second rod."""
        return self.spacing + 0.6 * self.single([0.6]).slip_off


def pair_of(scene: Scene, place: float = 0.8) -> Pair:
    """Return the pair of the built-in scene `double-beam`, whose beams are 1 m long, with the pin at a place."""
    upper, lower = scene.beam("upper"), scene.beam("lower")
    spacing = upper.start[1] - lower.start[1]
    return Pair(EA=upper.EA, GA=upper.GA, EI=upper.EI, pin_x=place, spacing=spacing)
