"""The record of a whole scene, which checks the rules between its records at construction."""

from collections.abc import Iterator
from functools import cached_property

from comparisons.scene import rules
from comparisons.scene.beam import BeamSpec
from comparisons.scene.coherence import Names, scene_rules
from comparisons.scene.conditions import HingeSpec, LoadSpec, SpringSpec, SupportSpec
from comparisons.scene.contact import ContactSpec, PinSpec
from comparisons.scene.record import Record, Unjudged, copied, key, listed, optional
from comparisons.scene.rules import Point
from comparisons.scene.stages import LoadHistory, PinMove, PrescribedMotion, StageSpec, amount


class Scene(Record):
    """Beams with supports and loads, pins and contacts, and the load parameters ``t_k = k/n`` that every model hits exactly.

    Beams whose ends have the same coordinates are rigidly joined there, unless a hinge is between them. The load parameter goes from
    0 to 1, and on by 1 in each of `stages`. Every pin is in a contact. At least one pin, load, weight or moving support is needed, and
    no beam may be free.
    """

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

    obeys = (scene_rules,)

    def _settle(self) -> None:
        if self.has("pins"):
            vars(self)["pins"] = tuple(copied(pin, moves=self._moves(pin)) for pin in self.pins)

    def _moves(self, pin: PinSpec) -> tuple[PinMove | None, ...] | None:
        """Return the motions of a pin in the stages; None where one is wrong."""
        try:
            return tuple({move.name: move for move in stage.pin}.get(pin.name) for stage in self.stages)
        except Unjudged:
            return None

    @cached_property
    def names(self) -> Names:
        """The beams and pins by their names."""
        return Names(self)

    def beam(self, name: str) -> BeamSpec:
        """Return the beam called `name`."""
        beam: BeamSpec = self.names.record("beam", name)
        return beam

    def pin(self, name: str) -> PinSpec:
        """Return the pin called `name`."""
        pin: PinSpec = self.names.record("pin", name)
        return pin

    def offset(self, contact: ContactSpec, fraction: float = 0.5) -> float:
        """Distance of the contact's node, or of its pin's centre, from the axis where they touch, at a fraction of a beam that tapers."""
        surface = 0.0 if contact.surface == "axis" else self.beam(contact.beam).height_at(fraction) / 2.0
        return surface + self.radius(contact)

    def radius(self, contact: ContactSpec) -> float:
        """Radius of the contact's pin, zero for a point."""
        return 0.0 if "." in contact.node else self.pin(contact.node).radius or 0.0

    @cached_property
    def all_supports(self) -> tuple[SupportSpec, ...]:
        """The clamped ends of the beams, then `supports`."""
        ends = ((beam.name, end) for beam in self.beams for end in beam.clamped)
        return (*(SupportSpec(beam=name, end=end, kind="clamped") for name, end in ends), *self.supports)

    @property
    def holding(self) -> tuple[SupportSpec | SpringSpec, ...]:
        """The supports and the springs."""
        return (*self.all_supports, *self.springs)

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
            rest = ((0.0, 0.0, 0.0),) * (len(self.stages) + 1)
            first, amounts = found.setdefault(load.node, LoadHistory(load, rest))
            found[load.node] = LoadHistory(first, (*amounts[:number], load.amount, *amounts[number + 1 :]))
        return tuple(found.values())

    def place(self, node: str) -> Point:
        """Return the undeformed position of a beam's end, ``upper.end``."""
        name, end = node.split(".")
        beam = self.beam(name)
        return beam.start if end == "start" else beam.end

    def supports_of(self, beam: str) -> tuple[SupportSpec, ...]:
        """Return the supports of a beam by falling number of held components; at equality the support at the start is first."""
        own = (support for support in self.all_supports if support.beam == beam)
        return tuple(sorted(own, key=lambda support: (-len(support.held), support.end == "end")))

    def tip(self, beam: str) -> str:
        """Return the end of a beam with fewer held components, "end" at equality."""
        own = self.supports_of(beam)
        more = bool(own) and own[0].end == "end" and (len(own) == 1 or own[0].held != own[1].held)
        return "start" if more else "end"

    @cached_property
    def times(self) -> tuple[float, ...]:
        """The load parameters: ``j + k/n``, k = 1..n, of the stage j = 0, 1, ... with n load parameters."""
        counts = (self.load_parameters, *(stage.load_parameters for stage in self.stages))
        return tuple(before + k / n for before, n in enumerate(counts) for k in range(1, n + 1))
