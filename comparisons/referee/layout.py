"""The rods of a scene between stations, with the numbers of the unknowns.

Stations are the contacts, the ends of the beams, and the places inside a beam where a force acts or a load begins or ends. Joined ends
are one station; an end behind a hinge is a station of its own with the place of the joint. A part is a rod between neighbouring stations
of a beam; its force is ``n = c - W(s)`` with an unknown constant c. Lengths are in units of the longest beam and forces in units of
``EI/L^2`` with the largest EI, so that all quantities are dimensionless. The number of a prescribed quantity is `NONE`, the place of a
zero that is appended to the unknowns.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.grip import Grip
from comparisons.referee.rod import Rod
from comparisons.scene import ContactSpec, Scene

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

NONE = -1
"""Number of a quantity that is prescribed and not unknown."""


@dataclass(frozen=True, kw_only=True)
class Position:
    """A position: a reference, which may be far larger than the displacement, and a displacement, prescribed or unknown by component."""

    reference: tuple[float, float]
    prescribed: tuple[float, float] = (0.0, 0.0)
    unknown: tuple[int, int] = (NONE, NONE)

    def displacement(self, z: Array) -> Array:
        """Return the displacement."""
        return np.array(
            [z[k] if k != NONE else g for g, k in zip(self.prescribed, self.unknown, strict=True)]
        )

    def position(self, z: Array) -> Array:
        """Return the position."""
        return np.array(self.reference) + self.displacement(z)


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A closed contact between a touching point x and the axis point ``r = x - offset(s) nu(phi)``.

    nu is the left normal of the direction phi. With an offset the angle phi is an unknown; since the energy is stationary in phi, the
    contact force acts along nu. Stationarity in s, ``nu . (r'_- + r'_+)/2 = -offset'``, makes nu normal to the face. With friction phi is
    the direction of the face by a row of its own.
    """

    spec: ContactSpec
    arc: int
    """Number of the arc position."""
    angle: int
    """Number of phi; `NONE` without offset."""
    offset: float
    """Distance of x from the axis at the start of the beam, positive on the left of the beam."""
    slope: float
    """Derivative of the offset by the arc position."""
    roll: float
    """Radius of a round pin, positive on the right of the beam."""
    grip: Grip | None
    """How friction holds the contact; None without friction."""

    def away(self, s: Any) -> Any:
        """Offset at an arc position, real or complex."""
        return self.offset + self.slope * s

    def lever(self, s: Any) -> Any:
        """Distance of the face from the axis at an arc position, positive on the right of the beam; real or complex."""
        return -self.away(s) - self.roll

    @property
    def right(self) -> float:
        """1 for a node on the right of the beam, -1 on its left."""
        return -1.0 if self.spec.side == "left" else 1.0


@dataclass(frozen=True, kw_only=True)
class Station:
    """An end of a beam, a joint, a contact, or a place inside a beam, with the dead load there.

    At the end of a beam the force includes the resultant of the load along the beam, since the part has c = n + W there.
    """

    place: Position
    """Position of the axis; of a contact, that of the touching point."""
    rotation_unknown: int
    prescribed_rotation: float = 0.0
    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0
    touch: Touch | None = None
    ends: tuple[str, ...] = ()
    """Ends of beams that are rigidly attached."""
    joint: tuple[str, ...] = ()
    """Ends of all beams at a joint, with those behind a hinge; empty for other stations."""
    springs: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Stiffnesses against displacement and rotation."""
    arc: float | None = None
    """Arc position of a place inside a beam."""

    def rotation(self, z: Array) -> float:
        """Return the rotation."""
        return self.prescribed_rotation if self.rotation_unknown == NONE else float(z[self.rotation_unknown])

    @property
    def unknown(self) -> tuple[int, int, int]:
        """Numbers of the displacement and the rotation."""
        return (*self.place.unknown, self.rotation_unknown)


@dataclass(frozen=True, kw_only=True)
class Hinge:
    """A hinge between the stations `end`, of the beam's end, and `joint`, with a rotational spring."""

    end: int
    joint: int
    stiffness: float


@dataclass(frozen=True, eq=False)
class Part:
    """A rod between two stations of a beam."""

    beam: int
    first: int
    last: int
    arcs: tuple[int, int]
    """Numbers of the arc positions of both stations."""
    fixed: tuple[float, float]
    """Arc positions that are not unknown; 0 for a contact."""
    force: int
    """Number of the first of the two components of c, along the chord of the undeformed beam and to its left."""
    rod: Rod
    piece: int
    """Number of the piece of the load."""

    def ends(self, z: Array) -> tuple[float, float]:
        """Arc positions at the start and the end."""
        a, b = (g if k == NONE else float(z[k]) for g, k in zip(self.fixed, self.arcs, strict=True))
        return a, b

    def extent(self, z: Array) -> float:
        """Undeformed length."""
        a, b = self.ends(z)
        return b - a

    def constant(self, z: Array) -> Array:
        """Return c (2,)."""
        return z[self.force : self.force + 2]


@dataclass(frozen=True, kw_only=True, eq=False)
class Layout:
    """Stations, parts and hinges of a scene at a load parameter; the parts of a beam are consecutive and in order."""

    scene: Scene
    load_parameter: float
    length: float
    force: float
    stations: tuple[Station, ...]
    parts: tuple[Part, ...]
    hinges: tuple[Hinge, ...]
    unknowns: int
    """Number of unknowns without the rotations inside the parts."""

    @cached_property
    def touches(self) -> tuple[Touch, ...]:
        """The closed contacts."""
        return tuple(item.touch for item in self.stations if item.touch is not None)

    @cached_property
    def arcs(self) -> Ints:
        """Numbers of the arc positions of the contacts."""
        return np.array([touch.arc for touch in self.touches], dtype=np.int64)

    @cached_property
    def forces(self) -> Ints:
        """Numbers (2 parts,) of the components of c."""
        return np.array([k for part in self.parts for k in (part.force, part.force + 1)], dtype=np.int64)

    @cached_property
    def uniform(self) -> bool:
        """Whether all beams are straight, of one section, and without a load along them."""
        return all(part.rod.uniform for part in self.parts)

    @property
    def rubs(self) -> bool:
        """Whether a closed contact has friction."""
        return any(touch.grip is not None for touch in self.touches)

    @property
    def grips(self) -> dict[str, Grip]:
        """How friction holds the contacts, by pair."""
        return {touch.spec.pair: touch.grip for touch in self.touches if touch.grip is not None}

    def rod(self, beam: int) -> Rod:
        """Return the rod of a beam."""
        return next(part.rod for part in self.parts if part.beam == beam)

    def touch(self, pair: str) -> Touch:
        """Return the closed contact of a pair."""
        return next(item for item in self.touches if item.spec.pair == pair)

    def joint(self, end: str) -> int:
        """Return the number of the joint to which a beam's end belongs."""
        return next(k for k, item in enumerate(self.stations) if end in item.joint)

    def beside(self, touch: Touch) -> tuple[Part, Part]:
        """Return the parts before and behind a contact."""
        before = next(part for part in self.parts if part.arcs[1] == touch.arc)
        return before, next(part for part in self.parts if part.arcs[0] == touch.arc)

    def position(self, z: Array, station: int) -> Array:
        """Position of the axis at a station."""
        there = self.stations[station]
        place, touch = there.place.position(z), there.touch
        if touch is None or touch.angle == NONE:
            return place
        return np.asarray(place - touch.away(float(z[touch.arc])) * normal(float(z[touch.angle])))

    def extents(self, z: Array) -> Array:
        """Arc positions (parts, 2) at the starts and the ends of all parts."""
        numbers, fixed = self._ends
        return np.where(numbers == NONE, fixed, z[numbers])

    @cached_property
    def _ends(self) -> tuple[Ints, Array]:
        return np.array([part.arcs for part in self.parts]), np.array([part.fixed for part in self.parts])


def normal(angle: float) -> Array:
    """Left normal of a direction."""
    return np.array([-math.sin(angle), math.cos(angle)])
