"""The rods of a scene between stations, with the numbers of the unknowns.

Stations are the contacts, the ends of the beams, and the places inside a beam where a force acts or a load begins or ends. Joined ends
are one station; an end behind a hinge is a station of its own with the place of the joint. A part is a rod between neighbouring stations
of a beam; its force is ``n = c - W(s)`` with an unknown constant c. Lengths are in units of the longest beam and forces in units of
``EI/L^2`` with the largest EI, so that all quantities are dimensionless. Prescribed quantities have negative numbers, their places in
`Layout.given` behind the unknowns.
"""

from collections.abc import Iterable, Mapping
from dataclasses import field
from functools import cached_property
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np

from comparisons.answer import Array, Ints
from comparisons.frozen import Frozen, Value
from comparisons.referee.grip import Grip
from comparisons.referee.rod import Face, Piece, face_of, rod_of, trimmed, units_of, value
from comparisons.scene import ContactSpec, Scene

Rod = tuple[list[float], list[Piece]]
"""Pieces of a beam behind the arc positions of their ends."""
NONE = -1
"""Number of a quantity that is zero."""
_FREE: Mapping[str, Grip] = MappingProxyType({})
_NOTHING = np.zeros(3)
_AXIS = Face(1.0, 0.0, 0.0, 0.0)


class Touch(Value):
    """A closed contact between a touching point x and the axis point ``r = x - offset(s) nu(phi)``, nu the left normal of the direction phi.

    The offset is the reach of the face on the left of the beam, and minus the reach on its right.

    The energy is stationary in phi, so that the contact force acts along nu, and in s: ``nu . (r'_- + r'_+)/2 = -offset'`` makes nu normal
    to the face. With friction phi is the direction of the face by a row of its own.
    """

    spec: ContactSpec
    station: int  #: Number of the station.
    arc: int  #: Number of the arc position.
    angle: int  #: Number of phi; `NONE` without offset.
    face: Face
    grip: Grip | None  #: How friction holds the contact; None without friction.


class Station(Frozen):
    """An end of a beam, a joint, a contact, or a place inside a beam; of a contact, the position is that of the touching point."""

    reference: Array  #: Undeformed position (2,), which may be far larger than the displacement.
    numbers: Ints  #: Numbers (3,) of the displacement and the rotation.
    #: Dead force and moment (3,); at the end of a beam with the resultant of the load along it, since the part has c = n + W there.
    load: Array = field(default_factory=lambda: np.zeros(3))
    #: Stiffnesses (3,) against displacement and rotation.
    springs: Array = field(default_factory=lambda: np.zeros(3))
    touch: Touch | None = None

    def turning(self, rotation: int, **more: Any) -> "Station":
        """Return a station at the same place with a rotation of its own."""
        return Station(reference=self.reference, numbers=np.append(self.numbers[:2], rotation), **more)


class Part(Frozen):
    """A rod between two stations of a beam."""

    beam: str
    stations: tuple[int, int]  #: Numbers of both stations.
    arcs: tuple[int, int]  #: Numbers of the arc positions of both stations.
    force: int  #: Number of the first of the two components of c.
    piece: Piece

    def constant(self, z: Array) -> Array:
        """Return c (2, 1)."""
        return z[self.force : self.force + 2, None]


class Layout(Frozen):
    """Stations, parts and hinges of a scene at a load parameter; the parts of a beam are consecutive and in order."""

    scene: Scene
    load_parameter: float
    length: float
    force: float
    stations: list[Station]
    parts: list[Part]
    joints: dict[str, int]  #: Numbers of the joints to which the beams' ends belong.
    #: Numbers of the stations of a beam's end behind a hinge and of its joint, and the stiffness of the spring in between.
    hinges: list[tuple[int, int, float]]
    given: Array  #: Prescribed quantities.
    unknowns: int  #: Number of unknowns without the rotations inside the parts.

    @cached_property
    def touches(self) -> dict[str, Touch]:
        """The closed contacts by pair."""
        return {item.touch.spec.pair: item.touch for item in self.stations if item.touch is not None}

    @cached_property
    def arcs(self) -> Ints:
        """Numbers of the arc positions of the contacts."""
        return np.array([touch.arc for touch in self.touches.values()], dtype=np.int64)

    @cached_property
    def forces(self) -> Ints:
        """Numbers (2 parts,) of the components of c."""
        return np.arange(self.parts[0].force, self.unknowns)

    @cached_property
    def moving(self) -> Ints:
        """Numbers of the displacements and arc positions."""
        moved = self.tables[0][:, :2]
        return np.append(moved[moved >= 0], self.arcs)

    @cached_property
    def tables(self) -> tuple[Ints, Array, Array]:
        """Numbers and loads (stations, 3) of the stations, and stiffness (3 stations, 3 stations) of springs and hinges."""
        numbers, loads, springs = (
            np.array([getattr(item, name) for item in self.stations])
            for name in ("numbers", "load", "springs")
        )
        stiffness = np.diag(springs.ravel())
        for end, joint, stiff in self.hinges:
            pair = 3 * np.array([end, joint]) + 2
            stiffness[np.ix_(pair, pair)] += stiff * np.array([[1.0, -1.0], [-1.0, 1.0]])
        return numbers, loads, stiffness

    def pieces(self, parts: Ints) -> Piece:
        """Pieces (e, 1) of the rods in which the parts (e,) are."""
        return Piece(*(table[..., parts, None] for table in self._pieces))

    @cached_property
    def _pieces(self) -> Piece:
        pieces = (part.piece for part in self.parts)
        table, *others = (np.concatenate(item, axis=-1) for item in zip(*pieces, strict=True))
        return Piece(trimmed(table), *others)

    def softest(self, z: Array) -> Array:
        """Smallest EA, GA and EI (3, parts), which are at an end of a part."""
        stiffness = self.pieces(np.arange(len(self.parts))).coefficients[:, :3]
        return np.asarray(value(stiffness, self.extents(z)).min(axis=-1))

    @property
    def grips(self) -> dict[str, Grip]:
        """How friction holds the contacts, by pair; none without friction."""
        return {pair: touch.grip for pair, touch in self.touches.items() if touch.grip is not None}

    def beside(self, touch: Touch) -> tuple[Part, Part]:
        """Return the parts before and behind a contact."""
        k = next(k for k, part in enumerate(self.parts) if part.arcs[1] == touch.arc)
        return self.parts[k], self.parts[k + 1]

    def full(self, z: Array) -> Array:
        """Unknowns and prescribed quantities."""
        return np.append(z, self.given)

    def motions(self, z: Array) -> Array:
        """Displacements and rotations (stations, 3)."""
        return self.full(z)[self.tables[0]]

    def shifts(self, z: Array) -> Array:
        """Ways (stations, 2) of the axis from the references."""
        ways = self.motions(z)[:, :2]
        for touch in self.touches.values():
            if touch.angle != NONE:
                phi, away = z[touch.angle], touch.face.left * touch.face.reach(z[touch.arc])
                ways[touch.station] -= away * np.array([-np.sin(phi), np.cos(phi)])
        return ways

    @cached_property
    def references(self) -> Array:
        """Undeformed positions (stations, 2)."""
        return np.array([item.reference for item in self.stations])

    def extents(self, z: Array) -> Array:
        """Arc positions (parts, 2) at the starts and the ends of all parts."""
        return self.full(z)[self.sides[0][:, 4]].reshape(-1, 2)

    @cached_property
    def chords(self) -> tuple[Ints, Array, Array]:
        """Numbers (2, parts) of the stations at both ends of the parts, ways (parts, 2) between these, and whether a contact is there (parts, 1)."""
        ends = np.array([part.stations for part in self.parts]).T
        first, last = self.references[ends]
        touched = np.isin(ends, [touch.station for touch in self.touches.values()])
        return ends, last - first, (touched[0] | touched[1])[:, None]

    @cached_property
    def sides(self) -> tuple[Ints, Array]:
        """Numbers (2 parts, 6) of c, displacement, arc position and phi at both ends of the parts; sign, and left, start and slope of the face."""
        numbers, sizes = [], []
        for part in self.parts:
            for station, arc, sign in zip(part.stations, part.arcs, (-1.0, 1.0), strict=True):
                there = self.stations[station]
                phi, face = (there.touch.angle, there.touch.face) if there.touch else (NONE, _AXIS)
                numbers.append((part.force, part.force + 1, *there.numbers[:2], arc, phi))
                sizes.append((sign, *face[:3]))
        return np.array(numbers), np.array(sizes).T


class _Numbers:
    """Numbers of the unknowns so far, and the prescribed quantities, which are added in front of each other."""

    def __init__(self) -> None:
        self.unknowns, self.given = 0, [0.0]

    def free(self, count: int = 1) -> int:
        """Add unknowns, and return the number of the first one."""
        self.unknowns += count
        return self.unknowns - count

    def fixed(self, value: float) -> int:
        self.given.append(value)
        return -len(self.given)


def lay_out(
    scene: Scene, load_parameter: float, closed: Mapping[str, float], grips: Mapping[str, Grip] = _FREE
) -> Layout:
    """Return the layout with contacts at the arc positions `closed`, which order them, and held by friction as `grips` say."""
    length, force = units_of(scene)
    unit = np.array([force, force, force * length])
    rods = {beam.name: rod_of(scene, beam, load_parameter) for beam in scene.beams}
    numbers = _Numbers()
    stations, joints = _joints(scene, load_parameter, unit, numbers)
    ends, hinges = dict(joints), []
    for hinge in scene.hinges:
        ends[hinge.node] = len(stations)
        hinges.append((len(stations), joints[hinge.node], hinge.stiffness / unit[2]))
        stations.append(stations[joints[hinge.node]].turning(numbers.free()))
    on_beam: dict[str, list[tuple[float, int, int]]] = {beam.name: [] for beam in scene.beams}
    for spec in (item for item in scene.contacts if item.pair in closed):
        face = face_of(scene, spec, length)
        turn, arc, angle = numbers.free(), numbers.free(), numbers.free() if face.start else NONE
        touch = Touch(
            spec=spec, station=len(stations), arc=arc, angle=angle, face=face, grip=grips.get(spec.pair)
        )
        if spec.node in joints:
            node = stations[joints[spec.node]]
        else:
            place = _place(scene, scene.pin(spec.node).position(load_parameter))
            node = Station(reference=place, numbers=np.full(3, NONE))
        on_beam[spec.beam].append((closed[spec.pair], len(stations), arc))
        stations.append(node.turning(turn, touch=touch))
    for name, (breaks, _) in rods.items():
        for s in breaks[1:-1]:
            here = (item for item in scene.load_histories if item.load.beam == name)
            loads = _total(
                item.at(load_parameter) for item in here if (item.load.at or 0.0) * breaks[-1] == s
            )
            on_beam[name].append((s * length, len(stations), numbers.fixed(s)))
            place = _place(scene, scene.beam(name).place(s / breaks[-1]))
            moved = numbers.free(3) + np.arange(3)
            stations.append(Station(reference=place, numbers=moved, load=loads / unit))
    parts: list[Part] = []
    for name, (breaks, pieces) in rods.items():
        begin, end = (0.0, ends[f"{name}.start"], NONE), ends[f"{name}.end"]
        stations[end].load[:2] += value(pieces[-1].coefficients[:, 3:, 0], breaks[-1])
        chain = [begin, *sorted(on_beam[name]), (breaks[-1], end, numbers.fixed(breaks[-1]))]
        piece = 0
        for (_, first, arc), (_, last, arc_after) in pairwise(chain):
            piece += arc < NONE  # a place inside the beam, whose arc position is prescribed
            arcs, c = (arc, arc_after), numbers.free(2)
            parts.append(Part(beam=name, stations=(first, last), arcs=arcs, force=c, piece=pieces[piece]))
    return Layout(
        scene=scene, load_parameter=load_parameter, length=length, force=force, stations=stations, parts=parts,
        joints=joints, hinges=hinges, given=np.array(numbers.given[::-1]), unknowns=numbers.unknowns,
    )  # fmt: skip


def _place(scene: Scene, point: tuple[float, float]) -> Array:
    """Position from the first beam's start."""
    return np.asarray((np.array(point) - scene.beams[0].start) / units_of(scene)[0])


def _total(amounts: Iterable[Any]) -> Array:
    """Sum of triples."""
    return np.asarray(np.sum([_NOTHING, *amounts], axis=0))


def _joints(scene: Scene, t: float, unit: Array, numbers: _Numbers) -> tuple[list[Station], dict[str, int]]:
    """Return the stations of joints with the numbers of their free components, and the numbers of the joints by the beams' ends."""
    stations, joints = list[Station](), dict[str, int]()
    hinged = {hinge.node: hinge.stiffness for hinge in scene.hinges}
    size = np.array([units_of(scene)[0]] * 2 + [1.0])
    for point, meeting in scene.meeting.items():
        ends = [f"{beam.name}.{end}" for beam, end in meeting]
        joints |= dict.fromkeys(ends, len(stations))
        held = (motion.at(t) for node, motion in scene.prescribed_motions.items() if node in ends)
        motion = next(held, (None, None, None))
        springs = _total((*item.stiffness, item.rotation) for item in scene.springs if item.node in ends)
        turns = springs[2] or any(hinged.get(end, True) for end in ends)
        loads = _total(item.at(t) for item in scene.load_histories if item.load.node in ends)
        given = [
            numbers.free() if way is None and free else numbers.fixed((way or 0.0) / one)
            for way, one, free in zip(motion, size, (True, True, turns), strict=True)
        ]
        stations.append(Station(
            reference=_place(scene, point), numbers=np.array(given), load=loads / unit,
            springs=springs * size / unit,
        ))  # fmt: skip
    return stations, joints
