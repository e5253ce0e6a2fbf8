"""Factorisation of the bodies' tangent stiffness, and the number of its negative eigenvalues.

The stiffness is a symmetric band matrix. If all its eigenvalues are positive, it is factorised by Cholesky's method.
Otherwise rows are exchanged. To count negative eigenvalues SuperLU factorises the matrix with its pivots on the diagonal,
``K = L D L^T``: the number of negative pivots is that of negative eigenvalues (Sylvester's law of inertia). If these factors
grow, they are inaccurate: then the eigenvalues themselves are counted.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigvals_banded
from scipy.linalg.lapack import dgbtrf, dgbtrs, dpbtrf, dtbtrs
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import splu

from fem_reference.statement.arrays import Floats

_GROWTH = 1e3
"""Largest ratio of a row's sums of ``|L| |U|`` and ``|K|`` at which the factors without row exchanges are used."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Factor:
    """A factorised symmetric matrix K. A solution is found in two halves, of which columns need the first one only."""

    half: Callable[[Floats], Floats]  # first half h(b) for ``b`` ``(m, ...)``: ``L^-1 b``, or b itself
    rest: Callable[[Floats], Floats]  # second half: ``K^-1 b`` from ``h(b)``
    product: Callable[[Floats, Floats], Floats]  # ``a^T K^-1 b`` from ``h(a)`` and ``h(b)``
    negatives: Callable[[], int]  # the number of negative eigenvalues


def factorise(band: Floats) -> Factor | None:
    """Factorise a symmetric matrix in lower band storage ``(width + 1, m)``; None if it is singular or not finite."""
    if not np.all(np.isfinite(band)):
        return None
    lower, failed = dpbtrf(band, lower=1)
    if failed:
        return _indefinite(band)

    def triangular(right: Floats, trans: str) -> Floats:
        return dtbtrs(lower, right, uplo="L", trans=trans)[0].reshape(right.shape)

    return Factor(
        half=lambda right: triangular(right, "N"),
        rest=lambda half: triangular(half, "T"),
        product=lambda a, b: a.T @ b,
        negatives=lambda: 0,
    )


def _indefinite(band: Floats) -> Factor | None:
    """Factorise a symmetric matrix that is not positive definite; None if it is singular."""
    (rows, m), w = band.shape, len(band) - 1
    both = np.zeros((m, 3 * w + 1)).T
    both[2 * w :] = band
    for k in range(1, rows):
        both[2 * w - k, k:] = band[k, : m - k]
    lu, pivots, failed = dgbtrf(both, w, w, overwrite_ab=1)
    if failed:
        return None

    def solution(right: Floats) -> Floats:
        return dgbtrs(lu, w, w, right, pivots)[0].reshape(right.shape)

    return Factor(
        half=lambda right: right,
        rest=solution,
        product=lambda a, b: a.T @ solution(b),
        negatives=lambda: _negatives(band),
    )


def _negatives(band: Floats) -> int:
    """Number of negative eigenvalues."""
    matrix = full(band)
    try:
        lu = splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:  # SuperLU's word for an exactly singular matrix
        lu = None
    if lu is not None and (lu.perm_r == lu.perm_c).all():
        rows = np.abs(lu.L) @ (np.abs(lu.U) @ np.ones(len(lu.perm_r)))
        if np.all(rows <= _GROWTH * np.asarray(np.abs(matrix).sum(axis=1)).ravel()):
            return int((lu.U.diagonal() < 0).sum())
    bound = 2 * band.shape[0] * float(np.abs(band).max())
    return int(eigvals_banded(band, lower=True, select="v", select_range=(-bound, 0.0)).size)


def full(band: Floats) -> csc_matrix:
    """Symmetric matrix ``(m, m)`` from its lower band storage."""
    below = diags([row[: band.shape[1] - k] for k, row in enumerate(band)], range(0, -len(band), -1))
    return csc_matrix(below + below.T - diags(band[0]))
