"""The record of a beam: its axis, section, material and meshes."""

import math

from comparisons.scene import rules
from comparisons.scene.record import Record, key, one_of, optional, refused
from comparisons.scene.rules import LARGEST, RANGE, TURN, FieldError, Mistakes, Point

Dimension = float | tuple[float, float]


class BeamSpec(Record):
    """A beam, straight and uniform unless it turns or tapers.

    The section is a rectangle `width` x `height` (effective shear area 5/6 of the area), or `area` and `second_moment`
    (effective shear area equal to the area); `shear_area` overrides the effective shear area. The material is isotropic:
    Young's modulus and either Poisson's ratio or the shear modulus, ``G = E/(2 (1 + nu))``.
    """

    name: str = key(rules.name, "Letters, digits, ``-`` and ``_``.")
    start: Point = key(rules.point, "The ends of the undeformed axis [length].")
    end: Point = key(rules.point, "The ends of the undeformed axis [length].")
    youngs_modulus: float = key(rules.positive, "Young's modulus [force/length^2].")
    poissons_ratio: float | None = optional(rules.poissons_ratio, "Poisson's ratio.")
    shear_modulus: float | None = optional(
        rules.positive, "Shear modulus, instead of `poissons_ratio` [force/length^2]."
    )
    turn: float = optional(
        rules.turn,
        "Natural curvature: the angle by which the undeformed axis turns left, an arc of a circle [rad].",
        0.0,
    )
    width: Dimension | None = optional(
        rules.dimension, "Width of the section, out of plane; two numbers where it tapers linearly [length]."
    )
    height: Dimension | None = optional(
        rules.dimension, "Height of the section, in plane; a number or two like `width` [length]."
    )
    area: float | None = optional(
        rules.positive, "Area, with `second_moment` instead of `width` and `height` [length^2]."
    )
    second_moment: float | None = optional(rules.positive, "Second moment of area, with `area` [length^4].")
    shear_area: float | None = optional(rules.positive, "Effective shear area [length^2].")
    density: float | None = optional(
        rules.positive, "Mass per undeformed volume, weighs by the `gravity` of ``[scene]`` [mass/length^3]."
    )
    clamped: tuple[str, ...] = optional(
        rules.subset("start", "end"), "Clamped ends, none by default: the short form of a `SupportSpec`.", ()
    )
    elements: int | None = optional(
        rules.whole_number, "Number of equal TSM elements; without one, one exact element or twenty others."
    )
    nodes: tuple[float, ...] = optional(
        rules.parts, "Positions of the inner TSM nodes as parts of the length, instead of `elements`.", ()
    )
    mesh: tuple[int, int] = optional(rules.mesh, "Elements of the solid along and across.", (50, 2))
    solid_clamp: str = optional(
        rules.choice("rod", "full"), "Clamp of the solid: free to contract, or the whole edge held.", "rod"
    )
    solid_mesh_file: str | None = optional(
        rules.text,
        "File with a mesh of the solid, instead of `mesh`: `fem_reference.solid.mesh_file.read_mesh`.",
    )
    solid_element: str = optional(rules.choice("Q1", "Q2", "Q2-full"), "Elements of the solid.", "Q2")
    material: str = optional(
        rules.choice("st-venant-kirchhoff", "biot-linear", "neo-hookean"),
        "Material law of the solid.",
        "st-venant-kirchhoff",
    )

    def _has_length(self) -> Mistakes:
        shortest = 1.0 / LARGEST
        if not shortest <= self.length <= LARGEST:
            rule = f"must differ from start, the distance {self.length:g} must lie between {shortest:g} and {LARGEST:g}"
            yield FieldError("end", self.end, rule)

    def _has_stiffness(self) -> Mistakes:
        least, most = RANGE
        stiffnesses = zip(("EA", "GA", "EI") * 2, (*self.stiffness(0.0), *self.stiffness(1.0)), strict=True)
        for name, stiffness in stiffnesses:
            if not least <= stiffness <= most:
                rule = f"{name} = {stiffness:g} must lie between {least:g} and {most:g}"
                yield FieldError("youngs_modulus", self.youngs_modulus, rule)
                return

    obeys = (
        one_of(("poissons_ratio",), ("shear_modulus",)),
        one_of(("width", "height"), ("area", "second_moment")),
        _has_length,
        refused(
            "shear_area", "must not be given where the section tapers", lambda b: b.tapers and b.shear_area
        ),
        _has_stiffness,
    )

    @property
    def divisions(self) -> int:
        """Number of elements of a mesh: those between `nodes`, `elements`, or twenty."""
        return len(self.nodes) + 1 if self.nodes else self.elements or 20

    @property
    def length(self) -> float:
        """Length of the undeformed axis; of an arc, ``(turn/2)/sin(turn/2)`` of the distance of its ends."""
        chord, half = math.dist(self.start, self.end), self.turn / 2.0
        return chord * (half / math.sin(half)) if half else chord

    @property
    def curvature(self) -> float:
        """Natural curvature, positive to the left [1/length]."""
        return self.turn / self.length

    @property
    def direction(self) -> Point:
        """Unit vector from start to end."""
        (x0, y0), (x1, y1) = self.start, self.end
        chord = math.dist(self.start, self.end)
        return (x1 - x0) / chord, (y1 - y0) / chord

    def tangent(self, fraction: float) -> Point:
        """Return the unit tangent of the undeformed axis at a fraction of the length."""
        return _turned(self.direction, self.turn * (fraction - 0.5)) if self.turn else self.direction

    def place(self, fraction: float) -> Point:
        """Return the point of the undeformed axis at a fraction of the length."""
        (x0, y0), (x1, y1) = self.start, self.end
        if not self.turn or fraction in (0.0, 1.0):
            return (1.0 - fraction) * x0 + fraction * x1, (1.0 - fraction) * y0 + fraction * y1
        half = self.turn * fraction / 2.0
        tx, ty = _turned(self.direction, half - self.turn / 2.0)
        chord = fraction * self.length * (math.sin(half) / half if half else 1.0)
        return x0 + chord * tx, y0 + chord * ty

    def projected(self, point: Point) -> Point:
        """Return the distance of a point to the left of the undeformed axis, and its projection over the length."""
        (tx, ty), (x0, y0) = self.tangent(0.0), self.start
        dx, dy = point[0] - x0, point[1] - y0
        along, left = tx * dx + ty * dy, tx * dy - ty * dx
        if not self.turn:
            return left, along / self.length
        k = self.curvature
        far = math.hypot(k * along, k * left - 1.0)
        turned = math.remainder(math.atan2(k * along, 1.0 - k * left) - self.turn / 2.0, TURN)
        return (2.0 * left - k * (along * along + left * left)) / (1.0 + far), turned / self.turn + 0.5

    @property
    def tapers(self) -> bool:
        """Whether the section changes along the beam."""
        return isinstance(self.width, tuple) or isinstance(self.height, tuple)

    @property
    def EA(self) -> float:
        """Stretching stiffness [force]; the middle section's where the beam tapers."""
        return self.stiffness()[0]

    @property
    def GA(self) -> float:
        """Shear stiffness G A_e [force]; the middle section's where the beam tapers."""
        return self.stiffness()[1]

    @property
    def EI(self) -> float:
        """Bending stiffness [force length^2]; the middle section's where the beam tapers."""
        return self.stiffness()[2]

    def stiffness(self, fraction: float = 0.5) -> tuple[float, float, float]:
        """Return EA, GA and EI at a fraction of the length."""
        G = self.shear_modulus or self.youngs_modulus / (2.0 * (1.0 + (self.poissons_ratio or 0.0)))
        area, inertia, sheared = self.section(fraction)
        return self.youngs_modulus * area, G * sheared, self.youngs_modulus * inertia

    def section(self, fraction: float = 0.5) -> tuple[float, float, float]:
        """Return area, second moment of area and effective shear area at a fraction of the length."""
        width, height = _between(self.width, fraction), self.height_at(fraction)
        if width and height:
            A, inertia, kappa = width * height, width * height**3 / 12.0, 5.0 / 6.0
        else:
            A, inertia, kappa = self.area or 0.0, self.second_moment or 0.0, 1.0
        return A, inertia, self.shear_area or kappa * A

    def height_at(self, fraction: float) -> float:
        """Return the height of the section at a fraction of the length, zero where the section has none."""
        return _between(self.height, fraction)

    @property
    def rectangle_height(self) -> float:
        """Largest height of the section, or ``sqrt(12 I/A)`` of the rectangle with its area and second moment."""
        area, inertia, _ = self.section()
        return max(self.height_at(0.0), self.height_at(1.0)) or math.sqrt(12.0 * inertia / area)

    def mass_per_length(self, fraction: float) -> float:
        """Return the mass per undeformed length at a fraction of the length, zero without `density`."""
        return (self.density or 0.0) * self.section(fraction)[0]

    @property
    def mass(self) -> float:
        """Mass, zero without `density`."""
        return self.length * sum(value / k for k, value in enumerate(self.mass_coefficients(), 1))

    def mass_coefficients(self) -> tuple[float, ...]:
        """Return the coefficients of the mass per length as a polynomial in the fraction of the length, the constant one first."""
        start, middle, end = map(self.mass_per_length, (0.0, 0.5, 1.0))
        if not self.tapers:
            return (middle,)
        return start, -3 * start + 4 * middle - end, 2 * start - 4 * middle + 2 * end


def _between(dimension: Dimension | None, fraction: float) -> float:
    """Return a dimension at a fraction of the length, zero where there is none."""
    a, b = dimension if isinstance(dimension, tuple) else (dimension or 0.0,) * 2
    return a + fraction * (b - a) if fraction < 0.5 else b - (1.0 - fraction) * (b - a)


def _turned(vector: Point, angle: float) -> Point:
    (x, y), c, s = vector, math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y
