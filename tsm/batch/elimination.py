"""Symmetric elimination of many banded systems with a border at once.

::

    [ A    B ] [ x ]   [ r ]
    [ B^T  D ] [ z ] = [ s ]

``A = L diag(d) L^T`` without exchange of rows. A pivot that is small by chance makes the solution of its system inaccurate and Newton's
method slower there; convergence is read from the residual, so no result is wrong. The determinant has the sign of the product of the pivots.
"""

from __future__ import annotations

import numpy as np

from tsm.elements.properties import Array


def row_length(k: int) -> int:
    """Length of a stored column of a band of bandwidth k: the lower half, and room that the elimination overwrites."""
    return max(2 * k, 1)


def reach(rows: Array, columns: Array, n: int) -> list[int]:
    """Last equation that each of n is coupled with once those before it are eliminated.

    Parameters
    ----------
    rows, columns : ndarray of int
        Entries of the matrix, lower half.
    n : int
        Number of equations.
    """
    last = np.arange(n)
    np.maximum.at(last, columns, rows)
    widened: list[int] = np.maximum.accumulate(last).tolist()
    return widened


def eliminate(
    band: Array, last: list[int], right: Array, corner: Array, border_side: Array
) -> tuple[Array, Array, Array]:
    """Solve all systems; those that break down have entries that are not finite.

    Parameters
    ----------
    band : ndarray, shape (n, row_length(k), N)
        ``band[j, i - j]`` is the entry i, j, lower half; contiguous, overwritten.
    last : list of int
        See `reach`.
    right : ndarray, shape (1 + b, n, N)
        r, then the columns of B; overwritten.
    corner : ndarray, shape (b, b, N)
        D; overwritten.
    border_side : ndarray, shape (b, N)
        s; overwritten.

    Returns
    -------
    x : ndarray, shape (n, N)
        Solution of the banded part.
    z : ndarray, shape (b, N)
        Solution of the border.
    orientation : ndarray of float, shape (N,)
        Sign of the determinant.
    """
    n, length, count = band.shape
    step = band.strides[1]
    inverse = np.empty((n, count))
    k = max(end - j for j, end in enumerate(last))
    room = np.empty((k, k, count))
    wide = np.empty((len(right), k, count))
    for j in range(n):
        near = last[j] - j
        np.divide(1.0, band[j, 0], out=inverse[j])
        if not near:
            continue
        column = band[j, 1 : near + 1]
        lower = column * inverse[j]
        # entry a, b of the rest of the band, its lower half; the upper falls into the room of the row before
        strides = (step, (length - 1) * step, band.itemsize)
        rest = np.ndarray((near, near, count), float, band, (j + 1) * length * step, strides)
        rest -= np.multiply(lower[:, None], column, out=room[:near, :near])
        part = right[:, j + 1 : j + near + 1]
        part -= np.multiply(right[:, j, None], lower, out=wide[:, :near])
        band[j, 1 : near + 1] = lower
    scaled = right[1:] * inverse
    for a in range(len(corner)):
        border_side[a] -= np.einsum("jn,jn->n", scaled[a], right[0])
        for b in range(a + 1):
            corner[a, b] -= np.einsum("jn,jn->n", scaled[a], right[1 + b])
    z, sign = _dense(corner, border_side)
    x = right[0] * inverse
    for a in range(len(corner)):
        x -= scaled[a] * z[a]
    for j in range(n - 2, -1, -1):
        near = last[j] - j
        x[j] -= np.einsum("mn,mn->n", band[j, 1 : near + 1], x[j + 1 : j + near + 1])
    odd = (inverse < 0).sum(axis=0) % 2
    return x, z, np.where(odd, -sign, sign)


def _dense(matrix: Array, border_side: Array) -> tuple[Array, Array]:
    """Solutions and signs of the determinants of symmetric systems, of which the lower half is given; overwrites both."""
    size = len(matrix)
    sign = np.ones(border_side.shape[1])
    for j in range(size):
        sign = np.where(matrix[j, j] < 0, -sign, sign)
        for i in range(j + 1, size):
            factor = matrix[i, j] / matrix[j, j]
            for m in range(j + 1, i + 1):
                matrix[i, m] -= factor * matrix[m, j]
            border_side[i] -= factor * border_side[j]
    for j in range(size - 1, -1, -1):
        border_side[j] /= matrix[j, j]
        for i in range(j):
            border_side[i] -= matrix[j, i] * border_side[j]
    return border_side, sign
