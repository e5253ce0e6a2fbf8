"""The tangent and residual of `fem_reference` written as scikit-fem forms, for checking and timing."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, LinearForm, MeshQuad


def vector_basis(nodes: NDArray[np.float64], cells: NDArray[np.int64]) -> Any:
    """scikit-fem's biquadratic vector basis on the same mesh; its numbering is ``2 n + i``."""
    corners, local = np.unique(cells[:, :4], return_inverse=True)
    mesh = MeshQuad(nodes[corners].T, local.reshape(-1, 4).T)
    return Basis(mesh, ElementVector(ElementQuad2()), intorder=5)


def _deformation_gradient(w: Any) -> Any:
    return np.asarray(w["u"].grad) + np.eye(2)[:, :, None, None]


def _strain(F: Any) -> Any:
    return (_green(F, F) - np.eye(2)[:, :, None, None]) / 2


def _green(F: Any, dF: Any) -> Any:
    product = np.einsum("ki...,kj...->ij...", F, dF)
    return (product + product.swapaxes(0, 1)) / 2


def _second_stress(E: Any, lam: float, mu: float) -> Any:
    return lam * (E[0, 0] + E[1, 1]) * np.eye(2)[:, :, None, None] + 2 * mu * E


def _contract(a: Any, b: Any) -> Any:
    return np.einsum("ij...,ij...->...", a, b)


def tangent_and_residual(
    basis: Any, u: NDArray[np.float64], lam: float, mu: float, width: float
) -> tuple[Any, Any]:
    """St. Venant-Kirchhoff, total Lagrangian: ``K`` (sparse) and ``f`` for the displacements ``u`` ``(2 n,)``."""

    @BilinearForm
    def tangent(du: Any, v: Any, w: Any) -> Any:
        F = _deformation_gradient(w)
        S = _second_stress(_strain(F), lam, mu)
        dS = _second_stress(_green(F, du.grad), lam, mu)
        return width * (_contract(_green(F, v.grad), dS) + _contract(_green(v.grad, du.grad), S))

    @LinearForm
    def residual(v: Any, w: Any) -> Any:
        F = _deformation_gradient(w)
        return width * _contract(_green(F, v.grad), _second_stress(_strain(F), lam, mu))

    field = basis.interpolate(u)
    return tangent.assemble(basis, u=field), residual.assemble(basis, u=field)
