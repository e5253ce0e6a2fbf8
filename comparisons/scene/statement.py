"""What a scene states: its keys, and the records that names in it mean."""

from collections import defaultdict
from contextlib import suppress
from functools import cached_property
from typing import Any

from comparisons.scene import rules
from comparisons.scene.beam import BeamSpec
from comparisons.scene.conditions import HingeSpec, LoadSpec, SpringSpec, SupportSpec
from comparisons.scene.contact import ContactSpec, PinSpec
from comparisons.scene.record import Record, Unjudged, key, listed, optional
from comparisons.scene.rules import FieldError, Point
from comparisons.scene.stages import StageSpec


class Found(dict[str, tuple[str, Any]]):
    """Records with their places, as ``beam[0]``, by their names; another name raises `Unjudged`, a ``KeyError``."""

    def __missing__(self, name: str) -> tuple[str, Any]:
        raise Unjudged(name)


class Names:
    """Beams and pins by their names, a name that appears twice left out. They are `complete` if all names are right."""

    def __init__(self, scene: "Statement") -> None:
        self.found, self.repeated = {"": Found(), "beam": Found(), "pin": Found()}, list[FieldError]()
        records = [(kind, *one) for kind in ("beam", "pin") for one in enumerate(scene.records(f"{kind}s"))]
        there = defaultdict[str, list[tuple[str, int, Any]]](list)
        for kind, i, record in records:
            if record.has("name"):
                there[record.name].append((kind, i, record))
        for name, ((kind, i, record), *more) in there.items():
            if not more:
                self.found[""][name] = self.found[kind][name] = f"{kind}[{i}]", record
            self.repeated += (FieldError(f"{k}[{j}].name", name, "must not appear twice") for k, j, _ in more)
        self.complete = scene.has("beams", "pins") and len(self.found[""]) == len(records)

    def place(self, name: str) -> str:
        """Return the place of a beam or pin, as ``beam[0]``."""
        return self.found[""][name][0]

    def is_a(self, kind: str, name: str) -> bool:
        """Whether `name` is that of a "beam" or a "pin"."""
        if name not in self.found[kind] and not self.complete:
            raise Unjudged(name)
        return name in self.found[kind]

    def is_node(self, node: str) -> bool:
        """Whether `node` is a pin's name, or a beam's end as ``upper.end``."""
        name, dot, end = node.partition(".")
        return self.is_a("beam" if dot else "pin", name) and (end in ("start", "end") or not dot)


class Statement(Record):
    """The keys of a scene, and what is found by a name."""

    name: str = key(rules.name, "Letters, digits, ``-`` and ``_``.")
    units: str = optional(rules.units, 'Units of force and length, as ``"N, m"``.', "N, m")
    load_parameters: int = key(rules.whole_number, "Number n of load parameters.")
    gravity: Point | None = optional(
        rules.point,
        "Acceleration of gravity at load parameter 1; times a `density` it is a force per volume [length/time^2].",
    )
    beams: tuple[BeamSpec, ...] = key(rules.Records("beam", BeamSpec, at_least=1), "The beams.")
    supports: tuple[SupportSpec, ...] = listed("support", SupportSpec, "The supports.")
    loads: tuple[LoadSpec, ...] = listed("load", LoadSpec, "The loads of the first stage.")
    pins: tuple[PinSpec, ...] = listed("pin", PinSpec, "The pins.")
    contacts: tuple[ContactSpec, ...] = listed("contact", ContactSpec, "The contacts.")
    hinges: tuple[HingeSpec, ...] = listed("hinge", HingeSpec, "The hinges.")
    springs: tuple[SpringSpec, ...] = listed("spring", SpringSpec, "The springs.")
    stages: tuple[StageSpec, ...] = listed("stage", StageSpec, "Stages after the first one.")

    def _settle(self) -> None:
        if self.has("pins"):
            vars(self)["pins"] = tuple(map(self._staged, self.pins))

    def _staged(self, pin: PinSpec) -> PinSpec:
        """Return a pin, wrong values included, with its motions in the stages; None where one is wrong."""
        staged, moves = object.__new__(PinSpec), None
        with suppress(Unjudged):
            moves = tuple({move.name: move for move in stage.pin}.get(pin.name) for stage in self.stages)
        own = {name: value for name, value in vars(pin).items() if name in pin.rules}
        vars(staged).update(own, moves=moves)
        return staged

    @cached_property
    def names(self) -> Names:
        """The beams and pins by their names."""
        return Names(self)

    def beam(self, name: str) -> BeamSpec:
        """Return the beam called `name`."""
        beam: BeamSpec = self.names.found["beam"][name][1]
        return beam

    def pin(self, name: str) -> PinSpec:
        """Return the pin called `name`."""
        pin: PinSpec = self.names.found["pin"][name][1]
        return pin

    def offset(self, contact: ContactSpec, fraction: float = 0.5) -> float:
        """Distance of the contact's node, or of its pin's centre, from the axis where they touch, at a fraction of a beam that tapers."""
        surface = 0.0 if contact.surface == "axis" else self.beam(contact.beam).height_at(fraction) / 2.0
        return surface + self.radius(contact)

    def radius(self, contact: ContactSpec) -> float:
        """Radius of the contact's pin, zero for a point."""
        return 0.0 if "." in contact.node else self.pin(contact.node).radius or 0.0

    @cached_property
    def meeting(self) -> dict[Point, list[tuple[BeamSpec, str]]]:
        """The ends of beams, each its beam and "start" or "end", by their undeformed places; those at one place are joined."""
        meeting = defaultdict[Point, list[tuple[BeamSpec, str]]](list)
        for beam in self.beams:
            meeting[beam.start].append((beam, "start"))
            meeting[beam.end].append((beam, "end"))
        return dict(meeting)

    def joined(self, beam: BeamSpec, end: str) -> bool:
        """Whether another beam shares an end of a beam."""
        return len(self.meeting[getattr(beam, end)]) > 1

    @cached_property
    def all_supports(self) -> tuple[SupportSpec, ...]:
        """The clamped ends of the beams, then `supports`."""
        ends = ((beam.name, end) for beam in self.beams for end in beam.clamped)
        return (*(SupportSpec(beam=name, end=end, kind="clamped") for name, end in ends), *self.supports)

    @property
    def holding(self) -> tuple[SupportSpec | SpringSpec, ...]:
        """The supports and the springs."""
        return (*self.all_supports, *self.springs)

    def place(self, node: str) -> Point:
        """Return the undeformed position of a beam's end, ``upper.end``."""
        name, end = node.split(".")
        beam = self.beam(name)
        return beam.start if end == "start" else beam.end
