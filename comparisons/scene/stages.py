"""Stages that follow the first one of a scene: what they move on from where the stage before ended."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from comparisons.scene import rules
from comparisons.scene.conditions import COMPONENTS, END, AtEnd, LoadSpec, SupportSpec
from comparisons.scene.record import Record, key, listed, one_of, optional, refused
from comparisons.scene.rules import Point

AT_REST = "must not be zero: the pin does not move"
IDLE = "give pin, support, load or gravity: nothing happens in the stage"


class PinMove(Record):
    """A pin's motion during a stage, at constant speed by the load parameter."""

    name: str = key(rules.name, "Name of the pin.")
    displacement: Point | None = optional(rules.point, "A straight motion from where the pin is [length].")
    path: tuple[Point, ...] | None = optional(
        rules.polyline(1), "The points that the pin moves to in turn, instead of `displacement` [length]."
    )

    obeys = (
        one_of(("displacement",), ("path",)),
        refused("displacement", AT_REST, lambda it: it.displacement == (0.0, 0.0)),
    )


class SupportMove(AtEnd):
    """A support's motion during a stage, in proportion to the load parameter."""

    end: str = key(END, "Which end; it has a support.")
    displacement: Point = optional(
        rules.point, "Displacement during the stage [length]; zero in a free direction.", (0.0, 0.0)
    )
    rotation: float = optional(rules.number, "Rotation during the stage, anticlockwise [rad].", 0.0)

    obeys = (
        refused("displacement", "displacement or rotation must not be zero", lambda it: not any(it.motion)),
    )

    @property
    def motion(self) -> tuple[float, float, float]:
        """Displacement x, y and rotation during the stage."""
        return (*self.displacement, self.rotation)


class StageSpec(Record):
    """A stage after the first one: pins, supports and loads change on from where the stage before ended; all others rest.

    The first stage is the scene without its stages, at load parameters from 0 to 1. The stages follow in the order of the file, the
    second one at load parameters from 1 to 2.
    """

    name: str | None = optional(rules.name, "Letters, digits, ``-`` and ``_``.")
    load_parameters: int = key(rules.whole_number, "Number of load parameters of the stage, equally spaced.")
    pin: tuple[PinMove, ...] = listed(
        "pin",
        PinMove,
        'Motions of pins, as ``[{ name = "pin", displacement = [0.0, -0.1] }]``, or with a `path`.',
    )
    support: tuple[SupportMove, ...] = listed(
        "support",
        SupportMove,
        'Motions of supports: ``[{ beam = "strip", end = "end", displacement = [0.0, 0.1] }]``, or a `rotation`.',
    )
    load: tuple[LoadSpec, ...] = listed(
        "load",
        LoadSpec,
        'Changes of loads: ``[{ beam = "strip", end = "end", force = [0.0, 1.0] }]``, or other keys of ``[[load]]``.',
    )
    gravity: Point = optional(
        rules.point, "Change of the acceleration of gravity [length/time^2].", (0.0, 0.0)
    )

    obeys = (refused("pin", IDLE, lambda it: not (it.pin or it.support or it.load or any(it.gravity))),)


def stage_of(load_parameter: float, stages: int) -> int:
    """Return the number from 0 of the stage at `load_parameter`; at a boundary, the one that ends."""
    return min(max(math.ceil(load_parameter) - 1, 0), stages - 1)


def amount(increments: Sequence[tuple[float, ...]], load_parameter: float) -> tuple[float, ...]:
    """Return quantities that rise from zero by `increments[k]` in the stage k, in proportion to the load parameter."""
    stage = stage_of(load_parameter, len(increments))
    part = load_parameter - stage
    return tuple(math.fsum(every[:stage]) + part * every[stage] for every in zip(*increments, strict=True))


class PrescribedMotion(NamedTuple):
    """The prescribed motion of a support through all stages: its change in every stage, zero where free."""

    support: SupportSpec
    increments: tuple[tuple[float, float, float], ...]

    @property
    def moves(self) -> bool:
        """Whether a component changes in some stage."""
        return any(map(any, self.increments))

    def at(self, load_parameter: float) -> tuple[float | None, float | None, float | None]:
        """Return displacement x, y and rotation at `load_parameter`, None where free."""
        values = zip(COMPONENTS, amount(self.increments, load_parameter), strict=True)
        x, y, rotation = (value if name in self.support.held else None for name, value in values)
        return x, y, rotation


class LoadHistory(NamedTuple):
    """A load, as the first stage states it that has it, and the change of its `LoadSpec.amount` in every stage."""

    load: LoadSpec
    increments: tuple[tuple[float, float, float], ...]

    def at(self, load_parameter: float) -> tuple[float, ...]:
        """Return force x, y and moment, or the force per length and zero, at `load_parameter`."""
        return amount(self.increments, load_parameter)
