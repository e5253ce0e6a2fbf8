"""What the records of a scene must obey together.

A rule is judged where the values that it reads are right; reading a wrong one raises `comparisons.scene.record.Unjudged`.
"""

import math
from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from comparisons.scene.beam import BeamSpec
from comparisons.scene.conditions import moved_where_free
from comparisons.scene.contact import ContactSpec
from comparisons.scene.ends import free_ends
from comparisons.scene.joints import joint_rules
from comparisons.scene.record import Record, Unjudged
from comparisons.scene.rules import MISSING, FieldError, Mistakes, Point, shown
from comparisons.scene.stages import StageSpec

if TYPE_CHECKING:
    from comparisons.scene.scene import Scene


def scene_rules(scene: "Scene") -> Mistakes:
    """Yield what is wrong between the records of `scene`."""
    names = Names(scene)
    placed = {kind: _listed(scene, f"{kind}s") for kind in ("load", "hinge", "spring")}
    stages = [(f"stage[{i}].", stage) for i, stage in enumerate(_listed(scene, "stages"))]
    placed |= {f"{key}load": _listed(stage, "load") for key, stage in stages}
    on_beams = {"support": _listed(scene, "supports"), **placed}
    for rule in (
        names.repeated,
        _contacts(scene, names),
        _distinct(_listed(scene, "contacts"), "contact", "pair", "node"),
        *(_named(records, place, names) for place, records in on_beams.items()),
        *(_distinct(records, place, "node", "end") for place, records in placed.items()),
        _distinct(_listed(scene, "stages"), "stage", "name", "name"),
        *(_named(_listed(stage, "pin"), f"{key}pin", names, "pin", "name") for key, stage in stages),
        *(_distinct(_listed(stage, "pin"), f"{key}pin", "name", "name") for key, stage in stages),
        *(_moved_supports(scene, stage, f"{key}support") for key, stage in stages),
        joint_rules(scene, names),
        _weight(scene),
        _idle_pins(scene, names),
        _cause(scene),
    ):
        with suppress(Unjudged):
            yield from rule


class Names:
    """Places of beams and pins, as ``beam[0]``, by their names.

    A name that appears twice cannot be judged. A name that nothing has cannot be judged either, where another name is wrong or
    appears twice.
    """

    def __init__(self, scene: "Scene") -> None:
        self.scene = scene
        self._places: dict[str, str] = {}
        self._complete = scene.has("beams", "pins")
        self.repeated: list[FieldError] = []
        for kind in ("beam", "pin"):
            for i, record in enumerate(_listed(scene, f"{kind}s")):
                place = f"{kind}[{i}]"
                if not record.has("name"):
                    self._complete = False
                elif self._places.setdefault(record.name, place) != place:
                    self.repeated.append(FieldError(f"{place}.name", record.name, "must not appear twice"))
        self._twice = {mistake.value for mistake in self.repeated}

    def place(self, name: str) -> str:
        """Return the place of the beam or pin called `name`; raise `Unjudged` if that is none or not clear."""
        if name in self._twice or name not in self._places:
            raise Unjudged(name)
        return self._places[name]

    def is_beam(self, name: str, kind: str = "beam") -> bool:
        """Whether `name` is that of a beam, or of another `kind`; raise `Unjudged` if that is not clear."""
        found = self._places.get(name, "").startswith(kind)
        if name in self._twice or not (found or (self._complete and not self._twice)):
            raise Unjudged(name)
        return found

    def is_node(self, node: str) -> bool:
        """Whether `node` is a pin's name, or a beam's end as ``upper.end``; raise `Unjudged` if that is not clear."""
        name, dot, end = node.partition(".")
        return self.is_beam(name, "beam" if dot else "pin") and (end in ("start", "end") or not dot)

    def beam(self, name: str) -> BeamSpec:
        """Return the beam called `name`; raise `Unjudged` if that is none or not clear."""
        self.place(name)
        return self.scene.beam(name)

    def of(self, kind: str) -> list[str]:
        """Return the names of a kind."""
        return [name for name, place in self._places.items() if place.startswith(kind)]


def _list(names: Iterable[str]) -> str:
    """Return names as they stand in a file, separated by commas."""
    return ", ".join(map(shown, names)) or "there is none"


def _listed(record: Record, field: str) -> Sequence[Any]:
    """Return the records that a field lists; none where it is wrong."""
    records: Sequence[Any] = getattr(record, field) if record.has(field) else ()
    return records


def _distinct(records: Iterable[Record], place: str, attribute: str, key: str) -> Mistakes:
    """Yield the records with the same `attribute` as an earlier one; `key` is its key unless the record states one."""
    seen: set[str] = set()
    for i, record in enumerate(records):
        with suppress(Unjudged):
            value = getattr(record, attribute)
            if value in seen:
                yield FieldError(
                    f"{place}[{i}].{getattr(record, 'key', key)}", value, "must not appear twice"
                )
            seen |= {value} - {None}


def _named(
    records: Iterable[Any], place: str, names: Names, kind: str = "beam", key: str = "beam"
) -> Mistakes:
    """Yield the records whose `key` names none of a kind."""
    for i, record in enumerate(records):
        with suppress(Unjudged):
            name = getattr(record, key)
            if not names.is_beam(name, kind):
                yield FieldError(f"{place}[{i}].{key}", name, f"must name a {kind}: {_list(names.of(kind))}")


def _idle_pins(scene: "Scene", names: Names) -> Mistakes:
    touching = {contact.node for contact in scene.contacts}
    if not all(names.is_node(one.node) and one.node.partition(".")[0] != one.beam for one in scene.contacts):
        return
    for i, pin in enumerate(scene.pins):
        with suppress(Unjudged):
            if names.place(pin.name) and pin.name not in touching:
                yield FieldError(f"pin[{i}].name", pin.name, "must be the node of a contact")


def _cause(scene: "Scene") -> Mistakes:
    moving = any(pin.moving for pin in scene.pins) or any(support.moves for support in scene.supports)
    if scene.beams and not (moving or scene.loads or scene.gravity or scene.stages):
        key, value = ("pin[0].displacement", scene.pins[0].displacement) if scene.pins else ("pin", MISSING)
        yield FieldError(key, value, "give a load, or a pin or a support that moves: nothing happens")


def _weight(scene: "Scene") -> Mistakes:
    heavy = [(f"beam[{i}].density", beam.density) for i, beam in enumerate(scene.beams) if beam.density]
    pulled = [(f"stage[{i}].gravity", one.gravity) for i, one in enumerate(scene.stages) if any(one.gravity)]
    if scene.gravity is None:
        for key, value in (heavy or pulled)[:1]:
            yield FieldError(key, value, "needs gravity in [scene]")
    elif not heavy:
        yield FieldError("scene.gravity", scene.gravity, "needs the density of a beam")
    elif not (any(scene.gravity) or pulled):
        yield FieldError("scene.gravity", scene.gravity, "must not be zero in every stage")


def _contacts(scene: "Scene", names: Names) -> Mistakes:
    yield from _named(scene.contacts, "contact", names)
    for i, contact in enumerate(scene.contacts):
        with suppress(Unjudged):
            yield from _contact(contact, names, f"contact[{i}]")


def _contact(contact: ContactSpec, names: Names, key: str) -> Mistakes:
    """Yield the first mistake of a contact: its node, its surface, and where the node is."""
    if not names.is_node(contact.node):
        ends = (f"{beam}.{end}" for beam in names.of("beam") for end in ("start", "end"))
        rule = f"must name a pin or a beam's end: {_list((*names.of('pin'), *ends))}"
        yield FieldError(f"{key}.node", contact.node, rule)
        return
    beam = names.beam(contact.beam)
    if contact.node in (f"{beam.name}.start", f"{beam.name}.end"):
        yield FieldError(f"{key}.node", contact.node, "must not be an end of the beam itself")
    elif contact.surface == "face" and beam.height is None:
        rule = f'needs the height of beam "{beam.name}"'
        yield FieldError(f"{key}.surface", contact.surface, rule)
    elif "." in contact.node and names.scene.place(contact.node) in (beam.start, beam.end):
        yield FieldError(f"{key}.node", contact.node, f'must not be joined to beam "{beam.name}"')
    else:
        yield from _position(contact, beam, names)


def _position(contact: ContactSpec, beam: BeamSpec, names: Names) -> Mistakes:
    """Yield a mistake where the undeformed position of a contact's node is on the wrong side, or else over an end."""
    name, dot, end = contact.node.partition(".")
    if dot:
        key, position = f"{names.place(name)}.{end}", names.scene.place(contact.node)
    else:
        pin = names.scene.pin(name)
        key, position = f"{names.place(name)}.{'start' if pin.path is None else 'path'}", pin.points[0]
    _, fraction = signed_gap(beam, contact.side, 0.0, position)
    gap, fraction = signed_gap(beam, contact.side, names.scene.offset(contact, fraction), position)
    if 0.0 <= fraction <= 1.0 and gap < -1e-12 * beam.length:
        where = f'on the {contact.side} of beam "{beam.name}"'
        yield FieldError(key, position, f"must lie {where} ({contact.surface}), gap {gap:.6g}")
        return
    for tip in free_ends(names.scene, contact):
        over = -tip.room(position)
        if over > 1e-12 * beam.length:
            where = f'the {tip.name} of beam "{beam.name}"'
            yield FieldError(key, position, f"must lie clear of {where}, overlap {over:.6g}")


def _moved_supports(scene: "Scene", stage: StageSpec, key: str) -> Mistakes:
    supports = {scene.place(support.node): support for support in scene.all_supports}
    beams = {beam.name for beam in scene.beams}
    seen: set[Point] = set()
    for j, move in enumerate(stage.support):
        with suppress(Unjudged):
            place = scene.place(move.node) if move.beam in beams else None
            if place is None or place not in supports:
                known = _list(support.node for support in supports.values())
                yield FieldError(f"{key}[{j}].end", move.node, f"must name an end with a support: {known}")
                continue
            if place in seen:
                yield FieldError(f"{key}[{j}].end", move.node, "must not appear twice")
            seen.add(place)
            wrong = moved_where_free(move, supports[place].held)
            yield from (mistake.within(f"{key}[{j}].") for mistake in wrong)


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
