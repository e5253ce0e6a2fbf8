"""Statement of a beam: its section, its undeformed axis and its division into elements."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from tsm.elements import ELEMENTS, MIXED

Point = tuple[float, float]

LARGEST = 1e50
"""Largest coordinate, length, force and moment: squares, products and quotients of such numbers stay in floating-point range."""
MOST = 1_000_000
"""Elements of a structure at most."""


def check(ok: bool, owner: str, field: str, value: object, rule: str) -> None:
    """Raise ValueError with the field, its value and the rule unless `ok`."""
    if not ok:
        raise ValueError(f"{owner}.{field} = {value!r}: {rule}")


def finite(*values: float) -> bool:
    """Whether all values are numbers of at most `LARGEST`."""
    return all(abs(value) <= LARGEST for value in values)


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
        for field in ("EA", "GA", "EI"):
            value = getattr(self, field)
            check(0 < value < math.inf, "Section", field, value, "must be positive and finite")

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
    """A straight, initially stress-free beam divided into elements, equal ones unless `nodes` says where.

    Parameters
    ----------
    name : str
        Unique name.
    start, end : tuple of float
        End points of the axis [length]; the beam's direction is start to end.
    section : Section
        Stiffnesses.
    elements : int
        Number of elements.
    element : str
        Element type, a key of `tsm.ELEMENTS`.
    nodes : tuple of float
        Where the elements meet, as parts of the length: one value less than elements; equal elements if empty.
    """

    name: str
    start: Point
    end: Point
    section: Section
    elements: int = 20
    element: str = MIXED.name
    nodes: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        owner = f"Beam({self.name})"
        for field in ("start", "end"):
            value = getattr(self, field)
            check(
                len(value) == 2 and finite(*value),
                owner,
                field,
                value,
                f"must be two finite numbers, of at most {LARGEST:g}",
            )
        check(
            1 / LARGEST <= self.length <= LARGEST,
            owner, "end", self.end, f"must differ from start, by {1 / LARGEST:g} to {LARGEST:g}",
        )  # fmt: skip
        check(
            isinstance(self.elements, int) and 1 <= self.elements <= MOST,
            owner,
            "elements",
            self.elements,
            f"must be a whole number from 1 to {MOST}",
        )
        check(
            self.element in ELEMENTS, owner, "element", self.element, f"must be one of {', '.join(ELEMENTS)}"
        )
        ends = (0.0, *self.nodes, 1.0)
        rising = all(a < b for a, b in pairwise(ends))
        check(rising, owner, "nodes", self.nodes, "must rise between 0 and 1")
        fits = not self.nodes or len(self.nodes) == self.elements - 1
        check(fits, owner, "nodes", self.nodes, f"must be one less than elements = {self.elements}")

    @property
    def parts(self) -> tuple[float, ...]:
        """Ends of the elements from 0 to 1, as parts of the length."""
        equal = (k / self.elements for k in range(1, self.elements))
        return (0.0, *(self.nodes or equal), 1.0)

    @property
    def length(self) -> float:
        """Length of the undeformed axis."""
        return math.dist(self.start, self.end)
