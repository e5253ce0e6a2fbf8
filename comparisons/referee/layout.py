"""A scene with a set of closed contacts as rods between stations, and the numbering of the unknowns.

Stations are the contacts and the ends of the beams; joined ends are one station. A part is a rod between neighbouring stations of
a beam. Loads act at ends only, so that the force ``n`` of a part is constant. Lengths are in units of the longest beam and forces
in units of ``EI/L^2`` with the largest EI, so that all quantities are dimensionless.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.friction import Grip
from comparisons.scene import ContactSpec, Scene

Array = NDArray[np.float64]

NONE = -1
"""Index of a quantity that is prescribed and not unknown."""
_FREE: Mapping[str, Grip] = MappingProxyType({})


@dataclass(frozen=True, kw_only=True)
class Position:
    """A position, the sum of a reference position and a displacement with prescribed or unknown components.

    Attributes
    ----------
    reference : (float, float)
        Undeformed position, or the position of a pin. It may be far larger than the displacement.
    prescribed : (float, float)
        Prescribed displacement.
    unknown : (int, int)
        Indices of the unknown displacements; `NONE` for a prescribed component.
    """

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
    """A closed contact between a touching point x and the axis point ``r = x - side offset nu(phi)``.

    nu is the left normal of the direction phi. With an offset the angle phi is an unknown; since the energy is stationary in phi,
    the contact force acts along nu. With friction phi is the direction of the mean tangent by a row of its own.

    Attributes
    ----------
    spec : ContactSpec
        The pair in the scene.
    place : Position
        Position of the touching point.
    offset : float
        Distance of x from the axis, positive on the left of the beam.
    arc, angle : int
        Indices of the unknown arc position and of phi (`NONE` without offset).
    grip : Grip or None
        How friction holds the contact; None without friction.
    lever, roll : float
        Distance of the face from the axis, and radius of a round pin; positive on the right of the beam.
    """

    spec: ContactSpec
    place: Position
    offset: float
    arc: int
    angle: int
    grip: Grip | None = None
    lever: float = 0.0
    roll: float = 0.0

    @property
    def right(self) -> float:
        """1 for a node on the right of the beam, -1 on its left."""
        return -1.0 if self.spec.side == "left" else 1.0


@dataclass(frozen=True, kw_only=True)
class Station:
    """An end of a beam, a joint or a contact.

    Attributes
    ----------
    place : Position
        Position of the axis; for a contact, position of the touching point.
    rotation_unknown : int
        Index of the unknown rotation; `NONE` if the rotation is prescribed.
    prescribed_rotation : float
        Prescribed rotation.
    force, moment
        Dead load.
    touch : int
        Index of the contact; `NONE` for an end.
    ends : tuple of str
        Ends of beams at the station.
    """

    place: Position
    rotation_unknown: int
    prescribed_rotation: float = 0.0
    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0
    touch: int = NONE
    ends: tuple[str, ...] = ()


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
        Index of the first of the two unknown force components, along the undeformed beam and to its left.
    axes : ndarray, shape (2, 2)
        Unit vectors along the undeformed beam and to its left, as columns.
    EI, stretch, shear : float
        Bending stiffness EI and flexibilities 1/EA and 1/GA.
    """

    beam: int
    first: int
    last: int
    force: int
    axes: Array
    EI: float
    stretch: float
    shear: float


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
    stations, touches, parts : tuple
        Stations, closed contacts and parts of the scene; the parts of a beam are consecutive and in order.
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
    unknowns: int

    def arc(self, z: Array, station: int, part: Part) -> float:
        """Arc position of a part's station."""
        touch = self.stations[station].touch
        if touch != NONE:
            return float(z[self.touches[touch].arc])
        beam = self.scene.beams[part.beam]
        return 0.0 if f"{beam.name}.start" in self.stations[station].ends else beam.length / self.length

    @property
    def rubs(self) -> bool:
        """Whether a closed contact has friction."""
        return any(touch.grip is not None for touch in self.touches)

    @property
    def grips(self) -> dict[str, Grip]:
        """How friction holds the contacts, by pair."""
        return {touch.spec.pair: touch.grip for touch in self.touches if touch.grip is not None}

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
        return place if touch.angle == NONE else place - touch.offset * normal(float(z[touch.angle]))

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
    length = max(beam.length for beam in scene.beams)
    force = max(beam.EI for beam in scene.beams) / length**2
    stations = _ends(scene, load_parameter, length, force)
    count = _count(stations)
    touches: list[Touch] = []
    where = {end: number for number, station in enumerate(stations) for end in station.ends}
    on_beam: dict[str, list[tuple[float, int]]] = {beam.name: [] for beam in scene.beams}
    for spec in scene.contacts:
        if spec.pair not in closed:
            continue
        if "." in spec.node:
            place = stations[where[spec.node]].place
        else:
            x, y = scene.pin(spec.node).position(load_parameter)
            place = Position(reference=_relative(scene, (x, y), length))
        left = 1.0 if spec.side == "left" else -1.0
        offset, roll = scene.offset(spec) / length * left, -scene.radius(spec) / length * left
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
                lever=-offset - roll,
                roll=roll,
            )
        )
    parts: list[Part] = []
    for number, beam in enumerate(scene.beams):
        x, y = beam.direction
        chain = [
            where[f"{beam.name}.start"],
            *(k for _, k in sorted(on_beam[beam.name])),
            where[f"{beam.name}.end"],
        ]
        for first, last in pairwise(chain):
            parts.append(
                Part(
                    beam=number,
                    first=first,
                    last=last,
                    force=count,
                    axes=np.array([[x, -y], [y, x]]),
                    EI=beam.EI / (force * length**2),
                    stretch=force / beam.EA,
                    shear=force / beam.GA,
                )
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
        unknowns=count,
    )


def _relative(scene: Scene, point: tuple[float, float], length: float) -> tuple[float, float]:
    """Return a position relative to the first beam's start, in units of length."""
    x, y = scene.beams[0].start
    return (point[0] - x) / length, (point[1] - y) / length


def _count(stations: list[Station]) -> int:
    """Number of unknowns of the stations."""
    return 1 + max(
        (k for item in stations for k in (*item.place.unknown, item.rotation_unknown)), default=NONE
    )


def _ends(scene: Scene, t: float, length: float, force: float) -> list[Station]:
    """Return the stations of the beams' ends, with indices of the free components."""
    names: dict[tuple[float, float], list[str]] = {}
    for beam in scene.beams:
        names.setdefault(beam.start, []).append(f"{beam.name}.start")
        names.setdefault(beam.end, []).append(f"{beam.name}.end")
    stations, count = [], 0
    for point, ends in names.items():
        motion: tuple[float | None, ...] = (None, None, None)
        for support in scene.all_supports:
            if support.node in ends:
                motion = support.motion
        unknown = [NONE, NONE, NONE]
        for component in range(3):
            if motion[component] is None:
                unknown[component], count = count, count + 1
        prescribed = (t * (motion[0] or 0.0) / length, t * (motion[1] or 0.0) / length)
        station = Station(
            place=Position(
                reference=_relative(scene, point, length),
                prescribed=prescribed,
                unknown=(unknown[0], unknown[1]),
            ),
            rotation_unknown=unknown[2],
            prescribed_rotation=t * (motion[2] or 0.0),
            ends=tuple(ends),
        )
        for load in scene.loads:
            if load.node in ends:
                px, py = station.force
                station = replace(
                    station,
                    force=(px + t * load.force[0] / force, py + t * load.force[1] / force),
                    moment=station.moment + t * load.moment / (force * length),
                )
        stations.append(station)
    return stations
