"""Dense Hessians of rods in contact, by elements that share nothing with `tsm`: what the index is held against.

`displacement_index` discretises the Reissner rod's strain energy in displacements and rotations, with a mesh node at every contact.
A pin holds that node and a beam's end shares its place; the arc position is an unknown that moves the mesh. No multiplier is
left, so the negative eigenvalues are the index.

`mixed_index` has the rotations and the constant forces of the segments, for contacts with an offset, whose normal depends on the forces.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from tsm.elements.properties import Array

DEGREE = 8
STEP = 1e-40


class Contact(NamedTuple):
    """What cuts a rod.

    Attributes
    ----------
    arc : str
        Name of its arc position.
    touching : hashable
        Node that touches, None for a pin.
    force : tuple of float
        On the rod.
    reach : float
        Offset of the surface, positive to the right.
    """

    arc: str
    touching: object
    force: tuple
    reach: float


class Segment(NamedTuple):
    """A rod between two loads.

    Attributes
    ----------
    stiffness : tuple of float
        EA, GA, EI.
    ends : tuple of 2 hashables
        Names of its end nodes.
    contacts : tuple of 2 (Contact or None)
        At its ends.
    length : float
        Undeformed.
    shape : callable
        Position (m, 2) and angle (m,) at parts (m,) of the length.
    force : tuple of float
        Internal force.
    """

    stiffness: tuple
    ends: tuple
    contacts: tuple
    length: float
    shape: Callable
    force: tuple


def lobatto(degree: int) -> Array:
    """Gauss-Lobatto nodes on the unit interval."""
    inner = legendre.Legendre.basis(degree).deriv().roots()
    return (np.concatenate([[-1.0], inner.real, [1.0]]) + 1) / 2


def tables(degree: int, points: int) -> tuple[Array, Array, Array]:
    """Weights, values and derivatives of the Lagrange polynomials at Gauss points."""
    nodes = lobatto(degree)
    x, w = legendre.leggauss(points)
    at = (x + 1) / 2
    to = np.linalg.inv(legendre.legvander(2 * nodes - 1, degree))
    values = legendre.legvander(2 * at - 1, degree) @ to
    slopes = np.stack([2 * legendre.legval(2 * at - 1, legendre.legder(column)) for column in to.T], axis=1)
    return w / 2, values, slopes


def gradient(z: Array, stiffness: tuple) -> Array:
    """Derivatives of ``h W`` by ``x', y', theta, theta'`` over the unit interval, and h."""
    EA, GA, EI = stiffness
    dx, dy, theta, turn, h = z
    c, s = np.cos(theta), np.sin(theta)
    stretch, shear = (c * dx + s * dy) / h - 1, (c * dy - s * dx) / h
    N, Q, m = EA * stretch, GA * shear, EI * turn / h
    X, Y = N * c - Q * s, N * s + Q * c
    energy = (N * stretch + Q * shear + m * turn / h) / 2
    return np.array([X, Y, h * (N * shear - Q * (1 + stretch)), m, energy - (X * dx + Y * dy + m * turn) / h])


def field_hessian(gradient: Callable, z: Array, stiffness: tuple) -> Array:
    """Second derivatives (5, 5, points) by complex steps."""
    columns = []
    for k in range(len(z)):
        moved = z.astype(complex)
        moved[k] += 1j * STEP
        columns.append(gradient(moved, stiffness).imag / STEP)
    return np.stack(columns, axis=1)


class Assembly:
    """Dense matrix over named unknowns; None is held, a name may be another's."""

    def __init__(self, same: dict) -> None:
        self.same = same
        self.numbers: dict = {}
        self.parts: list = []

    def add(self, names: list, matrix: Array) -> None:
        self.parts.append(([self.number(name) for name in names], matrix))

    def number(self, name: object) -> int:
        while name in self.same:
            name = self.same[name]
        return -1 if name is None else self.numbers.setdefault(name, len(self.numbers))

    def negatives(self, length: float, force: float) -> int:
        """Number of negative eigenvalues, in plain numbers."""
        whole = np.zeros((len(self.numbers) + 1,) * 2)
        for own, matrix in self.parts:
            np.add.at(whole, np.ix_(own, own), matrix)
        unit = {"place": length, "turn": 1.0, "arc": length, "force": force}
        units = np.array([unit[kind] for kind, *_ in self.numbers])
        values = np.linalg.eigvalsh(whole[:-1, :-1] * np.outer(units, units))
        return int(np.count_nonzero(values < 0))


def held(segments: list[Segment], fixed: set) -> dict:
    """Names that are another's: contacts lie where the touching node is."""
    same: dict = dict.fromkeys(fixed)
    for segment in segments:
        contact = segment.contacts[1]
        if contact is not None:
            for c in range(2):
                other = ("place", contact.touching, c) if contact.touching is not None else None
                same["place", segment.ends[1], c] = other
    return same


def displacement_index(
    segments: list[Segment], fixed: set, length: float, force: float, *, elements: int = 3
) -> int:
    """Index of an equilibrium whose contacts have no offset.

    Parameters
    ----------
    segments : list of Segment
        All rods.
    fixed : set
        Names ``("place", node, component)`` and ``("turn", node)`` that are prescribed.
    length, force : float
        Units.
    elements : int
        For every segment.
    """
    w, values, slopes = tables(DEGREE, DEGREE)
    nodes = lobatto(DEGREE)
    assembly = Assembly(held(segments, fixed))
    size = 3 * len(nodes)
    by = np.zeros((len(w), 5, size + 2))
    by[:, 0, 0:size:3] = by[:, 1, 1:size:3] = by[:, 3, 2:size:3] = slopes
    by[:, 2, 2:size:3] = values
    by[:, 4, size], by[:, 4, size + 1] = -1 / elements, 1 / elements
    for number, segment in enumerate(segments):
        h = np.full(len(w), segment.length / elements)
        for e in range(elements):
            position, theta = segment.shape((e + nodes) / elements)
            x, y = position.T
            z = np.array([slopes @ x, slopes @ y, values @ theta, slopes @ theta, h])
            hessian = field_hessian(gradient, z, segment.stiffness)
            names: list = []
            for n in range(len(nodes)):
                end = _node(segment, number, e * DEGREE + n, elements * DEGREE)
                names += [("place", end, 0), ("place", end, 1), ("turn", end)]
            names += [("arc", c.arc) if c else None for c in segment.contacts]
            assembly.add(names, np.einsum("q,qai,abq,qbj->ij", w, by, hessian, by, optimize=True))
    return assembly.negatives(length, force)


def _node(segment: Segment, number: int, place: int, last: int) -> object:
    return {0: segment.ends[0], last: segment.ends[1]}.get(place, (number, place))


def dual_gradient(z: Array, stiffness: tuple) -> Array:
    """Derivatives of ``h (EI theta'^2/2 - N - N^2/2EA - Q^2/2GA)`` by theta, ``theta'`` over the unit interval, force and h."""
    EA, GA, EI = stiffness
    theta, turn, nx, ny, h = z
    c, s = np.cos(theta), np.sin(theta)
    N, Q = nx * c + ny * s, ny * c - nx * s
    stretched, sheared = 1 + N / EA, Q / GA
    by_x, by_y = c * stretched - s * sheared, s * stretched + c * sheared
    stored = N + N * N / (2 * EA) + Q * Q / (2 * GA)
    return np.array(
        [
            -h * (stretched * Q - sheared * N),
            EI * turn / h,
            -h * by_x,
            -h * by_y,
            -EI * turn * turn / (2 * h * h) - stored,
        ]
    )


def mixed_index(
    segments: list[Segment], fixed: set, length: float, force: float, *, elements: int = 3
) -> int:
    """The same with the segments' forces as unknowns, which may have contacts with an offset."""
    w, values, slopes = tables(DEGREE, DEGREE + 1)
    nodes = lobatto(DEGREE)
    assembly = Assembly(dict.fromkeys(fixed))
    size = len(nodes)
    by = np.zeros((len(w), 5, size + 4))
    by[:, 0, :size], by[:, 1, :size] = values, slopes
    by[:, 2, size] = by[:, 3, size + 1] = 1
    by[:, 4, size + 2], by[:, 4, size + 3] = -1 / elements, 1 / elements
    pull = np.kron(np.array([[0, 0, -1], [0, 0, 1], [-1, 1, 0]]), np.eye(2))
    multipliers = 0
    for number, segment in enumerate(segments):
        h, forces = (
            np.full(len(w), segment.length / elements),
            np.multiply.outer(segment.force, np.ones(len(w))),
        )
        own = [("force", number, c) for c in range(2)]
        for e in range(elements):
            theta = segment.shape((e + nodes) / elements)[1]
            z = np.array([values @ theta, slopes @ theta, *forces, h])
            hessian = field_hessian(dual_gradient, z, segment.stiffness)
            names: list = [
                ("turn", _node(segment, number, e * DEGREE + n, elements * DEGREE)) for n in range(len(nodes))
            ]
            names += [*own, *(("arc", c.arc) if c else None for c in segment.contacts)]
            assembly.add(names, np.einsum("q,qai,abq,qbj->ij", w, by, hessian, by, optimize=True))
        places = [("place", end, c) for end in segment.ends for c in range(2)]
        assembly.add([*places, *own], pull)
        multipliers += 2
        contact = segment.contacts[1]
        if contact is not None:
            lever = [("force", contact.arc, c) for c in range(2)]
            touching = [
                ("place", contact.touching, c) if contact.touching is not None else None for c in range(2)
            ]
            assembly.add([*places[2:], *touching, *lever], pull)
            multipliers += 2
            if contact.reach:
                angle = float(segment.shape(np.array([1.0]))[1][0])
                at = np.array([angle, *segment.force, *contact.force])
                scale = np.array([1.0, force, force, force, force])
                names = [("turn", segment.ends[1]), *own, *lever]
                assembly.add(names, surface_hessian(at, scale, segment.stiffness, contact.reach))
    return assembly.negatives(length, force) - multipliers


def surface_hessian(at: Array, scale: Array, stiffness: tuple, reach: float) -> Array:
    """Second derivatives of ``- reach F . nu`` over angle, force before and contact force, nu across the mean tangent vector."""
    EA, GA, _ = stiffness

    def energy(z: Array) -> complex:
        angle, nx, ny, Fx, Fy = z
        c, s = np.cos(angle), np.sin(angle)
        tx = ty = 0.0
        for X, Y in ((nx, ny), (nx - Fx, ny - Fy)):
            N, Q = X * c + Y * s, Y * c - X * s
            tx, ty = tx + c * (1 + N / EA) - s * Q / GA, ty + s * (1 + N / EA) + c * Q / GA
        return -reach * (Fx * ty - Fy * tx) / np.sqrt(tx * tx + ty * ty)

    hessian = np.empty((5, 5))
    for i in range(5):
        for j in range(5):
            ahead, back = at.astype(complex), at.astype(complex)
            ahead[i] += 1j * STEP * scale[i]
            back[i] += 1j * STEP * scale[i]
            ahead[j] += 1e-4 * scale[j]
            back[j] -= 1e-4 * scale[j]
            hessian[i, j] = (energy(ahead) - energy(back)).imag / (2e-4 * STEP * scale[i] * scale[j])
    return (hessian + hessian.T) / 2
