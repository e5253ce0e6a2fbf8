"""Internal force and tangent stiffness of the solid by matrix products over all elements.

All elements have the shape functions of one reference square. Displacements become gradients, stresses nodal forces and
moduli stiffnesses by products with matrices of the square's shape functions, after a transformation at every point by the
inverse Jacobian.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, tril

from fem_reference.solid.mesh import Discretisation, Points, blocks
from fem_reference.statement.arrays import Array, Floats, Ints


@dataclass(frozen=True, kw_only=True, eq=False)
class Pattern:
    """Sparsity of a symmetric stiffness matrix, and the map from element stiffnesses to LAPACK's lower band."""

    # from all element entries, see `element_entries`, to the entries on and below the diagonal
    scatter: csr_matrix
    positions: Ints  # positions of these entries in the raveled band ``(m, width + 1)``, column after column
    added: Floats  # constant part of these entries
    size: int  # size, width: number of unknowns m, and number of diagonals below the main one
    width: int

    def band(self, elements: Array) -> Array:
        """Assemble element entries into the band ``(width + 1, m)`` of the stiffness, in Fortran order."""
        flat = np.zeros(self.size * (self.width + 1), dtype=elements.dtype)
        values = self.scatter @ elements
        values += self.added
        flat[self.positions] = values
        return flat.reshape(self.size, self.width + 1).T


def pattern(mesh: Discretisation, expansion: csr_matrix, added: csr_matrix | None = None) -> Pattern:
    """Pattern of the stiffness over the unknowns of an ``expansion`` with at most one entry a row, and an ``added`` symmetric one."""
    size = expansion.shape[1]
    given = expansion.tocoo()
    unknown, factor = np.full(expansion.shape[0], -1), np.zeros(expansion.shape[0])
    unknown[given.row], factor[given.row] = given.col, given.data
    dofs = (2 * mesh.cells[:, :, None] + np.arange(2)).reshape(len(mesh.cells), -1)
    found = [(dofs[:, 2 * a + i], dofs[:, 2 * b + k]) for i, k, a, b in blocks(mesh.cells.shape[1])]
    rows, columns = (np.concatenate([part.ravel() for part in side]) for side in zip(*found, strict=True))
    kept = np.flatnonzero((unknown[rows] >= 0) & (unknown[columns] >= 0))
    i, j, factors = unknown[rows[kept]], unknown[columns[kept]], factor[rows[kept]] * factor[columns[kept]]
    factors[(rows[kept] != columns[kept]) & (i == j)] *= 2  # the entry and the transposed one
    more = tril(added if added is not None else csr_matrix((size, size))).tocoo()
    first, last = np.append(np.minimum(i, j), more.col), np.append(np.maximum(i, j), more.row)
    width = int((last - first).max(initial=0))
    positions, slots = np.unique(first.astype(np.int64) * (width + 1) + last - first, return_inverse=True)
    scatter = csr_matrix((factors, (slots[: kept.size], kept)), shape=(positions.size, rows.size))
    constant = np.zeros(positions.size)
    constant[slots[kept.size :]] = more.data
    return Pattern(scatter=scatter, positions=positions, added=constant, size=size, width=width)


def deformation_gradient(mesh: Discretisation, u: Array, points: Points | None = None) -> Array:
    """``F = I + du/dX`` ``(2, 2, e, q)`` at the quadrature or other ``points`` from displacements ``u`` ``(n, 2)``."""
    at = mesh.gauss if points is None else points
    elements, shapes = mesh.cells.shape
    nodal = u.T.take(mesh.cells, axis=1)
    nodal -= nodal[:, :, :1]  # leaves the gradient, and less round-off in it
    H = (nodal.reshape(-1, shapes) @ at.slopes.reshape(-1, shapes).T).reshape(2, 1, elements, 2, -1)
    F = H[..., 0, :] * at.inverse[0] + H[..., 1, :] * at.inverse[1]
    F[0, 0] += 1
    F[1, 1] += 1
    return F


def internal_force(mesh: Discretisation, P: Array) -> Array:
    """Internal nodal forces ``(n, 2)``, the integral of ``P . dN/dX``, from stresses ``P`` ``(2, 2, e, q)``."""
    pulled = np.einsum("ijeq,Kjeq->ieKq", P * mesh.weights, mesh.gauss.inverse)
    forces = np.tensordot(pulled, mesh.gauss.slopes, ((2, 3), (0, 1)))
    return mesh.gather @ forces.reshape(2, -1).T


def element_entries(mesh: Discretisation, A: Array) -> Array:
    """Entries of all element stiffnesses, the integral of ``dN/dX . A . dN/dX``, in one array, block after block of `products`.

    ``A``: moduli ``(2, 2, 2, 2, e, q)``.
    """
    parts = []
    inverse, weighted = mesh.gauss.inverse, mesh.weights * mesh.gauss.inverse
    for i, k, products in mesh.products:
        half = np.einsum("jleq,Kjeq->Kleq", A[i, :, k], weighted)
        pulled = np.moveaxis(np.einsum("Kleq,Lleq->KLeq", half, inverse), 2, 0)
        parts.append((pulled.reshape(len(mesh.cells), -1) @ products).ravel())
    return np.concatenate(parts)
