"""Factorisation of a body's tangent stiffness, and the number of its negative eigenvalues.

A banded Cholesky factorisation succeeds if and only if all eigenvalues are positive. If it fails, the signs of the pivots of
``K = L D L^T`` give the number of negative eigenvalues (Sylvester's law of inertia). Pivots of a factorisation whose
entries grow are unreliable; then the eigenvalues themselves are counted.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigvals_banded
from scipy.linalg.lapack import dpbtrf, dpbtrs
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from fem_reference.arrays import Floats, Ints

_GROWTH = 1e3
"""Largest ratio of the row sums of ``|L| |D L^T|`` and ``|K|`` at which the signs of the pivots are used."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Band:
    """Positions of the entries of a symmetric sparse matrix in LAPACK's lower band storage.

    Parameters
    ----------
    entries
        Indices of the entries on and below the diagonal in the compressed-column data.
    positions
        Positions of these entries in the raveled band ``(m, width + 1)``, column after column.
    width
        Number of diagonals below the main one.
    """

    entries: Ints
    positions: Ints
    width: int

    def fill(self, K: csc_matrix) -> Floats:
        """Return a matrix in band storage, ``(width + 1, m)``, in Fortran order."""
        flat = np.zeros(K.shape[0] * (self.width + 1))
        flat[self.positions] = K.data[self.entries]
        return flat.reshape(K.shape[0], self.width + 1).T


@dataclass(frozen=True, kw_only=True, eq=False)
class Factor:
    """A factorised symmetric matrix.

    Parameters
    ----------
    solve
        Solution of ``K x = b`` for ``b`` ``(m,)`` or ``(m, c)``.
    negatives
        Function that returns the number of negative eigenvalues.
    """

    solve: Callable[[Floats], Floats]
    negatives: Callable[[], int]


def band_of(indices: Ints, indptr: Ints) -> Band:
    """Return the band of a sparsity pattern in compressed columns."""
    column = np.repeat(np.arange(indptr.size - 1), np.diff(indptr))
    entries = np.flatnonzero(indices >= column)
    below = indices[entries] - column[entries]
    width = int(below.max(initial=0))
    positions = column[entries].astype(np.int64) * (width + 1) + below
    return Band(entries=entries, positions=positions, width=width)


def factorise(K: csc_matrix, band: Band) -> Factor | None:
    """Factorise a symmetric matrix; None if it is singular."""
    lower, failed = dpbtrf(band.fill(K), lower=1, overwrite_ab=1)
    if failed:
        return _indefinite(K, band)

    def solve(right: Floats) -> Floats:
        return np.asarray(dpbtrs(lower, right, lower=1)[0]).reshape(right.shape)

    return Factor(solve=solve, negatives=lambda: 0)


def _indefinite(K: csc_matrix, band: Band) -> Factor | None:
    """Factorise a matrix that is not positive definite; None if it is singular."""
    try:
        lu = splu(K, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        if _reliable(K, lu):
            return Factor(solve=lu.solve, negatives=lambda: int((lu.U.diagonal() < 0).sum()))
    except RuntimeError:  # a zero pivot
        pass
    try:
        lu = splu(K, permc_spec="NATURAL")
    except RuntimeError:
        return None
    return Factor(solve=lu.solve, negatives=lambda: count_negatives(band.fill(K)))


def _reliable(K: csc_matrix, lu: object) -> bool:
    """Whether every pivot was taken from the diagonal and the factors did not grow."""
    rows, columns, L, U = (getattr(lu, name) for name in ("perm_r", "perm_c", "L", "U"))
    if not np.array_equal(rows, columns):
        return False
    ones = np.ones(K.shape[0])
    grown, size = abs(L) @ (abs(U) @ ones), abs(K) @ ones
    return bool(grown.max() <= _GROWTH * size.max())


def count_negatives(band: Floats) -> int:
    """Count the negative eigenvalues of a matrix in lower band storage ``(width + 1, m)`` by computing them."""
    bound = 2 * band.shape[0] * float(np.abs(band).max())
    return int(eigvals_banded(band, lower=True, select="v", select_range=(-bound, 0.0)).size)
