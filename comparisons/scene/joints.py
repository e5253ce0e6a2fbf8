"""Joints: beams that share an end are one structure, which must be held, and each of its joints by one support at most."""

import math
from itertools import combinations

from comparisons.scene.records import BeamSpec, Scene
from comparisons.scene.rules import FieldError

NEAR = 1e-6
"""Distance of two ends, relative to the beam, below which they are one joint by intention and must be so exactly."""


def check_joints(scene: Scene) -> None:
    """Raise `FieldError` for ends that nearly meet, for a joint with two supports and for a structure that is not held."""
    _check_meeting(scene)
    _check_one_support(scene)
    for structure in structures(scene):
        _check_held(scene, structure)


def structures(scene: Scene) -> list[list[BeamSpec]]:
    """Return the beams, grouped by what is joined together."""
    groups: list[list[BeamSpec]] = []
    for beam in scene.beams:
        joined = [group for group in groups if any(_meet(beam, other) for other in group)]
        groups = [group for group in groups if group not in joined]
        groups.append([other for group in joined for other in group] + [beam])
    return groups


def _meet(a: BeamSpec, b: BeamSpec) -> bool:
    return not {a.start, a.end}.isdisjoint({b.start, b.end})


def _check_meeting(scene: Scene) -> None:
    for (i, a), (j, b) in combinations(enumerate(scene.beams), 2):
        for end in ("start", "end"):
            for place, node in ((a.start, f"{a.name}.start"), (a.end, f"{a.name}.end")):
                mine = getattr(b, end)
                if mine != place and math.dist(mine, place) < NEAR * min(a.length, b.length):
                    raise FieldError(
                        f"beam[{j}].{end}", mine, f'must be "{node}" exactly, or stay clear of it'
                    )
        if {a.start, a.end} == {b.start, b.end}:
            raise FieldError(f"beam[{j}].end", b.end, f'must not lie on beam[{i}], "{a.name}", end to end')


def _check_one_support(scene: Scene) -> None:
    held: dict[tuple[float, float], str] = {}
    keys = [f"beam[{i}].clamped" for i, beam in enumerate(scene.beams) for _ in beam.clamped]
    keys += [f"support[{i}].end" for i in range(len(scene.supports))]
    for key, support in zip(keys, scene.all_supports, strict=True):
        place = scene.place(support.node)
        if place in held:
            raise FieldError(key, support.node, f'must not be supported twice, "{held[place]}" is there')
        held[place] = support.node


def _check_held(scene: Scene, structure: list[BeamSpec]) -> None:
    names = {beam.name for beam in structure}
    supports = [support for support in scene.all_supports if support.beam in names]
    key, beam = f"beam[{scene.beams.index(structure[0])}].clamped", structure[0]
    if not supports:
        rule = (
            f'beam "{beam.name}" is free: clamp it, give it a [[support]] or join it to a beam that has one'
        )
        raise FieldError(key, beam.clamped, rule)
    touched = {name for contact in scene.contacts for name in (contact.beam, contact.node.split(".")[0])}
    if not touched & names and not _rigid(scene, structure):
        rule = f'beam "{beam.name}" can move without strain: its supports must hold x, y and the rotation'
        raise FieldError(key, beam.clamped, rule)


def _rigid(scene: Scene, structure: list[BeamSpec]) -> bool:
    """Whether the supports leave no rigid motion ``(a - c y, b + c x, c)``."""
    own = [support for support in scene.all_supports if scene.beam(support.beam) in structure]
    levels = {scene.place(support.node)[1] for support in own if "x" in support.held}
    columns = {scene.place(support.node)[0] for support in own if "y" in support.held}
    turning = any("rotation" in support.held for support in own) or len(levels) > 1 or len(columns) > 1
    return bool(levels) and bool(columns) and turning
