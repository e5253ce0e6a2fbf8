"""The layout of a scene: its stations with supports, springs and loads, its contacts and hinges, and the parts in between."""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from types import MappingProxyType

import numpy as np

from comparisons.referee.grip import Grip
from comparisons.referee.layout import NONE, Hinge, Layout, Part, Position, Station, Touch
from comparisons.referee.rod import Rod, Units, face_slope, rod_of, touching_distance, units_of
from comparisons.scene import BeamSpec, ContactSpec, Scene

_FREE: Mapping[str, Grip] = MappingProxyType({})
_Place = tuple[float, int, int]
"""Arc position of a station on a beam, its number, and the number of the unknown arc position."""


def lay_out(
    scene: Scene, load_parameter: float, closed: Mapping[str, float], grips: Mapping[str, Grip] = _FREE
) -> Layout:
    """Return the layout of `scene`.

    `closed` are the arc positions of the closed pairs, which order them along the beams, and `grips` say how friction holds them; pairs
    without a grip have no friction.
    """
    units = length, force = units_of(scene)
    rods = [rod_of(scene, beam, load_parameter, units) for beam in scene.beams]
    stations, hinges = _joints(scene, load_parameter, rods, units)
    count = 1 + max((k for item in stations for k in item.unknown), default=NONE)
    at = {end: station.place for station in stations for end in station.joint}
    on_beam: dict[str, list[_Place]] = {beam.name: [] for beam in scene.beams}
    for spec in scene.contacts:
        if spec.pair not in closed:
            continue
        touch = _touch(scene, spec, count + 1, grips.get(spec.pair), length)
        place = at.get(spec.node) or Position(
            reference=_relative(scene, scene.pin(spec.node).position(load_parameter), length)
        )
        on_beam[spec.beam].append((closed[spec.pair], len(stations), touch.arc))
        stations.append(Station(place=place, rotation_unknown=count, touch=touch))
        count += 2 + (touch.angle != NONE)
    for beam, rod in zip(scene.beams, rods, strict=True):
        for station in _inner_stations(scene, beam, rod, load_parameter, units, count):
            on_beam[beam.name].append(((station.arc or 0.0) * length, len(stations), NONE))
            stations.append(station)
            count += 3
    ends = {end: number for number, station in enumerate(stations) for end in station.ends}
    parts: list[Part] = []
    for number, (beam, rod) in enumerate(zip(scene.beams, rods, strict=True)):
        first, last = ends[f"{beam.name}.start"], ends[f"{beam.name}.end"]
        chain = [(0.0, first, NONE), *sorted(on_beam[beam.name]), (beam.length, last, NONE)]
        piece = 0
        for (_, first, arc), (_, last, arc_after) in pairwise(chain):
            piece += stations[first].arc is not None
            begin, end = (stations[k].arc or 0.0 for k in (first, last))
            fixed = begin, rod.length if last == chain[-1][1] else end
            parts.append(Part(number, first, last, (arc, arc_after), fixed, count, rod, piece))
            count += 2
    return Layout(
        scene=scene, load_parameter=load_parameter, length=length, force=force, stations=tuple(stations),
        parts=tuple(parts), hinges=tuple(hinges), unknowns=count,
    )  # fmt: skip


def _relative(scene: Scene, point: tuple[float, float], length: float) -> tuple[float, float]:
    """Return a position relative to the first beam's start, in units of length."""
    x, y = scene.beams[0].start
    return (point[0] - x) / length, (point[1] - y) / length


def _touch(scene: Scene, spec: ContactSpec, arc: int, grip: Grip | None, length: float) -> Touch:
    """Return a closed contact with the unknowns from `arc` on."""
    left = 1.0 if spec.side == "left" else -1.0
    offset = touching_distance(scene, spec, 0.0) / length * left
    return Touch(
        spec=spec, arc=arc, angle=arc + 1 if offset else NONE, offset=offset, slope=left * face_slope(scene, spec),
        roll=-scene.radius(spec) / length * left, grip=grip,
    )  # fmt: skip


def _joints(scene: Scene, t: float, rods: list[Rod], units: Units) -> tuple[list[Station], list[Hinge]]:
    """Return the stations of joints and ends with the numbers of their free components, those behind hinges last, and the hinges."""
    length, force = units
    names: dict[tuple[float, float], list[str]] = {}
    resultants: dict[str, tuple[float, float]] = {}
    for beam, rod in zip(scene.beams, rods, strict=True):
        names.setdefault(beam.start, []).append(f"{beam.name}.start")
        names.setdefault(beam.end, []).append(f"{beam.name}.end")
        if rod.loaded:
            W = -np.array(rod.force(len(rod.load) - 1, (0.0, 0.0), rod.length))
            resultants[f"{beam.name}.end"] = (float(rod.axes[0] @ W), float(rod.axes[1] @ W))
    hinged = {hinge.node: hinge.stiffness / (force * length) for hinge in scene.hinges}
    stations: list[Station] = []
    count = 0
    for point, ends in names.items():
        own = tuple(end for end in ends if end not in hinged)
        motion: tuple[float | None, ...] = (None, None, None)
        for support in scene.all_supports:
            if support.node in ends:
                motion = scene.prescribed_motions[support.node].at(t)
        springs = [(*spring.stiffness, spring.rotation) for spring in scene.springs if spring.node in ends]
        kx, ky, turning = (sum(column) for column in zip((0.0, 0.0, 0.0), *springs, strict=True))
        turns = bool(own or turning or any(hinged.get(end) for end in ends))
        free = [motion[k] is None and (k < 2 or turns) for k in range(3)]
        numbers = [count + sum(free[:k]) if free[k] else NONE for k in range(3)]
        count += sum(free)
        loads = [
            item.at(t)
            for item in scene.load_histories
            if item.load.end is not None and item.load.node in ends
        ]
        x, y, moment = (sum(column) for column in zip((0.0, 0.0, 0.0), *loads, strict=True))
        along = [resultants[end] for end in own if end in resultants]
        stations.append(
            Station(
                place=Position(
                    reference=_relative(scene, point, length),
                    prescribed=((motion[0] or 0.0) / length, (motion[1] or 0.0) / length),
                    unknown=(numbers[0], numbers[1]),
                ),
                rotation_unknown=numbers[2],
                prescribed_rotation=motion[2] or 0.0,
                force=(
                    x / force + sum(W[0] for W in along),
                    y / force + sum(W[1] for W in along),
                ),
                moment=moment / (force * length),
                ends=own,
                joint=tuple(ends),
                springs=(kx * length / force, ky * length / force, turning / (force * length)),
            )
        )
    hinges: list[Hinge] = []
    for node, stiffness in hinged.items():
        joint = next(k for k, item in enumerate(stations) if node in item.joint)
        hinges.append(Hinge(end=len(stations), joint=joint, stiffness=stiffness))
        place, force_here = stations[joint].place, resultants.get(node, (0.0, 0.0))
        stations.append(Station(place=place, rotation_unknown=count, ends=(node,), force=force_here))
        count += 1
    return stations, hinges


def _inner_stations(
    scene: Scene, beam: BeamSpec, rod: Rod, t: float, units: Units, count: int
) -> Iterator[Station]:
    """Yield the stations inside a beam, where a force acts or a load begins or ends, with unknowns from `count` on."""
    length, force = units
    for arc in map(float, rod.breaks[1:-1]):
        loads = [
            item.at(t)
            for item in scene.load_histories
            if item.load.beam == beam.name and item.load.at is not None and item.load.at * rod.length == arc
        ]
        x, y, moment = (sum(column) for column in zip((0.0, 0.0, 0.0), *loads, strict=True))
        here = beam.place(arc / rod.length)
        yield Station(
            place=Position(reference=_relative(scene, here, length), unknown=(count, count + 1)),
            rotation_unknown=count + 2,
            force=(x / force, y / force),
            moment=moment / (force * length),
            arc=arc,
        )
        count += 3
