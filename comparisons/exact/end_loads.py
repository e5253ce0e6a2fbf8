"""The elastica, clamped at the origin along +x, under dead loads and moments at its free tip."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc, elliprd, elliprf

from comparisons.exact.checks import require_positive

Array = NDArray[np.float64]


def tip_under_dead_load(load: float, *, EI: float = 1.0, length: float = 1.0) -> Array:
    """Tip position of the cantilever under a vertical dead load at its tip.

    With the tip rotation `theta0`, `tanh tau = sin theta0` and `sin^2 psi = sin theta0/(1 + sin theta0)`,

        L sqrt(P/EI) = F(psi | -e^(2 tau)) sqrt(1 + e^(2 tau)),   x = sqrt(2 EI sin theta0/P),   y = L - 2 L E / ((1 + e^(2 tau)) F)

    (Bisshopp and Drucker, Quarterly of Applied Mathematics 3, 1945, 272-275, with Legendre's imaginary modulus).

    Returns
    -------
    ndarray, shape (2,)

    Raises
    ------
    ValueError
        If `load length^2 / EI` exceeds 1e5, where the beam is a straight vertical line to five digits.

    Examples
    --------
    >>> round(float(tip_under_dead_load(1.0)[1]), 10)
    0.3017207738
    """
    require_positive(load=load, EI=EI, length=length)
    root = float(np.sqrt(load / EI)) * length
    if load * length**2 / EI > 1e5:
        raise ValueError(f"load = {load}: load length^2 / EI must not exceed 1e5")

    def amplitude(tau: float) -> float:
        return float(np.arctan(np.sqrt(np.tanh(tau))))

    def scaled_length(tau: float) -> float:
        return float(ellipkinc(amplitude(tau), -np.exp(2.0 * tau)) * np.sqrt(1.0 + np.exp(2.0 * tau)))

    tau = float(
        brentq(lambda tau: scaled_length(tau) - root, 0.0, min(root**2, root) + 0.1, xtol=1e-300, rtol=1e-15)
    )
    psi, k = amplitude(tau), -np.exp(2.0 * tau)
    ratio = ellipeinc(psi, k) / ellipkinc(psi, k) / (1.0 - k)
    return length * np.array([np.sqrt(2.0 * np.tanh(tau)) / root, 1.0 - 2.0 * ratio])


def tip_under_thrust(thrust: float, moment: float, *, EI: float = 1.0, length: float = 1.0) -> Array:
    """Tip position and rotation of the cantilever under a dead force against its axis and a moment, both at its tip.

    With the tip's rotation `u`, `k^2 = sin^2(u/2) + moment^2/(4 EI P)` and `sin phi = sin(u/2)/k`,

        L sqrt(P/EI) = F(phi | k^2),   x = L (2 E(phi | k^2)/F - 1),   y = 2 k sqrt(EI/P) (1 - cos phi)

    The integrals F and E are taken in Carlson's form, which k above 1 does not disturb.
    Half of a column between two hinges under an eccentric load is such a cantilever (Timoshenko and Gere, Theory of Elastic
    Stability, 1961, sec. 2.7, where the moment is zero).

    Parameters
    ----------
    thrust : float
        The force, positive in compression.
    moment : float
        Positive anticlockwise, not zero: the sign decides to which side the cantilever bends.
    EI, length : float
        Bending stiffness and length.

    Returns
    -------
    ndarray, shape (3,)
        x, y and rotation [rad] of the tip, on the branch that leads there from the straight state.

    Raises
    ------
    ValueError
        If a value is not positive, the moment is zero, or the tip turns by more than half a circle.

    Examples
    --------
    >>> thrust = 1.8848 * np.pi**2 / 4  # in Timoshenko and Gere's table the tip has turned by 120 degrees
    >>> [round(float(value), 3) for value in tip_under_thrust(thrust, 1e-9) * [1, 1, 180 / np.pi]]
    [0.123, 0.803, 120.0]
    """
    require_positive(thrust=thrust, EI=EI, length=length)
    if moment == 0.0:
        raise ValueError("moment = 0: must not be zero")
    root, kick = float(np.sqrt(thrust / EI)) * length, abs(moment) / float(np.sqrt(4.0 * EI * thrust))

    def amplitude(turn: float) -> tuple[float, float, float]:
        half = float(np.sin(turn / 2.0))
        return half, half / float(np.hypot(half, kick)), kick / float(np.hypot(half, kick))

    def first(turn: float) -> float:
        _, sine, cosine = amplitude(turn)
        return sine * float(elliprf(cosine**2, np.cos(turn / 2.0) ** 2, 1.0))

    if first(np.pi) < root:
        raise ValueError(f"thrust = {thrust}: the tip turns by more than half a circle")
    turn = float(brentq(lambda turn: first(turn) - root, 0.0, np.pi, xtol=1e-15, rtol=1e-15))
    half, sine, cosine = amplitude(turn)
    second = root - half**2 * sine * float(elliprd(cosine**2, np.cos(turn / 2.0) ** 2, 1.0)) / 3.0
    x, y = 2.0 * second / root - 1.0, 2.0 * half**2 / (float(np.hypot(half, kick)) + kick) / root
    return np.array([length * x, np.sign(moment) * length * y, np.sign(moment) * turn])


def tip_under_moment(moment: float, *, EI: float = 1.0, length: float = 1.0) -> Array:
    """Tip position of the cantilever under a moment at its tip, an arc of the angle `t = moment length / EI`.

    Returns
    -------
    ndarray, shape (2,)

    Examples
    --------
    >>> [round(float(value), 12) + 0.0 for value in tip_under_moment(2 * np.pi)]
    [0.0, 0.0]
    """
    require_positive(EI=EI, length=length)
    t = moment * length / EI
    return length * np.array([np.sinc(t / np.pi), np.sin(t / 2.0) * np.sinc(t / (2.0 * np.pi))])
