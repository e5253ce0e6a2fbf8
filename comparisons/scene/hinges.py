"""Hinges between beams and their joints. A structure with hinges must not be a mechanism."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import TYPE_CHECKING

from comparisons.scene.rules import FieldError, Point

if TYPE_CHECKING:
    from comparisons.scene.beam import BeamSpec
    from comparisons.scene.records import Scene

Row = list[float]
LEAST = 1e-9
"""Least pivot of the equations of rigid motions, in coordinates over the structure's size; a smaller one counts as zero."""


def useless_hinges(scene: Scene) -> Iterator[FieldError]:
    """Yield the hinges at ends that nothing turns, and one hinge of every joint that all its beams leave free to turn."""
    meeting = _ends(scene)
    turned = {scene.place(item.node) for item in scene.holding if "rotation" in item.held}
    stiff = {hinge.node for hinge in scene.hinges if hinge.stiffness}
    hinged = {hinge.node for hinge in scene.hinges} - stiff
    free: set[Point] = set()
    for i, hinge in enumerate(scene.hinges):
        place = scene.place(hinge.node)
        if place in turned:
            continue
        if len(meeting[place]) == 1:
            rule = "must be joined to another beam, or its rotation held by a support or a spring"
            yield FieldError(f"hinge[{i}].end", hinge.node, rule)
        elif hinged.issuperset(meeting[place]) and place not in free:
            free.add(place)
            rule = "must leave one beam of the joint without a hinge: the joint turns freely"
            yield FieldError(f"hinge[{i}].end", hinge.node, rule)


def mechanism(scene: Scene, structure: list[BeamSpec]) -> Iterator[FieldError]:
    """Yield a mistake if the beams of a structure, each rigid, can move about its hinges."""
    names = {beam.name for beam in structure}
    own = [i for i, hinge in enumerate(scene.hinges) if hinge.beam in names and not hinge.stiffness]
    if own and _free_motion(scene, structure):
        node = scene.hinges[own[0]].node
        rule = "must not make a mechanism: the beams can move without strain"
        yield FieldError(f"hinge[{own[0]}].end", node, rule)


def _ends(scene: Scene) -> dict[Point, list[str]]:
    """Return the beams' ends at every place."""
    meeting: dict[Point, list[str]] = defaultdict(list)
    for beam in scene.beams:
        meeting[beam.start].append(f"{beam.name}.start")
        meeting[beam.end].append(f"{beam.name}.end")
    return meeting


def _bodies(scene: Scene, structure: list[BeamSpec]) -> tuple[dict[str, int], dict[Point, int | None]]:
    """Return the number of every beam's rigid body, and of the body that turns with every joint, None if all its beams are hinged."""
    hinged = {hinge.node for hinge in scene.hinges if not hinge.stiffness}
    body = {beam.name: i for i, beam in enumerate(structure)}
    joints: dict[Point, int | None] = {}
    fixed: dict[Point, list[str]] = {}
    for beam in structure:
        for place, end in ((beam.start, "start"), (beam.end, "end")):
            fixed.setdefault(place, [])
            if f"{beam.name}.{end}" not in hinged:
                fixed[place].append(beam.name)
    for names in fixed.values():
        merged = {body[name] for name in names}
        body = {name: min(merged) if number in merged else number for name, number in body.items()}
    numbers = {number: i for i, number in enumerate(sorted(set(body.values())))}
    body = {name: numbers[number] for name, number in body.items()}
    for place, names in fixed.items():
        joints[place] = body[names[0]] if names else None
    return body, joints


def _free_motion(scene: Scene, structure: list[BeamSpec]) -> bool:
    """Whether the bodies, each with a motion ``(a - c y, b + c x, c)``, can move against supports, springs and hinges."""
    body, joints = _bodies(scene, structure)
    columns, (x0, y0) = 3 * (1 + max(body.values())), structure[0].start
    size = max(beam.length for beam in structure)

    def rows(number: int, place: Point, sign: float = 1.0) -> tuple[Row, Row, Row]:
        """Return displacement x, y and rotation of a body at a place in the unknowns."""
        x, y = (place[0] - x0) / size, (place[1] - y0) / size
        found = ([0.0] * columns, [0.0] * columns, [0.0] * columns)
        found[0][3 * number], found[0][3 * number + 2] = sign, -sign * y
        found[1][3 * number + 1], found[1][3 * number + 2] = sign, sign * x
        found[2][3 * number + 2] = sign
        return found

    equations: list[Row] = []
    leading: dict[Point, int] = {place: number for place, number in joints.items() if number is not None}
    for beam in structure:
        for place in (beam.start, beam.end):
            first = leading.setdefault(place, body[beam.name])
            if first != body[beam.name]:
                pairs = zip(rows(first, place), rows(body[beam.name], place, -1.0), strict=True)
                both = [[a + b for a, b in zip(one, other, strict=True)] for one, other in pairs]
                equations += both[:2]
    for item in scene.holding:
        place = scene.place(item.node)
        if item.beam not in body:
            continue
        ux, uy, turn = rows(leading[place], place)
        equations += [row for name, row in (("x", ux), ("y", uy)) if name in item.held]
        if "rotation" in item.held and joints[place] is not None:
            equations.append(turn)
    return _rank(equations) < columns


def _rank(rows: list[Row]) -> int:
    """Return the rank of a matrix by elimination with complete pivoting."""
    rank = 0
    while rows:
        values = ((abs(value), i, j) for i, row in enumerate(rows) for j, value in enumerate(row))
        size, i, j = max(values)
        if size < LEAST:
            break
        pivot = rows.pop(i)
        for row in rows:
            if row[j]:
                factor = row[j] / pivot[j]
                row[:] = [a - factor * b for a, b in zip(row, pivot, strict=True)]
        rank += 1
    return rank
