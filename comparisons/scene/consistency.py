"""What the records of a scene must obey together.

A rule is judged where the values that it reads are right; reading a wrong one raises `comparisons.scene.record.Unjudged`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from comparisons.scene.contact import ContactSpec
from comparisons.scene.ends import free_ends
from comparisons.scene.joints import joint_rules
from comparisons.scene.names import Names, listed
from comparisons.scene.record import Unjudged, right
from comparisons.scene.rules import MISSING, FieldError, Point
from comparisons.scene.stage_rules import stage_rules

if TYPE_CHECKING:
    from comparisons.scene.beam import BeamSpec
    from comparisons.scene.records import Scene


def scene_rules(scene: Scene) -> Iterable[Iterator[FieldError]]:
    """Return the rules between the records of `scene`; each yields its mistakes."""
    names = Names(scene)
    return (
        iter(names.repeated),
        _contacts(scene, names),
        _distinct("contact", scene, "pair", "node"),
        _beams_named(scene, names),
        _distinct("load", scene, "node", "end"),
        _distinct("hinge", scene, "node", "end"),
        _distinct("spring", scene, "node", "end"),
        stage_rules(scene, names),
        joint_rules(scene, names),
        _weight(scene),
        _idle_pins(scene, names),
        _cause(scene),
    )


def _distinct(kind: str, scene: Scene, attribute: str, key: str) -> Iterator[FieldError]:
    """Yield the records of a kind with the same `attribute` as an earlier one; `key` is its key unless the record states one."""
    seen: set[str] = set()
    for i, record in enumerate[Any](getattr(scene, f"{kind}s")):
        with suppress(Unjudged):
            value = getattr(record, attribute)
            if value in seen:
                own = getattr(record, "key", key)
                yield FieldError(f"{kind}[{i}].{own}", value, "must not appear twice")
            seen.add(value)


def _beams_named(scene: Scene, names: Names) -> Iterator[FieldError]:
    for kind in ("support", "load", "hinge", "spring"):
        for i, record in enumerate[Any](getattr(scene, f"{kind}s") if right(scene, f"{kind}s") else ()):
            with suppress(Unjudged):
                yield from names.not_a_beam(f"{kind}[{i}].beam", record.beam)


def _idle_pins(scene: Scene, names: Names) -> Iterator[FieldError]:
    touching = {contact.node for contact in scene.contacts}
    if any(True for contact in scene.contacts for _ in _touching(contact, names, "")):
        return
    for i, pin in enumerate(scene.pins):
        with suppress(Unjudged):
            if names.place(pin.name) and pin.name not in touching:
                yield FieldError(f"pin[{i}].name", pin.name, "must be the node of a contact")


def _cause(scene: Scene) -> Iterator[FieldError]:
    moving = any(pin.moving for pin in scene.pins) or any(support.moves for support in scene.supports)
    if scene.beams and not (moving or scene.loads or scene.gravity or scene.stages):
        key, value = ("pin[0].displacement", scene.pins[0].displacement) if scene.pins else ("pin", MISSING)
        yield FieldError(key, value, "give a load, or a pin or a support that moves: nothing happens")


def _weight(scene: Scene) -> Iterator[FieldError]:
    heavy = [i for i, beam in enumerate(scene.beams) if beam.density is not None]
    pulled = [i for i, stage in enumerate(scene.stages) if any(stage.gravity)]
    if scene.gravity is None:
        if heavy:
            density = scene.beams[heavy[0]].density
            yield FieldError(f"beam[{heavy[0]}].density", density, "needs gravity in [scene]")
        elif pulled:
            gravity = scene.stages[pulled[0]].gravity
            yield FieldError(f"stage[{pulled[0]}].gravity", gravity, "needs gravity in [scene]")
    elif not heavy:
        yield FieldError("scene.gravity", scene.gravity, "needs the density of a beam")
    elif not (any(scene.gravity) or pulled):
        yield FieldError("scene.gravity", scene.gravity, "must not be zero in every stage")


def _contacts(scene: Scene, names: Names) -> Iterator[FieldError]:
    for i, contact in enumerate(scene.contacts):
        key = f"contact[{i}]"
        yield from _first(_touched(contact, names, key))
        yield from _first(
            _touching(contact, names, key),
            _apart(contact, names, key),
            _has_face(contact, names, key),
            _on_side(contact, names),
            _clear_of_ends(contact, names),
        )


def _first(*rules: Iterator[FieldError]) -> Iterator[FieldError]:
    """Yield the mistakes of the first rule that is broken."""
    for rule in rules:
        with suppress(Unjudged):
            mistakes = list(rule)
            yield from mistakes
            if mistakes:
                return


def _touched(contact: ContactSpec, names: Names, key: str) -> Iterator[FieldError]:
    yield from names.not_a_beam(f"{key}.beam", contact.beam)


def _touching(contact: ContactSpec, names: Names, key: str) -> Iterator[FieldError]:
    if not names.is_node(contact.node):
        rule = f"must name a pin or a beam's end: {listed(names.nodes())}"
        yield FieldError(f"{key}.node", contact.node, rule)
    elif contact.node in (f"{contact.beam}.start", f"{contact.beam}.end"):
        yield FieldError(f"{key}.node", contact.node, "must not be an end of the beam itself")


def _apart(contact: ContactSpec, names: Names, key: str) -> Iterator[FieldError]:
    beam = names.beam(contact.beam)
    if "." in contact.node and _position(contact, names)[1] in (beam.start, beam.end):
        yield FieldError(f"{key}.node", contact.node, f'must not be joined to beam "{beam.name}"')


def _has_face(contact: ContactSpec, names: Names, key: str) -> Iterator[FieldError]:
    if contact.surface == "face" and names.beam(contact.beam).height is None:
        rule = f'needs the height of beam "{contact.beam}"'
        yield FieldError(f"{key}.surface", contact.surface, rule)


def _on_side(contact: ContactSpec, names: Names) -> Iterator[FieldError]:
    beam = names.beam(contact.beam)
    key, position = _position(contact, names)
    _, fraction = signed_gap(beam, contact.side, 0.0, position)
    gap, fraction = signed_gap(beam, contact.side, names.scene.offset(contact, fraction), position)
    if 0.0 <= fraction <= 1.0 and gap < -1e-12 * beam.length:
        where = f'on the {contact.side} of beam "{beam.name}"'
        yield FieldError(key, position, f"must lie {where} ({contact.surface}), gap {gap:.6g}")


def _clear_of_ends(contact: ContactSpec, names: Names) -> Iterator[FieldError]:
    key, position = _position(contact, names)
    for end in free_ends(names.scene, contact):
        over = -end.room(position)
        if over > 1e-12 * names.beam(contact.beam).length:
            where = f'the {end.name} of beam "{contact.beam}"'
            yield FieldError(key, position, f"must lie clear of {where}, overlap {over:.6g}")


def _position(contact: ContactSpec, names: Names) -> tuple[str, Point]:
    """Return the key of the undeformed position of the contact's node, and the position."""
    name, dot, end = contact.node.partition(".")
    place = names.place(name)
    if dot:
        return f"{place}.{end}", names.scene.place(contact.node)
    pin = names.scene.pin(name)
    return f"{place}.{'start' if pin.path is None else 'path'}", pin.points[0]


def signed_gap(beam: BeamSpec, side: str, offset: float, point: Point) -> tuple[float, float]:
    """Return the gap of `point` to the undeformed beam and the fraction of the axis it projects on.

    ``g = s n.(x_c - x_start) - offset`` with n the left normal and s = -1 for a node from the right.
    """
    (tx, ty), (x0, y0) = beam.tangent(0.0), beam.start
    dx, dy = point[0] - x0, point[1] - y0
    sign = 1.0 if side == "left" else -1.0
    if beam.turn:
        left, fraction = _from_arc(beam, (tx * dx + ty * dy, tx * dy - ty * dx))
        return sign * left - offset, fraction
    return sign * (tx * dy - ty * dx) - offset, (tx * dx + ty * dy) / beam.length


def _from_arc(beam: BeamSpec, point: Point) -> Point:
    """Return the distance of a point to the left of an arc and the fraction of its length there; the start is the origin along x."""
    (x, y), k = point, beam.curvature
    far = math.hypot(k * x, k * y - 1.0)
    turned = math.remainder(math.atan2(k * x, 1.0 - k * y) - beam.turn / 2.0, 2.0 * math.pi)
    return (2.0 * y - k * (x * x + y * y)) / (1.0 + far), turned / beam.turn + 0.5
