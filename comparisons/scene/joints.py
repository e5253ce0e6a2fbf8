"""Joints of beams. Beams that share an end form one structure. A structure needs supports, with one at most at each joint."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice

from comparisons.scene.beam import BeamSpec
from comparisons.scene.conditions import COMPONENTS
from comparisons.scene.record import Unjudged
from comparisons.scene.rules import FieldError, Mistakes, Point
from comparisons.scene.statement import Statement

NEAR = 1e-6
"""Distance of two ends, relative to the beam's length, below which a joint is meant: the ends must then have equal coordinates."""
LEAST = 1e-9
"""Least pivot of the equations of rigid motions, in coordinates over the longest beam; a smaller one counts as zero."""


def joint_rules(scene: Statement) -> Mistakes:
    """Yield ends that nearly meet and beams end to end; without any, supports at one joint, hinges and structures that are not held."""
    misplaced = [*_nearly_meeting(scene), *_end_to_end(scene)]
    yield from misplaced
    if not misplaced:
        yield from _one_support(scene)
        yield from _held(scene)


def _held(scene: Statement) -> Mistakes:
    """Yield the hinges that do nothing, and the structures that are free or, untouched, can move without strain."""
    names = [beam.name for beam in scene.beams]
    names += (item.beam for item in (*scene.holding, *scene.hinges))
    for name in names:
        scene.beam(name)
    useless = list(_useless_hinges(scene))
    yield from useless
    touched: set[str] | None = None  # where a name in a contact is wrong
    with suppress(Unjudged):
        nodes = [name for one in scene.contacts for name in (one.node.partition(".")[0], one.beam)]
        touched = {name for name in nodes if scene.names.place(name)}
    for structure in _structures(scene):
        own, first = {beam.name for beam in structure}, structure[0]
        key, name = f"{scene.names.place(first.name)}.clamped", first.name
        hinges = [
            (i, one.node) for i, one in enumerate(scene.hinges) if one.beam in own and not one.stiffness
        ]
        if not any(item.beam in own for item in scene.holding):
            rule = f'beam "{name}" is free: clamp it, give it a [[support]] or a [[spring]] or join it to a beam that has one'
            yield FieldError(key, first.clamped, rule)
        elif useless or touched is None or touched & own:
            continue
        elif _moves(scene, structure, ()):
            rule = f'beam "{name}" can move without strain: its supports must hold x, y and the rotation'
            yield FieldError(key, first.clamped, rule)
        elif hinges and _moves(scene, structure, [node for _, node in hinges]):
            rule = "must not make a mechanism: the beams can move without strain"
            yield FieldError(f"hinge[{hinges[0][0]}].end", hinges[0][1], rule)


def _structures(scene: Statement) -> Iterator[list[BeamSpec]]:
    """Yield the beams, grouped by what is joined together."""
    free = {beam.name: beam for beam in scene.beams}
    while free:
        group = [free.pop(next(iter(free)))]
        for member in group:  # grows on the way
            for place in (member.start, member.end):
                group += (free.pop(other.name) for other, _ in scene.meeting[place] if other.name in free)
        yield group


def _nearly_meeting(scene: Statement) -> Mistakes:
    """Yield ends that nearly meet an end of an earlier beam. Along a direction that is no beam's, only neighbours can be near."""
    ends = sorted(
        (math.cos(1.0) * place[0] + math.sin(1.0) * place[1], i, end)
        for i, beam in enumerate(scene.beams)
        if beam.has("name", "start", "end")
        for end, place in (("start", beam.start), ("end", beam.end))
    )
    for k, (along, i, end) in enumerate(ends):
        for ahead, j, other in islice(ends, k + 1, None):
            if ahead - along > NEAR * scene.beams[i].length:
                break
            (first, joint), (last, near) = sorted(((i, end), (j, other)))
            a, b = scene.beams[first], scene.beams[last]
            node, place, met = f"{a.name}.{joint}", getattr(b, near), getattr(a, joint)
            if 0.0 < math.dist(met, place) < NEAR * min(a.length, b.length):
                rule = f'must be "{node}" exactly, or stay clear of it'
                yield FieldError(f"beam[{last}].{near}", place, rule)


def _end_to_end(scene: Statement) -> Mistakes:
    """Yield beams between the same ends as an earlier one, unless they are different arcs."""
    there: dict[tuple[frozenset[Point], float], int] = {}
    for j, beam in enumerate(scene.beams):
        with suppress(Unjudged):
            turn = beam.turn if beam.start < beam.end else -beam.turn
            i = there.setdefault((frozenset((beam.start, beam.end)), turn), j)
            if i != j:
                rule = f'must not lie on beam[{i}], "{scene.beams[i].name}", end to end'
                yield FieldError(f"beam[{j}].end", beam.end, rule)


def _one_support(scene: Statement) -> Mistakes:
    """Yield supports at a place that an earlier support holds."""
    keys = [f"beam[{i}].clamped" for i, beam in enumerate(scene.beams) for _ in beam.clamped]
    keys += [f"support[{i}].end" for i in range(len(scene.supports))]
    held: dict[Point, str] = {}
    for key, support in zip(keys, scene.all_supports, strict=True):
        place = scene.place(support.node)
        if place in held:
            rule = f'must not be supported twice, "{held[place]}" is there'
            yield FieldError(key, support.node, rule)
        held.setdefault(place, support.node)


def _useless_hinges(scene: Statement) -> Mistakes:
    """Yield the hinges at ends that nothing turns, and one hinge of every joint that all its beams leave free to turn."""
    turned = {scene.place(item.node) for item in scene.holding if "rotation" in item.held}
    stiff = {scene.place(hinge.node) for hinge in scene.hinges if hinge.stiffness}
    hinged = Counter(scene.place(node) for node in {hinge.node for hinge in scene.hinges})
    for i, hinge in enumerate(scene.hinges):
        place, rule = scene.place(hinge.node), ""
        if place in turned:
            continue
        if len(scene.meeting[place]) == 1:
            rule = "must be joined to another beam, or its rotation held by a support or a spring"
        elif hinged.pop(place, 0) == len(scene.meeting[place]) and place not in stiff:
            rule = "must leave one beam of the joint without a hinge: the joint turns freely"
        if rule:
            yield FieldError(f"hinge[{i}].end", hinge.node, rule)


def _moves(scene: Statement, structure: list[BeamSpec], free: Sequence[str]) -> bool:
    """Whether rigid beams can move: joints by (ux, uy, turn), and a beam turns by the relative motion of its ends.

    The ends `free` do not turn with their joints.
    """
    size, names = max(beam.length for beam in structure), {beam.name for beam in structure}
    places = dict.fromkeys(place for beam in structure for place in (beam.start, beam.end))
    joints = {place: 3 * k for k, place in enumerate(places)}
    rows: list[dict[int, float]] = []
    for turn, beam in enumerate(structure, 3 * len(joints)):
        start, end = joints[beam.start], joints[beam.end]
        dx, dy = ((b - a) / size for a, b in zip(beam.start, beam.end, strict=True))
        rows += [{end: 1.0, start: -1.0, turn: dy}, {end + 1: 1.0, start + 1: -1.0, turn: -dx}]
        nodes = ((start, f"{beam.name}.start"), (end, f"{beam.name}.end"))
        rows += ({joint + 2: 1.0, turn: -1.0} for joint, node in nodes if node not in free)
    for item in (item for item in scene.holding if item.beam in names):
        joint = joints[scene.place(item.node)]
        rows += ({joint + COMPONENTS.index(component): 1.0} for component in item.held)
    return _rank(rows) < 3 * len(joints) + len(structure)


def _rank(rows: list[dict[int, float]]) -> int:
    """Return the rank of a sparse matrix, its values by column, by elimination with the largest value of every row."""
    pivots: dict[int, dict[int, float]] = {}
    for row in rows:
        while known := row.keys() & pivots.keys():
            column = known.pop()
            factor = row.pop(column)
            for other, value in pivots[column].items():
                row[other] = row.get(other, 0.0) - factor * value
        size, column = max(((abs(value), column) for column, value in row.items()), default=(0.0, 0))
        if size > LEAST:
            scale = row.pop(column)
            pivots[column] = {other: value / scale for other, value in row.items() if value}
    return len(pivots)
