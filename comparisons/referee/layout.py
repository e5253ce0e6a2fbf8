"""A scene with a set of closed contacts as rods between stations, and the numbering of the unknowns.

Stations are the contacts, the ends of the beams, and the places inside a beam where a force acts or a load begins or ends. Joined ends
are one station; an end behind a hinge is a station of its own with the place of the joint. A part is a rod between neighbouring stations
of a beam; its force is ``n = c - W(s)`` with an unknown constant c. Lengths are in units of the longest beam and forces in units of
``EI/L^2`` with the largest EI, so that all quantities are dimensionless.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.faces import face_slope, touching_distance
from comparisons.referee.friction import Grip
from comparisons.referee.joints import inner_stations, joints, relative, rod_of, units_of
from comparisons.referee.rods import Rod
from comparisons.referee.stations import NONE, Hinge, Position, Station
from comparisons.scene import ContactSpec, Scene

Array = NDArray[np.float64]

_FREE: Mapping[str, Grip] = MappingProxyType({})


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A closed contact between a touching point x and the axis point ``r = x - offset(s) nu(phi)``.

    nu is the left normal of the direction phi. With an offset the angle phi is an unknown; since the energy is stationary in phi,
    the contact force acts along nu. With friction phi is the direction of the face by a row of its own.

    Stationarity in s, ``nu . (r'_- + r'_+)/2 = -offset'``, makes nu normal to the face, see `comparisons.referee.faces`.

    Attributes
    ----------
    spec : ContactSpec
        The pair in the scene.
    place : Position
        Position of the touching point.
    offset, slope : float
        Distance of x from the axis at the start of the beam, positive on the left of the beam, and its derivative by the arc position.
    arc, angle : int
        Indices of the unknown arc position and of phi (`NONE` without offset).
    grip : Grip or None
        How friction holds the contact; None without friction.
    roll : float
        Radius of a round pin, positive on the right of the beam.
    """

    spec: ContactSpec
    place: Position
    offset: float
    arc: int
    angle: int
    grip: Grip | None = None
    roll: float = 0.0
    slope: float = 0.0

    def away(self, s: Any) -> Any:
        """Offset at an arc position, real or complex."""
        return self.offset + self.slope * s

    def lever(self, s: Any) -> Any:
        """Distance of the face from the axis at an arc position, positive on the right of the beam; real or complex."""
        return -(self.away(s) if self.slope else self.offset) - self.roll

    @property
    def right(self) -> float:
        """1 for a node on the right of the beam, -1 on its left."""
        return -1.0 if self.spec.side == "left" else 1.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Part:
    """A rod between two stations of a beam.

    Attributes
    ----------
    beam : int
        Index of the beam.
    first, last : int
        Indices of the stations at the start and the end.
    force : int
        Index of the first of the two unknown components of c, along the chord of the undeformed beam and to its left.
    rod : Rod
        Axis, stiffnesses and load of the beam.
    axes : ndarray, shape (2, 2)
        Unit vectors along the chord of the undeformed beam and to its left, as columns.
    piece : int
        Index of the piece of the load on the part.
    """

    beam: int
    first: int
    last: int
    force: int
    rod: Rod
    axes: Array
    piece: int = 0

    def local(self, c: Any, s: Any) -> Any:
        """Force at an arc position in the frame of the undeformed tangent."""
        return self.rod.local(self.piece, c, s)


@dataclass(frozen=True, kw_only=True, eq=False)
class Layout:
    """Stations, contacts and parts of a scene at a load parameter.

    Attributes
    ----------
    scene : Scene
        The scene in the user's units.
    load_parameter : float
        Load parameter of supports, loads and pins.
    length, force : float
        Units of length and force.
    stations, touches, parts, hinges : tuple
        Stations, closed contacts, parts and hinges of the scene; the parts of a beam are consecutive and in order.
    unknowns : int
        Number of unknowns without the rotations inside the parts.
    """

    scene: Scene
    load_parameter: float
    length: float
    force: float
    stations: tuple[Station, ...]
    touches: tuple[Touch, ...]
    parts: tuple[Part, ...]
    hinges: tuple[Hinge, ...]
    unknowns: int

    def arc(self, z: Array, station: int, part: Part) -> float:
        """Arc position of a part's station."""
        there = self.stations[station]
        if there.touch != NONE:
            return float(z[self.touches[there.touch].arc])
        if there.arc is not None:
            return there.arc
        beam = self.scene.beams[part.beam]
        return 0.0 if f"{beam.name}.start" in there.ends else beam.length / self.length

    @cached_property
    def uniform(self) -> bool:
        """Whether all beams are straight, of one section, and without a load along them."""
        return all(part.rod.uniform for part in self.parts)

    @cached_property
    def sprung(self) -> bool:
        """Whether a joint has a spring to the ground."""
        return any(any(station.springs) for station in self.stations)

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

    def beside(self, touch: Touch) -> tuple[Part, Part]:
        """Return the parts before and behind a contact."""
        number = next(
            k
            for k, item in enumerate(self.stations)
            if item.touch != NONE and self.touches[item.touch] is touch
        )
        before = next(part for part in self.parts if part.last == number)
        behind = next(part for part in self.parts if part.first == number)
        return before, behind

    def ends(self, z: Array, part: Part) -> tuple[float, float]:
        """Arc positions at the start and the end of a part."""
        return self.arc(z, part.first, part), self.arc(z, part.last, part)

    def extent(self, z: Array, part: Part) -> float:
        """Undeformed length of a part."""
        return self.arc(z, part.last, part) - self.arc(z, part.first, part)

    def position(self, z: Array, station: int) -> Array:
        """Position of the axis at a station."""
        there = self.stations[station]
        place = there.place.position(z)
        if there.touch == NONE:
            return place
        touch = self.touches[there.touch]
        if touch.angle == NONE:
            return place
        return np.asarray(place - touch.away(float(z[touch.arc])) * normal(float(z[touch.angle])))

    def rotation(self, z: Array, station: int) -> float:
        """Rotation at a station."""
        there = self.stations[station]
        return (
            there.prescribed_rotation if there.rotation_unknown == NONE else float(z[there.rotation_unknown])
        )


def normal(angle: float) -> Array:
    """Left normal of a direction."""
    return np.array([-math.sin(angle), math.cos(angle)])


def lay_out(
    scene: Scene, load_parameter: float, closed: dict[str, float], grips: Mapping[str, Grip] = _FREE
) -> Layout:
    """Return the layout of `scene`.

    `closed` are the arc positions of the closed pairs, which order them along the beams, and `grips` say how friction holds them; pairs
    without a grip have no friction.
    """
    units = length, force = units_of(scene)
    rods = [rod_of(scene, beam, load_parameter, units) for beam in scene.beams]
    stations, hinges = joints(scene, load_parameter, units, rods)
    count = 1 + max(
        (k for item in stations for k in (*item.place.unknown, item.rotation_unknown)), default=NONE
    )
    touches: list[Touch] = []
    at = {end: number for number, station in enumerate(stations) for end in station.joint}
    on_beam: dict[str, list[tuple[float, int]]] = {beam.name: [] for beam in scene.beams}
    for spec in scene.contacts:
        if spec.pair not in closed:
            continue
        if "." in spec.node:
            place = stations[at[spec.node]].place
        else:
            x, y = scene.pin(spec.node).position(load_parameter)
            place = Position(reference=relative(scene, (x, y), length))
        left = 1.0 if spec.side == "left" else -1.0
        offset = touching_distance(scene, spec, 0.0) / length * left
        roll = -scene.radius(spec) / length * left
        turn, arc, count = count, count + 1, count + 2
        angle, count = (count, count + 1) if offset else (NONE, count)
        on_beam[spec.beam].append((closed[spec.pair], len(stations)))
        stations.append(Station(place=place, rotation_unknown=turn, touch=len(touches)))
        touches.append(
            Touch(
                spec=spec,
                place=place,
                offset=offset,
                arc=arc,
                angle=angle,
                grip=grips.get(spec.pair),
                roll=roll,
                slope=left * face_slope(scene, spec),
            )
        )
    for beam, rod in zip(scene.beams, rods, strict=True):
        for station in inner_stations(scene, beam, rod, load_parameter, units, count):
            assert station.arc is not None, "a place inside a beam has an arc position"
            on_beam[beam.name].append((station.arc * length, len(stations)))
            stations.append(station)
            count += 3
    ends = {end: number for number, station in enumerate(stations) for end in station.ends}
    parts: list[Part] = []
    for number, (beam, rod) in enumerate(zip(scene.beams, rods, strict=True)):
        chain = [
            ends[f"{beam.name}.start"],
            *(k for _, k in sorted(on_beam[beam.name])),
            ends[f"{beam.name}.end"],
        ]
        piece = 0
        for first, last in pairwise(chain):
            piece += stations[first].arc is not None
            parts.append(
                Part(beam=number, first=first, last=last, force=count, rod=rod, axes=rod.axes, piece=piece)
            )
            count += 2
    return Layout(
        scene=scene,
        load_parameter=load_parameter,
        length=length,
        force=force,
        stations=tuple(stations),
        touches=tuple(touches),
        parts=tuple(parts),
        hinges=tuple(hinges),
        unknowns=count,
    )
