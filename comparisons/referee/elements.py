"""Finite elements of high order for the rotation along the parts: shape functions, mesh, and energy with its exact gradient and Hessian.

On ``xi`` in [-1, 1] the shape functions are ``(1 - xi)/2``, ``(1 + xi)/2`` and the bubbles ``(P_j - P_(j-2))/(2 j - 1)``, j = 2..p. The
bubbles vanish at both ends and have orthogonal derivatives ``P_(j-1)``. The size of the last coefficients shows whether the element is
small enough (Szabo and Babuska, Finite Element Analysis, 1991).

With the undeformed tangent e and the section's normal d an element has the energy

    sum_g w [EI(s) theta_xi^2/2 half - half f],  f = n.(d - e) + N^2/2EA(s) + Q^2/2GA(s)

at the Gauss points ``s = s_a + (s_b - s_a) x``, x the fraction of the part between the arc positions s_a and s_b, and the element's ``half =
share (s_b - s_a)/2``. The derivatives by s_a and s_b include those of EI, 1/EA, 1/GA, n and e by s.
"""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss, legint, legvander
from numpy.polynomial.polynomial import polyder

from comparisons.answer import Array, Ints
from comparisons.referee.layout import Layout
from comparisons.referee.rod import Piece, value

DEGREE = 16
"""Degree p of the rotation on an element."""
_POINTS = DEGREE + 4
STEP = 1e-30
"""Imaginary step of derivatives, which have no error of subtraction."""
OUTER = 6
"""Unknowns of an element outside its bubbles: two rotations, c, s_a and s_b."""
_TURN = [0, 1, *range(OUTER, OUTER + DEGREE - 1)]


def shapes(xi: Array) -> tuple[Array, Array]:
    """Return the shape functions and their derivatives in xi, each (..., p + 1), beginning with the two linear functions."""
    legendre = legvander(xi, DEGREE)
    j = np.arange(2, DEGREE + 1)
    bubbles = (legendre[..., 2:] - legendre[..., :-2]) / (2.0 * j - 1.0)
    values = np.concatenate([legendre[..., :2] @ [[0.5, 0.5], [-0.5, 0.5]], bubbles], axis=-1)
    slopes = np.concatenate([legendre[..., :1] @ [[-0.5, 0.5]], legendre[..., 1:-1]], axis=-1)
    return values, slopes


GAUSS, WEIGHTS = leggauss(_POINTS)
VALUES, SLOPES = shapes(GAUSS)
"""Shape functions and derivatives at the Gauss points, (points, p + 1)."""
AMPLITUDE = 2.0 / (2.0 * np.arange(2, DEGREE + 1) - 1.0)
"""Bounds of the bubbles j = 2..p."""
_INTEGRALS = legint(np.linalg.inv(legvander(GAUSS, _POINTS - 1)), lbnd=-1)
"""From values at the Gauss points to the coefficients of the integral from -1."""


def up_to(xi: Array) -> Array:
    """Return the matrix (m, points) from values at the Gauss points to the integrals from -1 to xi (m,)."""
    return np.asarray(legvander(xi, _POINTS) @ _INTEGRALS)


class Mesh(NamedTuple):
    """Elements of all parts, in order."""

    layout: Layout
    grids: list[Array]  #: Their ends as fractions of every part, from 0 to 1.
    part: Ints
    start: Array
    share: Array  #: Start and length (e,) as fractions of the part.
    local: Ints  #: Numbers (e, 6) of `theta_a, theta_b, c_x, c_y, s_a, s_b`.
    unknowns: int  #: Number of unknowns including the vertices inside the parts, without the bubbles.
    points: Array  #: Gauss points (e, g) as fractions of the part.
    #: From the unknowns of an element to theta, theta_xi, c_x, c_y, half and s at its points, (e, g, 6, p + 5).
    to: Array


def mesh_of(layout: Layout, grids: list[Array]) -> Mesh:
    """Return the elements between the fractions `grids` of every part."""
    local: list[tuple[int, ...]] = []
    count = layout.unknowns
    for item, grid in zip(layout.parts, grids, strict=True):
        begin, end = (int(layout.stations[k].numbers[2]) for k in item.stations)
        chain = [begin, *range(count, count + len(grid) - 2), end]
        local += [(*ends, item.force, item.force + 1, *item.arcs) for ends in pairwise(chain)]
        count += len(grid) - 2
    start, share = np.concatenate([[grid[:-1], np.diff(grid)] for grid in grids], axis=1)
    half = share[:, None] / 2.0
    points = start[:, None] + half * (1.0 + GAUSS)
    to = np.zeros((*points.shape, 6, OUTER + DEGREE - 1))
    to[..., 0, _TURN], to[..., 1, _TURN] = VALUES, SLOPES
    to[..., 2, 2] = to[..., 3, 3] = 1.0
    to[..., 4, 4], to[..., 4, 5], to[..., 5, 4], to[..., 5, 5] = -half, half, 1.0 - points, points
    return Mesh(
        layout=layout, grids=grids,
        part=np.repeat(np.arange(len(grids)), [len(grid) - 1 for grid in grids]),
        start=start, share=share, local=np.array(local), unknowns=count, points=points, to=to,
    )  # fmt: skip


def rotations(mesh: Mesh, z: Array) -> Array:
    """Coefficients (e, p + 1) of the rotation in the shape functions; those of the bubbles stand behind the other unknowns."""
    bubbles = z[mesh.unknowns :].reshape(-1, DEGREE - 1)
    return np.column_stack([mesh.layout.full(z)[mesh.local[:, :2]], bubbles])


def at_gauss(mesh: Mesh, z: Array) -> Array:
    """Theta, theta_xi, c_x, c_y, half and s (6, e, g) at the Gauss points."""
    ends, coefficients = mesh.layout.extents(z)[mesh.part], rotations(mesh, z)
    extent, given = np.diff(ends), np.empty((6, *mesh.points.shape))
    given[0], given[1] = coefficients @ VALUES.T, coefficients @ SLOPES.T
    given[2:4] = z[mesh.local[:, 2:4]].T[..., None]
    given[4], given[5] = mesh.share[:, None] * extent / 2.0, ends[:, :1] + extent * mesh.points
    return given


def elements(mesh: Mesh, z: Array) -> tuple[Array, Array, Array]:
    """Gradient (e, p + 5) and Hessian of the energy in `theta_a, theta_b, c_x, c_y, s_a, s_b` and the bubbles; strain energy (e,)."""
    to, steps = mesh.to, at_gauss(mesh, z)[..., None] + 1j * STEP * np.eye(6)[:, None, None]
    given = steps.reshape(6, len(to), -1)
    found = _at_points(mesh.layout.pieces(mesh.part), given).reshape(7, *steps.shape[1:])
    first, second = found[:6, ..., 0].real, found[:6].imag.transpose(1, 2, 0, 3) / STEP
    gradient = np.einsum("ieg,egis->es", first * WEIGHTS, to)
    rows, weighted = (len(to), -1, to.shape[-1]), second * WEIGHTS[:, None, None]
    hessian = to.reshape(rows).swapaxes(1, 2) @ (weighted @ to).reshape(rows)
    return gradient, hessian, found[6, ..., 0].real @ WEIGHTS


def _at_points(pieces: Piece, given: Any) -> Any:
    """Gradient of the energy in theta, theta_xi, c_x, c_y, half and s, and the strain energy, at complex values (6, ...) of these."""
    theta, bent, *c, half, s = given
    EI, a, b, N, Q, n, way = pieces.strained(np.array(c), s, theta)
    EA_s, GA_s, EI_s, *load = value(polyder(pieces.coefficients), s)
    stored, moment = (a * N**2 + b * Q**2) / 2.0, EI * bent / half
    f = (n * way).sum(axis=0) - stored
    f_s = pieces.curvature * (way[0] * n[1] - way[1] * n[0]) - load[0] * way[0] - load[1] * way[1]
    f_s = f_s - (EA_s * (a * N) ** 2 + GA_s * (b * Q) ** 2) / 2.0
    by_half, by_s = -moment * bent / (2.0 * half) - f, EI_s * bent**2 / (2.0 * half) - half * f_s
    turned = -half * Q * (1.0 + (a - b) * N)
    return np.array([turned, moment, *(-half * way), by_half, by_s, moment * bent / 2.0 + half * stored])
