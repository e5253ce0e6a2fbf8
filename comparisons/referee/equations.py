"""Energy of the rods with its exact gradient and Hessian; the unknowns inside the elements are condensed.

With the force ``n = c - W(s)`` of a part in the frame of the undeformed tangent e, ``N = n_x cos th + n_y sin th`` and ``Q = -n_x sin th +
n_y cos th``:

    Pi = sum_parts c.(r_b - r_a - R_b + R_a) + int EI th'^2/2 - (n.(d - e) + N^2/2EA + Q^2/2GA) ds  -  loads  +  springs

is stationary in the rotation th, the stations' positions, the contacts' arc positions (which move the mesh) and, as a maximum, in c. R is
the undeformed axis, ``R_b - R_a = l e`` of a straight part. The resultant W of a load q along the beam is zero at its start: integration
by parts of ``int n.r' - q.r ds`` leaves ``c.(r_b - r_a)``, and W(L) with the loads at the beam's end. With the forces as unknowns, large
EA and GA cause neither round-off nor locking. Stationarity in an arc position means that ``H = m^2/2EI + m kappa0 + N + N^2/2EA + Q^2/2GA``
is continuous at the contact, which is ``F.(r'_- + r'_+) = 0``, contact without friction. A contact with friction has other rows in place of
this one: see `comparisons.referee.grip`.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.elements import OUTER, Mesh, elements
from comparisons.referee.grip import rows
from comparisons.referee.layout import NONE, Layout, Part, Touch, normal

Array = NDArray[np.float64]


class System(NamedTuple):
    """Gradient (u,) and Hessian (u, u) with condensed bubbles, with the rows of friction, and the recovery of the bubbles.

    If the other unknowns of an element change by x, its bubbles change by ``-(shift + lever x)``. `blocks` are the Hessians of the bubbles.
    `ends` (e, 2) are the moments at the elements' ends from the gradient, since a derivative of the rotation would lose digits.
    """

    gradient: Array
    hessian: Array
    shift: Array
    lever: Array
    blocks: Array
    ends: Array
    energy: float


def assemble(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> System:
    """Return the condensed equations at the unknowns `z` and the `bubbles` (e, p - 1)."""
    own, local = elements(layout, mesh, z, bubbles), mesh.local
    blocks, across = own.hessian[:, OUTER:, OUTER:], own.hessian[:, :OUTER, OUTER:]
    rhs = np.concatenate([own.gradient[:, OUTER:, None], across.swapaxes(1, 2)], axis=2)
    solved = np.linalg.solve(blocks, rhs)
    shift, lever = solved[:, :, 0], solved[:, :, 1:]
    gradient = own.gradient[:, :OUTER] - np.einsum("eij,ej->ei", across, shift)
    hessian = own.hessian[:, :OUTER, :OUTER] - across @ lever
    # the last row and column collect prescribed quantities, whose number is `NONE`
    g, k = np.zeros(mesh.unknowns + 1), np.zeros((mesh.unknowns + 1, mesh.unknowns + 1))
    np.add.at(g, local, gradient)
    np.add.at(k, (local[:, :, None], local[:, None, :]), hessian)
    _add_parts(layout, z, g, k)
    energy = float(own.energy.sum()) + _add_springs_and_loads(layout, z, g, k)
    for touch in layout.touches:
        if touch.grip is not None:
            e = element_before(mesh, touch)
            found = rows(layout, touch, z, own.gradient[e, 1])
            by = np.zeros((3, len(g)))
            by[:, found.numbers] = found.derivatives[:3]
            np.add.at(by.T, local[e], np.outer(hessian[e, 1], found.derivatives[:3, 6]))
            turn = found.numbers[0]
            g[touch.arc], k[touch.arc] = found.row, by[0]
            g[turn] -= found.couple
            k[turn] -= by[1]
            if touch.angle != NONE:
                g[touch.angle], k[touch.angle] = found.direction, by[2]
    return System(g[:-1], k[:-1, :-1], shift, lever, blocks, own.gradient[:, :2], energy)


def element_before(mesh: Mesh, touch: Touch) -> int:
    """Return the number of the element that ends at a contact."""
    return int(np.flatnonzero(mesh.local[:, 5] == touch.arc)[-1])


def _add_parts(layout: Layout, z: Array, g: Array, k: Array) -> None:
    """Add ``c.(r_b - r_a - R_b + R_a)`` of the parts."""
    shifts = layout.shifts(z)
    for part in layout.parts:
        own, axes = slice(part.force, part.force + 2), part.rod.axes
        n = z[own]
        g[own] += _apart(layout, z, part, shifts)
        for number, sign in ((part.first, -1.0), (part.last, 1.0)):
            there = layout.stations[number]
            for component, unknown in enumerate(there.unknown[:2]):
                g[unknown] += sign * axes[component] @ n
                k[own, unknown] += sign * axes[component]
                k[unknown, own] += sign * axes[component]
            touch = there.touch
            if touch is None:
                continue
            e = part.rod.direction(float(z[touch.arc]))
            g[touch.arc] -= sign * n @ e
            k[own, touch.arc] -= sign * e
            k[touch.arc, own] -= sign * e
            k[touch.arc, touch.arc] -= sign * part.rod.curvature * (n[1] * e[0] - n[0] * e[1])
            if touch.angle != NONE:
                _add_offset(part, touch, sign, z, g, k)


def _add_springs_and_loads(layout: Layout, z: Array, g: Array, k: Array) -> float:
    """Add dead loads, springs to the ground, ``k u^2/2``, and those of hinges; return the energy of the springs."""
    numbers, _, loads, springs = layout.tables
    moved = layout.motions(z)
    np.add.at(g, numbers, -loads)
    np.add.at(g, numbers, springs * moved)
    np.add.at(k, (numbers, numbers), springs)
    energy = float((springs * moved**2).sum()) / 2.0
    for end, joint, stiffness in layout.hinges:
        turns = numbers[[end, joint], 2]
        apart = moved[end, 2] - moved[joint, 2]
        energy += float(stiffness * apart**2) / 2.0
        np.add.at(g, turns, stiffness * apart * np.array([1.0, -1.0]))
        np.add.at(k, (turns[:, None], turns), stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]]))
    return energy


def _add_offset(part: Part, touch: Touch, sign: float, z: Array, g: Array, k: Array) -> None:
    """Add ``sign c.r`` of the axis point ``r = x - offset(s) nu(phi)`` by phi, and by s where the offset depends on s."""
    own, axes, nu = slice(part.force, part.force + 2), part.rod.axes, normal(float(z[touch.angle]))
    n, tau, offset = z[own], np.array([nu[1], -nu[0]]), touch.away(float(z[touch.arc]))
    way, lean = offset * axes.T @ tau, -touch.slope * axes.T @ nu
    for unknown, by in ((touch.angle, way), (touch.arc, lean)):
        g[unknown] += sign * by @ n
        k[own, unknown] += sign * by
        k[unknown, own] += sign * by
    k[touch.angle, touch.angle] += sign * offset * nu @ axes @ n
    mixed = sign * touch.slope * (axes.T @ tau) @ n
    k[touch.angle, touch.arc] += mixed
    k[touch.arc, touch.angle] += mixed


def _apart(layout: Layout, z: Array, part: Part, shifts: Array) -> Array:
    """Return ``r_b - r_a - R_b + R_a`` in the beam's frame; it is exactly zero for an undeformed beam."""
    a, b = layout.stations[part.first], layout.stations[part.last]
    apart = np.asarray(part.rod.axes.T @ (shifts[part.last] - shifts[part.first]))
    if a.touch is None and b.touch is None:
        return apart
    rest = part.rod.axes.T @ (b.reference - a.reference)
    return np.asarray(apart + rest - part.rod.between(*part.ends(z)))
