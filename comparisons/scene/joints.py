"""Joints of beams. Beams that share an end form one structure. A structure needs supports, with one at most at each joint."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations, product
from typing import TYPE_CHECKING

from comparisons.scene.hinges import mechanism, useless_hinges
from comparisons.scene.record import Unjudged, right
from comparisons.scene.rules import FieldError, Point

if TYPE_CHECKING:
    from comparisons.scene.beam import BeamSpec
    from comparisons.scene.names import Names
    from comparisons.scene.records import Scene

NEAR = 1e-6
"""Distance of two ends, relative to the beam's length, below which a joint is meant: the ends must then have equal coordinates."""


def joint_rules(scene: Scene, names: Names) -> Iterator[FieldError]:
    """Yield ends that nearly meet and beams end to end; without any, supports at one joint, hinges and structures that are not held."""
    misplaced = [*_nearly_meeting(scene), *_end_to_end(scene)]
    yield from misplaced
    if not misplaced:
        yield from _one_support(scene, names)
        yield from _held(scene, names)


def _held(scene: Scene, names: Names) -> Iterator[FieldError]:
    named = [beam.name for beam in scene.beams]
    for records in (scene.supports, scene.springs, scene.hinges):
        named += (record.beam for record in records)
    if not all(map(names.is_beam, named)):
        return
    useless = list(useless_hinges(scene))
    yield from useless
    touched = _touched(scene, names)
    numbers = {beam.name: i for i, beam in enumerate(scene.beams)}
    for structure in structures(scene):
        with suppress(Unjudged):
            number = numbers[structure[0].name]
            free = list(_structure_held(scene, structure, number))
            yield from free
            own = {beam.name for beam in structure}
            if not free and not useless and touched is not None and touched.isdisjoint(own):
                yield from _structure_stiff(scene, structure, number)


def _touched(scene: Scene, names: Names) -> set[str] | None:
    """Return the names of beams and pins in contacts; None where a name in a contact is wrong."""
    with suppress(Unjudged):
        contacts = scene.contacts
        if all(names.is_beam(contact.beam) and names.is_node(contact.node) for contact in contacts):
            return {name for contact in contacts for name in (contact.beam, contact.node.partition(".")[0])}
    return None


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


def _nearly_meeting(scene: Scene) -> Iterator[FieldError]:
    beams = {i: beam for i, beam in enumerate(scene.beams) if right(beam, "name", "start", "end")}
    meeting: dict[Point, list[int]] = defaultdict(list)
    for i, beam in beams.items():
        meeting[beam.start].append(i)
        meeting[beam.end].append(i)
    longest = {place: max(beams[i].length for i in own) for place, own in meeting.items()}
    for place, other in _neighbours(longest):
        if math.dist(place, other) < NEAR * min(longest[place], longest[other]):
            for i, j in combinations(sorted({*meeting[place], *meeting[other]}), 2):
                yield from _pair(beams[i], beams[j], j)


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


def _pair(a: BeamSpec, b: BeamSpec, number: int) -> Iterator[FieldError]:
    """Yield the ends of `b`, the beam of that number, that nearly meet an end of `a`."""
    for end in ("start", "end"):
        for place, node in ((a.start, f"{a.name}.start"), (a.end, f"{a.name}.end")):
            near = getattr(b, end)
            if near != place and math.dist(near, place) < NEAR * min(a.length, b.length):
                yield FieldError(
                    f"beam[{number}].{end}", near, f'must be "{node}" exactly, or stay clear of it'
                )


def _end_to_end(scene: Scene) -> Iterator[FieldError]:
    """Yield beams between the same ends as an earlier one, unless they are different arcs."""
    there: dict[tuple[frozenset[Point], float], int] = {}
    for j, beam in enumerate(scene.beams):
        with suppress(Unjudged):
            turn = beam.turn if beam.start < beam.end else -beam.turn
            i = there.setdefault((frozenset((beam.start, beam.end)), turn), j)
            if i != j:
                rule = f'must not lie on beam[{i}], "{scene.beams[i].name}", end to end'
                yield FieldError(f"beam[{j}].end", beam.end, rule)


def _one_support(scene: Scene, names: Names) -> Iterator[FieldError]:
    """Yield supports at a place that an earlier support holds."""
    held: dict[Point, str] = {}
    for key, node in _supported(scene, names):
        with suppress(Unjudged):
            place = scene.place(node)
            if place in held:
                yield FieldError(key, node, f'must not be supported twice, "{held[place]}" is there')
            held[place] = node


def _supported(scene: Scene, names: Names) -> Iterator[tuple[str, str]]:
    """Yield the keys of the supports and the ends that they hold."""
    for i, beam in enumerate(scene.beams):
        with suppress(Unjudged):
            if names.is_beam(beam.name):
                yield from ((f"beam[{i}].clamped", f"{beam.name}.{end}") for end in beam.clamped)
    for i, support in enumerate(scene.supports):
        with suppress(Unjudged):
            if names.is_beam(support.beam):
                yield f"support[{i}].end", support.node


def _structure_held(scene: Scene, structure: list[BeamSpec], number: int) -> Iterator[FieldError]:
    """Yield a mistake if nothing holds a structure; `number` is its first beam's."""
    beam, names = structure[0], {member.name for member in structure}
    if not any(map(scene.supports_of, names)) and not any(spring.beam in names for spring in scene.springs):
        rule = f'beam "{beam.name}" is free: clamp it, give it a [[support]] or a [[spring]] or join it to a beam that has one'
        yield FieldError(f"beam[{number}].clamped", beam.clamped, rule)


def _structure_stiff(scene: Scene, structure: list[BeamSpec], number: int) -> Iterator[FieldError]:
    """Yield a mistake if a structure that nothing touches can move without strain."""
    beam = structure[0]
    if not _rigid(scene, structure):
        rule = f'beam "{beam.name}" can move without strain: its supports must hold x, y and the rotation'
        yield FieldError(f"beam[{number}].clamped", beam.clamped, rule)
    else:
        yield from mechanism(scene, structure)


def _rigid(scene: Scene, structure: list[BeamSpec]) -> bool:
    """Whether the supports and springs leave no rigid motion ``(a - c y, b + c x, c)``."""
    names = {beam.name for beam in structure}
    own = [item for item in scene.holding if item.beam in names]
    levels = {scene.place(support.node)[1] for support in own if "x" in support.held}
    columns = {scene.place(support.node)[0] for support in own if "y" in support.held}
    turning = any("rotation" in support.held for support in own) or len(levels) > 1 or len(columns) > 1
    return bool(levels) and bool(columns) and turning
