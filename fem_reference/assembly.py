"""Internal force and tangent stiffness of the solid by batched matrix products."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.factor import Band, band_of
from fem_reference.mesh import Discretisation


@dataclass(frozen=True, kw_only=True, eq=False)
class Pattern:
    """Sparsity pattern of a stiffness matrix with the map from element matrices to its entries.

    Parameters
    ----------
    scatter
        Sparse matrix from all element entries, raveled ``(e, 2 k, 2 k)``, to the stored entries of the stiffness.
    indices, indptr
        Row indices and column pointers of the compressed columns.
    band
        Map from the entries to band storage.
    """

    scatter: csr_matrix
    indices: Ints
    indptr: Ints
    band: Band

    def matrix(self, elements: Array) -> csc_matrix:
        """Assemble element matrices ``(e, 2 k, 2 k)`` into the stiffness ``(m, m)``."""
        m = self.indptr.size - 1
        return csc_matrix((self.scatter @ elements.ravel(), self.indices, self.indptr), shape=(m, m))

    def entries(self, matrix: csr_matrix) -> Floats:
        """Entries of a matrix ``(m, m)`` whose pattern lies in this one, in the order of ``indices``."""
        m = self.indptr.size - 1
        keys = np.repeat(np.arange(m, dtype=np.int64), np.diff(self.indptr)) * m + self.indices
        given = matrix.tocoo()
        entries = np.zeros(keys.size)
        entries[np.searchsorted(keys, given.col.astype(np.int64) * m + given.row)] = given.data
        return entries


def pattern(mesh: Discretisation, expansion: csr_matrix, added: csr_matrix | None = None) -> Pattern:
    """Build the pattern of the stiffness over the unknowns of ``expansion`` ``(2 n, m)``, and of a matrix ``added`` ``(m, m)``.

    A row of the expansion has at most one entry: a displacement is a multiple of one unknown, or zero.
    """
    size = expansion.shape[1]
    given = expansion.tocoo()
    position, factor = np.full(expansion.shape[0], -1), np.zeros(expansion.shape[0])
    position[given.row], factor[given.row] = given.col, given.data
    dofs = element_dofs(mesh)
    local, sign = position[dofs], factor[dofs]
    shape = (*local.shape, local.shape[1])
    row = np.broadcast_to(local[:, :, None], shape).ravel()
    column = np.broadcast_to(local[:, None, :], shape).ravel()
    kept = np.flatnonzero((row >= 0) & (column >= 0))
    entries = column[kept] * size + row[kept]
    more = np.zeros(0, dtype=entries.dtype)
    if added is not None:
        rows, columns = added.nonzero()
        more = columns.astype(entries.dtype) * size + rows
    keys, slot = np.unique(np.concatenate([entries, more]), return_inverse=True)
    slot = slot[: kept.size]
    signs = (sign[:, :, None] * sign[:, None, :]).ravel()[kept]
    indices: Ints = (keys % size).astype(np.int32)  # SuperLU takes 32 bits
    indptr: Ints = np.concatenate([[0], np.cumsum(np.bincount(keys // size, minlength=size))]).astype(
        np.int32
    )
    return Pattern(
        scatter=csr_matrix((signs, (slot, kept)), shape=(keys.size, row.size)),
        indices=indices,
        indptr=indptr,
        band=band_of(indices, indptr),
    )


def element_dofs(mesh: Discretisation) -> Ints:
    """Degrees of freedom ``(e, 2 k)`` of the elements, local order ``2 a + i``."""
    return (2 * mesh.cells[:, :, None] + np.arange(2)).reshape(len(mesh.cells), -1)


def deformation_gradient(mesh: Discretisation, u: Array, gradients: Floats | None = None) -> Array:
    """``F = I + du/dX`` at the quadrature points, ``(2, 2, e, q)``, from nodal displacements ``u`` ``(n, 2)``.

    With ``gradients`` such as ``mesh.nodal_gradients``, F is evaluated at their points instead.
    """
    G = mesh.gradients if gradients is None else gradients
    elements, rows, _ = G.shape
    H = (G @ u[mesh.cells]).reshape(elements, 2, rows // 2, 2).transpose(3, 1, 0, 2)
    return np.eye(2)[:, :, None, None] + H


def internal_force(mesh: Discretisation, P: Array) -> Array:
    """Internal nodal forces ``(n, 2)``, the integral of ``P . dN/dX``, from stresses ``P`` ``(2, 2, e, q)``."""
    elements = len(mesh.cells)
    weighted = (P * mesh.weights).transpose(2, 1, 3, 0).reshape(elements, -1, 2)
    forces = mesh.gradients.transpose(0, 2, 1) @ weighted
    total: Array = mesh.gather @ forces.reshape(-1, 2)
    return total


def element_tangents(mesh: Discretisation, A: Array, out: Array | None = None) -> Array:
    """Element stiffnesses ``(e, 2 k, 2 k)``, the integral of ``dN/dX . A . dN/dX``, from ``A`` ``(2, 2, 2, 2, e, q)``.

    A has major symmetry, so that three of the four blocks of components are computed. ``out`` receives the result.
    """
    elements, rows, shapes = mesh.gradients.shape
    G = mesh.gradients.reshape(elements, 2, rows // 2, shapes)
    weighted = (A * mesh.weights)[..., None]
    inner = np.empty((elements, 2, rows // 2, 3, shapes), dtype=A.dtype)
    for block, (i, k) in enumerate(((0, 0), (0, 1), (1, 1))):
        for j in range(2):
            np.multiply(weighted[i, j, k, 0], G[:, 0], out=inner[:, j, :, block])
            inner[:, j, :, block] += weighted[i, j, k, 1] * G[:, 1]
    blocks = mesh.gradients.transpose(0, 2, 1) @ inner.reshape(elements, rows, 3 * shapes)
    blocks = blocks.reshape(elements, shapes, 3, shapes)
    size = (elements, 2 * shapes, 2 * shapes)
    filled = np.empty(size, dtype=A.dtype) if out is None else out
    tangents = filled.reshape(elements, shapes, 2, shapes, 2)
    tangents[:, :, 0, :, 0], tangents[:, :, 1, :, 1] = blocks[:, :, 0], blocks[:, :, 2]
    tangents[:, :, 0, :, 1], tangents[:, :, 1, :, 0] = blocks[:, :, 1], blocks[:, :, 1].swapaxes(1, 2)
    return filled


def batches(mesh: Discretisation) -> tuple[Discretisation, ...]:
    """Split the elements into batches whose arrays fit into the processor's cache."""
    count = -(-len(mesh.cells) // _BATCH)
    return tuple(
        replace(mesh, cells=cells, gradients=gradients, weights=weights)
        for cells, gradients, weights in zip(
            *(np.array_split(field, count) for field in (mesh.cells, mesh.gradients, mesh.weights)),
            strict=True,
        )
    )


_BATCH = 256
