"""A Reissner rod, clamped at the origin along +x, whose tip is hinged to a point that moves along a path: by shooting from the clamp.

The internal force n is constant, and the moment vanishes at the tip. The unknowns are the moment at the clamp and n. A compressed rod
buckles sideways within a thousandth of its length, which a long step could pass over. Therefore a step is shortened until the prediction
along the path's tangent is small, and halved unless Newton's corrections are. A straight rod is followed up to its buckling load, where
the determinant of the equations changes its sign.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

# the equations of one rod, which the exact answers of the product share
from comparisons.exact.reissner import Array, Flexibility
from comparisons.exact.section import Section, integrate
from tests.oracles.newton import newton

SMALLEST_STEP = 1e-12
PREDICTION, CORRECTION = 0.1, 0.05
"""Changes of the unknowns, over the largest of them or EI/L^2."""


class Tied(NamedTuple):
    """States at `s` positions of the tip, nan without a stable equilibrium that is connected with the straight rod.

    Force on the tip (s, 2), moment of the clamp on the rod, and rotation of the tip.
    """

    force: Array
    clamp_moment: Array
    tip_rotation: Array


class Rod(NamedTuple):
    """A rod with L = EI = 1."""

    flexibility: Flexibility

    def end(self, z: Array) -> Section:
        """Return the tip at moment and force (3, c)."""
        moment, nx, ny = z
        zero = np.zeros_like(moment)
        return integrate(Section(zero, zero, zero, moment), (nx, ny), zero + 1.0, self.flexibility)

    def solved(self, z: Array, tip: Array, allowed: float = 1.0) -> tuple[Array, Array] | None:
        """Return the equilibrium with a place of the tip near another one, see `newton`."""

        def residual(z: Array) -> Array:
            end = self.end(z)
            return np.stack([end.x - tip[0], end.y - tip[1], end.moment])

        return newton(residual, z, allowed)

    def advanced(self, z: Array, start: Array, way: Array) -> Array:
        """Return the unknowns at the end of a straight piece of the path, nan if it is not reached."""
        state, done, step = self.solved(z, start), 0.0, 1.0
        while state is not None and done < 1.0:
            rate = np.linalg.solve(state[1], [*way, 0.0])
            size = np.abs(rate).max() / max(1.0, np.abs(state[0]).max())
            step = min(step, PREDICTION / max(size, PREDICTION), 1.0 - done)
            following = 1.0 if step == 1.0 - done else done + step
            ahead = self.solved(state[0] + step * rate, start + following * way, CORRECTION)
            if ahead is None or np.linalg.det(ahead[1]) * np.linalg.det(state[1]) <= 0.0:
                step /= 2.0
                state = None if step < SMALLEST_STEP else state
            else:
                state, done, step = ahead, following, 2.0 * step
        return np.full(3, np.nan) if state is None else state[0]


def rod_with_tied_tip(points: ArrayLike, *, EA: float, GA: float, EI: float, length: float = 1.0) -> Tied:
    """Return the equilibria at the vertices (s, 2) of the tip's path, which starts at the undeformed tip `(length, 0)`."""
    unit = EI / length**2
    rod, states = Rod(Flexibility(stretch=unit / EA, shear=unit / GA)), [np.zeros(3)]
    for start, end in pairwise(np.asarray(points, dtype=np.float64) / length):
        states.append(rod.advanced(states[-1], start, end - start))
    moment, *force = np.array(states).T
    rotation = rod.end(np.array(states).T).theta
    return Tied(unit * np.stack(force, axis=1), -unit * length * moment, rotation)
