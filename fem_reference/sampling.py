"""Shape functions at arbitrary points of a strip, and Gauss points of its sections."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.mesh import Discretisation
from fem_reference.strip import Strip

SECTION_LAYERS = 8
"""Layers of Gauss points over the height by which a section of a user's mesh is integrated."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Sample:
    """Shape functions of the elements that contain p given points."""

    cells: Ints  # nodes of the element that contains each point ``(p, k)``
    values: Floats  # shape functions ``(p, k)``
    gradients: Floats  # shape-function gradients ``(p, 2, k)`` [1/m]

    def rows(self, nodes: int) -> csr_matrix:
        """Interpolation matrix ``(p, nodes)`` from nodal values to values at the points."""
        points = np.repeat(np.arange(len(self.cells)), self.cells.shape[1])
        return csr_matrix((self.values.ravel(), (points, self.cells.ravel())), shape=(len(self.cells), nodes))

    def deformation_gradient(self, u: Array) -> Array:
        """``F = I + du/dX`` at the points, ``(2, 2, p)``, from nodal displacements ``u`` ``(n, 2)``."""
        H: Array = (self.gradients @ u[self.cells]).transpose(2, 1, 0)
        return np.eye(2)[:, :, None] + H


def sample(mesh: Discretisation, points: Floats) -> Sample:
    """Evaluate the shape functions at the places ``points`` ``(p, 2)``: axial coordinate and distance to the left of the axis.

    Raises ValueError if a point is not in the strip.
    """
    found = sample_basis(mesh.basis, mesh.cells, points)
    if mesh.nodes is mesh.places:
        return found
    bent = np.einsum("pka,pbk->pab", mesh.nodes[found.cells], found.gradients)
    return replace(found, gradients=np.linalg.inv(bent).swapaxes(1, 2) @ found.gradients)


def sample_basis(basis: object, cells: Ints, points: Floats) -> Sample:
    """Evaluate the shape functions of a scikit-fem basis; ``cells`` ``(e, k)`` are the nodes of its elements."""
    containing = basis.mesh.element_finder()(*points.T)  # type: ignore[attr-defined]  # scikit-fem has no types
    mapping, element = basis.mapping, basis.elem  # type: ignore[attr-defined]
    local = mapping.invF(points.T[:, :, None], tind=containing)
    shapes = [element.gbasis(mapping, local, i, tind=containing)[0] for i in range(cells.shape[1])]
    values = [np.broadcast_to(np.asarray(shape), (len(points), 1))[:, 0] for shape in shapes]
    gradients = [np.broadcast_to(shape.grad, (2, len(points), 1))[:, :, 0].T for shape in shapes]
    return Sample(
        cells=cells[containing], values=np.stack(values, axis=-1), gradients=np.stack(gradients, axis=-1)
    )


def section_points(
    strip: Strip, nodes: Floats, edges: dict[str, Ints], stations: Floats
) -> tuple[Floats, Floats, Floats]:
    """Points, shares that sum to one, and heights of the sections at ``stations`` ``(m,)``, section after section.

    Three-point Gauss rules in the rows of elements, or in equal layers of a user's mesh.
    """
    layers = strip.mesh[1] if strip.mesh_file is None else SECTION_LAYERS
    low, high = (np.interp(stations, *nodes[edges[name]].T) for name in ("right", "left"))
    points, weights = np.polynomial.legendre.leggauss(3)
    fractions = (np.arange(layers)[:, None] + (1 + points) / 2).ravel() / layers
    y = low[:, None] + fractions * (high - low)[:, None]
    x = np.broadcast_to(stations[:, None], y.shape)
    return np.stack([x.ravel(), y.ravel()], axis=1), np.tile(weights / 2, layers) / layers, high - low
