"""Stages that follow the first one of a scene: what they move on from where the stage before ended."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated

from comparisons.scene import rules
from comparisons.scene.amounts import amount
from comparisons.scene.conditions import COMPONENTS, AtEnd, LoadSpec, SupportSpec
from comparisons.scene.record import Record, exactly_one_of
from comparisons.scene.rules import MISSING, Count, FieldError, Name, Number, Point, Vector


@dataclass(frozen=True, kw_only=True)
class PinMove(Record):
    """A pin's motion during a stage, at constant speed by the load parameter.

    Parameters
    ----------
    name : str
        Name of the pin.
    displacement : (float, float)
        A straight motion from where the pin is [length].
    path : tuple of (float, float)
        The points that the pin moves to, one after another, instead of `displacement` [length].

    Raises
    ------
    FieldError
        A ``ValueError`` that names field, value and rule.
    """

    name: Name
    displacement: Vector | None = None
    path: Annotated[tuple[Point, ...], rules.further_points] | None = None

    def own_rules(self) -> Iterable[Iterator[FieldError]]:
        """Return the rules: one way to state the motion, and a displacement that is not zero."""
        return exactly_one_of(self, ("displacement",), ("path",)), self._moves()

    def _moves(self) -> Iterator[FieldError]:
        if self.displacement is not None and not any(self.displacement):
            yield FieldError("displacement", self.displacement, "must not be zero: the pin does not move")


@dataclass(frozen=True, kw_only=True)
class SupportMove(AtEnd):
    """A support's motion during a stage, in proportion to the load parameter.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"}
        Which end; it has a support.
    displacement : (float, float)
        Displacement during the stage [length]; zero in a free direction.
    rotation : float
        Rotation during the stage, anticlockwise [rad].

    Raises
    ------
    FieldError
        A ``ValueError`` that names field, value and rule.
    """

    displacement: Vector = (0.0, 0.0)
    rotation: Number = 0.0

    def own_rules(self) -> Iterable[Iterator[FieldError]]:
        """Return the rule: the support moves."""
        return (self._moves(),)

    def _moves(self) -> Iterator[FieldError]:
        if not any(self.motion):
            yield FieldError("displacement", self.displacement, "displacement or rotation must not be zero")

    @property
    def motion(self) -> tuple[float, float, float]:
        """Displacement x, y and rotation during the stage."""
        return (*self.displacement, self.rotation)


@dataclass(frozen=True, kw_only=True)
class StageSpec(Record):
    """A stage after the first one: pins, supports and loads change on from where the stage before ended; all others rest.

    The first stage is the scene without its stages, at load parameters from 0 to 1. The stages follow in the order of the file, the
    second one at load parameters from 1 to 2.

    Parameters
    ----------
    name : str, optional
        Letters, digits, ``-`` and ``_``.
    load_parameters : int
        Number of load parameters of the stage, equally spaced.
    pin : tuple of PinMove
        Motions of pins, as ``[{ name = "pin", displacement = [0.0, -0.1] }]``; `path` is possible instead of `displacement`.
    support : tuple of SupportMove
        Motions of supports, as ``[{ beam = "strip", end = "end", displacement = [0.0, 0.1], rotation = 0.0 }]``.
    load : tuple of LoadSpec
        Changes of loads, as ``[{ beam = "strip", end = "end", force = [0.0, 1.0] }]``, with the keys of ``[[load]]``.
    gravity : (float, float)
        Change of the acceleration of gravity [length/time^2].

    Raises
    ------
    FieldError
        A ``ValueError`` that names field, value and rule.
    """

    name: Name | None = None
    load_parameters: Count
    pin: Annotated[tuple[PinMove, ...], rules.records(PinMove)] = ()
    support: Annotated[tuple[SupportMove, ...], rules.records(SupportMove)] = ()
    load: Annotated[tuple[LoadSpec, ...], rules.records(LoadSpec)] = ()
    gravity: Vector = (0.0, 0.0)

    def own_rules(self) -> Iterable[Iterator[FieldError]]:
        """Return the rule: something changes."""
        return (self._changes(),)

    def _changes(self) -> Iterator[FieldError]:
        if not (self.pin or self.support or self.load or any(self.gravity)):
            yield FieldError(
                "pin", MISSING, "give pin, support, load or gravity: nothing happens in the stage"
            )


@dataclass(frozen=True, kw_only=True)
class PrescribedMotion:
    """The prescribed motion of a support through all stages.

    Parameters
    ----------
    support : SupportSpec
        The support.
    increments : tuple of (float, float, float)
        Change of displacement x, y and rotation in every stage, zero where free.
    """

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


@dataclass(frozen=True, kw_only=True)
class LoadHistory:
    """A load through all stages.

    Parameters
    ----------
    load : LoadSpec
        Where the load acts, with the amounts of the first stage that states it.
    increments : tuple of (float, float, float)
        Change of force x, y and moment in every stage; for a load per length, change of the force per length and zero.
    """

    load: LoadSpec
    increments: tuple[tuple[float, float, float], ...]

    def at(self, load_parameter: float) -> tuple[float, ...]:
        """Return force x, y and moment, or the force per length and zero, at `load_parameter`."""
        return amount(self.increments, load_parameter)


def load_histories(stages: tuple[tuple[LoadSpec, ...], ...]) -> tuple[LoadHistory, ...]:
    """Return the loads of all stages, place by place in the order of the file."""
    first: dict[str, LoadSpec] = {}
    for load in (load for loads in stages for load in loads):
        first.setdefault(load.node, load)
    amounts = [{load.node: load.amount for load in loads} for loads in stages]
    return tuple(
        LoadHistory(load=load, increments=tuple(given.get(node, (0.0, 0.0, 0.0)) for given in amounts))
        for node, load in first.items()
    )
