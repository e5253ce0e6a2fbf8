"""Joints of beams. Beams that share an end form one structure. A structure needs supports, with one at most at each joint."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from itertools import combinations, product
from typing import TYPE_CHECKING

from comparisons.scene.hinges import check_mechanism
from comparisons.scene.rules import FieldError, Point

if TYPE_CHECKING:
    from comparisons.scene.records import BeamSpec, Scene

NEAR = 1e-6
"""Distance of two ends, relative to the beam's length, below which a joint is meant: the ends must then have equal coordinates."""


def check_joints(scene: Scene) -> None:
    """Raise `FieldError` for ends that nearly meet, for a joint with two supports and for a structure that is not held."""
    _check_meeting(scene)
    _check_apart(scene)
    _check_one_support(scene)
    touched = {name for contact in scene.contacts for name in (contact.beam, contact.node.split(".")[0])}
    numbers = {beam.name: i for i, beam in enumerate(scene.beams)}
    for structure in structures(scene):
        key = f"beam[{numbers[structure[0].name]}].clamped"
        _check_held(scene, structure, touched, key)


def structures(scene: Scene) -> list[list[BeamSpec]]:
    """Return the beams, grouped by what is joined together."""
    meeting = _meeting(scene)
    groups: list[list[BeamSpec]] = []
    grouped: set[str] = set()
    for beam in scene.beams:
        if beam.name in grouped:
            continue
        grouped.add(beam.name)
        group = [beam]
        for member in group:  # grows on the way
            for other in (other for place in (member.start, member.end) for other in meeting.pop(place, ())):
                if other.name not in grouped:
                    grouped.add(other.name)
                    group.append(other)
        groups.append(group)
    return groups


def _meeting(scene: Scene) -> dict[Point, list[BeamSpec]]:
    """Return the beams at every end."""
    meeting: dict[Point, list[BeamSpec]] = defaultdict(list)
    for beam in scene.beams:
        meeting[beam.start].append(beam)
        meeting[beam.end].append(beam)
    return meeting


def _check_meeting(scene: Scene) -> None:
    meeting = _meeting(scene)
    longest = {place: max(beam.length for beam in beams) for place, beams in meeting.items()}
    for place, other in _neighbours(longest):
        if math.dist(place, other) >= NEAR * min(longest[place], longest[other]):
            continue
        numbers = {beam.name: i for i, beam in enumerate(scene.beams)}
        own = sorted({numbers[beam.name] for at in (place, other) for beam in meeting[at]})
        for i, j in combinations(own, 2):
            _check_pair(scene.beams[i], scene.beams[j], j)


def _neighbours(longest: dict[Point, float]) -> Iterator[tuple[Point, Point]]:
    """Yield all pairs of ends with a distance of at most `NEAR` times the shorter beam; some pairs may be farther apart.

    The search uses grids of squares, one grid for every power of two among the beam lengths. A grid has the ends of all beams of
    its length or longer. Each end is compared with the ends in the neighbouring squares of the grid for its beam's length.
    """
    levels = {place: math.frexp(length)[1] for place, length in longest.items()}
    for level in sorted(set(levels.values())):
        size = NEAR * math.ldexp(1.0, level)
        squares: dict[tuple[int, int], list[Point]] = defaultdict(list)
        square = {
            place: (math.floor(place[0] / size), math.floor(place[1] / size))
            for place in longest
            if levels[place] >= level
        }
        for place, own in square.items():
            squares[own].append(place)
        for place, (column, row) in square.items():
            if levels[place] == level:
                for dx, dy in product((-1, 0, 1), repeat=2):
                    near = squares.get((column + dx, row + dy), ())
                    yield from ((place, other) for other in near if other != place)


def _check_pair(a: BeamSpec, b: BeamSpec, number: int) -> None:
    """Raise for ends of `b`, the beam of that number, that nearly meet an end of `a`."""
    for end in ("start", "end"):
        for place, node in ((a.start, f"{a.name}.start"), (a.end, f"{a.name}.end")):
            mine = getattr(b, end)
            if mine != place and math.dist(mine, place) < NEAR * min(a.length, b.length):
                raise FieldError(
                    f"beam[{number}].{end}", mine, f'must be "{node}" exactly, or stay clear of it'
                )


def _check_apart(scene: Scene) -> None:
    """Raise for two beams between the same ends, unless they are different arcs."""
    there: dict[tuple[frozenset[Point], float], int] = {}
    for j, beam in enumerate(scene.beams):
        turn = beam.turn if beam.start < beam.end else -beam.turn
        i = there.setdefault((frozenset((beam.start, beam.end)), turn), j)
        if i != j:
            rule = f'must not lie on beam[{i}], "{scene.beams[i].name}", end to end'
            raise FieldError(f"beam[{j}].end", beam.end, rule)


def _check_one_support(scene: Scene) -> None:
    held: dict[Point, str] = {}
    keys = [f"beam[{i}].clamped" for i, beam in enumerate(scene.beams) for _ in beam.clamped]
    keys += [f"support[{i}].end" for i in range(len(scene.supports))]
    for key, support in zip(keys, scene.all_supports, strict=True):
        place = scene.place(support.node)
        if place in held:
            raise FieldError(key, support.node, f'must not be supported twice, "{held[place]}" is there')
        held[place] = support.node


def _check_held(scene: Scene, structure: list[BeamSpec], touched: set[str], key: str) -> None:
    beam, names = structure[0], [member.name for member in structure]
    if not any(map(scene.supports_of, names)) and not any(spring.beam in names for spring in scene.springs):
        rule = f'beam "{beam.name}" is free: clamp it, give it a [[support]] or a [[spring]] or join it to a beam that has one'
        raise FieldError(key, beam.clamped, rule)
    if touched.isdisjoint(names) and not _rigid(scene, structure):
        rule = f'beam "{beam.name}" can move without strain: its supports must hold x, y and the rotation'
        raise FieldError(key, beam.clamped, rule)
    if touched.isdisjoint(names):
        check_mechanism(scene, structure)


def _rigid(scene: Scene, structure: list[BeamSpec]) -> bool:
    """Whether the supports and springs leave no rigid motion ``(a - c y, b + c x, c)``."""
    names = {beam.name for beam in structure}
    own = [item for item in scene.holding if item.beam in names]
    levels = {scene.place(support.node)[1] for support in own if "x" in support.held}
    columns = {scene.place(support.node)[0] for support in own if "y" in support.held}
    turning = any("rotation" in support.held for support in own) or len(levels) > 1 or len(columns) > 1
    return bool(levels) and bool(columns) and turning
