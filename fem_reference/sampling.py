"""Gauss points of the sections of a strip, and the deformation gradient at arbitrary points."""

import numpy as np

from fem_reference.arrays import Floats, Ints
from fem_reference.mesh import Discretisation, inverted, shape_slopes
from fem_reference.strip import Strip

SECTION_LAYERS = 8
"""Layers of Gauss points over the height by which a section of a user's mesh is integrated."""


def gradient_at(mesh: Discretisation, u: Floats, points: Floats) -> Floats:
    """``F = I + du/dX`` ``(2, 2, p)`` at the places ``points`` ``(p, 2)``; ValueError where one is not in the strip."""
    containing = mesh.basis.mesh.element_finder()(*points.T)
    local = mesh.basis.mapping.invF(points.T[:, :, None], tind=containing)[:, :, 0]
    slopes, cells = shape_slopes(mesh.basis.elem, local), mesh.cells[containing]
    inverse, _ = inverted(np.einsum("paj,Kpa->jKp", mesh.nodes[cells], slopes))
    return np.asarray(np.eye(2)[:, :, None] + np.einsum("pai,Kpa,Kjp->ijp", u[cells], slopes, inverse))


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
