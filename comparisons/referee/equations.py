"""Energy of the rods with its exact gradient and Hessian; the unknowns inside the elements are condensed.

With the force ``n = c - W(s)`` of a part, the undeformed tangent e and the section's directions d and d2, ``N = n.d`` and ``Q = n.d2``:

    Pi = sum_parts c.(r_b - r_a - R_b + R_a) + int EI th'^2/2 - (n.(d - e) + N^2/2EA + Q^2/2GA) ds  -  loads  +  springs

is stationary in the rotation th, the stations' positions, the contacts' arc positions (which move the mesh) and, as a maximum, in c. R is
the undeformed axis, ``R_b - R_a = l e`` of a straight part. The resultant W of a load q along the beam is zero at its start: integration
by parts of ``int n.r' - q.r ds`` leaves ``c.(r_b - r_a)``, and W(L) with the loads at the beam's end. With the forces as unknowns, large
EA and GA cause neither round-off nor locking. Stationarity in an arc position means that ``H = m^2/2EI + m kappa0 + N + N^2/2EA + Q^2/2GA``
is continuous at the contact, which is ``F.(r'_- + r'_+) = 0``, contact without friction. A contact with friction has other rows in place of
this one: the direction of its face, slip or stick by Coulomb's law, and the couple of a face. With the direction t of the face and its
angle phi, its left normal n, the part ``a = t . (r'_- + r'_+)/2`` of the mean tangent, the section's rotation theta from its undeformed
direction beta, the natural curvature kappa0 and the whole one ``k = theta' + kappa0``, and ``lever``, the radius of the circle whose
envelope is the face, and ``roll = R`` to the right of the beam, minus these values to its left::

    n . (r'_- + r'_+)/2 = -offset'          direction of the face
    F_t = F . t,  F_n = side F . n           tangential and normal force on the beam, side = 1 for a node on the right
    m_- - m_+ = C = lever F_t                couple on the section, since F acts on the face
    v = A s' + lever psi' + roll phi'        slip rate, A = a + lever k and psi = phi - theta - beta
    slip:   F_t = sigma mu F_n,  sigma = sign v
    stick:  v = 0,  or (A + A*)/2 (s - s*) + lever (psi - psi*) + roll (phi - phi*) = c

The power of the node is the rate of the strain energy and ``F_t v``. Starred values are those where the stick began, and c is the error of the
trapezium of v, which `friction.slip` finds along the path; where the height tapers the lever in stick is the mean of the two. Without a
taper t is along the mean tangent. The couple and the row of phi take the place of the two conditions of stationarity in arc position and
phi, which hold without friction only.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from comparisons.answer import Array
from comparisons.referee.elements import OUTER, STEP, Mesh, elements
from comparisons.referee.grip import LOOSE
from comparisons.referee.layout import NONE, Layout, Touch
from comparisons.referee.rod import value


class System(NamedTuple):
    """The equations with the rows of friction, the elements' bubbles condensed."""

    gradient: Array
    hessian: Array
    held: Array  #: Gradient by the prescribed quantities: the forces and moments that hold them.
    shift: Array
    #: If the other unknowns of an element change by x, its bubbles change by ``-(shift + lever x)``.
    lever: Array
    blocks: Array  #: Hessians of the bubbles.
    #: Moments (e, 2) at the elements' ends from the gradient, since a derivative of the rotation would lose digits.
    ends: Array
    energy: float


def assemble(mesh: Mesh, z: Array) -> System:
    """Return the condensed equations at the unknowns `z`, with the coefficients of the bubbles behind the others."""
    own_gradient, own_hessian, stored = elements(mesh, z)
    layout, local = mesh.layout, mesh.local
    blocks, across = own_hessian[:, OUTER:, OUTER:], own_hessian[:, :OUTER, OUTER:]
    rhs = np.concatenate([own_gradient[:, OUTER:, None], across.swapaxes(1, 2)], axis=2)
    solved = np.linalg.solve(blocks, rhs)
    shift, lever = solved[:, :, 0], solved[:, :, 1:]
    hessian = own_hessian[:, :OUTER, :OUTER] - across @ lever
    size, free = mesh.unknowns + len(layout.given), slice(mesh.unknowns)
    g, k = np.zeros(size), np.zeros((size, size))
    np.add.at(g, local, own_gradient[:, :OUTER])
    np.add.at(k, (local[:, :, None], local[:, None, :]), hessian)
    _add_parts(layout, z, g, k)
    energy = float(stored.sum()) + _add_springs_and_loads(layout, z, g, k)
    held = g[mesh.unknowns :].copy()
    np.add.at(g, local, -np.einsum("eij,ej->ei", across, shift))
    for touch in layout.touches.values():
        if touch.grip is not None:
            e = element_before(mesh, touch)
            numbers, (row, couple, direction, *_), derivatives = rows(layout, touch, z, own_gradient[e, 1])
            by = np.zeros((3, len(g)))
            by[:, numbers] = derivatives[:3]
            np.add.at(by.T, local[e], np.outer(hessian[e, 1], derivatives[:3, 6]))
            g[touch.arc], k[touch.arc] = row, by[0]
            g[numbers[0]] -= couple
            k[numbers[0]] -= by[1]
            if touch.angle != NONE:
                g[touch.angle], k[touch.angle] = direction, by[2]
    return System(g[free], k[free, free], held, shift, lever, blocks, own_gradient[:, :2], energy)


def rows(layout: Layout, touch: Touch, z: Array, moment: float) -> tuple[list[int], Array, Array]:
    """Return numbers; row of friction, couple, row of the direction, A and psi; and their derivatives (5, 8) by the numbers."""
    before, behind = layout.beside(touch)
    turn = int(layout.stations[touch.station].numbers[2])
    forces = [before.force, before.force + 1, behind.force, behind.force + 1]
    # theta, c before the contact and behind it, phi, the moment before it, which has no number, and s
    numbers = [turn, *forces, touch.angle, -1, touch.arc]
    real = layout.full(z)[numbers]
    real[6] = moment
    given = real[:, None] + 1j * STEP * np.eye(len(real))
    theta, phi, m, s = given[0], given[5], given[6], given[7]
    piece, face, grip = before.piece, touch.face, touch.grip or LOOSE
    mean = (piece.tangent(given[1:3], s, theta) + behind.piece.tangent(given[3:5], s, theta)) / 2.0
    force, lever = given[1:3] - given[3:5], face.lever(s)
    cos, sin = np.cos(phi), np.sin(phi)
    aligned = mean[1] * cos - mean[0] * sin + face.tilt
    a = mean[0] * cos + mean[1] * sin if face.slope else (mean[0] ** 2 + mean[1] ** 2) ** 0.5
    x, y = (cos, sin) if face.slope else mean / a
    drag, push = force[0] * x + force[1] * y, face.left * (force[0] * y - force[1] * x)
    couple = lever * drag
    stretch = a + lever * ((m - couple / 2.0) / value(piece.coefficients[:, 2], s) + piece.curvature)
    shear = phi - theta - piece.angle(s)
    row, hold = drag - grip.slip * grip.friction * push, grip.hold
    if hold is not None:
        row = (stretch + hold.stretch) / 2.0 * (s - hold.arc_position) - hold.area(layout.load_parameter)
        if touch.angle >= 0:
            lever = (lever + face.lever(hold.arc_position)) / 2.0
            row = row + lever * wrapped(shear - hold.shear)
            row = row - face.left * face.radius * (phi - hold.direction)
    values = np.array([row, couple, aligned, stretch, shear])
    return numbers, values[:, 0].real, values.imag / STEP


def wrapped(angle: Any) -> Any:
    """Angle less the multiple of 2 pi next to it; phi is measured from the axes of the scene, theta from the undeformed beam."""
    return angle - 2.0 * math.pi * np.round(np.real(angle) / (2.0 * math.pi))


def element_before(mesh: Mesh, touch: Touch) -> int:
    """Return the number of the element that ends at a contact."""
    return int(np.flatnonzero(mesh.local[:, 5] == touch.arc)[-1])


def _add_parts(layout: Layout, z: Array, g: Array, k: Array) -> None:
    """Add ``c.(r_b - r_a - R_b + R_a)`` of the parts; at a contact ``r = x - offset(s) nu(phi)``."""
    local, sizes = layout.sides
    given = layout.full(z)[local].T[..., None] + 1j * STEP * np.eye(6)[:, None]
    angle = layout.pieces(np.arange(len(local)) // 2).angle(given[4])
    by = _at_side(given, angle, sizes[..., None])
    hessian = np.zeros((len(local), 6, 6))
    hessian[:, 2:] = by.imag.swapaxes(0, 1) / STEP
    hessian[:, :2, 2:] = hessian[:, 2:, :2].swapaxes(1, 2)
    np.add.at(g, local[:, 2:], by[..., 0].real.T)
    np.add.at(k, (local[:, :, None], local[:, None, :]), hessian)
    (first, last), rest, touched = layout.chords
    ways, (begin, end) = layout.shifts(z), layout.extents(z).T[..., None]
    # exactly zero for an undeformed beam without contacts
    rest = np.where(touched, rest - layout.pieces(np.arange(len(rest))).between(begin, end)[..., 0].T, 0.0)
    g[layout.forces] += (ways[last] - ways[first] + rest).ravel()


def _at_side(given: Any, angle: Any, sizes: Array) -> Any:
    """Gradient of ``c.(r - R)`` at an end of a part by displacement (2), s and phi, at complex values."""
    (x, y, _, _, s, phi), (sign, left, start, slope) = given, sizes
    along, cos, sin = x * np.cos(angle) + y * np.sin(angle), np.cos(phi), np.sin(phi)
    by_s = -along - left * slope * (y * cos - x * sin)
    by_phi = left * (start + slope * s) * (x * cos + y * sin)
    return sign * np.array([x, y, by_s, by_phi])


def _add_springs_and_loads(layout: Layout, z: Array, g: Array, k: Array) -> float:
    """Add dead loads, springs to the ground, ``k u^2/2``, and those of hinges; return the energy of the springs."""
    numbers, loads, stiffness = layout.tables
    moved = layout.motions(z).ravel()
    forces = stiffness @ moved
    np.add.at(g, numbers.ravel(), forces - loads.ravel())
    np.add.at(k, np.ix_(numbers.ravel(), numbers.ravel()), stiffness)
    return float(moved @ forces) / 2.0


def scales(matrix: Array) -> Array:
    """Return factors of rows and columns with which the largest entry of every row is about one."""
    scale, size = np.ones(len(matrix)), np.abs(matrix)
    for _ in range(3):
        scale = np.sqrt(scale / (size * scale).max(axis=1))
    return scale


def index_of(mesh: Mesh, z: Array, system: System) -> int:
    """Return the index of an equilibrium, the number of negative eigenvalues on the admissible variations; -1 with friction.

    The energy is a maximum in the two force components of every part, whose block of the Hessian is negative definite. By
    Haynsworth's formula ``index = negatives(K) - 2 parts``, where the negatives of the elements' condensed blocks count too. The
    normal of a contact with offset is normal to the mean of the two tangents, so that the angle phi is not an independent variation.
    """
    if mesh.layout.grips:
        return -1
    free = directions(mesh, z)
    reduced = free.T @ system.hessian @ free
    scale = scales(reduced)
    eigenvalues = np.linalg.eigvalsh(scale[:, None] * reduced * scale), np.linalg.eigvalsh(system.blocks)
    return sum(int((values < 0.0).sum()) for values in eigenvalues) - 2 * len(mesh.layout.parts)


def orientation_of(system: System) -> int:
    """Return the sign of the determinant, with friction too; where it changes, a path passes a critical point."""
    signs = [np.linalg.slogdet(system.hessian)[0], *np.linalg.slogdet(system.blocks)[0]]
    return int(np.prod(np.sign(signs)))


def directions(mesh: Mesh, z: Array) -> Array:
    """Admissible variations as columns; the angles phi follow with the directions of the faces."""
    turned = [item for item in mesh.layout.touches.values() if item.angle != NONE]
    free = np.eye(mesh.unknowns)
    for touch in turned:
        numbers, _, derivatives = rows(mesh.layout, touch, z, 0.0)
        change = np.zeros(len(free) + 1)
        np.add.at(change, numbers, derivatives[2])
        free[touch.angle] = -change[:-1] / change[touch.angle]
    return np.delete(free, [touch.angle for touch in turned], axis=1)
