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

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from numpy.typing import NDArray

from comparisons.referee.layout import Layout

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

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

    part: Ints
    start: Array
    share: Array
    """Start and length (e,) as fractions of the part."""
    local: Ints
    """Numbers (e, 6) of `theta_a, theta_b, c_x, c_y, s_a, s_b`."""
    unknowns: int
    """Number of unknowns including the vertices inside the parts, without the bubbles."""


def mesh_of(layout: Layout, grids: list[Array]) -> Mesh:
    """Return the elements between the fractions `grids` of every part, each from 0 to 1."""
    part: list[int] = []
    local: list[tuple[int, ...]] = []
    count = layout.unknowns
    for number, (item, grid) in enumerate(zip(layout.parts, grids, strict=True)):
        inner = range(count, count + len(grid) - 2)
        begin, end = (int(layout.stations[k].numbers[2]) for k in (item.first, item.last))
        part += [number] * (len(grid) - 1)
        local += [(*ends, item.force, item.force + 1, *item.arcs) for ends in pairwise([begin, *inner, end])]
        count += len(inner)
    return Mesh(
        part=np.array(part),
        start=np.concatenate([grid[:-1] for grid in grids]),
        share=np.concatenate([np.diff(grid) for grid in grids]),
        local=np.array(local),
        unknowns=count,
    )


def mesh_for(layout: Layout, mesh: Mesh) -> Mesh:
    """Return the same elements for the layout of another load parameter, which has other prescribed rotations."""
    return mesh_of(layout, [np.append(mesh.start[mesh.part == k], 1.0) for k in range(len(layout.parts))])


def rotations(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> Array:
    """Coefficients (e, p + 1) of the rotation in the shape functions."""
    return np.column_stack([layout.full(z)[mesh.local[:, :2]], bubbles])


class Places(NamedTuple):
    """Rods at points (..., g) of the elements: EI, 1/EA, 1/GA, and n; with derivatives by s where rods are not uniform."""

    EI: Any
    stretch: Any
    shear: Any
    n: Array
    frame: Array | None = None
    """Unit vectors (..., 2, 2) along the undeformed tangent and to its left in the frame of the chord, as columns; None where they are that."""
    by_s: "tuple[Places, Places, Array] | None" = None
    """First and second derivatives, and kappa0."""

    def in_chord(self, vector: Array) -> Array:
        """Return vectors (..., 2) in the frame of the chord."""
        return vector if self.frame is None else (self.frame @ vector[..., None])[..., 0]


def places(layout: Layout, parts: Ints, s: Array, c: Array) -> Places:
    """Evaluate the rods at arc positions (e, g) of elements of the parts `parts` (e,) with the constants c (e, 2)."""
    rods = [part.rod for part in layout.parts]
    if layout.uniform:
        EI, stretch, shear = np.array([rod.greatest for rod in rods])[parts].T[..., None]
        return Places(EI, stretch, shear, c[:, None, :])
    stiff, first, second = _evaluated(_padded([_padded(list(rod.stiffness)).T for rod in rods])[parts], s)
    W, q, change = _evaluated(_padded([part.rod.load[part.piece] for part in layout.parts])[parts], s)
    k0, turn = (
        np.array([getattr(rod, name) for rod in rods])[parts][:, None] for name in ("curvature", "turn")
    )
    x, y = np.cos(k0 * s - turn / 2.0), np.sin(k0 * s - turn / 2.0)

    def turned(vector: Array) -> Array:
        return np.stack([x * vector[0] + y * vector[1], x * vector[1] - y * vector[0]], axis=-1)

    n, load = turned(c.T[:, :, None] - W), turned(q)
    slope = k0[..., None] * across(n) - load
    bend = k0[..., None] * (across(slope) - across(load)) - turned(change)
    flexible = 1.0 / stiff[1:]
    softer = -first[1:] * flexible**2
    bent = (2.0 * first[1:] ** 2 * flexible - second[1:]) * flexible**2
    frame = np.stack([np.stack([x, -y], axis=-1), np.stack([y, x], axis=-1)], axis=-2)
    one, two = Places(first[0], softer[0], softer[1], slope), Places(second[0], bent[0], bent[1], bend)
    return Places(stiff[0], flexible[0], flexible[1], n, frame, (one, two, k0[..., None]))


def _padded(tables: list[Array]) -> Array:
    """Stack tables of coefficients of any degrees."""
    most = max(map(len, tables))
    return np.stack(
        [np.concatenate([item, np.zeros((most - len(item), *item.shape[1:]))]) for item in tables]
    )


def _evaluated(coefficients: Array, s: Array) -> tuple[Array, Array, Array]:
    """Value, first and second derivative (m, e, g) of polynomials with coefficients (e, k, m) at arc positions (e, g)."""
    rows = coefficients.transpose(1, 2, 0)[..., None]
    value = rows[-1] + np.zeros_like(s)
    first, second = np.zeros_like(value), np.zeros_like(value)
    for row in rows[-2::-1]:
        second = second * s + first
        first = first * s + value
        value = value * s + row
    return value, first, 2.0 * second


def across(vector: Array) -> Array:
    """Return vectors (..., 2) turned right by a right angle."""
    return np.stack([vector[..., 1], -vector[..., 0]], axis=-1)


def fields(theta: Array, there: Places) -> tuple[Array, Array, Array]:
    """Return N, Q, and ``r'`` minus the undeformed tangent, in its frame, at rotations (...)."""
    c, s = np.cos(theta), np.sin(theta)
    n_x, n_y = there.n[..., 0], there.n[..., 1]
    N, Q = n_x * c + n_y * s, n_y * c - n_x * s
    x = -2.0 * np.sin(theta / 2.0) ** 2 + there.stretch * N * c - there.shear * Q * s
    return N, Q, np.stack([x, s + there.stretch * N * s + there.shear * Q * c], axis=-1)


def elements(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> tuple[Array, Array, Array]:
    """Gradient (e, p + 5) and Hessian of the energy in `theta_a, theta_b, c_x, c_y, s_a, s_b` and the bubbles; strain energy (e,)."""
    ends = layout.extents(z)[mesh.part]
    extent = (ends[:, 1] - ends[:, 0])[:, None]
    x = mesh.start[:, None] + mesh.share[:, None] * (1.0 + GAUSS) / 2.0
    half, grows = mesh.share[:, None] * extent / 2.0, mesh.share[:, None] / 2.0
    there = places(layout, mesh.part, ends[:, :1] + extent * x, z[mesh.local[:, 2:4]])
    coefficients = rotations(layout, mesh, z, bubbles)
    by_theta, by_theta2, by_bent, by_y, by_yy, by_theta_y, by_bent_y, stored = _at_points(
        there, half, coefficients @ VALUES.T, coefficients @ SLOPES.T
    )
    # from (c_x, c_y, s_a, s_b) to y
    to = np.zeros((*x.shape, 4, 4))
    to[..., 0, 0] = to[..., 1, 1] = 1.0
    to[..., 2, 2], to[..., 2, 3], to[..., 3, 2], to[..., 3, 3] = -grows, grows, 1.0 - x, x
    to_y = to * WEIGHTS[:, None, None]
    size = coefficients.shape[1] + 4
    turn = np.r_[0, 1, OUTER:size]
    gradient, hessian = np.zeros((len(x), size)), np.zeros((len(x), size, size))
    gradient[:, turn] = (by_bent * WEIGHTS) @ SLOPES + (by_theta * WEIGHTS) @ VALUES
    gradient[:, 2:OUTER] = (by_y[..., None, :] @ to_y).sum(axis=1)[:, 0]
    bending, straining = (there.EI / half * WEIGHTS)[:, None, :], (by_theta2 * WEIGHTS)[:, None, :]
    hessian[:, turn[:, None], turn] = (SLOPES.T * bending) @ SLOPES + (VALUES.T * straining) @ VALUES
    mixed = VALUES.T @ (by_theta_y[..., None, :] @ to_y)[..., 0, :]
    mixed += SLOPES.T @ (by_bent_y[..., None, :] @ to_y)[..., 0, :]
    hessian[:, turn, 2:OUTER], hessian[:, 2:OUTER, turn] = mixed, mixed.swapaxes(1, 2)
    hessian[:, 2:OUTER, 2:OUTER] = (to.swapaxes(-1, -2) @ by_yy @ to_y).sum(axis=1)
    return gradient, hessian, stored @ WEIGHTS


def _at_points(there: Places, half: Array, theta: Array, bent: Array) -> tuple[Array, ...]:
    """Energy by theta, twice, by theta_xi, by ``y = (c_x, c_y, half, s)``, twice, by theta and y, by theta_xi and y, and what is stored."""
    a, b, n = there.stretch, there.shear, there.n
    N, Q, tangent = fields(theta, there)
    cos, sin = np.cos(theta), np.sin(theta)
    d1, d2 = np.stack([cos, sin], axis=-1), np.stack([-sin, cos], axis=-1)
    stretched, stored = 1.0 + N * (a - b), (a * N**2 + b * Q**2) / 2.0
    turned = d2 * stretched[..., None] + d1 * (Q * (a - b))[..., None]
    flexible = a[..., None, None] * d1[..., :, None] * d1[..., None, :]
    flexible = flexible + b[..., None, None] * d2[..., :, None] * d2[..., None, :]
    if there.frame is not None:
        flexible = there.frame @ flexible @ there.frame.swapaxes(-1, -2)
    moment, wide = there.EI * bent / half, half[..., None]
    energy = moment * bent / 2.0
    y, yy = np.zeros((*theta.shape, 4)), np.zeros((*theta.shape, 4, 4))
    theta_y, bent_y = np.zeros_like(y), np.zeros_like(y)
    y[..., :2] = -wide * there.in_chord(tangent)
    y[..., 2] = stored - energy / half - (n * tangent).sum(axis=-1)
    yy[..., :2, :2] = -wide[..., None] * flexible
    yy[..., :2, 2] = yy[..., 2, :2] = -there.in_chord(tangent)
    yy[..., 2, 2] = 2.0 * energy / half**2
    theta_y[..., :2], theta_y[..., 2] = -wide * there.in_chord(turned), -Q * stretched
    bent_y[..., 2] = -moment / half
    if there.by_s is not None:
        one, two, k0 = there.by_s
        along, over = (one.n * d1).sum(axis=-1), (one.n * d2).sum(axis=-1)
        lean = d1 * (a * along + one.stretch * N)[..., None] + d2 * (b * over + one.shear * Q)[..., None]
        f_s = (tangent * one.n).sum(axis=-1) + (one.stretch * N**2 + one.shear * Q**2) / 2.0
        f_ss = (
            a * along**2 + b * over**2 + 2.0 * (one.stretch * N * along + one.shear * Q * over)
            + (tangent * two.n).sum(axis=-1) + (two.stretch * N**2 + two.shear * Q**2) / 2.0
        )  # fmt: skip
        y[..., 3] = one.EI * bent**2 / (2.0 * half) - half * f_s
        yy[..., 3, 3] = two.EI * bent**2 / (2.0 * half) - half * f_ss
        yy[..., :2, 3] = yy[..., 3, :2] = -wide * there.in_chord(lean - k0 * across(tangent))
        yy[..., 2, 3] = yy[..., 3, 2] = -one.EI * bent**2 / (2.0 * half**2) - f_s
        theta_y[..., 3] = -half * ((turned * one.n).sum(axis=-1) + (one.stretch - one.shear) * N * Q)
        bent_y[..., 3] = one.EI * bent / half
    theta2 = half * (N * stretched - Q**2 * (a - b))
    return -half * Q * stretched, theta2, moment, y, yy, theta_y, bent_y, energy + half * stored
