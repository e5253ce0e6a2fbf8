"""The elastica with EI = L = 1, clamped at the origin along +x: end loads by elliptic integrals, pins by quadrature.

Under a pin the beam carries the force `F (-sin beta, cos beta)` between clamp and pin. It makes the angle `wc = beta - tc` with the
normal at the pin, where the tangent has the angle tc: 0 without friction, `-sigma atan mu` in slip of the sense sigma. With `u = tc - theta`

    theta'^2 = 2 F (sin(u + wc) - sin wc),   lam = sqrt(1/2F)
    s, x, y = lam int_0^tc {1, cos, sin}(tc - u) du / sqrt(sin(u + wc) - sin wc)

The substitution `u = A sin^2(psi/2)`, `A = pi - 2 wc`, makes the integrands analytic. The unknowns are `q = psi(clamp)^2` and
`ell = lam psi(clamp)`.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc, elliprd, elliprf

Array = NDArray[np.float64]

COMPLEX_STEP = 1e-60
GAUSS, WEIGHTS = np.polynomial.legendre.leggauss(40)
GAUSS, WEIGHTS = (GAUSS + 1.0) / 2.0, WEIGHTS / 2.0


class Loaded(NamedTuple):
    """Force, tangent angle at the pin, arc position and position of the pin; complex arrays (...)."""

    force: NDArray[np.complex128]
    angle: NDArray[np.complex128]
    arc: NDArray[np.complex128]
    x: NDArray[np.complex128]
    y: NDArray[np.complex128]


def sinc(x: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Return `sin x/x`; near zero a series in `x^2`, with which a complex step in `q = psi^2` is exact at `q = 0`."""
    small = np.abs(x) < 1e-3
    return np.where(small, 1.0 - x**2 / 6.0 * (1.0 - x**2 / 20.0), np.sin(x) / np.where(small, 1.0, x))


def loaded(q: ArrayLike, ell: ArrayLike, wc: ArrayLike) -> Loaded:
    """Integrate from the pin to the clamp at unknowns (...), which may be complex."""
    q, ell, wc = (np.asarray(value, dtype=np.complex128)[..., None] for value in (q, ell, wc))
    A, psi, force = np.pi - 2.0 * wc, np.sqrt(q) * GAUSS, q / (2.0 * ell**2)
    lower, upper = A * np.sin(psi / 2.0) ** 2 / 2.0, A * np.cos(psi / 2.0) ** 2 / 2.0
    rate = np.sqrt(2.0) * ell * WEIGHTS / np.sqrt(sinc(lower) * sinc(upper))
    angle = A * np.sin(np.sqrt(q) / 2.0) ** 2
    theta = angle - 2.0 * lower
    return Loaded(
        force=force[..., 0],
        angle=angle[..., 0],
        arc=rate.sum(axis=-1),
        x=(rate * np.cos(theta)).sum(axis=-1),
        y=(rate * np.sin(theta)).sum(axis=-1),
    )


def greatest(load: Callable[[Loaded], NDArray[np.complex128]], wc: float = 0.0) -> tuple[float, float]:
    """Greatest load of a pin raised at x = 1 below a beam without end, where lengths are over x, and the height at which it occurs."""

    def rate(q: float) -> float:
        return float(load(loaded(q + 1j * COMPLEX_STEP, 1.0, wc)).imag / COMPLEX_STEP)

    part = loaded(brentq(rate, 1e-3, 2.5, xtol=1e-15), 1.0, wc)
    return float(load(part).real), float((part.y / part.x).real)


def contact_force_limit() -> tuple[float, float]:
    """Greatest contact force of a pin raised at x = 1, and its height."""
    return greatest(lambda part: part.force * part.x**2)


def three_point_limit(friction: float = 0.0) -> list[tuple[float, float]]:
    """Greatest load of one support of a long beam over two, half a span of 1 apart from its middle, and the deflection.

    The first is that while the beam is drawn in between the supports, the second that while it is pushed back.
    """
    angle = np.arctan(friction)
    return [
        greatest(lambda part, wc=wc: np.cos(part.angle + wc) * part.force * part.x**2, wc)
        for wc in (-angle, angle)
    ]


def slip_off_height(x: float) -> float:
    """Height at which a pin raised at x leaves the beam over its tip."""
    excess = lambda q: float((loaded(q, 1.0, 0.0).x / loaded(q, 1.0, 0.0).arc).real) - x  # noqa: E731
    part = loaded(brentq(excess, 1e-9, 7.0, xtol=1e-15), 1.0, 0.0)
    return float((part.y / part.arc).real)


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
