"""The elastica with EI = L = 1 along the path of Konyukhov and Schweizerhof's pin with Coulomb friction, by the first integral.

The pin slips towards the clamp, sticks and slips towards the tip. The unknowns are `q`, `ell` and `wc` of `tests.oracles.elastica`: in slip of
the sense sigma `wc = -sigma atan mu`, in stick the arc position is held. No code is shared with the exact rod of the product.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from tests.oracles.elastica import loaded
from tests.oracles.newton import State, advanced
from tests.oracles.shooting import ks_pins

Array = NDArray[np.float64]
FIRST, LAST = ks_pins([0.0, 1.0])


class Rubbed(NamedTuple):
    """Load parameters at which the stick begins and ends, and force, arc position and clamp moment at the end of the path."""

    stick: float
    slip: float
    force: float
    arc_position: float
    clamp_moment: float


def rubbed(friction: float) -> Rubbed:
    """Return both events and the end of the path."""
    angle = float(np.arctan(friction))
    touch = np.array([0.0, np.sqrt(np.cos(angle) / (np.pi - 2.0 * angle)), angle])

    def followed(last: State, end: float, held: Callable[[Array], Array]) -> State:
        """State at a load parameter, in steps from another one, where a function of the unknowns (3, c) is zero."""

        def residual(z: Array, t: float) -> Array:
            part, (x, y) = loaded(*z), FIRST + t * (LAST - FIRST)
            return np.stack([part.x - x, part.y - y, held(z)])

        for t in np.linspace(last[0], end, 13)[1:]:
            last = advanced(residual, last, float(t))
        return last

    def sliding(t: float) -> State:
        return followed((0.0, touch, np.zeros(3)), t, lambda z: z[2] - angle)

    def speed(t: float) -> float:
        """Rate of the arc position in the first slip."""
        _, z, rates = sliding(t)
        return float(loaded(*(z + 1e-60j * rates)).arc.imag)

    stick = float(brentq(speed, 0.3, 0.65, xtol=1e-15))
    start = (stick, sliding(stick)[1], np.zeros(3))
    place = loaded(*start[1]).arc.real

    def stuck(t: float) -> Array:
        return followed(start, t, lambda z: loaded(*z).arc - place)[1]

    slip = float(brentq(lambda t: stuck(t)[2] + angle, stick, stick + 0.09, xtol=1e-15))
    _, z, _ = followed((slip, stuck(slip), np.zeros(3)), 1.0, lambda z: z[2] + angle)
    part = loaded(*z)
    force, beta = float(part.force.real), float(part.angle.real + z[2])
    moment = -force * float(LAST[1] * np.sin(beta) + LAST[0] * np.cos(beta))
    return Rubbed(stick, slip, force, float(part.arc.real), moment)
