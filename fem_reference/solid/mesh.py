"""Meshes of quadrilaterals."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.statement.arrays import Floats, Ints, cofactor, determinant
from fem_reference.statement.strip import Strip

GAUSS = {"Q1": (2, 2), "Q2": (2, 3), "Q2-full": (3, 3)}
"""Numbers of Gauss points in each element, along the strip and across.

If an element is bent by the angle a, its parabolic shape functions have a spurious membrane strain of about a^2 / 24 times
Legendre's second polynomial along the strip. The polynomial vanishes at two Gauss points; with three points the
element locks. Three points across the strip avoid zero-energy modes.
"""
EDGES = ("start", "end", "right", "left")
"""Names of the two ends and of the faces to the right and left of the direction from start to end."""

SECTION_LAYERS = 8
"""Layers of Gauss points over the height by which a section of a user's mesh is integrated."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Points:
    """The same q points of the reference square in every element."""

    slopes: Floats  # derivatives of the k shape functions along the two coordinates xi of the square, ``(2, q, k)``
    inverse: Floats  # inverse Jacobians ``d xi_K / d X_j`` ``(2, 2, e, q)`` [1/m]


@dataclass(frozen=True, kw_only=True, eq=False)
class Discretisation:
    """Elements of a strip."""

    nodes: Floats  # reference positions ``(n, 2)`` from the start of the strip [m]
    # axial coordinate and distance to the left of the axis of the nodes ``(n, 2)``; the positions of a
    # straight strip [m]
    places: Floats
    # nodes of each element ``(e, k)``: four positions anticlockwise from the lower left one; biquadratic
    # elements also have four midside nodes and a centre node
    cells: Ints
    gauss: Points  # gauss, at_nodes: quadrature points, and the element's own nodes
    at_nodes: Points
    weights: Floats  # quadrature weights ``(e, q)``, width included [m^3]
    gather: csr_matrix  # sparse matrix ``(n, e k)`` that adds the nodal values of all elements
    # nodes of the four edges by name (`EDGES`). An end is ordered upwards, a face from start to end
    edges: dict[str, Ints]
    stations: Floats  # undeformed axial coordinates of the sections, increasing, ``(m,)`` [m]
    sections: csr_matrix  # weights ``(m, n)`` of the nodes in the section means; rows sum to one
    basis: Any  # scikit-fem's scalar basis over the places

    @cached_property
    def products(self) -> list[tuple[int, int, Floats]]:
        """Blocks of an element's stiffness, see `blocks`, with products ``(4 q, ...)`` of two shape functions' derivatives in the square."""
        G = self.gauss.slopes
        every = np.einsum("Kqa,Lqb->KLqab", G, G).reshape(-1, *2 * G.shape[2:])
        return [(i, k, every[:, a, b]) for i, k, a, b in blocks(G.shape[2])]


def blocks(shapes: int) -> list[tuple[int, int, Ints, Ints]]:
    """Blocks of an element's symmetric stiffness: components i and k, and shape functions a and b of the entries.

    The blocks of the first and of the second component have a <= b, that of both components has all.
    """
    upper, every = np.triu_indices(shapes), np.indices((shapes, shapes)).reshape(2, -1)
    return [(0, 0, *upper), (1, 1, *upper), (0, 1, *every)]


def structured_mesh(strip: Strip) -> Discretisation:
    """Mesh a strip with equal rows over the height and equal element lengths along the axis."""
    from skfem import MeshQuad

    nx, ny = strip.mesh
    x, y = strip.length * np.linspace(0.0, 1.0, nx + 1), strip.height * np.linspace(-0.5, 0.5, ny + 1)
    tensor = MeshQuad.init_tensor(x, y)
    points = tensor.p
    points[1] *= strip.height_at(points[0]) / strip.height
    basis = scalar_basis(MeshQuad(points, tensor.t[[0, 3, 2, 1]]), strip.element)
    nodes = basis.doflocs.T
    order = np.lexsort((np.round(nodes[:, 1] / strip.height, 9), np.round(nodes[:, 0] / x[1], 9)))
    columns = order.reshape(-1, (1 if strip.element == "Q1" else 2) * ny + 1)
    m, r = columns.shape
    weights = np.tile(edge_weights(strip.element, nodes[columns[0], 1]), m)
    sections = csr_matrix((weights, columns.ravel(), np.arange(m + 1) * r), shape=(m, len(nodes)))
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
    cells, places = basis.element_dofs.T.astype(np.int64), basis.doflocs.T.copy()
    nodes = strip.placed(places)
    gauss, volumes = _points(basis.elem, basis.X, nodes[cells])
    return Discretisation(
        nodes=nodes,
        places=places,
        cells=cells,
        gauss=gauss,
        at_nodes=_points(basis.elem, basis.elem.doflocs.T, nodes[cells])[0],
        weights=strip.width_at(np.asarray(basis.global_coordinates())[0]) * volumes * basis.W,
        gather=csr_matrix((np.ones(cells.size), (cells.ravel(), np.arange(cells.size)))),
        edges=edges,
        stations=stations,
        sections=sections,
        basis=basis,
    )


def _points(element: Any, X: Floats, positions: Floats) -> tuple[Points, Floats]:
    """The points X ``(2, q)`` in elements whose nodes are at ``positions`` ``(e, k, 2)``, and the determinants ``(e, q)`` there."""
    slopes = _shape_slopes(element, X)
    J = np.einsum("eaj,Kqa->jKeq", positions, slopes, order="C")
    volumes = determinant(J)
    inverse = cofactor(J).swapaxes(0, 1) / volumes
    inverse = np.where(np.abs(inverse) > 1e-13 * np.abs(inverse).max(), inverse, 0.0)
    return Points(slopes=slopes, inverse=inverse), volumes


def _shape_slopes(element: Any, X: Floats) -> Floats:
    """Derivatives ``(2, q, k)`` of the shape functions of a scikit-fem element at the points X ``(2, q)`` of the reference square."""
    return np.stack([element.lbasis(X, number)[1] for number in range(len(element.doflocs))], axis=-1)


def edge_weights(element: str, along: Floats, traction: Floats | None = None) -> Floats:
    """Nodal shares ``integral N p ds / length`` ``(r,)`` of a linear ``traction`` p, or of p = 1, on an edge with nodes ``along``."""
    p = np.ones_like(along) if traction is None else traction
    mass = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6 if element == "Q1" else _MASS
    step, weights = len(mass) - 1, np.zeros(along.size)
    for j in range(0, along.size - step, step):
        part = slice(j, j + step + 1)
        weights[part] += (along[j + step] - along[j]) * mass @ p[part]
    return weights / (along[-1] - along[0])


_MASS = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) / 30
"""Integrals of the products of two quadratic shape functions of a unit edge."""


class Interpolation(NamedTuple):
    """The elements at p places."""

    nodes: Ints  # nodes of the element ``(p, k)``
    shapes: Floats  # its shape functions ``(p, k)``
    slopes: Floats  # their derivatives in the positions ``(2, p, k)`` [1/m]

    def of(self, u: Floats) -> tuple[Floats, Floats]:
        """Displacements ``(p, 2)`` and deformation gradients ``F = I + du/dX`` ``(2, 2, p)`` of nodal displacements ``u``."""
        own = u[self.nodes]
        gradient = np.einsum("pai,jpa->ijp", own, self.slopes)
        return np.einsum("pai,pa->pi", own, self.shapes), np.eye(2)[:, :, None] + gradient


def interpolation(mesh: Discretisation, points: Floats) -> Interpolation:
    """Interpolation at the places ``points`` ``(p, 2)``; ValueError where one is not in the strip."""
    element, containing = mesh.basis.elem, mesh.basis.mesh.element_finder()(*points.T)
    local = mesh.basis.mapping.invF(points.T[:, :, None], tind=containing)[:, :, 0]
    slopes, nodes = _shape_slopes(element, local), mesh.cells[containing]
    shapes = np.stack([element.lbasis(local, number)[0] for number in range(nodes.shape[1])], axis=-1)
    J = np.einsum("paj,Kpa->jKp", mesh.nodes[nodes], slopes)
    return Interpolation(nodes, shapes, np.einsum("Kpa,jKp->jpa", slopes, cofactor(J) / determinant(J)))


def section_points(
    strip: Strip, nodes: Floats, edges: dict[str, Ints], stations: Floats
) -> tuple[Floats, Floats, Floats]:
    """Gauss points, shares that sum to one, and heights of the sections at ``stations`` ``(m,)``, section after section."""
    layers = strip.mesh[1] if strip.mesh_file is None else SECTION_LAYERS
    low, high = (np.interp(stations, *nodes[edges[name]].T) for name in ("right", "left"))
    points, weights = np.polynomial.legendre.leggauss(3)
    fractions = (np.arange(layers)[:, None] + (1 + points) / 2).ravel() / layers
    y = low[:, None] + fractions * (high - low)[:, None]
    x = np.broadcast_to(stations[:, None], y.shape)
    return np.stack([x.ravel(), y.ravel()], axis=1), np.tile(weights / 2, layers) / layers, high - low
