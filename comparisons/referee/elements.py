"""Energy of the elements of straight, uniform rods without a load along them, with its exact gradient and Hessian."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import SLOPES, VALUES, WEIGHTS
from comparisons.referee.layout import Layout
from comparisons.referee.stations import NONE

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_STIFF = (SLOPES.T * WEIGHTS) @ SLOPES
OUTER = 5
"""Unknowns of an element outside its bubbles: two rotations, n and l."""


class Mesh(NamedTuple):
    """Elements of all parts, in order.

    part, first (e,): indices of the part and of the vertex at the start; the vertex at the end is the next one.
    start, share (e,): start and length of the element as fractions of the part.
    vertices (v,): index of the unknown rotation at each vertex; `NONE` if it is prescribed.
    prescribed (v,): prescribed rotations.
    unknowns: number of unknowns including the vertices inside the parts, without the bubbles.
    """

    part: Ints
    first: Ints
    start: Array
    share: Array
    vertices: Ints
    prescribed: Array
    unknowns: int


def mesh_of(layout: Layout, grids: list[Array]) -> Mesh:
    """Return the elements between the fractions `grids` of every part, each from 0 to 1."""
    part: list[int] = []
    first: list[int] = []
    vertices: list[int] = []
    turned: list[float] = []
    count = layout.unknowns
    for number, (item, grid) in enumerate(zip(layout.parts, grids, strict=True)):
        inner = len(grid) - 2
        part += [number] * (inner + 1)
        first += list(range(len(vertices), len(vertices) + inner + 1))
        ends = [layout.stations[k] for k in (item.first, item.last)]
        vertices += [ends[0].rotation_unknown, *range(count, count + inner), ends[1].rotation_unknown]
        turned += [ends[0].prescribed_rotation, *[0.0] * inner, ends[1].prescribed_rotation]
        count += inner
    return Mesh(
        part=np.array(part),
        first=np.array(first),
        start=np.concatenate([grid[:-1] for grid in grids]),
        share=np.concatenate([np.diff(grid) for grid in grids]),
        vertices=np.array(vertices),
        prescribed=np.array(turned),
        unknowns=count,
    )


def mesh_for(layout: Layout, mesh: Mesh) -> Mesh:
    """Return the same elements for the layout of another load parameter, which has other prescribed rotations."""
    return mesh_of(layout, [np.append(mesh.start[mesh.part == k], 1.0) for k in range(len(layout.parts))])


class Properties(NamedTuple):
    """EI, 1/EA and 1/GA of every element (e,), and the index of the first force unknown of its part."""

    EI: Array
    stretch: Array
    shear: Array
    force: Ints


def properties(layout: Layout, mesh: Mesh) -> Properties:
    """Return the stiffness data of the elements."""
    table = np.array([item.rod.greatest for item in layout.parts])[mesh.part]
    force = np.array([item.force for item in layout.parts])[mesh.part]
    return Properties(table[:, 0], table[:, 1], table[:, 2], force)


def rotations(mesh: Mesh, z: Array, bubbles: Array) -> Array:
    """Coefficients (e, p + 1) of the rotation in the shape functions."""
    there = np.where(mesh.vertices == NONE, mesh.prescribed, z[mesh.vertices])
    return np.column_stack([there[mesh.first], there[mesh.first + 1], bubbles])


class Fields(NamedTuple):
    """Section forces N and Q, and ``tangent``, the derivative ``r'`` minus the undeformed direction, in the beam's frame."""

    N: Array
    Q: Array
    tangent: Array


def fields(theta: Array, n: Array, stretch: Array | float, shear: Array | float) -> Fields:
    """Return the fields at rotations (...) under forces n (..., 2)."""
    c, s = np.cos(theta), np.sin(theta)
    N, Q = n[..., 0] * c + n[..., 1] * s, n[..., 1] * c - n[..., 0] * s
    x = -2.0 * np.sin(theta / 2.0) ** 2 + stretch * N * c - shear * Q * s
    y = s + stretch * N * s + shear * Q * c
    return Fields(N, Q, np.stack([x, y], axis=-1))


class Elements(NamedTuple):
    """Gradient (e, p + 4) and Hessian of the elements' energy in `theta_a, theta_b, n_x, n_y, l` and the bubbles; energy (e,).

    ``energy`` is the strain energy alone.
    """

    gradient: Array
    hessian: Array
    energy: Array


def elements(mesh: Mesh, rods: Properties, extents: Array, coefficients: Array, n: Array) -> Elements:
    """Evaluate the elements for the parts' `extents` by element (e,), the rotations (e, p + 1) and n (e, 2)."""
    half = (mesh.share * extents / 2.0)[:, None]
    theta = coefficients @ VALUES.T
    a, c = rods.stretch[:, None], rods.shear[:, None]
    N, Q, tangent = fields(theta, n[:, None, :], a, c)
    stretched = 1.0 + N * (a - c)
    cos, sin = np.cos(theta), np.sin(theta)
    d_turn = Q * stretched
    d_turn2 = Q**2 * (a - c) - N * stretched
    # derivative of r' in theta: d2 (1 + N (a - c)) + d1 Q (a - c)
    cross = np.stack([-sin * stretched + cos * Q * (a - c), cos * stretched + sin * Q * (a - c)], axis=-1)
    bend = rods.EI[:, None] / half
    bent = coefficients @ _STIFF
    size = coefficients.shape[1]
    gradient = np.empty((len(theta), size + 3))
    hessian = np.empty((len(theta), size + 3, size + 3))
    turn = np.r_[0, 1, OUTER : size + 3]
    w = WEIGHTS
    by_turn = (d_turn * w) @ VALUES
    by_force = w @ tangent
    straight = ((n[:, None, :] * tangent).sum(axis=-1) - a * N**2 / 2.0 - c * Q**2 / 2.0) @ w
    bending = np.einsum("ei,ei->e", bent, coefficients)
    share = mesh.share
    gradient[:, turn] = bend * bent - half * by_turn
    gradient[:, 2:4] = -half * by_force
    gradient[:, 4] = -bending * rods.EI / (2.0 * half[:, 0] ** 2) * share / 2.0 - straight * share / 2.0
    inner = bend[:, :, None] * _STIFF - (VALUES.T * (half * d_turn2 * w)[:, None, :]) @ VALUES
    hessian[:, turn[:, None], turn[None, :]] = inner
    mixed = -half[:, :, None] * (VALUES.T @ (cross * w[:, None]))
    hessian[:, turn, 2:4] = mixed
    hessian[:, 2:4, turn] = mixed.transpose(0, 2, 1)
    by_extent = -(bend / half * bent + by_turn) * (share / 2.0)[:, None]
    hessian[:, turn, 4] = hessian[:, 4, turn] = by_extent
    hessian[:, 2:4, 4] = hessian[:, 4, 2:4] = -by_force * (share / 2.0)[:, None]
    hessian[:, 4, 4] = bending * rods.EI / half[:, 0] ** 3 * share**2 / 4.0
    xx = (a * cos**2 + c * sin**2) @ w
    yy = (a * sin**2 + c * cos**2) @ w
    xy = ((a - c) * sin * cos) @ w
    hessian[:, 2:4, 2:4] = -half[:, :, None] * np.stack([np.stack([xx, xy], -1), np.stack([xy, yy], -1)], -2)
    stored = rods.EI / (2.0 * half[:, 0]) * bending + half[:, 0] * ((a * N**2 + c * Q**2) @ w) / 2.0
    return Elements(gradient, hessian, stored)
