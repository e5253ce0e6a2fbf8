"""Where the search for the exact equilibrium starts: what an answer says about axes, forces and arc positions."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.layout import NONE, Layout, Part, Place
from comparisons.response import Response, SupportHistory
from comparisons.scene import Scene

Array = NDArray[np.float64]

_CLOSED_LOOP = 1e-3
"""Weight of the parts' balance of moments, which the axis' curvature states badly: it decides only what the balance of forces leaves open."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Given:
    """An answer at one load parameter, in the scene's units.

    Attributes
    ----------
    load_parameter : float
        Of the answer.
    arcs : dict of float
        Arc position of every closed pair, by name.
    forces : dict of (float, float)
        Contact force on the beam of every closed pair.
    axes : dict of (ndarray, ndarray)
        Arc length (m,) and deformed positions (m, 2) of every beam's axis.
    reactions : dict of (float, float, float)
        Force and moment of the supports, by the held end.
    tips : dict of (float, float)
        Position of the beams' less held ends, by beam.
    """

    load_parameter: float
    arcs: dict[str, float]
    forces: dict[str, tuple[float, float]]
    axes: dict[str, tuple[Array, Array]]
    reactions: dict[str, tuple[float, float, float]]
    tips: dict[str, tuple[float, float]]


def given_by(response: Response, scene: Scene, k: int) -> Given:
    """Return what `response` states at its load parameter number k."""
    closed = {pair: item for pair, item in response.contacts.items() if item.force[k] != 0.0}
    reactions: dict[str, tuple[float, float, float]] = {}
    for beam, first in response.supports.items():
        stated: list[SupportHistory] = [first] if first.other_end is None else [first, first.other_end]
        for spec, item in zip(scene.supports_of(beam), stated, strict=False):
            reactions[spec.node] = (float(item.force[k, 0]), float(item.force[k, 1]), float(item.moment[k]))
    return Given(
        load_parameter=float(response.load_parameter[k]),
        arcs={pair: float(item.arc_position[k]) for pair, item in closed.items()},
        forces={
            pair: (math.nan, math.nan)
            if item.vector is None
            else (float(item.vector[k, 0]), float(item.vector[k, 1]))
            for pair, item in closed.items()
        },
        axes={beam.name: response.axis_line(beam.name, k) for beam in scene.beams},
        reactions=reactions,
        tips={beam: (float(tip[k, 0]), float(tip[k, 1])) for beam, tip in response.tips.items()},
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Rotations:
    """The rotation of a beam's section by arc length, from the direction of its axis; units of `Layout`."""

    arc: Array
    theta: Array

    def at(self, arc: Array | float) -> Array:
        """Return the rotation, linear between and beyond the given ones."""
        found = np.interp(arc, self.arc, self.theta)
        if len(self.arc) < 2:
            return np.asarray(found)
        slope = np.diff(self.theta) / np.diff(self.arc)
        before, beyond = np.minimum(arc - self.arc[0], 0.0), np.maximum(arc - self.arc[-1], 0.0)
        return np.asarray(found + before * slope[0] + beyond * slope[-1])


def first_guess(layout: Layout, given: Given) -> tuple[Array, list[Rotations]]:
    """Return the unknowns of the layout and the beams' rotations as `given` has them."""
    scene, z = layout.scene, np.zeros(layout.unknowns)
    turns = [_tangents(layout, given, number) for number in range(len(scene.beams))]
    turns = _aligned(layout, turns)
    for touch in layout.touches:
        z[touch.arc] = given.arcs[touch.spec.pair] / layout.length
    _place_stations(layout, given, turns, z)
    _balance(layout, given, turns, z)
    turns = _aligned(
        layout, [_less_shear(layout, given, turn, number, z) for number, turn in enumerate(turns)]
    )
    for part in layout.parts:
        for number in (part.first, part.last):
            station = layout.stations[number]
            if station.turn != NONE:
                z[station.turn] = turns[part.beam].at(layout.arc(z, number, part))
    return z, turns


def _chords(layout: Layout, given: Given, number: int) -> tuple[Array, NDArray[np.complex128]]:
    """Middles of the stated axis' chords and the chords over their arc lengths, as complex numbers from the undeformed direction."""
    beam = layout.scene.beams[number]
    arc, line = given.axes[beam.name]
    pieces, extents = np.diff(line, axis=0) @ (1.0, 1.0j) / complex(*beam.direction), np.diff(arc)
    long = (np.abs(pieces) > 0.0) & (extents > 0.0)
    return (arc[:-1] + arc[1:])[long] / (2.0 * layout.length), pieces[long] / extents[long]


def _tangents(layout: Layout, given: Given, number: int) -> Rotations:
    """Angles of the axis' chords from the undeformed direction, without jumps of a turn."""
    middle, way = _chords(layout, given, number)
    if not len(middle):
        return Rotations(arc=np.array([0.0]), theta=np.array([0.0]))
    return Rotations(arc=middle, theta=np.unwrap(np.angle(way)))


def _aligned(layout: Layout, turns: list[Rotations]) -> list[Rotations]:
    """Add whole turns, so that beams agree with the supports that hold their rotation and at joints with each other."""
    known: dict[int, float] = {k: item.turned for k, item in enumerate(layout.stations) if item.turn == NONE}
    left = list(range(len(turns)))
    aligned = list(turns)
    while left:
        number = next((b for b in left if any(k in known for k, _ in _both(layout, b))), left[0])
        left.remove(number)
        ends = _both(layout, number)
        shift = next((known[k] - float(turns[number].at(arc)) for k, arc in ends if k in known), 0.0)
        turn = Rotations(
            arc=turns[number].arc, theta=turns[number].theta + 2.0 * math.pi * round(shift / (2.0 * math.pi))
        )
        aligned[number] = turn
        for k, arc in ends:
            known.setdefault(k, float(turn.at(arc)))
    return aligned


def _both(layout: Layout, beam: int) -> list[tuple[int, float]]:
    """Stations of a beam's ends and where they are on it."""
    own = [part for part in layout.parts if part.beam == beam]
    return [(own[0].first, 0.0), (own[-1].last, layout.scene.beams[beam].length / layout.length)]


def _place_stations(layout: Layout, given: Given, turns: list[Rotations], z: Array) -> None:
    scene = layout.scene
    origin = np.array(scene.beams[0].start)
    for station in layout.stations:
        if station.touch == NONE:
            name, end = station.ends[0].split(".")
            line = given.axes[name][1]
            seen = (line[0 if end == "start" else -1] - origin) / layout.length - np.array(station.place.rest)
            _set(z, station.place, seen)
        else:
            touch = layout.touches[station.touch]
            if touch.angle != NONE:
                number = [beam.name for beam in scene.beams].index(touch.spec.beam)
                x, y = scene.beams[number].direction
                z[touch.angle] = math.atan2(y, x) + float(turns[number].at(z[touch.arc]))


def _set(z: Array, place: Place, moved: Array) -> None:
    for component, number in enumerate(place.unknown):
        if number != NONE:
            z[number] = moved[component]


def _balance(layout: Layout, given: Given, turns: list[Rotations], z: Array) -> None:
    """Forces of the parts: those that balance the given contact forces, reactions and loads best."""
    column = {part.force: 2 * k for k, part in enumerate(layout.parts)}
    size = 2 * len(layout.parts)
    acting, known = _acting(layout, given)
    rows, right = [], []
    for k, item in enumerate(layout.stations):
        row = np.zeros((2, size))
        for part in layout.parts:
            here = slice(column[part.force], column[part.force] + 2)
            row[:, here] += ((part.last == k) * 1.0 - (part.first == k) * 1.0) * part.axes
        stated = [k in known or item.touch != NONE or number != NONE for number in item.place.unknown]
        rows += [row[component] for component in range(2) if stated[component]]
        right += [acting[k, component] for component in range(2) if stated[component]]
    for part in layout.parts:
        lever, value = _moments(layout, part, turns, z)
        full = np.zeros(size)
        full[column[part.force] : column[part.force] + 2] = _CLOSED_LOOP * lever
        rows.append(full)
        right.append(_CLOSED_LOOP * value)
    found = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    for part in layout.parts:
        z[part.force : part.force + 2] = found[column[part.force] : column[part.force] + 2]


def _acting(layout: Layout, given: Given) -> tuple[Array, set[int]]:
    """Forces (stations, 2) from outside the rods that meet at a station, and the stations whose reactions are given."""
    acting = np.array([item.force for item in layout.stations])
    where = {end: k for k, item in enumerate(layout.stations) for end in item.ends}
    for end, (x, y, _) in given.reactions.items():
        acting[where[end]] += np.array([x, y]) / layout.force
    for k, item in enumerate(layout.stations):
        if item.touch == NONE:
            continue
        spec = layout.touches[item.touch].spec
        force = np.nan_to_num(np.array(given.forces[spec.pair])) / layout.force
        acting[k] += force
        if "." in spec.node:
            acting[where[spec.node]] -= force
    return acting, {where[end] for end in given.reactions}


def _moments(layout: Layout, part: Part, turns: list[Rotations], z: Array) -> tuple[Array, float]:
    """Row and right side of ``(r_b - r_a) x n = m_a - m_b`` in the beam's frame."""
    a, b = layout.arc(z, part.first, part), layout.arc(z, part.last, part)
    chord = part.axes.T @ (layout.position(z, part.last) - layout.position(z, part.first))
    turn, step = turns[part.beam], (b - a) / 8.0
    m_a, m_b = (
        part.EI * float(turn.at(x + step) - turn.at(x)) / step if step > 0.0 else 0.0 for x in (a, b - step)
    )
    return np.array([-chord[1], chord[0]]), m_a - m_b


def _less_shear(layout: Layout, given: Given, turn: Rotations, number: int, z: Array) -> Rotations:
    """Take the sections' directions from the axis: ``r' - n/GA = (1 + N/EA - N/GA) d1``, since ``r' = d1 + (N/EA) d1 + (Q/GA) d2``.

    The factor of d1 is negative in strong shear; of the two signs only one agrees with N.
    """
    _, way = _chords(layout, given, number)
    theta = turn.theta
    if not len(way):
        return turn
    for part in layout.parts:
        if part.beam != number or not part.shear:
            continue
        inside = (turn.arc >= layout.arc(z, part.first, part)) & (turn.arc <= layout.arc(z, part.last, part))
        n = complex(z[part.force], z[part.force + 1])
        along = way - part.shear * n
        size = np.abs(along)
        d1 = along / np.where(size > 0.0, size, 1.0)
        factor = (part.stretch - part.shear) * (d1 * n.conjugate()).real
        d1 = np.where(np.abs(1.0 + factor - size) <= np.abs(1.0 - factor + size), d1, -d1)
        theta = np.where(inside & (size > 0.0), np.angle(d1), theta)
    return Rotations(arc=turn.arc, theta=np.unwrap(theta))
