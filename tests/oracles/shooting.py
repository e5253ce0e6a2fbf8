"""Part of a rod under a constant force by a Runge-Kutta method: what every exact answer must agree with."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
RIGID = {"EA": np.inf, "GA": np.inf, "EI": 1.0}
KS = {"EA": 8.4, "GA": 5.0 / 6.0 * 8.4 / 2.6, "EI": 2.8e-4}
"""Section of the cantilever of Konyukhov and Schweizerhof, whose length is 1."""


def ks_pins(t: Sequence[float] | Array, offset: float = 0.0) -> Array:
    """Return places (s, 2) of their pin."""
    t = np.asarray(t)
    return np.stack([1.0 - t, 2.0 * t / np.pi - offset], axis=1)


def shot(
    force: Sequence[float] | Array, start: Sequence[float], length: float, *, EA: float, GA: float, EI: float
) -> tuple[Array, Array]:
    """Return `x, y, theta, m` and the strain energy (5,) after a length, from `x, y, theta, m`, and the strained tangent (2,) there."""
    nx, ny = force

    def rates(_: float, state: Array) -> list[float]:
        c, s = np.cos(state[2]), np.sin(state[2])
        N, Q = nx * c + ny * s, ny * c - nx * s
        dx, dy = (1.0 + N / EA) * c - Q / GA * s, (1.0 + N / EA) * s + Q / GA * c
        energy = (N**2 / EA + Q**2 / GA + state[3] ** 2 / EI) / 2.0
        return [dx, dy, state[3] / EI, dy * nx - dx * ny, energy]

    moment = min(abs(start[3]) or 1.0, 1.0)
    scale = 1e-15 * np.array([1.0, 1.0, 1.0, moment, moment])
    found = solve_ivp(rates, (0.0, length), [*start, 0.0], method="DOP853", rtol=1e-13, atol=scale)
    return found.y[:, -1], np.array(rates(0.0, found.y[:, -1])[:2])
