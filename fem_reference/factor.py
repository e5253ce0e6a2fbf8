"""Factorisation of a body's tangent stiffness, and the number of its negative eigenvalues.

The stiffness is a symmetric band matrix. If all its eigenvalues are positive, it is factorised by Cholesky's method.
Otherwise ``K = L J L^T`` with signs J on the diagonal: where Cholesky's method meets a pivot that is not positive, the column is
divided by the root of its absolute value, and the method goes on behind it. The number of negative signs is the number of
negative eigenvalues (Sylvester's law of inertia). The pivots are not exchanged. If the factors grow, they are inaccurate: then the
matrix is factorised with row exchanges, and the eigenvalues themselves are counted.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigvals_banded, solve_triangular
from scipy.linalg.lapack import dgbtrf, dgbtrs, dpbtrf, dtbtrs

from fem_reference.arrays import Floats

_GROWTH = 1e3
"""Largest ratio of the row sums of ``|L| |L^T|`` and ``|K|`` at which the factors without row exchanges are used."""

_COLUMNS = 8
"""Number of columns, over the number of diagonals, that are factored at once where a pivot is not positive."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Factor:
    """A factorised symmetric matrix K. A solution is found in two halves."""

    # first half ``h(b)`` of the solution for ``b`` ``(m,)`` or ``(m, c)``: ``L^-1 b``, or b itself after
    # row exchanges
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
    return _definite(matrix()) or _indefinite(matrix()) or _with_row_exchanges(matrix())


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


def _indefinite(lower: Floats) -> Factor | None:
    """Factorise and overwrite a symmetric matrix; None if the factors without row exchanges are inaccurate."""
    size = _largest_row_sum(lower)
    signs = _signed_cholesky(lower)
    if signs is None or _grown(lower) > _GROWTH * size:
        return None
    return Factor(
        half=lambda right: _triangular(lower, right),
        rest=lambda half: _triangular(lower, (signs * half.T).T, transposed=True),
        product=lambda a, b: np.asarray((signs * a.T) @ b),
        negatives=lambda: int((signs < 0).sum()),
    )


def _signed_cholesky(lower: Floats) -> Floats | None:
    """Overwrite a matrix ``L J L^T`` by its factor L, both in band storage; return the diagonal ``(m,)`` of J.

    None where a pivot vanishes.
    """
    m, start = lower.shape[1], 0
    signs = np.ones(m)
    while start < m:
        stop = min(start + _COLUMNS * len(lower), m)
        part, failed = dpbtrf(lower[:, start:stop], lower=1)
        if failed:
            stop = start + failed - 1
            part = dpbtrf(lower[:, start:stop], lower=1)[0] if failed > 1 else lower[:, start:stop]
        lower[:, start:stop] = part
        pivot = _continue_behind(lower, start, stop, pivot=failed > 0)
        if failed and (pivot == 0 or not np.isfinite(pivot)):
            return None
        if failed:
            signs[stop] = np.sign(pivot)
        start = stop + (failed > 0)
    return signs


def _continue_behind(lower: Floats, start: int, stop: int, *, pivot: bool) -> float:
    """Subtract the factored columns ``start`` to ``stop`` from the rows behind them.

    With ``pivot`` the column ``stop`` is factored and subtracted too. The value of its pivot is returned.
    """
    width, m = lower.shape[0] - 1, lower.shape[1]
    first, end = max(start, stop - width), min(stop + width + 1, m)
    window, own, value = _dense(lower, first, end), stop - first, 0.0
    if own:
        behind = solve_triangular(window[:own, :own], window[own:, :own].T, lower=True).T
        window[own:, :own] = behind
        window[own:, own:] -= behind @ behind.T
    if pivot:
        value = float(window[own, own])
        if value != 0:
            window[own:, own] *= np.sign(value) / np.sqrt(abs(value))
        column = window[own + 1 :, own]
        window[own + 1 :, own + 1 :] -= np.sign(value) * np.outer(column, column)
    for diagonal in range(min(width + 1, end - first)):
        lower[diagonal, first : end - diagonal] = np.diagonal(window, -diagonal)
    return value


def _dense(band: Floats, first: int, end: int) -> Floats:
    """Lower triangle of the rows and columns ``first`` to ``end`` of a band matrix."""
    size = end - first
    window = np.zeros((size, size))
    for diagonal in range(min(band.shape[0], size)):
        rows = np.arange(diagonal, size)
        window[rows, rows - diagonal] = band[diagonal, first : end - diagonal]
    return window


def _with_row_exchanges(band: Floats) -> Factor | None:
    """Factorise a band matrix with row exchanges; None if it is singular."""
    width, m = band.shape[0] - 1, band.shape[1]
    both = np.zeros((3 * width + 1, m), order="F")
    for diagonal in range(width + 1):
        both[2 * width + diagonal, : m - diagonal] = band[diagonal, : m - diagonal]
        both[2 * width - diagonal, diagonal:] = band[diagonal, : m - diagonal]
    lu, rows, failed = dgbtrf(both, width, width, overwrite_ab=1)
    if failed:
        return None

    def solve(right: Floats) -> Floats:
        return np.asarray(dgbtrs(lu, width, width, right, rows)[0]).reshape(right.shape)

    return Factor(
        half=lambda right: right,
        rest=solve,
        product=lambda a, b: np.asarray(a.T @ solve(b)),
        negatives=lambda: count_negatives(band),
    )


def _grown(lower: Floats) -> float:
    """Largest row sum of ``|L| |L^T|``."""
    m, columns = lower.shape[1], sum(np.abs(entries) for entries in lower)
    total = np.zeros(m)
    for diagonal, entries in enumerate(lower):
        total[diagonal:] += (np.abs(entries) * columns)[: m - diagonal]
    return float(total.max())


def _largest_row_sum(band: Floats) -> float:
    """Largest row sum of the absolute values of a symmetric matrix in lower band storage."""
    m, total = band.shape[1], np.abs(band[0])
    for diagonal, entries in enumerate(band[1:], 1):
        total += np.abs(entries)
        total[diagonal:] += np.abs(entries)[: m - diagonal]
    return float(total.max())


def count_negatives(band: Floats) -> int:
    """Count the negative eigenvalues of a matrix in lower band storage ``(width + 1, m)`` by computing them."""
    bound = 2 * band.shape[0] * float(np.abs(band).max())
    return int(eigvals_banded(band, lower=True, select="v", select_range=(-bound, 0.0)).size)
