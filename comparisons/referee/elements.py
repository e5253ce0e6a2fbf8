"""Finite elements of high order for the rotation along the parts: shape functions, mesh, and energy with its exact gradient and Hessian.

On ``xi`` in [-1, 1] the shape functions are ``(1 - xi)/2``, ``(1 + xi)/2`` and the bubbles ``(P_j - P_(j-2))/(2 j - 1)``, j = 2..p. The
bubbles vanish at both ends and have orthogonal derivatives ``P_(j-1)``. The size of the last coefficients shows whether the element is
small enough (Szabo and Babuska, Finite Element Analysis, 1991).

In the frame of the undeformed tangent e, which has the angle beta(s) from the chord, the force is ``n = R(-beta) (c - W)``. An element has
the energy

    sum_g w [EI(s) theta_xi^2/2 half - half f],  f = n.(d - e) + N^2/2EA(s) + Q^2/2GA(s)

at the Gauss points ``s = s_a + (s_b - s_a) x``, x the fraction of the part between the arc positions s_a and s_b, and the element's ``half =
share (s_b - s_a)/2``. The derivatives by s_a and s_b include those of EI, 1/EA, 1/GA and n by s where rods are not uniform.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from comparisons.referee.layout import Layout

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Complex = NDArray[np.complexfloating[Any, Any]]

DEGREE = 16
"""Degree p of the rotation on an element."""
_POINTS = DEGREE + 4
OUTER = 6
"""Unknowns of an element outside its bubbles: two rotations, c, s_a and s_b."""


def shapes(xi: Array) -> tuple[Array, Array]:
    """Return the shape functions and their derivatives in xi, each (..., p + 1), beginning with the two linear functions."""
    legendre = legvander(xi, DEGREE)
    j = np.arange(2, DEGREE + 1)
    half = np.full(np.shape(xi), 0.5)
    bubbles = (legendre[..., 2:] - legendre[..., :-2]) / (2.0 * j - 1.0)
    values = np.concatenate([(0.5 - xi / 2.0)[..., None], (0.5 + xi / 2.0)[..., None], bubbles], axis=-1)
    slopes = np.concatenate([-half[..., None], half[..., None], legendre[..., 1:-1]], axis=-1)
    return values, slopes


GAUSS, WEIGHTS = leggauss(_POINTS)
VALUES, SLOPES = shapes(GAUSS)
"""Shape functions and derivatives at the Gauss points, (points, p + 1)."""
AMPLITUDE = 2.0 / (2.0 * np.arange(2, DEGREE + 1) - 1.0)
"""Bounds of the bubbles j = 2..p."""
_COEFFICIENTS = np.linalg.inv(legvander(GAUSS, _POINTS - 1))


def up_to(xi: Array) -> Array:
    """Return the matrix (m, points) from values at the Gauss points to the integrals from -1 to xi (m,)."""
    table = legvander(xi, _POINTS)
    j = np.arange(1, _POINTS)
    integrals = np.column_stack([xi + 1.0, (table[:, 2:] - table[:, :-2]) / (2.0 * j + 1.0)])
    return np.asarray(integrals @ _COEFFICIENTS)


class Mesh(NamedTuple):
    """Elements of all parts, in order."""

    grids: list[Array]
    """Their ends as fractions of every part, from 0 to 1."""
    part: Ints
    start: Array
    share: Array
    """Start and length (e,) as fractions of the part."""
    local: Ints
    """Numbers (e, 6) of `theta_a, theta_b, c_x, c_y, s_a, s_b`."""
    unknowns: int
    """Number of unknowns including the vertices inside the parts, without the bubbles."""


def mesh_of(layout: Layout, grids: list[Array]) -> Mesh:
    """Return the elements between the fractions `grids` of every part."""
    local: list[tuple[int, ...]] = []
    count = layout.unknowns
    for item, grid in zip(layout.parts, grids, strict=True):
        begin, end = (int(layout.stations[k].numbers[2]) for k in (item.first, item.last))
        chain = [begin, *range(count, count + len(grid) - 2), end]
        local += [(*ends, item.force, item.force + 1, *item.arcs) for ends in pairwise(chain)]
        count += len(grid) - 2
    return Mesh(
        grids=grids,
        part=np.repeat(np.arange(len(grids)), [len(grid) - 1 for grid in grids]),
        start=np.concatenate([grid[:-1] for grid in grids]),
        share=np.concatenate([np.diff(grid) for grid in grids]),
        local=np.array(local),
        unknowns=count,
    )


def rotations(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> Array:
    """Coefficients (e, p + 1) of the rotation in the shape functions."""
    return np.column_stack([layout.full(z)[mesh.local[:, :2]], bubbles])


class Places(NamedTuple):
    """Rods at points (..., g) of the elements: EI, 1/EA, 1/GA, and n; plane vectors are complex numbers."""

    EI: Any
    stretch: Any
    shear: Any
    n: Complex
    frame: Any = 1.0
    """Direction (..., g) of the undeformed axis in the frame of the chord."""
    by_s: "tuple[Places, Places, Array] | None" = None
    """First and second derivatives by s, and kappa0; None where rods are uniform."""


def places(layout: Layout, parts: Ints, s: Array, c: Array) -> Places:
    """Evaluate the rods at arc positions (e, g) of elements of the parts `parts` (e,) with the constants c (e, 2)."""
    rods, force = [part.rod for part in layout.parts], (c @ (1.0, 1.0j))[:, None]
    if layout.uniform:
        EI, stretch, shear = np.array([rod.greatest for rod in rods])[parts].T[..., None]
        return Places(EI, stretch, shear, force)
    stiff, first, second = _evaluated([rod.stiffness for rod in rods], parts, s)
    W, q, change = (
        x + 1.0j * y for x, y in _evaluated([part.rod.load[part.piece].T for part in layout.parts], parts, s)
    )
    k0, turn = np.array([(rod.curvature, rod.turn) for rod in rods])[parts].T[..., None]
    frame = np.exp(1.0j * (k0 * s - turn / 2.0))
    n, load = (force - W) / frame, q / frame
    slope = -1.0j * k0 * n - load
    bend = -1.0j * k0 * (slope - load) - change / frame
    soft = 1.0 / stiff[1:]
    softer, bent = -first[1:] * soft**2, (2.0 * first[1:] ** 2 * soft - second[1:]) * soft**2
    one, two = (
        Places(stiffness[0], flexible[0], flexible[1], force)
        for stiffness, flexible, force in ((first, softer, slope), (second, bent, bend))
    )
    return Places(stiff[0], soft[0], soft[1], n, frame, (one, two, k0))


def _evaluated(rows: Sequence[Sequence[Array]], parts: Ints, s: Array) -> Array:
    """Value, first and second derivative (3, m, e, g) of m polynomials of every part at arc positions (e, g)."""
    most = max(len(item) for row in rows for item in row)
    table = np.array([[np.pad(item, (0, most - len(item))) for item in row] for row in rows])[parts]
    found = np.zeros((3, table.shape[1], *s.shape))
    for row in table.transpose(2, 1, 0)[::-1, ..., None]:
        found[2] = found[2] * s + found[1]
        found[1] = found[1] * s + found[0]
        found[0] = found[0] * s + row
    found[2] *= 2.0
    return found


def fields(theta: Array, there: Places) -> tuple[Array, Array, Complex]:
    """Return N, Q, and ``r'`` minus the undeformed tangent, in its frame, at rotations (...)."""
    force = there.n * np.exp(-1.0j * theta)
    strain = there.stretch * force.real + 1.0j * there.shear * force.imag
    return force.real, force.imag, np.expm1(1.0j * theta) + np.exp(1.0j * theta) * strain


def pairs(vector: Complex) -> Array:
    """Return complex numbers (...) as vectors (..., 2)."""
    return np.stack([vector.real, vector.imag], axis=-1)


def elements(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> tuple[Array, Array, Array]:
    """Gradient (e, p + 5) and Hessian of the energy in `theta_a, theta_b, c_x, c_y, s_a, s_b` and the bubbles; strain energy (e,)."""
    ends = layout.extents(z)[mesh.part]
    extent, share = (ends[:, 1] - ends[:, 0])[:, None], mesh.share[:, None]
    x = mesh.start[:, None] + share * (1.0 + GAUSS) / 2.0
    there = places(layout, mesh.part, ends[:, :1] + extent * x, z[mesh.local[:, 2:4]])
    coefficients = rotations(layout, mesh, z, bubbles)
    # from the unknowns of an element to theta, theta_xi, c_x, c_y, half and s
    size = coefficients.shape[1] + 4
    turn, to = np.r_[0, 1, OUTER:size], np.zeros((*x.shape, 6, size))
    to[..., 0, turn], to[..., 1, turn] = VALUES, SLOPES
    to[..., 2, 2] = to[..., 3, 3] = 1.0
    to[..., 4, 4], to[..., 4, 5], to[..., 5, 4], to[..., 5, 5] = -share / 2.0, share / 2.0, 1.0 - x, x
    theta, bent = coefficients @ VALUES.T, coefficients @ SLOPES.T
    first, second, stored = _at_points(there, share * extent / 2.0, theta, bent)
    gradient = np.einsum("egi,egis->es", first * WEIGHTS[:, None], to)
    rows, weighted = (len(x), -1, size), second * WEIGHTS[:, None, None]
    hessian = to.reshape(rows).swapaxes(1, 2) @ (weighted @ to).reshape(rows)
    return gradient, hessian, stored @ WEIGHTS


def _at_points(there: Places, half: Array, theta: Array, bent: Array) -> tuple[Array, Array, Array]:
    """Gradient (..., 6) and Hessian of the energy in theta, theta_xi, c_x, c_y, half and s at points (...), and what is stored."""
    a, b, n, d = there.stretch, there.shear, there.n, np.exp(1.0j * theta)
    N, Q, tangent = fields(theta, there)
    stretched, stored = 1.0 + N * (a - b), (a * N**2 + b * Q**2) / 2.0
    turned = d * (Q * (a - b) + 1.0j * stretched)
    moment, square = there.EI * bent / half, (there.frame * d) ** 2
    energy, wide = moment * bent / 2.0, half[..., None]
    first, second = np.zeros((*theta.shape, 6)), np.zeros((*theta.shape, 6, 6))
    first[..., 0], first[..., 1] = -half * Q * stretched, moment
    first[..., 2:4] = -wide * pairs(there.frame * tangent)
    first[..., 4] = stored - energy / half - (n.conj() * tangent).real
    second[..., 0, 0] = half * (N * stretched - Q**2 * (a - b))
    second[..., 1, 1], second[..., 4, 4] = there.EI / half, 2.0 * energy / half**2
    second[..., 2, 2:4] = -wide / 2.0 * pairs(a + b + (a - b) * square)
    second[..., 3, 2:4] = -wide / 2.0 * pairs(1.0j * (a + b - (a - b) * square))
    mixed = {(0, 4): -Q * stretched, (1, 4): -moment / half}
    both = {0: -wide * pairs(there.frame * turned), 4: first[..., 2:4] / wide}
    if there.by_s is not None:
        one, two, k0 = there.by_s
        along, over = (one.n / d).real, (one.n / d).imag
        lean = d * (a * along + one.stretch * N + 1.0j * (b * over + one.shear * Q))
        f_s = (tangent.conj() * one.n).real + (one.stretch * N**2 + one.shear * Q**2) / 2.0
        f_ss = (
            a * along**2 + b * over**2 + 2.0 * (one.stretch * N * along + one.shear * Q * over)
            + (tangent.conj() * two.n).real + (two.stretch * N**2 + two.shear * Q**2) / 2.0
        )  # fmt: skip
        first[..., 5] = one.EI * bent**2 / (2.0 * half) - half * f_s
        second[..., 5, 5] = two.EI * bent**2 / (2.0 * half) - half * f_ss
        both[5] = -wide * pairs(there.frame * (lean + 1.0j * k0 * tangent))
        mixed[0, 5] = -half * ((turned.conj() * one.n).real + (one.stretch - one.shear) * N * Q)
        mixed[1, 5] = one.EI * bent / half
        mixed[4, 5] = -one.EI * bent**2 / (2.0 * half**2) - f_s
    for (i, j), value in mixed.items():
        second[..., i, j] = second[..., j, i] = value
    for i, vector in both.items():
        second[..., i, 2:4] = second[..., 2:4, i] = vector
    return first, second, energy + half * stored
