"""Number of negative eigenvalues of a symmetric matrix that is a band with a border.

For a band A, border columns B and a corner D, ``negatives(K) = negatives(A) + negatives(D - B^T A^-1 B)`` (Haynsworth 1968).
Most bands are positive definite, which Cholesky's factorisation shows. If A is not positive definite, or the border is wide, the whole matrix is factorised.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.system.lapack import lapack

_EPS = float(np.finfo(float).eps)
_WEAK = 1e-13
"""Smallest pivot of Cholesky's factorisation, over the diagonal, of a band that is treated as regular."""
_SOFT = 1e5
"""Largest dimensionless flexibility of a structure without its contacts. A larger one shows a nearly singular band, whose Schur complement
has too few digits."""
WIDE = 64
"""Largest border that is treated as dense columns, whose cost grows with its square; a wider one is sparse as a whole."""
_DENSE = 1500
"""Largest number of unknowns of a dense matrix."""


class Symmetric(NamedTuple):
    """Symmetric tangent, a band with a border."""

    band: Array  # LAPACK's lower band storage; shape (k + 1, n)
    right: Array  # border columns, for dimensionless unknowns; shape (n, b)
    corner: Array  # matrix of the border's rows and columns, for dimensionless unknowns; shape (b, b)
    units: Array  # units of the band's unknowns, over the root of an energy; shape (n,)
    multipliers: int  # unknowns that are forces or moments


def negatives(symmetric: Symmetric) -> int | None:
    """Number of negative eigenvalues, None where one of them is zero or not a number."""
    band, right, corner, units, _ = symmetric
    if len(corner) > WIDE and (counted := _negatives_sparse(symmetric)) is not None:
        return counted
    factor, info = lapack().dpbtrf(band, lower=1)
    if info == 0 and (factor[0] ** 2 > _WEAK * band[0]).all():
        if not len(corner):
            return 0
        inside, _ = lapack().dpbtrs(factor, right, lower=1)
        reduced = corner - right.T @ inside
        if np.abs(reduced).max() < _SOFT:
            return _negatives_dense(reduced)
    count, width = right.shape
    if count + width > _DENSE:
        return _negatives_sparse(symmetric)
    whole = np.zeros((count + width, count + width))
    for k, diagonal in enumerate(band[:count]):
        whole[range(k, count), range(count - k)] = diagonal[: count - k] * units[k:] * units[: count - k]
    whole[count:, :count], whole[count:, count:] = right.T * units, np.tril(corner)
    return _negatives_dense(whole + np.tril(whole, -1).T)


def _negatives_sparse(symmetric: Symmetric) -> int | None:
    """Number of negative eigenvalues of a large matrix, by an LU decomposition; None if a pivot leaves the diagonal."""
    from scipy.sparse import block_array, coo_array, dia_array
    from scipy.sparse.linalg import splu

    band, right, corner, units, _ = symmetric
    shape = (band.shape[1],) * 2
    lower = dia_array((band, -np.arange(len(band))), shape)
    above = dia_array((band[1:], -np.arange(1, len(band))), shape)
    inside = (lower + above.T).multiply(units).multiply(units[:, None])
    beside = coo_array(right * units[:, None])
    whole = block_array([[inside, beside], [beside.T, coo_array(corner)]] if len(corner) else [[inside]])
    fit = _equilibrating(np.asarray(abs(whole).max(axis=0).todense()).ravel())
    scaled = whole.multiply(fit).multiply(fit[:, None]).tocsc()
    options = {"SymmetricMode": True, "Equil": False}
    try:
        lu = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    except RuntimeError:
        return None
    pivots = lu.U.diagonal()
    if (lu.perm_r != lu.perm_c).any() or not (np.abs(pivots) > _EPS).all():
        return None
    return int(np.count_nonzero(pivots < 0))


def _equilibrating(largest: Array) -> Array:
    """Scale factors that bring the largest entry of every row near one. Scaling keeps the number of negative eigenvalues (Sylvester)."""
    factor = 1 / np.sqrt(largest)
    return np.where(np.isfinite(factor), factor, 1.0)


def _negatives_dense(matrix: Array) -> int | None:
    """Number of negative eigenvalues of a dense matrix, by Bunch and Kaufman's factorisation."""
    scale = _equilibrating(np.abs(matrix).max(axis=0, initial=0.0))
    factors, exchanges, _ = lapack().dsytrf(matrix * scale * scale[:, None], lower=1)
    single = exchanges > 0
    pivots = factors.diagonal()[single]
    if not np.isfinite(factors).all() or (np.abs(pivots) <= _EPS).any():
        return None
    # the pivots of two rows are indefinite
    return int(np.count_nonzero(pivots < 0)) + int(np.count_nonzero(~single)) // 2
