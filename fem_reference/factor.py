"""Factorisation of a body's tangent stiffness, and the number of its negative eigenvalues.

The stiffness is a symmetric band matrix. If all its eigenvalues are positive, it is factorised by Cholesky's method.
Otherwise SuperLU factorises it with its pivots on the diagonal, ``K = L D L^T``: the number of negative pivots is the number of
negative eigenvalues (Sylvester's law of inertia). If these factors grow, they are inaccurate: then rows are exchanged, and the
eigenvalues themselves are counted.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigvals_banded
from scipy.linalg.lapack import dpbtrf, dtbtrs
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import SuperLU, splu

from fem_reference.arrays import Floats

_GROWTH = 1e3
"""Largest ratio of the row sums of ``|L| |U|`` and ``|K|`` at which the factors without row exchanges are used."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Factor:
    """A factorised symmetric matrix K. A solution is found in two halves."""

    # first half ``h(b)`` of the solution for ``b`` ``(m,)`` or ``(m, c)``: ``L^-1 b`` by Cholesky, else b itself
    half: Callable[[Floats], Floats]
    rest: Callable[[Floats], Floats]  # second half: ``K^-1 b`` from ``h(b)``
    product: Callable[[Floats, Floats], Floats]  # ``a^T K^-1 b`` from ``h(a)`` and ``h(b)``
    negatives: Callable[[], int]  # function that returns the number of negative eigenvalues

    def solve(self, right: Floats) -> Floats:
        """Solution of ``K x = b`` for ``b`` ``(m,)`` or ``(m, c)``."""
        return self.rest(self.half(right))


def factorise(matrix: Callable[[], Floats]) -> Factor | None:
    """Factorise a symmetric matrix; None if it is singular.

    ``matrix`` returns the matrix in lower band storage ``(width + 1, m)``, in Fortran order, as a new array in every call.
    """
    return _definite(matrix()) or _indefinite(matrix())


def _definite(band: Floats) -> Factor | None:
    """Factorise and overwrite a positive definite matrix; None if it is not."""
    lower, failed = dpbtrf(band, lower=1, overwrite_ab=1)
    if failed:
        return None
    return Factor(
        half=lambda right: _triangular(lower, right),
        rest=lambda half: _triangular(lower, half, transposed=True),
        product=lambda a, b: np.asarray(a.T @ b),
        negatives=lambda: 0,
    )


def _triangular(lower: Floats, right: Floats, *, transposed: bool = False) -> Floats:
    """Solve ``L x = b`` or ``L^T x = b``."""
    solution, _ = dtbtrs(lower, right, uplo="L", trans="T" if transposed else "N")
    return np.asarray(solution).reshape(right.shape)


def _indefinite(band: Floats) -> Factor | None:
    """Factorise a symmetric matrix; None if it is singular."""
    lower = [entries[: band.shape[1] - k] for k, entries in enumerate(band)]
    width = len(lower) - 1
    matrix = csc_matrix(diags([*lower[:0:-1], *lower], [*range(width, 0, -1), *range(0, -width - 1, -1)]))
    symmetric = _superlu(matrix, diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    accurate = (
        symmetric is not None
        and (symmetric.perm_r == symmetric.perm_c).all()
        and not _grown(symmetric, matrix)
    )
    lu = symmetric if accurate else _superlu(matrix)
    if lu is None:
        return None
    return Factor(
        half=lambda right: right,
        rest=lambda half: np.asarray(lu.solve(np.ascontiguousarray(half))),
        product=lambda a, b: np.asarray(a.T @ lu.solve(np.ascontiguousarray(b))),
        negatives=lambda: int((lu.U.diagonal() < 0).sum()) if accurate else count_negatives(band),
    )


def _superlu(matrix: csc_matrix, **options: object) -> SuperLU | None:
    """Factors in the order of the band; None if the matrix is singular."""
    try:
        return splu(matrix, permc_spec="NATURAL", **options)
    except RuntimeError:  # SuperLU's word for an exactly singular matrix
        return None


def _grown(lu: SuperLU, matrix: csc_matrix) -> bool:
    """Whether the factors are so much larger than the matrix that they are inaccurate."""
    rows = np.abs(lu.L) @ (np.abs(lu.U) @ np.ones(matrix.shape[0]))
    return not rows.max() <= _GROWTH * np.abs(matrix).sum(axis=1).max()


def count_negatives(band: Floats) -> int:
    """Count the negative eigenvalues of a matrix in lower band storage ``(width + 1, m)`` by computing them."""
    bound = 2 * band.shape[0] * float(np.abs(band).max())
    return int(eigvals_banded(band, lower=True, select="v", select_range=(-bound, 0.0)).size)
