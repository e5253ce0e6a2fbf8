"""The elastica, clamped at the origin along +x, under a dead load or a moment at its free tip."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc

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
