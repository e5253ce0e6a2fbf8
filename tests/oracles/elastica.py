"""The elastica with EI = L = 1, clamped at the origin along +x, by elliptic integrals."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc, elliprd, elliprf

Array = NDArray[np.float64]


def tip_under_dead_load(load: float) -> Array:
    """Tip (2,) under a dead load P across the axis at the tip; P up to 1e5, where the beam all but hangs straight.

    With the tip rotation `theta0`, `tanh tau = sin theta0` and `sin^2 psi = sin theta0/(1 + sin theta0)`,

        sqrt(P) = F(psi | -e^(2 tau)) sqrt(1 + e^(2 tau)),   x = sqrt(2 sin theta0/P),   y = 1 - 2 E / ((1 + e^(2 tau)) F)

    (Bisshopp and Drucker, Quarterly of Applied Mathematics 3, 1945, 272-275, with Legendre's imaginary modulus).
    """
    root = float(np.sqrt(load))

    def amplitude(tau: float) -> float:
        return float(np.arctan(np.sqrt(np.tanh(tau))))

    def scaled_length(tau: float) -> float:
        return float(ellipkinc(amplitude(tau), -np.exp(2.0 * tau)) * np.sqrt(1.0 + np.exp(2.0 * tau)))

    tau = brentq(
        lambda tau: scaled_length(tau) - root, 0.0, min(root**2, root) + 0.1, xtol=1e-300, rtol=1e-15
    )
    psi, k = amplitude(tau), -np.exp(2.0 * tau)
    ratio = ellipeinc(psi, k) / ellipkinc(psi, k) / (1.0 - k)
    return np.array([np.sqrt(2.0 * np.tanh(tau)) / root, 1.0 - 2.0 * ratio])


def tip_under_thrust(thrust: float, moment: float) -> Array:
    """Place and rotation of the tip (3,) under a dead force P against the axis and a moment M, not zero, both at the tip.

    With the tip's rotation `u` up to half a circle, `k^2 = sin^2(u/2) + M^2/(4 P)` and `sin phi = sin(u/2)/k`,

        sqrt(P) = F(phi | k^2),   x = 2 E(phi | k^2)/F - 1,   y = 2 k (1 - cos phi)/sqrt(P)

    The integrals F and E are taken in Carlson's form, which k above 1 does not disturb. Half of a column between two hinges under an
    eccentric load is such a cantilever (Timoshenko and Gere, Theory of Elastic Stability, 1961, sec. 2.7, where the moment is zero).
    """
    root, kick = float(np.sqrt(thrust)), abs(moment) / float(np.sqrt(4.0 * thrust))

    def amplitude(turn: float) -> tuple[float, float, float]:
        half = float(np.sin(turn / 2.0))
        return half, half / float(np.hypot(half, kick)), kick / float(np.hypot(half, kick))

    def first(turn: float) -> float:
        _, sine, cosine = amplitude(turn)
        return sine * float(elliprf(cosine**2, np.cos(turn / 2.0) ** 2, 1.0))

    turn = float(brentq(lambda turn: first(turn) - root, 0.0, np.pi, xtol=1e-15, rtol=1e-15))
    half, sine, cosine = amplitude(turn)
    second = root - half**2 * sine * float(elliprd(cosine**2, np.cos(turn / 2.0) ** 2, 1.0)) / 3.0
    x, y = 2.0 * second / root - 1.0, 2.0 * half**2 / (float(np.hypot(half, kick)) + kick) / root
    return np.array([x, np.sign(moment) * y, np.sign(moment) * turn])
