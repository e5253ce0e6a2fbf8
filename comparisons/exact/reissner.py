"""The loaded part of a Reissner rod under a frictionless pin, by quadrature.

The rod has the stiffnesses EA, GA and EI and the section axes `d1 = (cos theta, sin theta)`, `d2 = (-sin theta, cos theta)`:

    theta' = m/EI,   r' = (1 + N/EA) d1 + (Q/GA) d2,   m' = -r' x n,   N = n.d1,  Q = n.d2

Between clamp and pin the internal force is the constant contact force `n = F f`, `f = (-sin beta, cos beta)`. With
`w = beta - theta`, `N = -F sin w`, `Q = F cos w` and `c = 1/EA - 1/GA` the moment equation is `m' = -F cos w (1 - F c sin w)`.
At the pin `m = 0`, `w = wc` and `S = sin wc`. The integral of the moment equation is

    m^2 = 2 EI F (sin w - S) (1 - F c (sin w + S)/2)

so that `ds = -EI dw/m`, and arc length and position are integrals over `w` from `wc` to `beta`, the value at the clamp. The
component of the position along `e = (cos beta, sin beta)` is the lever arm `m/F`. Without friction the contact force does no work
when the pin slides: `f.(r'_- + r'_+) = 0` with the tangent `r'_-` before the pin and the unit tangent `r'_+` of the unloaded tail, hence

    F c S^2 - 2 S + F/GA = 0,   S = (F/GA)/(1 + sqrt(1 - F^2 c/GA))

The substitution `w = wc + A sin^2(psi/2)`, `A = pi - 2 wc`, makes the integrands analytic over the whole range up to the turning
point `w = pi - wc`, where the clamp moment vanishes (`sinc x = sin x/x`):

    ds = lam sqrt(2) dpsi / sqrt(sinc(A sin^2(psi/2)/2) sinc(A cos^2(psi/2)/2) (1 - F c (sin w + S)/2)),   lam = sqrt(EI/2F)

The two unknowns are `q = psi(clamp)^2` and `ell = lam psi(clamp)`. In these the solution is analytic at the touch, where `q = 0`
and `s = ell sqrt(pi)`; `q < 0` is a tensile contact force. Lengths are in units of the rod's length L, forces in EI/L^2, moments in EI/L.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]  # real or complex: derivatives are complex steps

COMPLEX_STEP = 1e-60

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(28)
_FRACTIONS = np.append((_GAUSS + 1.0) / 2.0, 1.0)  # the last point is the end of the part, with weight zero
_WEIGHTS = np.append(_WEIGHTS / 2.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Flexibility:
    """Axial and shear flexibility of a rod, `EI/(EA L^2)` and `EI/(GA L^2)`; zero is rigid."""

    stretch: float
    shear: float


class LoadedPart(NamedTuple):
    """The part of the rod from a section to the pin; arrays have the shape of the unknowns.

    Contact force `force` F and its angle `direction` beta, the angles `slip = wc` at the pin and `lag = w` at the section, the
    undeformed length `arc`, and the components `along` e and `across` e (along f) of the vector from the section to the pin.
    """

    force: Array
    direction: Array
    slip: Array
    lag: Array
    arc: Array
    along: Array
    across: Array


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def loaded_part(q: ArrayLike, ell: ArrayLike, flexibility: Flexibility, upto: ArrayLike = 1.0) -> LoadedPart:
    """Integrate over the part of the rod from the pin to `psi = upto psi(clamp)`; `upto = 1` is the whole loaded part.

    Parameters
    ----------
    q, ell, upto : array_like
        Unknowns (see the module) and fraction of `psi`; they broadcast and may be complex.
    flexibility : Flexibility
        Flexibility of the rod.

    Returns
    -------
    LoadedPart
        Complex arrays. For real input, nan or an imaginary part means that the state does not exist.
    """
    q, ell, upto = (np.asarray(value, dtype=np.complex128)[..., None] for value in (q, ell, upto))
    F = q / (2.0 * ell**2)
    c = flexibility.stretch - flexibility.shear
    S = F * flexibility.shear / (1.0 + np.sqrt(1.0 - F**2 * c * flexibility.shear))
    wc = np.arcsin(S)
    A = np.pi - 2.0 * wc
    psi = np.sqrt(q) * upto * _FRACTIONS
    lower, upper = A * np.sin(psi / 2.0) ** 2 / 2.0, A * np.cos(psi / 2.0) ** 2 / 2.0
    w = wc + 2.0 * lower
    sine, cosine = np.sin(w), np.cos(w)
    root = np.sqrt(sinc(lower) * sinc(upper) * (1.0 - F * c * (sine + S) / 2.0))
    rate = np.sqrt(2.0) * ell * upto * _WEIGHTS / root
    across = F * flexibility.shear * cosine**2 - (1.0 - F * flexibility.stretch * sine) * sine
    along = ell * upto * A * sinc(psi) * root / np.sqrt(2.0)
    return LoadedPart(
        force=F[..., 0],
        direction=(wc + A * np.sin(np.sqrt(q) / 2.0) ** 2)[..., 0],
        slip=wc[..., 0],
        lag=w[..., -1],
        arc=rate.sum(axis=-1),
        along=along[..., -1],
        across=(rate * across).sum(axis=-1),
    )


def position(part: LoadedPart) -> Array:
    """Vector from the section to the pin's point of the axis, shape (..., 2)."""
    c, s = np.cos(part.direction), np.sin(part.direction)
    return np.stack([c * part.along - s * part.across, s * part.along + c * part.across], axis=-1)


def normal(part: LoadedPart) -> Array:
    """Direction f of the contact force, shape (..., 2)."""
    return np.stack([-np.sin(part.direction), np.cos(part.direction)], axis=-1)


def sinc(x: Array) -> Array:
    """Return `sin x/x`; near zero a series in `x^2`, with which a complex step in `q = psi^2` is exact at `q = 0`."""
    small = np.abs(x) < 1e-3
    return np.where(small, 1.0 - x**2 / 6.0 * (1.0 - x**2 / 20.0), np.sin(x) / np.where(small, 1.0, x))
