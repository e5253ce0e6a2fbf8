"""Meshes of quadrilaterals in the frame of the strip."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.arrays import Floats, Ints
from fem_reference.strip import Strip

GAUSS = {"Q1": (2, 2), "Q2": (2, 3), "Q2-full": (3, 3)}
"""Numbers of Gauss points in each element, along the strip and across.

If an element is bent by the angle a, its parabolic shape functions have a spurious membrane strain of about a^2 / 24 times
Legendre's second polynomial along the strip. The polynomial vanishes at two Gauss points; with three points the
element locks. Three points across the strip avoid zero-energy modes.
"""
EDGES = ("start", "end", "right", "left")
"""Names of the two ends and of the faces to the right and left of the direction from start to end."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Discretisation:
    """Elements of a strip in the strip's frame, with x along the axis from 0 to L and y to the left.

    Parameters
    ----------
    nodes
        Reference positions ``(n, 2)`` [m].
    cells
        Nodes of each element ``(e, k)``: four corners anticlockwise from the lower left one; biquadratic elements also
        have four midside nodes and a centre node.
    gradients
        Shape-function gradients ``(e, 2 q, k)``, direction-major in the middle axis [1/m].
    weights
        Quadrature weights ``(e, q)``, width included [m^3].
    nodal_gradients
        Shape-function gradients at the element's own nodes, in the same layout as ``gradients`` [1/m].
    gather
        Sparse matrix ``(n, e k)`` that adds the nodal values of all elements.
    edges
        Nodes of the four edges by name (`EDGES`). An end is ordered upwards, a face from start to end.
    stations
        Undeformed axial coordinates of the sections, increasing, ``(m,)`` [m].
    sections
        Weights ``(m, n)`` of the nodes in the section means; rows sum to one.
    basis
        scikit-fem's scalar basis, for `fem_reference.sampling`.
    """

    nodes: Floats
    cells: Ints
    gradients: Floats
    weights: Floats
    nodal_gradients: Floats
    gather: csr_matrix
    edges: dict[str, Ints]
    stations: Floats
    sections: csr_matrix
    basis: Any


def structured_mesh(strip: Strip) -> Discretisation:
    """Mesh a strip with equal rows over the height and element lengths in a geometric series along the axis."""
    from skfem import MeshQuad

    nx, ny = strip.mesh
    x = strip.length * _fractions(nx, strip.grading)
    y = strip.height / 2 * np.linspace(-1.0, 1.0, ny + 1)
    tensor = MeshQuad.init_tensor(x, y)
    basis = scalar_basis(MeshQuad(tensor.p, tensor.t[[0, 3, 2, 1]]), strip.element)
    nodes = basis.doflocs.T
    order = np.lexsort((np.round(nodes[:, 1] / strip.height, 9), np.round(nodes[:, 0] / x[1], 9)))
    columns = order.reshape(-1, (1 if strip.element == "Q1" else 2) * ny + 1)
    m, r = columns.shape
    weights = np.tile(edge_weights(strip.element, nodes[columns[0], 1]), m)
    sections = csr_matrix((weights, (np.repeat(np.arange(m), r), columns.ravel())), shape=(m, len(nodes)))
    edges = {"start": columns[0], "end": columns[-1], "right": columns[:, 0], "left": columns[:, -1]}
    return from_basis(strip, basis, edges, nodes[columns[:, 0], 0], sections)


def scalar_basis(mesh: Any, element: str) -> Any:
    """Return scikit-fem's basis for an element on straight-sided quadrilaterals with the Gauss points of `GAUSS`."""
    from skfem import Basis, ElementQuad1, ElementQuad2

    (x, wx), (y, wy) = (np.polynomial.legendre.leggauss(n) for n in GAUSS[element])
    points = np.stack([np.repeat((1 + x) / 2, y.size), np.tile((1 + y) / 2, x.size)])
    shapes = ElementQuad1() if element == "Q1" else ElementQuad2()
    return Basis(mesh, shapes, quadrature=(points, np.outer(wx, wy).ravel() / 4))


def from_basis(
    strip: Strip, basis: Any, edges: dict[str, Ints], stations: Floats, sections: csr_matrix
) -> Discretisation:
    """Build the discretisation from a scikit-fem basis."""
    from skfem import Basis

    element, cells = basis.elem, basis.element_dofs.T.astype(np.int64)
    shapes = len(element.doflocs)
    at_nodes = Basis(basis.mesh, element, quadrature=(element.doflocs.T, np.ones(shapes)))
    return Discretisation(
        nodes=basis.doflocs.T.copy(),
        cells=cells,
        gradients=_gradients(basis.basis),
        weights=strip.width * basis.dx,
        nodal_gradients=_gradients(at_nodes.basis),
        gather=csr_matrix((np.ones(cells.size), (cells.ravel(), np.arange(cells.size)))),
        edges=edges,
        stations=stations,
        sections=sections,
        basis=basis,
    )


def _fractions(n: int, grading: float) -> Floats:
    """Return ``n + 1`` points of [0, 1] with distances in a geometric series; last over first is ``grading``."""
    lengths = grading ** (np.arange(n) / (n - 1))
    points = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
    points[-1] = 1.0
    return points if grading != 1.0 else np.linspace(0.0, 1.0, n + 1)


def edge_weights(element: str, along: Floats) -> Floats:
    """Nodal shares ``integral N ds / length`` ``(r,)`` of a uniform traction on an edge; ``along`` are the nodes' coordinates."""
    pattern, step = ((1 / 2, 1 / 2), 1) if element == "Q1" else ((1 / 6, 4 / 6, 1 / 6), 2)
    weights = np.zeros(along.size)
    for j in range(0, along.size - step, step):
        weights[j : j + step + 1] += np.array(pattern) * (along[j + step] - along[j])
    return np.asarray(weights / (along[-1] - along[0]))


def edge_moments(element: str, along: Floats) -> Floats:
    """Nodal shares ``integral N s ds / length`` ``(r,)`` of a traction proportional to the edge's coordinate s, ``along``."""
    pattern, step = ((1 / 2, 1 / 2), 1) if element == "Q1" else ((1 / 6, 4 / 6, 1 / 6), 2)
    moments = np.zeros(along.size)
    for j in range(0, along.size - step, step):
        side, middle = along[j + step] - along[j], (along[j + step] + along[j]) / 2
        moments[j : j + step + 1] += np.array(pattern) * side * middle
        moments[[j, j + step]] += np.array([-1, 1]) * side**2 / 12
    return np.asarray(moments / (along[-1] - along[0]))


def _gradients(basis: Any) -> Floats:
    """Arrange scikit-fem's gradients, ``(2, e, q)`` per shape function, as ``(e, 2 q, k)``."""
    stacked = np.stack([field[0].grad for field in basis])
    shapes, axes, elements, points = stacked.shape
    return np.ascontiguousarray(stacked.transpose(2, 1, 3, 0)).reshape(elements, axes * points, shapes)
