"""The stations of a scene without its contacts: ends, joints and hinges with their supports, springs and loads, and places inside beams."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.polynomial.polynomial import polymul, polyval
from numpy.typing import NDArray

from comparisons.referee.rods import Flexibility, Rod, resultants
from comparisons.referee.stations import NONE, Hinge, Position, Station
from comparisons.scene import BeamSpec, Scene

Array = NDArray[np.float64]

Units = tuple[float, float]
"""Units of length and force."""


def units_of(scene: Scene) -> Units:
    """Return the longest beam's length, and the largest EI over its square."""
    length = max(beam.length for beam in scene.beams)
    return length, max(beam.EI for beam in scene.beams) / length**2


def relative(scene: Scene, point: tuple[float, float], length: float) -> tuple[float, float]:
    """Return a position relative to the first beam's start, in units of length."""
    x, y = scene.beams[0].start
    return (point[0] - x) / length, (point[1] - y) / length


def rod_of(scene: Scene, beam: BeamSpec, t: float, units: Units) -> Rod:
    """Return a beam as a rod with the load along it at load parameter t."""
    length, force = units
    x, y = beam.direction
    axes = np.array([[x, -y], [y, x]])
    extent = beam.length / length
    width, height = (_linear(given, extent) for given in (beam.width, beam.height))
    EA, GA, EI = beam.stiffness(0.0)
    stiffness = tuple(np.array([item]) for item in (EI / (force * length**2), EA / force, GA / force))
    flexibility = Flexibility(EI / (force * length**2), force / EA, force / GA)
    if beam.tapers:
        area = polymul(width, height)
        shapes = (polymul(polymul(area, height), height), area, area)
        stiffness = tuple(item * shape / shape[0] for item, shape in zip(stiffness, shapes, strict=True))
        least = [min(item[0], float(polyval(extent, item))) for item in stiffness]
        flexibility = Flexibility(least[0], 1.0 / least[1], 1.0 / least[2])
    places, W = resultants(extent, list(_spans(scene, beam, t, units, axes)), _breaks(scene, beam, extent))
    return Rod(
        length=extent,
        turn=beam.turn,
        axes=axes,
        stiffness=(stiffness[0], stiffness[1], stiffness[2]),
        greatest=flexibility,
        load=W,
        breaks=places,
    )


def _linear(given: float | tuple[float, float] | None, extent: float) -> Array:
    """Coefficients of a dimension along the beam."""
    if not isinstance(given, tuple):
        return np.array([given or 0.0])
    return (
        np.array([given[0], (given[1] - given[0]) / extent]) if given[0] != given[1] else np.array([given[0]])
    )


def joints(scene: Scene, t: float, units: Units, rods: Sequence[Rod]) -> tuple[list[Station], list[Hinge]]:
    """Return the stations of joints and ends with the indices of their free components, those behind hinges last, and the hinges."""
    length, force = units
    names: dict[tuple[float, float], list[str]] = {}
    for beam in scene.beams:
        names.setdefault(beam.start, []).append(f"{beam.name}.start")
        names.setdefault(beam.end, []).append(f"{beam.name}.end")
    hinged = {hinge.node: hinge.stiffness / (force * length) for hinge in scene.hinges}
    stations: list[Station] = []
    count = 0
    for point, ends in names.items():
        motion: tuple[float | None, ...] = (None, None, None)
        for support in scene.all_supports:
            if support.node in ends:
                motion = scene.prescribed_motions[support.node].at(t)
        station = Station(
            place=Position(reference=relative(scene, point, length)),
            rotation_unknown=NONE,
            prescribed_rotation=motion[2] or 0.0,
            ends=tuple(end for end in ends if end not in hinged),
            joint=tuple(ends),
            springs=_springs(scene, ends, units),
        )
        turns = bool(station.ends or station.springs[2] or any(hinged.get(end) for end in ends))
        unknown = [NONE, NONE, NONE]
        for component in range(3):
            if motion[component] is None and (component < 2 or turns):
                unknown[component], count = count, count + 1
        place = replace(
            station.place,
            prescribed=((motion[0] or 0.0) / length, (motion[1] or 0.0) / length),
            unknown=(unknown[0], unknown[1]),
        )
        station = replace(station, place=place, rotation_unknown=unknown[2])
        stations.append(_loaded(scene, station, t, units))
    hinges: list[Hinge] = []
    for hinge in scene.hinges:
        joint = next(k for k, item in enumerate(stations) if hinge.node in item.joint)
        hinges.append(Hinge(end=len(stations), joint=joint, stiffness=hinged[hinge.node]))
        stations.append(Station(place=stations[joint].place, rotation_unknown=count, ends=(hinge.node,)))
        count += 1
    return [_with_resultants(scene, station, rods) for station in stations], hinges


def inner_stations(
    scene: Scene, beam: BeamSpec, rod: Rod, t: float, units: Units, count: int
) -> Iterator[Station]:
    """Yield the stations inside a beam, where a force acts or a load begins or ends, with unknowns from `count` on."""
    length, force = units
    for arc in map(float, rod.breaks[1:-1]):
        x, y, moment = 0.0, 0.0, 0.0
        for item in scene.load_histories:
            if item.load.beam == beam.name and item.load.at is not None and item.load.at * rod.length == arc:
                x, y, moment = (a + b for a, b in zip((x, y, moment), item.at(t), strict=True))
        here = beam.place(arc / rod.length)
        yield Station(
            place=Position(reference=relative(scene, here, length), unknown=(count, count + 1)),
            rotation_unknown=count + 2,
            force=(x / force, y / force),
            moment=moment / (force * length),
            arc=arc,
        )
        count += 3


def _springs(scene: Scene, ends: Sequence[str], units: Units) -> tuple[float, float, float]:
    """Stiffnesses of the springs at a joint."""
    length, force = units
    own = [(*spring.stiffness, spring.rotation) for spring in scene.springs if spring.node in ends]
    kx, ky, turning = (sum(column) for column in zip((0.0, 0.0, 0.0), *own, strict=True))
    return kx * length / force, ky * length / force, turning / (force * length)


def _loaded(scene: Scene, station: Station, t: float, units: Units) -> Station:
    """Return the station of a joint with the dead loads that act there."""
    length, force = units
    for item in scene.load_histories:
        if item.load.end is not None and item.load.node in station.joint:
            px, py = station.force
            x, y, moment = item.at(t)
            station = replace(
                station,
                force=(px + x / force, py + y / force),
                moment=station.moment + moment / (force * length),
            )
    return station


def _with_resultants(scene: Scene, station: Station, rods: Sequence[Rod]) -> Station:
    """Return a station with the resultants of the loads along the beams that end there."""
    for beam, rod in zip(scene.beams, rods, strict=True):
        if f"{beam.name}.end" in station.ends and rod.loaded:
            x, y = station.force + rod.axes @ rod.resultant(len(rod.load) - 1, rod.length)
            station = replace(station, force=(float(x), float(y)))
    return station


def _breaks(scene: Scene, beam: BeamSpec, extent: float) -> set[float]:
    """Arc positions inside a beam at which a force acts."""
    loads = [item.load for item in scene.load_histories if item.load.beam == beam.name]
    return {load.at * extent for load in loads if load.at is not None}


def _spans(
    scene: Scene, beam: BeamSpec, t: float, units: Units, axes: Array
) -> Iterator[tuple[float, float, Array]]:
    """Yield loads along a beam: from one arc position to another, with coefficients (k, 2) in the frame of the chord."""
    length, force = units
    extent = beam.length / length
    for item in scene.load_histories:
        if item.load.beam == beam.name and item.load.force_per_length is not None:
            a, b = item.load.span
            q = axes.T @ np.array(item.at(t)[:2]) * length / force
            yield a * extent, b * extent, q[None, :]
    if beam.density:
        gravity = axes.T @ np.array(scene.gravity_at(t))
        width, height = (_linear(given, extent) for given in (beam.width, beam.height))
        area = polymul(width, height) if beam.tapers else np.array([beam.section(0.0)[0]])
        yield 0.0, extent, np.outer(beam.density * area * length / force, gravity)
