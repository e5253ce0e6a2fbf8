r"""Hyperelastic laws in plane stress and plane strain: energy, stress and tangent.

Every law is a function of the deformation gradient in the plane, ``F``: tensor axes first, any number of point axes
after. Those here are isotropic, so that two invariants of F decide. ``lam`` and ``mu`` are Lame's constants. A law whose stress is linear in a strain measure is exact in plane stress
with ``lam`` replaced by ``2 lam mu / (lam + 2 mu) = E nu / (1 - nu^2)``, since the transverse stress vanishes at the
transverse strain ``-lam / (lam + 2 mu)`` times the trace in the plane. For a nonlinear law the transverse stretch is
condensed at every point.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

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


def lame_constants(youngs_modulus: float, poissons_ratio: float) -> tuple[float, float]:
    """Return ``lam = E nu / ((1 + nu) (1 - 2 nu))`` and ``mu = E / (2 (1 + nu))`` [Pa]."""
    E, nu = youngs_modulus, poissons_ratio
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


def in_plane_lam(lam: float, mu: float, plane: str) -> float:
    """Return the constant lam of a linear law in plane ``"stress"`` or ``"strain"`` [Pa]."""
    return 2 * lam * mu / (lam + 2 * mu) if plane == "stress" else lam


_PERMUTATION = np.array([[0.0, 1.0], [-1.0, 0.0]])
_IDENTITY, _TURNED = (a[:, None, :, None] * a[None, :, None, :] for a in (np.eye(2), _PERMUTATION))
"""Derivatives of F and of its cofactors by F."""
Values = tuple[Any, ...]


def _everywhere(constant: Array, F: Array) -> Array:
    """A constant tensor with the point axes of F."""
    return constant.reshape(constant.shape + (1,) * (F.ndim - 2))


def isotropic(values: Callable[[Array, Array], Values]) -> Law:
    """Law with the energy ``W(I, J)``, ``I = F:F`` and ``J = det F``, as every isotropic one: ``P = 2 W_I F + W_J cof F``.

    ``values``: W, W_I, W_J, W_II, W_IJ and W_JJ at I and J.
    """

    def at(F: Array) -> Values:
        return values(np.einsum("ij...,ij...", F, F), determinant(F))

    def stress(F: Array) -> Array:
        _, by_I, by_J, *_ = at(F)
        return 2 * by_I * F + by_J * cofactor(F)

    def tangent(F: Array) -> Array:
        (_, by_I, by_J, II, IJ, JJ), C = at(F), cofactor(F)
        changes = 4 * II * F + 2 * IJ * C, 2 * IJ * F + JJ * C  # of 2 W_I and of W_J, by F
        A: Array = 2 * by_I * _everywhere(_IDENTITY, F) + by_J * _everywhere(_TURNED, F)
        for direction, change in zip((F, C), changes, strict=True):
            A += direction[:, :, None, None] * change
        return A

    return Law(energy=lambda F: at(F)[0], stress=stress, tangent=tangent)


def st_venant_kirchhoff(lam: float, mu: float, plane: str) -> Law:
    """``W = lam (tr E)^2 / 2 + mu E:E`` with Green's strain ``E = (F^T F - I) / 2``, ``4 E:E = I^2 - 2 J^2 - 2 I + 2``."""
    lam = in_plane_lam(lam, mu, plane)

    def energy(F: Array) -> Array:
        """From E, which leaves small strains their digits."""
        E = (np.einsum("ki...,kj...->ij...", F, F) - _everywhere(np.eye(2), F)) / 2
        return lam / 2 * (E[0, 0] + E[1, 1]) ** 2 + mu * np.einsum("ij...,ij...", E, E)

    def values(I: Array, J: Array) -> Values:  # noqa: E741 - the invariant's letter
        return np.nan, lam / 4 * (I - 2) + mu / 2 * (I - 1), -mu * J, lam / 4 + mu / 2, 0.0, -mu

    return replace(isotropic(values), energy=energy)


def biot_linear(lam: float, mu: float, plane: str) -> Law:
    """``W = lam (tr U - 2)^2 / 2 + mu |U - I|^2``, linear in Biot's strain ``U - I``; ``tr U = s = sqrt(I + 2 J)``."""
    lam = in_plane_lam(lam, mu, plane)

    def values(I: Array, J: Array) -> Values:  # noqa: E741
        s = np.sqrt(I + 2 * J)
        slope = (lam * (s - 2) - 2 * mu) / s
        second = (lam - slope) / s**2
        W = lam / 2 * (s - 2) ** 2 + mu * (I - 2 * s + 2)
        return W, mu + slope / 2, slope, second / 4, second / 2, second

    return isotropic(values)


def neo_hookean(lam: float, mu: float, plane: str) -> Law:
    """``W = mu (F:F + e^(2 z) - 3) / 2 - mu ln j + lam (ln j)^2 / 2``, ``j = e^z det F``, transverse stretch ``e^z``.

    Plane strain has z = 0; in plane stress ``dW/dz = mu (e^(2 z) - 1) + lam ln j = 0`` at every point.
    """

    def values(I: Array, J: Array) -> Values:  # noqa: E741
        with np.errstate(
            divide="ignore", invalid="ignore"
        ):  # nan at a folded point ends the iteration by name
            log_area = np.log(J)
        z = 0 * log_area
        for _ in range(_CONDENSATION_STEPS if plane == "stress" else 0):
            free = 2 * mu * np.exp(2 * z)
            step = (free / 2 - mu + lam * (log_area + z)) / (free + lam)
            z = z - step
            if not np.abs(step).max(initial=0.0) > 1e-15:
                break
        log_j, free = log_area + z, 2 * mu * np.exp(2 * z)
        slope, c = lam * log_j - mu, lam * free / (lam + free) if plane == "stress" else lam
        W = (mu * (I - 3) + free / 2) / 2 - mu * log_j + lam / 2 * log_j**2
        return W, mu / 2, slope / J, 0.0, 0.0, (c - slope) / J**2

    return isotropic(values)


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
