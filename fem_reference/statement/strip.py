"""A strip: geometry, section, material, clamps and mesh."""

from cmath import rect
from dataclasses import dataclass
from math import atan2, pi, sin
from typing import Any

import numpy as np

from fem_reference.statement.arrays import Array
from fem_reference.statement.checks import Point, require, require_choice, require_finite, require_positive
from fem_reference.statement.material import MATERIALS, PLANES

ELEMENTS = ("Q1", "Q2", "Q2-full")

LARGEST_MEMORY = 2 * 2.0**30
"""Largest estimated memory for the mesh of a strip [bytes]."""
LARGEST_WORK = 1e11
"""Largest estimated number of operations in one factorisation, about half a minute."""


def solution_cost(mesh: tuple[int, int], element: str) -> tuple[float, float]:
    """Estimate the memory [bytes] and the operations of one factorisation of a structured mesh.

    A biquadratic element takes 36 kB and a bilinear one 9.4 kB (measured). Two bands of ``m (w + 1)`` numbers are added.
    With r nodes on a section the bandwidth w is ``4 r + 5``, or ``2 r + 3`` for bilinear elements. The factorisation takes
    ``m w^2`` operations.
    """
    nx, ny = map(float, mesh)
    order, element_memory = (1, 9.4e3) if element == "Q1" else (2, 36e3)
    r = order * ny + 1
    m, width = 2 * r * (order * nx + 1), 2 * order * r + 2 * order + 1
    return element_memory * nx * ny + 16 * m * (width + 1), m * width**2


@dataclass(frozen=True, kw_only=True)
class Strip:
    """A strip whose axis is straight or an arc of a circle.

    Its own frame, that of a mesh file, has the origin at the start and x along the axis there.

    Parameters
    ----------
    name
        Name of the strip in contacts, loads and results.
    start, end
        Ends of the axis [m]; its direction is from start to end.
    turn
        Angle by which the undeformed axis turns to the left from start to end; zero for a straight strip [rad].
    height, width
        Dimensions of the section in the plane and out of it [m].
    end_height, end_width
        Dimensions of the section at the end, if the strip tapers: they change linearly along the axis. None for those at the start [m].
    youngs_modulus, poissons_ratio
        Elastic constants [Pa, -].
    clamped
        The ends clamped at rest, none, one or both of ``"start"`` and ``"end"``.
    clamp
        ``"rod"``: the clamped edge has no axial displacement and its middle no transverse displacement, as a clamped rod
        with free lateral contraction. ``"full"``: both displacements vanish on the edge.
    mesh
        Numbers of elements along the axis (at least 2) and over the height.
    element
        ``"Q2"``: biquadratic with two Gauss points along the strip and three across. ``"Q2-full"``: biquadratic with
        three by three Gauss points. ``"Q1"``: bilinear; elements that are longer than high lock in bending.
    mesh_file
        File with a mesh of quadrilaterals in the strip's frame, which replaces ``mesh``; see
        `fem_reference.solid.mesh_file.read_mesh`.
    material
        A key of `fem_reference.statement.material.MATERIALS`.
    plane
        ``"stress"``: plane stress; ``"strain"``: plane strain.

    Raises
    ------
    ValueError
        If a value is out of range, or the mesh needs more than `LARGEST_MEMORY` or `LARGEST_WORK`.
    """

    name: str
    start: Point
    end: Point
    height: float
    width: float
    youngs_modulus: float
    poissons_ratio: float
    turn: float = 0.0
    end_height: float | None = None
    end_width: float | None = None
    clamped: tuple[str, ...] = ("start",)
    clamp: str = "rod"
    mesh: tuple[int, int] = (50, 2)
    element: str = "Q2"
    mesh_file: str | None = None
    material: str = "st-venant-kirchhoff"
    plane: str = "stress"

    def __post_init__(self) -> None:
        given, mesh = self.mesh_file is None, self.mesh
        require_finite(self, "start", self.start, 2)
        require_finite(self, "end", self.end, 2)
        require(self, "turn", abs(self.turn) < 2 * pi, "must lie between -2 pi and 2 pi")
        require(self, "end", self.length > 0, "must differ from start")
        room = abs(self.curvature) * self.largest_height < 2
        require(self, "turn", room, "must leave the radius of the axis above half the height")
        require(self, "turn", given or not self.turn, "must be zero with a mesh file")
        rule = "must be None with a mesh file, which has the strip's shape"
        require(self, "end_height", given or self.end_height is None, rule)
        require_positive(self, "height", "width", "youngs_modulus", "end_height", "end_width")
        require(self, "poissons_ratio", -1 < self.poissons_ratio < 0.5, "must lie between -1 and 0.5")
        require_choice(self, "clamped", ((), ("start",), ("end",), ("start", "end")))
        require_choice(self, "element", ELEMENTS)
        require_choice(self, "clamp", ("rod", "full"))
        require_choice(self, "material", tuple(MATERIALS))
        require_choice(self, "plane", PLANES)
        whole = len(mesh) == 2 and all(isinstance(n, int) and n < 10**15 for n in mesh)
        rule = "must be two whole numbers, >= 2 and >= 1"
        require(self, "mesh", whole and mesh[0] >= 2 and mesh[1] >= 1, rule)
        if given:
            memory, work = solution_cost(mesh, self.element)
            rule = f"must need at most {LARGEST_MEMORY / 2**30:g} GiB, needs about {memory / 2**30:.3g}"
            require(self, "mesh", memory <= LARGEST_MEMORY, rule)
            rule = f"must need at most {LARGEST_WORK:g} operations a factorisation, needs about {work:.2g}"
            require(self, "mesh", work <= LARGEST_WORK, rule)

    @property
    def chord(self) -> complex:
        """Vector from start to end in the complex plane [m]."""
        return complex(*self.end) - complex(*self.start)

    @property
    def length(self) -> float:
        """Length of the axis [m]."""
        half = self.turn / 2
        return abs(self.chord) * (half / sin(half) if half else 1.0)

    @property
    def curvature(self) -> float:
        """Curvature of the undeformed axis, positive to the left [1/m]."""
        return self.turn / self.length

    @property
    def bending_stiffness(self) -> float:
        """``E b h^3 / 12`` of the middle section [N m^2]."""
        middle = self.length / 2
        return float(self.youngs_modulus * self.width_at(middle) * self.height_at(middle) ** 3 / 12)

    @property
    def axial_stiffness(self) -> float:
        """``E b h / L`` of the middle section [N/m]."""
        middle = self.length / 2
        return float(self.youngs_modulus * self.width_at(middle) * self.height_at(middle) / self.length)

    def height_at(self, x: Any) -> Any:
        """Height of the sections at the axial coordinates ``x`` [m]."""
        return self.height + x / self.length * ((self.end_height or self.height) - self.height)

    def width_at(self, x: Any) -> Any:
        """Width of the sections at the axial coordinates ``x`` [m]."""
        return self.width + x / self.length * ((self.end_width or self.width) - self.width)

    @property
    def largest_height(self) -> float:
        """Largest height of a section [m]."""
        return max(self.height, self.end_height or 0.0)

    @property
    def direction(self) -> complex:
        """Unit tangent of the undeformed axis at the start, in the complex plane."""
        return self.chord / abs(self.chord) * (rect(1.0, -self.turn / 2) if self.turn else 1.0)

    def directions(self, x: Any) -> tuple[Array, Array]:
        """Tangents and left normals ``(2, ...)`` of the undeformed axis at axial coordinates."""
        t = self.direction * np.exp(1j * self.curvature * np.asarray(x))
        return np.stack([t.real, t.imag]), np.stack([-t.imag, t.real])

    def placed(self, places: Array) -> Array:
        """Positions ``(..., 2)`` from the start of undeformed ``places``: axial coordinate, and distance to the left of the axis."""
        k, (x, y) = self.curvature, np.moveaxis(places, -1, 0)
        along, across = x, y
        if k:
            s = np.sin(k * x)
            along, across = s / k - y * s, 2 * np.sin(k * x / 2) ** 2 / k + y * np.cos(k * x)
        z = self.direction * (along + 1j * across)
        return np.stack([z.real, z.imag], axis=-1)

    def place(self, point: Point) -> tuple[float, float]:
        """Axial coordinate, and distance to the left of the axis, of a ``point``."""
        k, z = self.curvature, (complex(*point) - complex(*self.start)) * self.direction.conjugate()
        if not k:
            return z.real, z.imag
        radius = abs(1 + 1j * k * z)
        return atan2(k * z.real, 1 - k * z.imag) / k, (2 * z.imag - k * abs(z) ** 2) / (1 + radius)
