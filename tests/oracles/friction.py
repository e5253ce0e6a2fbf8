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
from tests.oracles.newton import newton
from tests.oracles.shooting import ks_pins

Array = NDArray[np.float64]
WAY = ks_pins([0.0, 1.0])[1] - ks_pins([0.0, 1.0])[0]


class Rubbed(NamedTuple):
    """Load parameters at which the stick begins and ends, and force, arc position and clamp moment at the end of the path."""

    stick: float
    slip: float
    force: float
    arc_position: float
    clamp_moment: float


def followed(z: Array, begin: float, end: float, held: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Unknowns (3,) and their rates at a load parameter, in steps from another one, where a function of the unknowns (3, c) is zero."""

    def residual(z: Array, pin: Array) -> Array:
        part = loaded(*z)
        return np.stack([part.x - pin[0], part.y - pin[1], held(z)])

    rates = np.zeros(3)
    for pin in ks_pins(np.linspace(begin, end, 13)):
        found = newton(lambda z, pin=pin: residual(z, pin), z + (end - begin) / 12.0 * rates)
        assert found is not None, f"no equilibrium at {pin}"
        z, rates = found[0], np.linalg.solve(found[1], [*WAY, 0.0])
    return z, rates


def rubbed(friction: float) -> Rubbed:
    """Return both events and the end of the path."""
    angle = float(np.arctan(friction))
    inwards, outwards = (lambda z: z[2] - angle), (lambda z: z[2] + angle)
    touch = np.array([0.0, np.sqrt(np.cos(angle) / (np.pi - 2.0 * angle)), angle])

    def speed(t: float) -> float:
        """Rate of the arc position in the first slip."""
        z, rates = followed(touch, 0.0, t, inwards)
        return float(loaded(*(z + 1e-60j * rates)).arc.imag)

    stick = float(brentq(speed, 0.3, 0.65, xtol=1e-15))
    start = followed(touch, 0.0, stick, inwards)[0]
    place = loaded(*start).arc.real

    def stuck(t: float) -> Array:
        return followed(start, stick, t, lambda z: loaded(*z).arc - place)[0]

    slip = float(brentq(lambda t: outwards(stuck(t)), stick, stick + 0.09, xtol=1e-15))
    z, _ = followed(stuck(slip), slip, 1.0, outwards)
    part = loaded(*z)
    force, beta = float(part.force.real), float(part.angle.real + z[2])
    x, y = ks_pins([1.0])[0]
    return Rubbed(
        stick, slip, force, float(part.arc.real), -force * float(y * np.sin(beta) + x * np.cos(beta))
    )
