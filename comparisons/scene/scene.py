"""A whole scene: what its records must obey together, and what happens over the load parameters.

A rule is judged where the values that it reads are right; reading a wrong one raises `comparisons.scene.record.Unjudged`.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from typing import Any

from comparisons.scene.beam import BeamSpec
from comparisons.scene.conditions import LoadSpec, SupportSpec, moved_where_free
from comparisons.scene.contact import ContactSpec
from comparisons.scene.ends import free_ends
from comparisons.scene.joints import joint_rules
from comparisons.scene.record import Unjudged
from comparisons.scene.rules import MISSING, FieldError, Mistakes, Point, shown
from comparisons.scene.stages import LoadHistory, PrescribedMotion, StageSpec, amount
from comparisons.scene.statement import Names, Statement

PLACED = ("beam", "beam", "node", "end")
LISTS = {"contact": ("beam", "beam", "pair", "node"), "support": ("beam", "beam", "", "")}
LISTS |= {**dict.fromkeys(("load", "hinge", "spring"), PLACED), "stage": ("", "", "name", "name")}
"""For each list of the scene: the key that names something and the kind of thing, then the attribute that is unique in it and its key."""
IN_STAGES = {"pin": ("name", "pin", "name", "name"), "load": PLACED}
"""The same of the lists in a stage."""


def _together(scene: Statement) -> Mistakes:
    """Yield what is wrong between the records of `scene`."""
    for rule in (
        scene.names.repeated,
        *(_contact(one, scene, f"contact[{i}]") for i, one in enumerate(scene.records("contacts"))),
        *(_named(*one, scene.names) for one in _lists(scene)),
        *(_moved_supports(scene, stage, f"{key}support") for key, stage in _stages(scene)),
        joint_rules(scene),
        _weight(scene),
        _idle_pins(scene),
        _cause(scene),
    ):
        with suppress(Unjudged):
            yield from rule


def _list(names: Iterable[str]) -> str:
    """Return names as they stand in a file, separated by commas."""
    return ", ".join(map(shown, names)) or "there is none"


def _stages(scene: Statement) -> Iterator[tuple[str, StageSpec]]:
    yield from ((f"stage[{i}].", stage) for i, stage in enumerate(scene.records("stages")))


def _lists(scene: Statement) -> Iterator[tuple[str, Sequence[Any], tuple[str, str, str, str]]]:
    """Yield the place of every list of records, the records, and what `LISTS` says of them."""
    yield from ((kind, scene.records(f"{kind}s"), how) for kind, how in LISTS.items())
    for key, stage in _stages(scene):
        yield from ((key + kind, stage.records(kind), how) for kind, how in IN_STAGES.items())


def _named(place: str, records: Sequence[Any], how: tuple[str, str, str, str], names: Names) -> Mistakes:
    """Yield the records that name none of a kind, and those with the same attribute as an earlier one."""
    (key, kind, attribute, shared), seen = how, set[str]()
    for i, record in enumerate(records):
        with suppress(Unjudged):
            if key and not names.is_a(kind, name := getattr(record, key)):
                yield FieldError(
                    f"{place}[{i}].{key}", name, f"must name a {kind}: {_list(names.found[kind])}"
                )
        with suppress(Unjudged):
            value = getattr(record, attribute, None)
            if value in seen:
                yield FieldError(
                    f"{place}[{i}].{getattr(record, 'key', shared)}", value, "must not appear twice"
                )
            elif value is not None:
                seen.add(value)


def _idle_pins(scene: Statement) -> Mistakes:
    names = scene.names
    touching = {contact.node for contact in scene.contacts}
    if all(names.is_node(one.node) and one.node.partition(".")[0] != one.beam for one in scene.contacts):
        for i, pin in enumerate(scene.pins):
            with suppress(Unjudged):
                if names.place(pin.name) and pin.name not in touching:
                    yield FieldError(f"pin[{i}].name", pin.name, "must be the node of a contact")


def _cause(scene: Statement) -> Mistakes:
    moving = any(pin.moving for pin in scene.pins) or any(support.moves for support in scene.supports)
    if scene.beams and not (moving or scene.loads or scene.gravity or scene.stages):
        key, value = ("pin[0].displacement", scene.pins[0].displacement) if scene.pins else ("pin", MISSING)
        yield FieldError(key, value, "give a load, or a pin or a support that moves: nothing happens")


def _weight(scene: Statement) -> Mistakes:
    heavy = [(f"beam[{i}].density", beam.density) for i, beam in enumerate(scene.beams) if beam.density]
    pulled = [(f"{key}gravity", stage.gravity) for key, stage in _stages(scene) if any(stage.gravity)]
    if scene.gravity is None:
        yield from (
            FieldError(key, value, "needs gravity in [scene]") for key, value in (heavy or pulled)[:1]
        )
    elif not heavy:
        yield FieldError("scene.gravity", scene.gravity, "needs the density of a beam")
    elif not (any(scene.gravity) or pulled):
        yield FieldError("scene.gravity", scene.gravity, "must not be zero in every stage")


def _contact(contact: ContactSpec, scene: Statement, key: str) -> Mistakes:
    """Yield the first mistake of a contact: its node, its surface, and where the node is."""
    names = scene.names
    if not names.is_node(contact.node):
        ends = (f"{beam}.{end}" for beam in names.found["beam"] for end in ("start", "end"))
        rule = f"must name a pin or a beam's end: {_list((*names.found['pin'], *ends))}"
        yield FieldError(f"{key}.node", contact.node, rule)
        return
    beam = scene.beam(contact.beam)
    if contact.node in (f"{beam.name}.start", f"{beam.name}.end"):
        yield FieldError(f"{key}.node", contact.node, "must not be an end of the beam itself")
    elif contact.surface == "face" and beam.height is None:
        yield FieldError(f"{key}.surface", contact.surface, f'needs the height of beam "{beam.name}"')
    elif "." in contact.node and scene.place(contact.node) in (beam.start, beam.end):
        yield FieldError(f"{key}.node", contact.node, f'must not be joined to beam "{beam.name}"')
    else:
        yield from _position(contact, beam, scene)


def _position(contact: ContactSpec, beam: BeamSpec, scene: Statement) -> Mistakes:
    """Yield a mistake where the undeformed position of a contact's node is on the wrong side, or else over an end."""
    name, dot, end = contact.node.partition(".")
    if dot:
        key, position = end, scene.place(contact.node)
    else:
        pin = scene.pin(name)
        key, position = "start" if pin.path is None else "path", pin.points[0]
    key = f"{scene.names.place(name)}.{key}"
    left, fraction = beam.projected(position)
    gap = (left if contact.side == "left" else -left) - scene.offset(contact, fraction)
    if 0.0 <= fraction <= 1.0 and gap < -1e-12 * beam.length:
        where = f'on the {contact.side} of beam "{beam.name}"'
        yield FieldError(key, position, f"must lie {where} ({contact.surface}), gap {gap:.6g}")
        return
    for tip in free_ends(scene, contact):
        over = -tip.room(position)
        if over > 1e-12 * beam.length:
            where = f'the {tip.name} of beam "{beam.name}"'
            yield FieldError(key, position, f"must lie clear of {where}, overlap {over:.6g}")


def _moved_supports(scene: Statement, stage: StageSpec, key: str) -> Mistakes:
    supports = {scene.place(support.node): support for support in scene.all_supports}
    beams, seen = {beam.name for beam in scene.beams}, set[Point]()
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


class Scene(Statement):
    """Beams with supports and loads, pins and contacts, and the load parameters ``t_k = k/n`` that every model hits exactly.

    Beams whose ends have the same coordinates are rigidly joined there, unless a hinge is between them. The load parameter goes from
    0 to 1, and on by 1 in each of `stages`. Every pin is in a contact. At least one pin, load, weight or moving support is needed, and
    no beam may be free.
    """

    obeys = (_together,)

    @cached_property
    def prescribed_motions(self) -> dict[str, PrescribedMotion]:
        """The motions of `all_supports` through all stages, by supported end."""
        moves = [{self.place(move.node): move.motion for move in stage.support} for stage in self.stages]
        motions = {}
        for support in self.all_supports:
            x, y, rotation = (value or 0.0 for value in support.motion)
            onward = (moved.get(self.place(support.node), (0.0, 0.0, 0.0)) for moved in moves)
            motions[support.node] = PrescribedMotion(support, ((x, y, rotation), *onward))
        return motions

    @property
    def stage_gravities(self) -> tuple[Point, ...]:
        """The change of the acceleration of gravity in every stage."""
        return (self.gravity or (0.0, 0.0), *(stage.gravity for stage in self.stages))

    def gravity_at(self, load_parameter: float) -> Point:
        """Return the acceleration of gravity at `load_parameter`."""
        x, y = amount(self.stage_gravities, load_parameter)
        return x, y

    def numbered_loads(self) -> Iterator[tuple[int, LoadSpec]]:
        """Yield the number of the stage, from 0, of every load, and the load."""
        stages = enumerate((self.loads, *(stage.load for stage in self.stages)))
        yield from ((number, load) for number, loads in stages for load in loads)

    @cached_property
    def load_histories(self) -> tuple[LoadHistory, ...]:
        """The dead loads through all stages, place by place in the order of the file."""
        found: dict[str, LoadHistory] = {}
        for number, load in self.numbered_loads():
            first, amounts = found.get(load.node) or (load, ((0.0, 0.0, 0.0),) * (len(self.stages) + 1))
            found[load.node] = LoadHistory(first, (*amounts[:number], load.amount, *amounts[number + 1 :]))
        return tuple(found.values())

    def supports_of(self, beam: str) -> tuple[SupportSpec, ...]:
        """Return the supports of a beam by falling number of held components; at equality the support at the start is first."""
        own = (support for support in self.all_supports if support.beam == beam)
        return tuple(sorted(own, key=lambda support: (-len(support.held), support.end == "end")))

    def tip(self, beam: str) -> str:
        """Return the end of a beam with fewer held components, "end" at equality."""
        held = [support.end for support in self.supports_of(beam)]
        return "start" if held[:1] == ["end"] else "end"

    @cached_property
    def times(self) -> tuple[float, ...]:
        """The load parameters: ``j + k/n``, k = 1..n, of the stage j = 0, 1, ... with n load parameters."""
        counts = (self.load_parameters, *(stage.load_parameters for stage in self.stages))
        return tuple(before + k / n for before, n in enumerate(counts) for k in range(1, n + 1))
