"""Shape functions at any points of a strip."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.mesh import Discretisation


@dataclass(frozen=True, kw_only=True, eq=False)
class Sample:
    """Elements found at p points, and their shape functions there.

    Parameters
    ----------
    cells
        Nodes of the element at each point ``(p, k)``.
    values
        Shape functions ``(p, k)``.
    gradients
        Their gradients ``(p, 2, k)`` [1/m].
    """

    cells: Ints
    values: Floats
    gradients: Floats

    def rows(self, nodes: int) -> csr_matrix:
        """Values at the points as weights of all nodes, ``(p, nodes)``."""
        points = np.repeat(np.arange(len(self.cells)), self.cells.shape[1])
        return csr_matrix((self.values.ravel(), (points, self.cells.ravel())), shape=(len(self.cells), nodes))

    def deformation_gradient(self, u: Array) -> Array:
        """``F = I + du/dX`` at the points, ``(2, 2, p)``, from nodal displacements ``u`` ``(n, 2)``."""
        H: Array = (self.gradients @ u[self.cells]).transpose(2, 1, 0)
        return np.eye(2)[:, :, None] + H


def sample(mesh: Discretisation, points: Floats) -> Sample:
    """Find the elements at ``points`` ``(p, 2)``, in the strip's frame.

    Raises
    ------
    ValueError
        If a point is not in the strip.
    """
    return sample_basis(mesh.basis, mesh.cells, points)


def sample_basis(basis: object, cells: Ints, points: Floats) -> Sample:
    """As `sample`, from scikit-fem's basis and the nodes of its elements ``(e, k)``."""
    found = basis.mesh.element_finder()(*points.T)  # type: ignore[attr-defined]  # scikit-fem has no types
    mapping, element = basis.mapping, basis.elem  # type: ignore[attr-defined]
    local = mapping.invF(points.T[:, :, None], tind=found)
    shapes = [element.gbasis(mapping, local, i, tind=found)[0] for i in range(cells.shape[1])]
    values = [np.broadcast_to(np.asarray(shape), (len(points), 1))[:, 0] for shape in shapes]
    gradients = [np.broadcast_to(shape.grad, (2, len(points), 1))[:, :, 0].T for shape in shapes]
    return Sample(
        cells=cells[found], values=np.stack(values, axis=-1), gradients=np.stack(gradients, axis=-1)
    )
