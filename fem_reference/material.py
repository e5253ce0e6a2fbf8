r"""Hyperelastic laws in plane stress: energy, stress and tangent.

Both laws are written with the plane-stress constants ``lam = E nu / (1 - nu^2)`` and ``mu = E / (2 (1 + nu))``;
``F`` is the deformation gradient, tensor axes first, any number of point axes after.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fem_reference.arrays import Array

LawFunction = Callable[[Array, float, float], Array]


@dataclass(frozen=True, kw_only=True)
class Law:
    """A hyperelastic law: functions of ``(F, lam, mu)``.

    Parameters
    ----------
    energy
        Strain energy per reference volume W, shape ``(...)`` [Pa].
    stress
        First Piola-Kirchhoff stress ``P = dW/dF``, shape ``(2, 2, ...)`` [Pa].
    tangent
        ``dP/dF``, shape ``(2, 2, 2, 2, ...)``, with ``A[i, j, k, l] = dP[i, j] / dF[k, l]`` [Pa].
    """

    energy: LawFunction
    stress: LawFunction
    tangent: LawFunction


def plane_stress_constants(youngs_modulus: float, poissons_ratio: float) -> tuple[float, float]:
    """Return ``lam = E nu / (1 - nu^2)`` and ``mu = E / (2 (1 + nu))`` [Pa]."""
    lam = youngs_modulus * poissons_ratio / (1 - poissons_ratio**2)
    return lam, youngs_modulus / (2 * (1 + poissons_ratio))


def _identity(F: Array) -> Array:
    return np.eye(2).reshape(2, 2, *(1,) * (F.ndim - 2))


def _green_strain(F: Array) -> Array:
    E: Array = (np.einsum("ki...,kj...->ij...", F, F) - _identity(F)) / 2
    return E


def _second_stress(F: Array, lam: float, mu: float) -> Array:
    E = _green_strain(F)
    S: Array = lam * (E[0, 0] + E[1, 1]) * _identity(F) + 2 * mu * E
    return S


def _svk_energy(F: Array, lam: float, mu: float) -> Array:
    E = _green_strain(F)
    W: Array = lam / 2 * (E[0, 0] + E[1, 1]) ** 2 + mu * np.einsum("ij...,ij...->...", E, E)
    return W


def _svk_stress(F: Array, lam: float, mu: float) -> Array:
    P: Array = np.einsum("ik...,kj...->ij...", F, _second_stress(F, lam, mu))
    return P


def _svk_tangent(F: Array, lam: float, mu: float) -> Array:
    """``lam F_ij F_kl + mu (F_il F_kj + (F F^T)_ik delta_jl) + delta_ik S_jl``."""
    FF = np.einsum("ij...,kl...->ijkl...", F, F)
    A: Array = lam * FF + mu * FF.swapaxes(1, 3)
    b = mu * np.einsum("im...,km...->ik...", F, F)
    S = _second_stress(F, lam, mu)
    for n in range(2):
        A[:, n, :, n] += b
        A[n, :, n, :] += S
    return A


def _cofactor(F: Array) -> Array:
    return np.stack([np.stack([F[1, 1], -F[1, 0]]), np.stack([-F[0, 1], F[0, 0]])])


def _rotation(F: Array) -> tuple[Array, Array]:
    """Rotation R of the polar decomposition and ``s = tr U``: ``F + cof F = s R``."""
    Z = F + _cofactor(F)
    s = np.sqrt(Z[0, 0] ** 2 + Z[1, 0] ** 2)
    return Z / s, s


def _biot_energy(F: Array, lam: float, mu: float) -> Array:
    _, s = _rotation(F)
    W: Array = lam / 2 * (s - 2) ** 2 + mu * (np.einsum("ij...,ij...->...", F, F) - 2 * s + 2)
    return W


def _biot_stress(F: Array, lam: float, mu: float) -> Array:
    R, s = _rotation(F)
    return 2 * mu * F + (lam * (s - 2) - 2 * mu) * R


# d(F + cof F)/dF: the identity plus the product of two permutation symbols.
_PERMUTATION = np.array([[0.0, 1.0], [-1.0, 0.0]])
_IDENTITY_4 = np.einsum("ik,jl->ijkl", np.eye(2), np.eye(2))
_DZ_DF = _IDENTITY_4 + np.einsum("ik,jl->ijkl", _PERMUTATION, _PERMUTATION)


def _biot_tangent(F: Array, lam: float, mu: float) -> Array:
    """``2 mu I + lam R R + (lam (s - 2) - 2 mu) dR/dF`` with ``dR/dF = (d(F + cof F)/dF - R R) / s``."""
    R, s = _rotation(F)
    points = (1,) * (F.ndim - 2)
    RR = np.einsum("ij...,kl...->ijkl...", R, R)
    factor = (lam * (s - 2) - 2 * mu) / s
    A: Array = 2 * mu * _IDENTITY_4.reshape(2, 2, 2, 2, *points) + (
        factor * _DZ_DF.reshape(2, 2, 2, 2, *points) + (lam - factor) * RR
    )
    return A


#: St. Venant-Kirchhoff, ``W = lam (tr E)^2 / 2 + mu E:E`` with Green's strain E; and the law linear in Biot's strain,
#: ``W = lam (tr U - 2)^2 / 2 + mu |U - I|^2``, in closed form with ``tr U = sqrt(F:F + 2 det F)``.
MATERIALS: dict[str, Law] = {
    "st-venant-kirchhoff": Law(energy=_svk_energy, stress=_svk_stress, tangent=_svk_tangent),
    "biot-linear": Law(energy=_biot_energy, stress=_biot_stress, tangent=_biot_tangent),
}
