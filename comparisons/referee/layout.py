"""A scene with given closed pairs as a set of rods between stations: what is unknown, and where it stands in the vector of unknowns.

Stations are the beams' ends, one for those that are joined, and the contacts. A part is a rod between neighbouring stations of a beam;
with loads at ends only, its force ``n`` is constant. Lengths are in units of the longest beam and forces in units of
``EI/L^2`` with the largest EI, so that every quantity here has no unit.
"""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from comparisons.scene import ContactSpec, Scene

Array = NDArray[np.float64]

NONE = -1
"""Number of a quantity that is given and not unknown."""


@dataclass(frozen=True, kw_only=True)
class Place:
    """A position ``rest + moved``, where a component of the displacement is given or unknown.

    Attributes
    ----------
    rest, given : (float, float)
        Undeformed position, or that of a pin, and the given displacement; apart, since the one may be far larger than the other.
    unknown : (int, int)
        Numbers of the unknowns, `NONE` where the component is given.
    """

    rest: tuple[float, float]
    given: tuple[float, float] = (0.0, 0.0)
    unknown: tuple[int, int] = (NONE, NONE)

    def moved(self, z: Array) -> Array:
        """Return the displacement."""
        return np.array([z[k] if k != NONE else g for g, k in zip(self.given, self.unknown, strict=True)])

    def at(self, z: Array) -> Array:
        """Return the position."""
        return np.array(self.rest) + self.moved(z)


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A closed contact: the touching point x and the axis point ``r = x - side offset nu(phi)``, nu the left normal of the angle phi.

    The angle is an unknown where the offset is not zero: that the energy is stationary in it makes the force act along nu.

    Attributes
    ----------
    spec : ContactSpec
        The pair.
    place : Place
        The touching point.
    offset : float
        Distance of x from the axis, positive on the left of the beam.
    arc, angle : int
        Numbers of the unknown arc position and of phi (`NONE` without offset).
    """

    spec: ContactSpec
    place: Place
    offset: float
    arc: int
    angle: int


@dataclass(frozen=True, kw_only=True)
class Station:
    """An end of a beam, a joint or a contact.

    Attributes
    ----------
    place : Place
        Position of the axis, that of the touching point for a contact.
    turn : int
        Number of the rotation, `NONE` where it is given.
    turned : float
        The rotation where it is given.
    force, moment
        Dead load.
    touch : int
        Number of the contact, `NONE` for an end.
    ends : tuple of str
        The beams' ends that meet here.
    """

    place: Place
    turn: int
    turned: float = 0.0
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
        Number of the beam.
    first, last : int
        Numbers of its stations.
    force : int
        Number of the first of the two unknown components, along the undeformed beam and to its left.
    axes : ndarray, shape (2, 2)
        Columns: unit vectors along the undeformed beam and to its left.
    EI, stretch, shear : float
        Bending stiffness, 1/EA and 1/GA.
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
        In the user's units.
    load_parameter : float
        Of supports, loads and pins.
    length, force : float
        Units of length and force.
    stations, touches, parts : tuple
        Of the whole scene; the parts of a beam follow one another.
    unknowns : int
        Number of unknowns without those inside the parts.
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

    def extent(self, z: Array, part: Part) -> float:
        """Undeformed length of a part."""
        return self.arc(z, part.last, part) - self.arc(z, part.first, part)

    def position(self, z: Array, station: int) -> Array:
        """Position of the axis at a station."""
        there = self.stations[station]
        place = there.place.at(z)
        if there.touch == NONE:
            return place
        touch = self.touches[there.touch]
        return place if touch.angle == NONE else place - touch.offset * normal(float(z[touch.angle]))

    def turned(self, z: Array, station: int) -> float:
        """Rotation at a station."""
        there = self.stations[station]
        return there.turned if there.turn == NONE else float(z[there.turn])


def normal(angle: float) -> Array:
    """Left normal of a direction."""
    return np.array([-math.sin(angle), math.cos(angle)])


def lay_out(scene: Scene, load_parameter: float, closed: dict[str, float]) -> Layout:
    """Return the layout of `scene` with the pairs `closed`, by name, at arc positions that order them along their beams."""
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
            place = Place(rest=_relative(scene, (x, y), length))
        offset = scene.offset(spec) / length * (1.0 if spec.side == "left" else -1.0)
        turn, arc, count = count, count + 1, count + 2
        angle, count = (count, count + 1) if offset else (NONE, count)
        on_beam[spec.beam].append((closed[spec.pair], len(stations)))
        stations.append(Station(place=place, turn=turn, touch=len(touches)))
        touches.append(Touch(spec=spec, place=place, offset=offset, arc=arc, angle=angle))
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
    x, y = scene.beams[0].start
    return (point[0] - x) / length, (point[1] - y) / length


def _count(stations: list[Station]) -> int:
    return 1 + max((k for item in stations for k in (*item.place.unknown, item.turn)), default=NONE)


def _ends(scene: Scene, t: float, length: float, force: float) -> list[Station]:
    """Return the stations of the beams' ends; what is free is numbered."""
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
        given = (t * (motion[0] or 0.0) / length, t * (motion[1] or 0.0) / length)
        station = Station(
            place=Place(rest=_relative(scene, point, length), given=given, unknown=(unknown[0], unknown[1])),
            turn=unknown[2],
            turned=t * (motion[2] or 0.0),
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
