"""Energy of the rods with its exact gradient and Hessian; the unknowns inside the elements are condensed.

With the force ``n = c - W(s)`` of a part in the frame of the undeformed tangent e, ``N = n_x cos th + n_y sin th`` and ``Q = -n_x sin th +
n_y cos th``:

    Pi = sum_parts c.(r_b - r_a - R_b + R_a) + int EI th'^2/2 - (n.(d - e) + N^2/2EA + Q^2/2GA) ds  -  loads  +  springs

is stationary in the rotation th, the stations' positions, the contacts' arc positions (which move the mesh) and, as a maximum, in c. R is
the undeformed axis, ``R_b - R_a = l e`` of a straight part. The resultant W of a load q along the beam is zero at its start: integration
by parts of ``int n.r' - q.r ds`` leaves ``c.(r_b - r_a)``, and W(L) with the loads at the beam's end. With the forces as unknowns, large
EA and GA cause neither round-off nor locking. Stationarity in an arc position means that ``H = m^2/2EI + m kappa0 + N + N^2/2EA + Q^2/2GA``
is continuous at the contact, which is ``F.(r'_- + r'_+) = 0``, contact without friction. A contact with friction has other rows in place of
this one: see `comparisons.referee.friction`.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee import elements, graded
from comparisons.referee.elements import Elements, Mesh, Properties, rotations
from comparisons.referee.friction import rows
from comparisons.referee.layout import Layout, Part, Touch, normal
from comparisons.referee.stations import NONE, Station

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


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
    parts, outer = _parts(layout, mesh, rods, z, bubbles)
    blocks = parts.hessian[:, outer:, outer:]
    rhs = np.concatenate([parts.gradient[:, outer:, None], parts.hessian[:, outer:, :outer]], axis=2)
    solved = np.linalg.solve(blocks, rhs)
    shift, lever = solved[:, :, 0], solved[:, :, 1:]
    across = parts.hessian[:, :outer, outer:]
    gradient = parts.gradient[:, :outer] - np.einsum("eij,ej->ei", across, shift)
    hessian = parts.hessian[:, :outer, :outer] - across @ lever
    local, sign = _numbers(layout, mesh, rods)
    spread = np.array([0, 1, 2, 3, 4, 4, 5][: local.shape[1]])
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
        energy=float(parts.energy.sum()) + spring_energy(layout, z),
    )


def _parts(layout: Layout, mesh: Mesh, rods: Properties, z: Array, bubbles: Array) -> tuple[Elements, int]:
    """Return the elements, and the number of their unknowns outside the bubbles."""
    c = np.stack([z[rods.force], z[rods.force + 1]], axis=1)
    coefficients = rotations(mesh, z, bubbles)
    if not layout.uniform:
        return graded.elements(layout, mesh, z, coefficients, c), graded.OUTER
    extents = np.array([layout.extent(z, part) for part in layout.parts])[mesh.part]
    return elements.elements(mesh, rods, extents, coefficients, c), elements.OUTER


class _Condensed(NamedTuple):
    """Moments (e,) at the ends of the elements with their derivatives (e, 6 or 7), and the indices and signs of the elements' unknowns."""

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

    Where rods are not uniform the arc position of the part's beginning counts once more, since it is an unknown of its own besides the
    part's length. Prescribed quantities have the index after the last unknown, which is dropped.
    """

    def arc(station: int) -> int:
        touch = layout.stations[station].touch
        return NONE if touch == NONE else layout.touches[touch].arc

    arcs = np.array([(arc(part.first), arc(part.last)) for part in layout.parts])[mesh.part]
    columns = [mesh.vertices[mesh.first], mesh.vertices[mesh.first + 1], rods.force, rods.force + 1, arcs]
    signs = [1.0, 1.0, 1.0, 1.0, -1.0, 1.0]
    if not layout.uniform:
        columns, signs = [*columns, arcs[:, 0]], [*signs, 1.0]
    local = np.column_stack(columns)
    local[local == NONE] = mesh.unknowns
    return local, np.tile(signs, (len(local), 1))


def _add_stations(layout: Layout, z: Array, g: Array, k: Array) -> None:
    """Add ``c.(r_b - r_a - R_b + R_a)`` of the parts, loads and springs; the last row and column collect prescribed quantities."""
    for part in layout.parts:
        rows = np.array([part.force, part.force + 1])
        n = z[rows]
        g[rows] += _apart(layout, z, part)
        for station, sign in ((part.first, -1.0), (part.last, 1.0)):
            there = layout.stations[station]
            touch = None if there.touch == NONE else layout.touches[there.touch]
            for component, number in enumerate(there.place.unknown):
                g[number] += sign * part.axes[component] @ n
                k[rows, number] += sign * part.axes[component]
                k[number, rows] += sign * part.axes[component]
            if touch is None:
                continue
            if part.rod.turn:
                e = part.rod.direction(float(z[touch.arc]))
                g[touch.arc] -= sign * n @ e
                k[rows, touch.arc] -= sign * e
                k[touch.arc, rows] -= sign * e
                k[touch.arc, touch.arc] -= sign * part.rod.curvature * (n[1] * e[0] - n[0] * e[1])
            else:
                g[touch.arc] -= sign * n[0]
                k[part.force, touch.arc] -= sign
                k[touch.arc, part.force] -= sign
            if touch.angle != NONE:
                _add_offset(part, touch, sign, z, g, k)
    for there in layout.stations:
        if there.touch == NONE:
            for number, load in zip(
                (*there.place.unknown, there.rotation_unknown), (*there.force, there.moment), strict=True
            ):
                g[number] -= load
    _add_springs(layout, z, g, k)


def _add_offset(part: Part, touch: Touch, sign: float, z: Array, g: Array, k: Array) -> None:
    """Add ``sign c.r`` of the axis point ``r = x - offset(s) nu(phi)`` by phi, and by s where the offset depends on s."""
    rows = np.array([part.force, part.force + 1])
    n, nu = z[rows], normal(float(z[touch.angle]))
    tau = np.array([nu[1], -nu[0]])
    offset = touch.away(float(z[touch.arc]))
    way = offset * part.axes.T @ tau
    g[touch.angle] += sign * way @ n
    k[rows, touch.angle] += sign * way
    k[touch.angle, rows] += sign * way
    k[touch.angle, touch.angle] += sign * offset * nu @ part.axes @ n
    if touch.slope:
        lean, turned = -touch.slope * part.axes.T @ nu, touch.slope * part.axes.T @ tau
        g[touch.arc] += sign * lean @ n
        k[rows, touch.arc] += sign * lean
        k[touch.arc, rows] += sign * lean
        k[touch.angle, touch.arc] += sign * turned @ n
        k[touch.arc, touch.angle] += sign * turned @ n


def _add_springs(layout: Layout, z: Array, g: Array, k: Array) -> None:
    """Add springs to the ground, ``k u^2/2``, and of hinges, ``k (theta - theta_joint)^2/2``."""
    for number, there in _sprung(layout):
        moved = (*there.place.displacement(z), layout.rotation(z, number))
        for unknown, stiffness, way in zip(
            (*there.place.unknown, there.rotation_unknown), there.springs, moved, strict=True
        ):
            g[unknown] += stiffness * way
            k[unknown, unknown] += stiffness
    for hinge in layout.hinges:
        ends = [layout.stations[number].rotation_unknown for number in (hinge.end, hinge.joint)]
        moment = hinge.stiffness * (layout.rotation(z, hinge.end) - layout.rotation(z, hinge.joint))
        for unknown, sign in zip(ends, (1.0, -1.0), strict=True):
            g[unknown] += sign * moment
            k[unknown, unknown] += hinge.stiffness
        k[ends[0], ends[1]] -= hinge.stiffness
        k[ends[1], ends[0]] -= hinge.stiffness


def _sprung(layout: Layout) -> Iterator[tuple[int, Station]]:
    """Yield the stations with springs to the ground."""
    if layout.sprung:
        yield from ((number, there) for number, there in enumerate(layout.stations) if any(there.springs))


def spring_energy(layout: Layout, z: Array) -> float:
    """Energy of the springs to the ground and of hinges."""
    energy = 0.0
    for number, there in _sprung(layout):
        moved = (*there.place.displacement(z), layout.rotation(z, number))
        energy += sum(k * way**2 / 2.0 for k, way in zip(there.springs, moved, strict=True))
    for hinge in layout.hinges:
        energy += (
            hinge.stiffness * (layout.rotation(z, hinge.end) - layout.rotation(z, hinge.joint)) ** 2 / 2.0
        )
    return float(energy)


def _apart(layout: Layout, z: Array, part: Part) -> Array:
    """Return ``r_b - r_a - R_b + R_a`` in the beam's frame; it is exactly zero for an undeformed beam."""
    a, b = layout.stations[part.first], layout.stations[part.last]
    moved = b.place.displacement(z) - a.place.displacement(z)
    for there, sign in ((a, -1.0), (b, 1.0)):
        if there.touch != NONE and layout.touches[there.touch].angle != NONE:
            touch = layout.touches[there.touch]
            moved = moved - sign * touch.away(float(z[touch.arc])) * normal(float(z[touch.angle]))
    apart = np.asarray(part.axes.T @ moved)
    if a.touch == NONE and b.touch == NONE:
        return apart
    rest = part.axes.T @ (np.array(b.place.reference) - np.array(a.place.reference))
    return np.asarray(apart + rest - part.rod.between(*layout.ends(z, part)))
