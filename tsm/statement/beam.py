"""Statement of a beam: its section, its undeformed axis, its division into elements, and the loads along it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Literal

from tsm.elements import ELEMENTS, MIXED

Point = tuple[float, float]
End = Literal["start", "end"]

LARGEST = 1e50
"""Largest coordinate, length, force and moment: squares, products and quotients of such numbers stay in floating-point range."""
MOST_STAGES = 10_000
"""Largest number of stages."""
MOST = 1_000_000
"""Elements of a structure at most."""
_ALIKE = 1e-12
"""Largest relative difference of two lengths or ratios that are one."""


def check(ok: bool, owner: str, field: str, value: object, rule: str) -> None:
    """Raise ValueError with the field, its value and the rule unless `ok`."""
    if not ok:
        raise ValueError(f"{owner}.{field} = {value!r}: {rule}")


def checks(owner: str, record: Any) -> Callable[[str, bool, str], None]:
    """`check` for the fields of a record."""
    return lambda field, ok, rule: check(ok, owner, field, getattr(record, field), rule)


def finite(*values: float) -> bool:
    """Whether all values are numbers of at most `LARGEST`."""
    return all(abs(value) <= LARGEST for value in values)


def is_point(value: Point) -> bool:
    """Whether a value is two finite numbers."""
    return len(value) == 2 and finite(*value)


ENDS = ("start", "end")
END, FINITE = 'must be "start" or "end"', f"finite, of at most {LARGEST:g}"
"""Rules."""
POINT, STAGE = f"must be two finite numbers, of at most {LARGEST:g}", f"must lie between 0 and {MOST_STAGES}"


@dataclass(frozen=True, kw_only=True)
class Section:
    """Stiffnesses of a cross-section.

    Parameters
    ----------
    EA : float
        Axial stiffness [force].
    GA : float
        Shear stiffness ``G A_e`` with the effective area ``A_e = kappa A`` [force].
    EI : float
        Bending stiffness [force length^2].

    Raises
    ------
    ValueError
        If a stiffness is not positive and finite.
    """

    EA: float
    GA: float
    EI: float

    def __post_init__(self) -> None:
        check = checks("Section", self)
        for field in ("EA", "GA", "EI"):
            check(field, 0 < getattr(self, field) < math.inf, "must be positive and finite")

    @classmethod
    def rectangle(
        cls, *, width: float, height: float, youngs_modulus: float, shear_modulus: float
    ) -> Section:
        """Solid rectangle ``width x height``, bent in the plane of its height, ``A_e = 5/6 A``.

        >>> Section.rectangle(width=0.02, height=0.02, youngs_modulus=2.1e4, shear_modulus=8e3).EA
        8.4
        """
        area = width * height
        return cls(
            EA=youngs_modulus * area,
            GA=shear_modulus * area * 5 / 6,
            EI=youngs_modulus * width * height * height * height / 12,
        )


@dataclass(frozen=True, kw_only=True)
class Beam:
    """An initially stress-free beam divided into elements, equal ones unless `nodes` says where.

    Parameters
    ----------
    name : str
        Unique name.
    start, end : tuple of float
        End points of the axis [length]; the beam's direction is start to end.
    section : Section
        Stiffnesses, of a tapered beam those at the start.
    elements : int
        Number of elements.
    element : str
        Element type, a key of `tsm.ELEMENTS`.
    nodes : tuple of float
        Where the elements meet, as parts of the length: one value less than elements; equal elements if empty.
    turn : float
        Angle by which the undeformed axis turns to the left from start to end [rad]. The axis is an arc of a circle, a straight line for 0.
    end_section : Section or None
        Stiffnesses at the end of a tapered beam. Height and width, which are proportional to ``sqrt(EI/EA)`` and ``EA/sqrt(EI/EA)``, vary
        linearly in the arc length, and GA is proportional to EA. None for a uniform beam.
    """

    name: str
    start: Point
    end: Point
    section: Section
    elements: int = 20
    element: str = MIXED.name
    nodes: tuple[float, ...] = ()
    turn: float = 0.0
    end_section: Section | None = None

    def __post_init__(self) -> None:
        check = checks(f"Beam({self.name})", self)
        check("turn", abs(self.turn) < math.tau, "must lie between -2 pi and 2 pi, without them")
        if self.end_section is not None:
            start, end = (section.GA / section.EA for section in (self.section, self.end_section))
            check("end_section", abs(start - end) <= _ALIKE * start, "must have the GA/EA of section")
        for field in ("start", "end"):
            check(field, is_point(getattr(self, field)), POINT)
        apart = f"must differ from start, by {1 / LARGEST:g} to {LARGEST:g}"
        check("end", 1 / LARGEST <= self.length <= LARGEST, apart)
        whole = isinstance(self.elements, int) and 1 <= self.elements <= MOST
        check("elements", whole, f"must be a whole number from 1 to {MOST}")
        check("element", self.element in ELEMENTS, f"must be one of {', '.join(ELEMENTS)}")
        rising = all(a < b for a, b in pairwise((0.0, *self.nodes, 1.0)))
        check("nodes", rising, "must rise between 0 and 1")
        fits = not self.nodes or len(self.nodes) == self.elements - 1
        check("nodes", fits, f"must be one less than elements = {self.elements}")

    @property
    def parts(self) -> tuple[float, ...]:
        """Ends of the elements from 0 to 1, as parts of the length."""
        equal = (k / self.elements for k in range(1, self.elements))
        return (0.0, *(self.nodes or equal), 1.0)

    @property
    def length(self) -> float:
        """Length of the undeformed axis."""
        chord, half = math.dist(self.start, self.end), self.turn / 2
        return chord * (half / math.sin(half)) if half else chord

    @property
    def curvature(self) -> float:
        """Natural curvature, positive where the axis turns to the left."""
        return self.turn / self.length

    @property
    def varies(self) -> bool:
        """Whether the beam is curved or tapered."""
        return self.turn != 0 or self.end_section is not None

    def direction(self, part: float) -> float:
        """Angle of the undeformed axis from the x axis, at a part of the length.

        >>> section = Section(EA=1, GA=1, EI=1)
        >>> arc = Beam(name="arc", start=(1.0, 0.0), end=(0.0, 1.0), section=section, turn=math.pi / 2)
        >>> round(arc.direction(0.5) / math.pi, 12)
        0.75
        """
        chord = math.atan2(self.end[1] - self.start[1], self.end[0] - self.start[0])
        return chord + (part - 0.5) * self.turn

    def point(self, part: float) -> Point:
        """Point of the undeformed axis at a part of the length.

        >>> section = Section(EA=1, GA=1, EI=1)
        >>> arc = Beam(name="arc", start=(1.0, 0.0), end=(0.0, 1.0), section=section, turn=math.pi / 2)
        >>> [round(x, 12) for x in arc.point(0.5)]
        [0.707106781187, 0.707106781187]
        """
        if not self.turn or part in {0.0, 1.0}:
            x, y = ((1 - part) * a + part * b for a, b in zip(self.start, self.end, strict=True))
            return x, y
        half = part * self.turn / 2
        chord, angle = self.length * part * math.sin(half) / half, self.direction(part / 2)
        return self.start[0] + chord * math.cos(angle), self.start[1] + chord * math.sin(angle)

    def node(self, arc: float) -> int | None:
        """Number of the node at an arc position, None where there is none.

        >>> section = Section(EA=1, GA=1, EI=1)
        >>> Beam(name="b", start=(0, 0), end=(4, 0), section=section, elements=2).node(2.0)
        1
        """
        apart = [abs(part - arc / self.length) for part in self.parts]
        nearest = min(range(len(apart)), key=apart.__getitem__)
        return nearest if apart[nearest] <= _ALIKE else None

    def divided(self, *arcs: float) -> Beam:
        """Beam with further nodes at arc positions [length].

        >>> section = Section(EA=1, GA=1, EI=1)
        >>> Beam(name="b", start=(0, 0), end=(4, 0), section=section, elements=2).divided(1.0, 2.0).parts
        (0.0, 0.25, 0.5, 1.0)
        """
        new = {arc / self.length for arc in arcs if self.node(arc) is None}
        parts = sorted({*self.parts, *new})
        if not new:
            return self
        return replace(self, elements=len(parts) - 1, nodes=tuple(parts[1:-1]))


@dataclass(frozen=True, kw_only=True)
class LineLoad:
    """Dead force per undeformed length along a beam or a part of it, applied in one stage; it keeps its direction.

    Parameters
    ----------
    beam : str
        Name of the beam.
    force : tuple of tuple of float
        Force per length (x, y) [force/length]: the coefficients of a polynomial in the arc position over the beam's length, the constant
        one first. The weight of a tapered beam has three.
    start, end : float
        Arc positions between which the load acts [length], nodes of the beam; by default the whole beam.
    stage : int
        Number of the stage, from 0, in which the load grows with the load parameter; it stays after the stage.
    """

    beam: str
    force: tuple[Point, ...]
    start: float = 0.0
    end: float = math.inf
    stage: int = 0

    def __post_init__(self) -> None:
        check = checks(f"LineLoad({self.beam})", self)
        check("stage", 0 <= self.stage <= MOST_STAGES, STAGE)
        pairs = len(self.force) > 0 and all(map(is_point, self.force))
        check("force", pairs, f"must hold pairs of finite numbers, of at most {LARGEST:g}")
        check("start", 0 <= self.start < self.end, "must lie between 0 and end")

    def elements(self, beam: Beam) -> range:
        """Elements of its beam on which the load acts, counted from 0."""
        first, last = beam.node(self.start), beam.node(min(self.end, beam.length))
        assert first is not None, "the load begins at a node"
        assert last is not None, "the load ends at a node"
        return range(first, last)

    def check(self, beam: Beam) -> None:
        """Raise ValueError unless the load lies on its beam and begins and ends at nodes."""
        owner, longest = f"LineLoad({self.beam})", beam.length * (1 + _ALIKE)
        inside = self.end <= longest or self.end == math.inf
        check(inside, owner, "end", self.end, f"must be at most the length {beam.length:g}")
        for field, arc in (("start", self.start), ("end", min(self.end, beam.length))):
            at_node = beam.node(arc) is not None
            check(at_node, owner, field, arc, "must be a node of the beam, see Beam.divided")
