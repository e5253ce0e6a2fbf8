"""Energy of the rods with its exact gradient and Hessian; the unknowns inside the elements are condensed.

With the constant force n of a part in the frame of the beam, ``N = n_x cos th + n_y sin th``, ``Q = -n_x sin th + n_y cos th``:

    Pi = sum_parts n.(r_b - r_a - l e) + int EI th'^2/2 - (n.(d - e) + N^2/2EA + Q^2/2GA) ds  -  loads

is stationary in the rotation th, the stations' positions, the contacts' arc positions (which move the mesh) and, as a maximum, in n.
With the forces as unknowns, large EA and GA cause neither round-off nor locking. Stationarity in an arc position means that
``H = m^2/2EI + N + N^2/2EA + Q^2/2GA`` is continuous at the contact, which is ``F.(r'_- + r'_+) = 0``, contact without friction. A contact
with friction has other rows in place of this one: see `comparisons.referee.friction`.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import SLOPES, VALUES, WEIGHTS
from comparisons.referee.friction import rows
from comparisons.referee.layout import NONE, Layout, Touch, normal

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_STIFF = (SLOPES.T * WEIGHTS) @ SLOPES
_OUTER = 5


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
    table = np.array([(item.EI, item.stretch, item.shear) for item in layout.parts])[mesh.part]
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
    turn = np.r_[0, 1, _OUTER : size + 3]
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


class System(NamedTuple):
    """Gradient (u,) and Hessian (u, u) with condensed bubbles, with the rows of friction, and the recovery of the bubbles.

    If the other unknowns of an element change by x, its bubbles change by ``-(shift + lever x)``. `blocks` are the Hessians of
    the bubbles, `local` and `sign` the indices and signs of the elements' unknowns. `ends` (e, 2) are the moments at the elements'
    ends from the gradient, since a derivative of the rotation would lose digits.
    """

    gradient: Array
    hessian: Array
    shift: Array
    lever: Array
    blocks: Array
    local: Ints
    sign: Array
    ends: Array
    energy: float


def assemble(layout: Layout, mesh: Mesh, rods: Properties, z: Array, bubbles: Array) -> System:
    """Return the condensed equations at the unknowns `z` and the `bubbles` (e, p - 1)."""
    extents = np.array([layout.extent(z, part) for part in layout.parts])[mesh.part]
    n = np.stack([z[rods.force], z[rods.force + 1]], axis=1)
    parts = elements(mesh, rods, extents, rotations(mesh, z, bubbles), n)
    blocks = parts.hessian[:, _OUTER:, _OUTER:]
    rhs = np.concatenate([parts.gradient[:, _OUTER:, None], parts.hessian[:, _OUTER:, :_OUTER]], axis=2)
    solved = np.linalg.solve(blocks, rhs)
    shift, lever = solved[:, :, 0], solved[:, :, 1:]
    across = parts.hessian[:, :_OUTER, _OUTER:]
    gradient = parts.gradient[:, :_OUTER] - np.einsum("eij,ej->ei", across, shift)
    hessian = parts.hessian[:, :_OUTER, :_OUTER] - across @ lever
    local, sign = _numbers(layout, mesh, rods)
    spread = np.array([0, 1, 2, 3, 4, 4])
    size = mesh.unknowns + 1
    g, k = np.zeros(size), np.zeros((size, size))
    np.add.at(g, local, sign * gradient[:, spread])
    np.add.at(
        k,
        (local[:, :, None], local[:, None, :]),
        sign[:, :, None] * sign[:, None, :] * hessian[:, spread[:, None], spread[None, :]],
    )
    _add_stations(layout, z, g, k)
    for touch in layout.touches:
        if touch.grip is not None:
            _rub(layout, mesh, touch, z, _Condensed(gradient[:, 1], hessian[:, 1, spread], local, sign), g, k)
    return System(
        gradient=g[:-1],
        hessian=k[:-1, :-1],
        shift=shift,
        lever=lever,
        blocks=blocks,
        local=local,
        sign=sign,
        ends=parts.gradient[:, :2],
        energy=float(parts.energy.sum()),
    )


class _Condensed(NamedTuple):
    """Moments (e,) at the ends of the elements with their derivatives (e, 6), and the indices and signs of the elements' unknowns."""

    moment: Array
    derivatives: Array
    local: Ints
    sign: Array


def _rub(layout: Layout, mesh: Mesh, touch: Touch, z: Array, ends: _Condensed, g: Array, k: Array) -> None:
    """Exchange the rows of a contact's arc position and phi for those of friction, and add the couple on its section."""
    before, behind = layout.beside(touch)
    turn = layout.stations[before.last].rotation_unknown
    e = int(np.flatnonzero(mesh.part == layout.parts.index(before))[-1])
    dropped = len(g) - 1
    angle = dropped if touch.angle == NONE else touch.angle
    places = [turn, before.force, before.force + 1, behind.force, behind.force + 1, angle, dropped, touch.arc]
    given = np.append(z, 0.0)[places]
    given[6] = ends.moment[e]
    values, derivatives = rows(layout, touch, (before, behind), given)
    by = np.zeros((3, len(g)))
    by[:, places] = derivatives
    np.add.at(by.T, ends.local[e], np.outer(ends.sign[e] * ends.derivatives[e], derivatives[:, 6]))
    g[touch.arc], k[touch.arc] = values.row, by[0]
    g[turn] -= values.couple
    k[turn] -= by[1]
    if touch.angle != NONE:
        g[touch.angle], k[touch.angle] = values.direction, by[2]


def _numbers(layout: Layout, mesh: Mesh, rods: Properties) -> tuple[Ints, Array]:
    """Indices and signs of the elements' unknowns: rotations, force, and arc positions of the part's ends.

    Prescribed quantities have the index after the last unknown, which is dropped.
    """

    def arc(station: int) -> int:
        touch = layout.stations[station].touch
        return NONE if touch == NONE else layout.touches[touch].arc

    arcs = np.array([(arc(part.first), arc(part.last)) for part in layout.parts])[mesh.part]
    local = np.column_stack(
        [mesh.vertices[mesh.first], mesh.vertices[mesh.first + 1], rods.force, rods.force + 1, arcs]
    )
    local[local == NONE] = mesh.unknowns
    return local, np.tile([1.0, 1.0, 1.0, 1.0, -1.0, 1.0], (len(local), 1))


def _add_stations(layout: Layout, z: Array, g: Array, k: Array) -> None:
    """Add ``n.(r_b - r_a - l e)`` of the parts and the loads; the last row and column collect prescribed quantities."""
    for part in layout.parts:
        rows = np.array([part.force, part.force + 1])
        n = z[rows]
        apart = _chord(layout, z, part.first, part.last, part.axes, layout.extent(z, part))
        g[rows] += apart
        for station, sign in ((part.first, -1.0), (part.last, 1.0)):
            there = layout.stations[station]
            touch = None if there.touch == NONE else layout.touches[there.touch]
            for component, number in enumerate(there.place.unknown):
                g[number] += sign * part.axes[component] @ n
                k[rows, number] += sign * part.axes[component]
                k[number, rows] += sign * part.axes[component]
            if touch is None:
                continue
            g[touch.arc] -= sign * n[0]
            k[part.force, touch.arc] -= sign
            k[touch.arc, part.force] -= sign
            if touch.angle != NONE:
                nu = normal(float(z[touch.angle]))
                way = touch.offset * part.axes.T @ np.array([nu[1], -nu[0]])
                g[touch.angle] += sign * way @ n
                k[rows, touch.angle] += sign * way
                k[touch.angle, rows] += sign * way
                k[touch.angle, touch.angle] += sign * touch.offset * nu @ part.axes @ n
    for there in layout.stations:
        if there.touch == NONE:
            for number, load in zip(
                (*there.place.unknown, there.rotation_unknown), (*there.force, there.moment), strict=True
            ):
                g[number] -= load


def _chord(layout: Layout, z: Array, first: int, last: int, axes: Array, extent: float) -> Array:
    """Return ``r_b - r_a - l e`` in the beam's frame; it is exactly zero for an undeformed beam."""
    a, b = layout.stations[first], layout.stations[last]
    moved = b.place.displacement(z) - a.place.displacement(z)
    for there, sign in ((a, -1.0), (b, 1.0)):
        if there.touch != NONE and layout.touches[there.touch].angle != NONE:
            touch = layout.touches[there.touch]
            moved = moved - sign * touch.offset * normal(float(z[touch.angle]))
    apart = np.asarray(axes.T @ moved)
    if a.touch == NONE and b.touch == NONE:
        return apart
    rest = axes.T @ (np.array(b.place.reference) - np.array(a.place.reference))
    return np.asarray(apart + rest - np.array([extent, 0.0]))
