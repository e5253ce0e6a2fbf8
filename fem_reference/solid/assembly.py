"""Internal force and tangent stiffness of the solid by matrix products over all elements.

All elements have the shape functions of one reference square. Displacements become gradients, stresses nodal forces and
moduli stiffnesses by products with matrices of the square's shape functions, after a transformation at every point by the
inverse Jacobian.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, tril

from fem_reference.solid.mesh import Discretisation, Points
from fem_reference.statement.arrays import Array, Floats, Ints
from fem_reference.statement.material import Law


@dataclass(frozen=True, kw_only=True, eq=False)
class Pattern:
    """Sparsity of a symmetric stiffness matrix, and the map from element stiffnesses to LAPACK's lower band."""

    # from all element entries, see `element_entries`, to the entries on and below the diagonal
    scatter: csr_matrix
    positions: Ints  # positions of these entries in the raveled band ``(m, width + 1)``, column after column
    size: int  # size, width: number of unknowns m, and number of diagonals below the main one
    width: int

    def band(self, elements: Array) -> Array:
        """Assemble element entries into the band ``(width + 1, m)`` of the stiffness, in Fortran order."""
        flat = np.zeros(self.size * (self.width + 1), dtype=elements.dtype)
        flat[self.positions] = self.scatter @ elements
        return flat.reshape(self.size, self.width + 1).T

    def band_of(self, matrix: csr_matrix) -> Floats:
        """Band ``(width + 1, m)`` of a symmetric matrix ``(m, m)`` whose pattern lies in this one."""
        band, lower = np.zeros((self.width + 1, self.size)), tril(matrix).tocoo()
        band[lower.row - lower.col, lower.col] = lower.data
        return band


def pattern(mesh: Discretisation, expansion: csr_matrix, added: csr_matrix | None = None) -> Pattern:
    """Pattern of the stiffness over the unknowns of an ``expansion`` with at most one entry a row, and of ``added``."""
    size = expansion.shape[1]
    given = expansion.tocoo()
    unknown, factor = np.full(expansion.shape[0], -1), np.zeros(expansion.shape[0])
    unknown[given.row], factor[given.row] = given.col, given.data
    dofs = (2 * mesh.cells[:, :, None] + np.arange(2)).reshape(len(mesh.cells), -1)
    pairs = _entries(mesh.cells.shape[1])
    rows, columns = (np.concatenate([dofs[:, pair[side]].ravel() for pair in pairs]) for side in (0, 1))
    kept = np.flatnonzero((unknown[rows] >= 0) & (unknown[columns] >= 0))
    i, j, factors = unknown[rows[kept]], unknown[columns[kept]], factor[rows[kept]] * factor[columns[kept]]
    factors[(rows[kept] != columns[kept]) & (i == j)] *= 2  # the entry and the transposed one
    more = tril(added if added is not None else csr_matrix((size, size))).tocoo()
    first, last = np.append(np.minimum(i, j), more.col), np.append(np.maximum(i, j), more.row)
    width = int((last - first).max(initial=0))
    positions, slots = np.unique(first.astype(np.int64) * (width + 1) + last - first, return_inverse=True)
    scatter = csr_matrix((factors, (slots[: kept.size], kept)), shape=(positions.size, rows.size))
    return Pattern(scatter=scatter, positions=positions, size=size, width=width)


def _entries(shapes: int) -> list[tuple[Ints, Ints]]:
    """Local degrees of freedom ``2 a + i`` of the rows and columns in the three parts of `element_entries`."""
    a, b = np.triu_indices(shapes)
    row, column = (index.ravel() for index in np.indices((shapes, shapes)))
    return [(2 * a, 2 * b), (2 * a + 1, 2 * b + 1), (2 * row, 2 * column + 1)]


def deformation_gradient(mesh: Discretisation, u: Array, points: Points | None = None) -> Array:
    """``F = I + du/dX`` ``(2, 2, e, q)`` at the quadrature or other ``points`` from displacements ``u`` ``(n, 2)``."""
    at = mesh.gauss if points is None else points
    elements, shapes = mesh.cells.shape
    nodal = u.T.take(mesh.cells, axis=1)
    nodal -= nodal[:, :, :1]  # leaves the gradient, and less round-off in it
    H = (nodal.reshape(-1, shapes) @ at.slopes.reshape(-1, shapes).T).reshape(2, elements, 2, -1)
    F = np.empty((2, 2, elements, H.shape[3]), dtype=u.dtype)
    for i in range(2):
        for j in range(2):
            F[i, j] = at.transformed(H[i].swapaxes(0, 1), j)
        F[i, i] += 1
    return F


def internal_force(mesh: Discretisation, P: Array) -> Array:
    """Internal nodal forces ``(n, 2)``, the integral of ``P . dN/dX``, from stresses ``P`` ``(2, 2, e, q)``."""
    elements, shapes = mesh.cells.shape
    pulled = np.empty((2, elements, 2, P.shape[3]), dtype=P.dtype)
    for i in range(2):
        weighted = P[i] * mesh.weights
        for k in range(2):
            pulled[i, :, k] = mesh.gauss.pulled_back(weighted, k)
    forces = pulled.reshape(2 * elements, -1) @ mesh.gauss.slopes.reshape(-1, shapes)
    return np.asarray(mesh.gather @ forces.reshape(2, -1).T)


def element_entries(mesh: Discretisation, law: Law, u: Array) -> Array:
    """Entries of all element stiffnesses, the integral of ``dN/dX . A . dN/dX``, in one array.

    The three parts are the blocks of the first and of the second component for the shape functions a <= b,
    ``(e, k (k + 1) / 2)``, and that of both components for all, ``(e, k k)``.
    """
    A = law.tangent(deformation_gradient(mesh, u))
    upper, every = mesh.products
    parts = [_pulled_back(mesh, A[i, :, i], _UPPER) @ upper for i in range(2)]
    return np.concatenate([part.ravel() for part in (*parts, _pulled_back(mesh, A[0, :, 1], _ALL) @ every)])


_UPPER, _ALL = ((0, 0), (0, 1), (1, 1)), ((0, 0), (0, 1), (1, 0), (1, 1))


def _pulled_back(mesh: Discretisation, block: Array, components: tuple[tuple[int, int], ...]) -> Array:
    """Weighted ``components`` of a block ``A_jl`` ``(2, 2, e, q)`` on the reference square, ``(e, c q)``."""
    at, (elements, q) = mesh.gauss, mesh.weights.shape
    pulled = np.empty((elements, len(components), q), dtype=block.dtype)
    for number, (first, second) in enumerate(components):
        if at.aligned:
            factor = mesh.weights * at.inverse[first, first] * at.inverse[second, second]
            np.multiply(block[first, second], factor, out=pulled[:, number])
        else:
            sides = [at.pulled_back(block[:, side], first) for side in range(2)]
            pulled[:, number] = mesh.weights * at.pulled_back(sides, second)
    return pulled.reshape(elements, -1)
