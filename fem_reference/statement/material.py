r"""Hyperelastic laws in plane stress and plane strain: energy, stress and tangent.

Every law is a function of the deformation gradient in the plane, ``F``: tensor axes first, any number of point axes
after. ``lam`` and ``mu`` are Lame's constants. A law whose stress is linear in a strain measure is exact in plane stress
with ``lam`` replaced by ``2 lam mu / (lam + 2 mu) = E nu / (1 - nu^2)``, since the transverse stress vanishes at the
transverse strain ``-lam / (lam + 2 mu)`` times the trace in the plane. For a nonlinear law the transverse stretch is
condensed at every point.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference.statement.arrays import Array, cofactor, determinant

LawFunction = Callable[[Array], Array]
PLANES = ("stress", "strain")


@dataclass(frozen=True, kw_only=True)
class Law:
    """A hyperelastic law in the plane."""

    energy: LawFunction  # strain energy per reference volume ``W(F)``, shape ``(...)`` [Pa]
    stress: LawFunction  # first Piola-Kirchhoff stress ``P = dW/dF``, shape ``(2, 2, ...)`` [Pa]
    # ``dP/dF``, shape ``(2, 2, 2, 2, ...)``, with ``A[i, j, k, l] = dP[i, j] / dF[k, l]`` [Pa]
    tangent: LawFunction

    @cached_property
    def elastic(self) -> Array:
        """``dP/dF`` without deformation, ``(2, 2, 2, 2)`` [Pa]."""
        return self.tangent(np.eye(2)[:, :, None])[..., 0]


def lame_constants(youngs_modulus: float, poissons_ratio: float) -> tuple[float, float]:
    """Return ``lam = E nu / ((1 + nu) (1 - 2 nu))`` and ``mu = E / (2 (1 + nu))`` [Pa]."""
    E, nu = youngs_modulus, poissons_ratio
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


def in_plane_lam(lam: float, mu: float, plane: str) -> float:
    """Return the constant lam of a linear law in plane ``"stress"`` or ``"strain"`` [Pa]."""
    return 2 * lam * mu / (lam + 2 * mu) if plane == "stress" else lam


def _contract(A: Array, B: Array) -> Array:
    return np.einsum("ij...,ij...", A, B)


def _times(A: Array, B: Array) -> Array:
    """``A . B`` at every point."""
    return np.einsum("ij...,jk...->ik...", A, B)


def _outer(A: Array, B: Array) -> Array:
    return A[:, :, None, None] * B[None, None]


def _everywhere(constant: Array, F: Array) -> Array:
    """A constant tensor with the point axes of F."""
    return constant.reshape(constant.shape + (1,) * (F.ndim - 2))


def _log_area(F: Array) -> Array:
    """``ln det F``; nan at a folded point, which ends the iteration by name."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.log(determinant(F))


def st_venant_kirchhoff(lam: float, mu: float, plane: str) -> Law:
    """``W = lam (tr E)^2 / 2 + mu E:E`` with Green's strain ``E = (F^T F - I) / 2``."""
    lam = in_plane_lam(lam, mu, plane)

    def green(F: Array) -> Array:
        return (_times(F.swapaxes(0, 1), F) - _everywhere(np.eye(2), F)) / 2

    def second_stress(F: Array) -> Array:
        E = green(F)
        return 2 * mu * E + lam * (E[0, 0] + E[1, 1]) * _everywhere(np.eye(2), F)

    def energy(F: Array) -> Array:
        E = green(F)
        return lam / 2 * (E[0, 0] + E[1, 1]) ** 2 + mu * _contract(E, E)

    def stress(F: Array) -> Array:
        return _times(F, second_stress(F))

    def tangent(F: Array) -> Array:
        """``lam F_ij F_kl + mu (F_il F_kj + (F F^T)_ik delta_jl) + delta_ik S_jl``."""
        FF = _outer(F, F)
        A: Array = mu * FF.swapaxes(1, 3)
        FF *= lam
        A += FF
        b, S = mu * _times(F, F.swapaxes(0, 1)), second_stress(F)
        for n in range(2):
            A[:, n, :, n] += b
            A[n, :, n, :] += S
        return A

    return Law(energy=energy, stress=stress, tangent=tangent)


_PERMUTATION = np.array([[0.0, 1.0], [-1.0, 0.0]])
_IDENTITY = np.eye(2)[:, None, :, None] * np.eye(2)[None, :, None, :]
_DZ_DF = _IDENTITY + _PERMUTATION[:, None, :, None] * _PERMUTATION[None, :, None, :]


def biot_linear(lam: float, mu: float, plane: str) -> Law:
    """``W = lam (tr U - 2)^2 / 2 + mu |U - I|^2``, linear in Biot's strain ``U - I``.

    In closed form with ``tr U = s = sqrt(F:F + 2 det F)`` and the rotation ``R = (F + cof F) / s``.
    """
    lam = in_plane_lam(lam, mu, plane)

    def rotation(F: Array) -> tuple[Array, Array]:
        Z = F + cofactor(F)
        s = np.sqrt(Z[0, 0] ** 2 + Z[1, 0] ** 2)
        return Z / s, s

    def energy(F: Array) -> Array:
        _, s = rotation(F)
        return lam / 2 * (s - 2) ** 2 + mu * (_contract(F, F) - 2 * s + 2)

    def stress(F: Array) -> Array:
        R, s = rotation(F)
        return 2 * mu * F + (lam * (s - 2) - 2 * mu) * R

    def tangent(F: Array) -> Array:
        """``2 mu I + lam R R + (lam (s - 2) - 2 mu) dR/dF`` with ``dR/dF = (d(F + cof F)/dF - R R) / s``."""
        R, s = rotation(F)
        factor = (lam * (s - 2) - 2 * mu) / s
        A: Array = (lam - factor) * _outer(R, R)
        A += factor * _everywhere(_DZ_DF, F) + 2 * mu * _everywhere(_IDENTITY, F)
        return A

    return Law(energy=energy, stress=stress, tangent=tangent)


def neo_hookean(lam: float, mu: float, plane: str) -> Law:
    """``W = mu (F:F + e^(2 z) - 3) / 2 - mu ln J + lam (ln J)^2 / 2``, ``J = e^z det F``, transverse stretch ``e^z``.

    Plane strain has z = 0; in plane stress ``dW/dz = mu (e^(2 z) - 1) + lam ln J = 0`` at every point.
    """

    def log_stretch(F: Array) -> Array:
        log_area = _log_area(F)
        z = 0 * log_area
        if plane == "strain":
            return z
        for _ in range(_CONDENSATION_STEPS):
            squared = np.exp(2 * z)
            step = (mu * (squared - 1) + lam * (log_area + z)) / (2 * mu * squared + lam)
            z = z - step
            if not np.abs(step).max(initial=0.0) > 1e-15:
                break
        return z

    def energy(F: Array) -> Array:
        z = log_stretch(F)
        log_J = _log_area(F) + z
        return mu / 2 * (_contract(F, F) + np.exp(2 * z) - 3) - mu * log_J + lam / 2 * log_J**2

    def stress(F: Array) -> Array:
        J = determinant(F)
        return mu * F + (lam * (_log_area(F) + log_stretch(F)) - mu) * cofactor(F) / J

    def tangent(F: Array) -> Array:
        """``mu I + c F^-T F^-T - (lam ln J - mu) F^-T_il F^-T_kj``, c = lam, condensed: ``lam W_zz0 / (lam + W_zz0)``."""
        J, z = determinant(F), log_stretch(F)
        inverse = cofactor(F) / J
        both = _outer(inverse, inverse)
        free = 2 * mu * np.exp(2 * z)
        c = lam * free / (lam + free) if plane == "stress" else lam
        A: Array = c * both - (lam * (_log_area(F) + z) - mu) * both.swapaxes(1, 3)
        return A + mu * _everywhere(_IDENTITY, F)

    return Law(energy=energy, stress=stress, tangent=tangent)


_CONDENSATION_STEPS = 50

MATERIALS: dict[str, Callable[[float, float, str], Law]] = {
    "st-venant-kirchhoff": st_venant_kirchhoff,
    "biot-linear": biot_linear,
    "neo-hookean": neo_hookean,
}
"""The laws by name, as functions of ``lam, mu, plane``; plane is one of `PLANES`."""


def elastic_law(material: str, youngs_modulus: float, poissons_ratio: float, plane: str = "stress") -> Law:
    """Return the law ``material`` of `MATERIALS` with the given constants in plane ``"stress"`` or ``"strain"``."""
    return MATERIALS[material](*lame_constants(youngs_modulus, poissons_ratio), plane)
