"""Two cantilevers in contact: a pin pushes the first rod, whose tip pushes the second, until the pin has come to the first one's tip.

Both rods have the same section, L = 1, are clamped at x = 0 and lie along +x, the first at y = 0 and the second at y = spacing. The pin
moves from (pin_x, 0) along +y, so that its depth is y. In the coupled stage both contacts are closed. The second rod is a single rod
under a pin, solved by quadratures with the unknowns `(q, ell)` of `comparisons.exact.reissner`. The first rod carries the force n from its
clamp to the pin and minus the tip force T from the pin to its tip; its equations are integrated by collocation. With the force
`P = n + T` of the pin and its arc position s, the six unknowns `q, ell, m(0), n_x, n_y, s` satisfy

    r(s) = pin,   P.(r'_- + r'_+) = 0,   m(L) = 0,   r(L) = point of the second rod under the tip
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from comparisons.exact import RodPath, rod_under_pin

# the equations of one rod, which the exact answers of the product share
from comparisons.exact.reissner import Array, Flexibility, loaded_part, normal, position
from comparisons.exact.section import Section, integrate, tangent
from comparisons.scene import Scene
from tests.oracles.newton import newton

SMALLEST_STEP = 1e-9


class Coupled(NamedTuple):
    """States of the coupled stage at `s` depths of the pin, nan at depths outside of it, and where it begins and ends.

    Forces of the pin on the first rod and of its tip on the second (s, 2), arc positions of both contacts, moments of both clamps,
    positive from x towards y, and the place of the first rod's tip (s, 2).
    """

    pin_force: Array
    tip_force: Array
    pin_arc: Array
    tip_arc: Array
    clamp_moments: Array
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
        """Residual (6, c) of the six equations for columns of unknowns (6, c), in units of EI."""
        q, ell, moment, nx, ny, s = (np.asarray(value, dtype=np.complex128) for value in z)
        second, zero = loaded_part(q, ell, self.flexibility), np.zeros_like(s)
        under_tip = position(second)
        Tx, Ty = np.moveaxis(second.force[..., None] * normal(second), -1, 0)
        pin = integrate(Section(zero, zero, zero, moment), (nx, ny), s, self.flexibility)
        tip = integrate(pin, (-Tx, -Ty), 1.0 - s, self.flexibility)
        before = tangent(pin.theta, (nx, ny), self.flexibility)
        after = tangent(pin.theta, (-Tx, -Ty), self.flexibility)
        slide = (nx + Tx) * (before[0] + after[0]) + (ny + Ty) * (before[1] + after[1])
        gap = tip.x - under_tip[..., 0], tip.y - under_tip[..., 1] - self.spacing
        return np.stack([pin.x - self.pin_x, pin.y - depth, slide, tip.moment, *gap])

    def solve(self, z: Array, depth: float) -> Array | None:
        """Unknowns from nearby ones, see `newton`."""
        found = newton(lambda z: self.residual(z, depth), z)
        return None if found is None else found[0]

    def touch(self) -> tuple[float, Array]:
        """Depth at which the first rod's tip touches the second, and the unknowns there."""
        depth = brentq(
            lambda d: self.single([d]).tip[-1, 1] - self.spacing, 1e-9, self.spacing - 1e-9, xtol=1e-15
        )
        one = self.single([depth])
        moment, force = -one.clamp_moment[1] / self.EI, one.force[1] / self.EI
        return float(depth), np.array(
            [0.0, one.tip[1, 0] / np.sqrt(np.pi), moment, *force, one.arc_position[1]]
        )

    def advance(self, z: Array, depth: float, target: float) -> tuple[Array, float]:
        """Unknowns at a target; or the last ones before, and the depth at which the pin has come to the tip."""
        step = target - depth
        while depth < target:
            following = target if depth + step >= target else depth + step
            trial = self.solve(z, following)
            if trial is None:
                step /= 2.0
                assert step > SMALLEST_STEP, f"no equilibrium beyond {depth}"
                continue
            if trial[5] > 1.0:
                beyond = lambda d, z=z: self.solve(z, d)[5] - 1.0  # noqa: E731
                return z, float(brentq(beyond, depth, following, xtol=1e-14))
            z, depth = trial, following
        return z, depth

    def stage(self, depths: ArrayLike) -> Coupled:
        """Coupled stage at increasing depths."""
        touch, z = self.touch()
        depth, end, rows = touch, np.inf, []
        for target in np.asarray(depths, dtype=np.float64):
            if touch <= target < end:
                z, depth = self.advance(z, depth, float(target))
                end = depth if depth < target else end
            rows.append(z if touch <= target < end else np.full(6, np.nan))
        while end == np.inf:
            target = depth + 0.05
            z, depth = self.advance(z, depth, target)
            end = depth if depth < target else end
        q, ell, moment, nx, ny, s = np.array(rows).reshape(-1, 6).T
        second = loaded_part(q, ell, self.flexibility)
        tip_force = self.EI * (second.force[:, None] * normal(second)).real
        return Coupled(
            pin_force=self.EI * np.stack([nx, ny], axis=1) + tip_force,
            tip_force=tip_force,
            pin_arc=s,
            tip_arc=second.arc.real,
            clamp_moments=-self.EI * np.column_stack([moment, (second.force * second.along).real]),
            tip=position(second).real + np.array([0.0, self.spacing]),
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
