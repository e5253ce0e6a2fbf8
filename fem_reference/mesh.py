"""The strip's mesh of biquadratic quadrilaterals, in the strip's own frame.

This is the one module that reads scikit-fem's arrays.
"""

from dataclasses import dataclass

import numpy as np

from fem_reference.arrays import Floats, Ints
from fem_reference.problem import Strip

# Anticlockwise corners, then midsides, then the centre: scikit-fem's order and VTK's biquadratic quad.
NODES_PER_CELL = 9


@dataclass(frozen=True, kw_only=True, eq=False)
class Discretisation:
    """Biquadratic elements of a strip in its own frame (x along the axis from 0 to L, y from -h/2 to h/2).

    Parameters
    ----------
    nodes
        Reference positions ``(n, 2)`` [m].
    cells
        Nodes of each element ``(e, 9)``: four corners anticlockwise, four midsides, centre.
    gradients
        Shape-function gradients ``(e, 2 q, 9)``, direction-major in the middle axis [1/m].
    weights
        Quadrature weights ``(e, q)``, width included [m^3].
    nodal_gradients
        As ``gradients``, at the nine nodes of each element instead of the quadrature points.
    columns
        Nodes ``(2 nx + 1, 2 ny + 1)``: sections along the axis, from the right face to the left one.
    """

    nodes: Floats
    cells: Ints
    gradients: Floats
    weights: Floats
    nodal_gradients: Floats
    columns: Ints

    @property
    def stations(self) -> Floats:
        """Axial coordinates of the sections, ``(2 nx + 1,)`` [m]."""
        x: Floats = self.nodes[self.columns[:, 0], 0]
        return x

    @property
    def section_weights(self) -> Floats:
        """Simpson weights of the section mean, ``(2 ny + 1,)``; they sum to one."""
        y = self.nodes[self.columns[0], 1]
        weights = np.zeros(y.size)
        for j in range(0, y.size - 2, 2):
            weights[j : j + 3] += (y[j + 2] - y[j]) * np.array([1.0, 4.0, 1.0]) / 6
        weights /= y[-1] - y[0]
        return weights


def discretise(strip: Strip) -> Discretisation:
    """Mesh a strip with ``strip.mesh`` biquadratic elements, 3 x 3 Gauss points each."""
    from skfem import Basis, ElementQuad2, MeshQuad

    nx, ny = strip.mesh
    x = np.linspace(0.0, strip.length, nx + 1)
    y = strip.height / 2 * np.linspace(-1.0, 1.0, ny + 1)
    tensor = MeshQuad.init_tensor(x, y)
    mesh = MeshQuad(tensor.p, tensor.t[[0, 3, 2, 1]])
    element = ElementQuad2()
    basis = Basis(mesh, element, intorder=5)
    at_nodes = Basis(mesh, element, quadrature=(element.doflocs.T, np.ones(NODES_PER_CELL)))
    nodes = basis.doflocs.T.copy()
    order = np.lexsort((np.round(nodes[:, 1] / strip.height, 9), np.round(nodes[:, 0] / strip.length, 9)))
    return Discretisation(
        nodes=nodes,
        cells=basis.element_dofs.T.astype(np.int64),
        gradients=_gradients(basis.basis),
        weights=strip.width * basis.dx,
        nodal_gradients=_gradients(at_nodes.basis),
        columns=order.reshape(2 * nx + 1, 2 * ny + 1),
    )


def _gradients(basis: list[tuple[object, ...]]) -> Floats:
    """Gradients ``(e, 2 q, 9)`` from scikit-fem's ``(2, e, q)`` per shape function."""
    stacked = np.stack([field[0].grad for field in basis])  # type: ignore[attr-defined]  # scikit-fem has no types
    shapes, axes, elements, points = stacked.shape
    return np.ascontiguousarray(stacked.transpose(2, 1, 3, 0)).reshape(elements, axes * points, shapes)
