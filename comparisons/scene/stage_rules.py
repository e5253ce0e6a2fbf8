"""What the stages of a scene must obey together with its other records."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from comparisons.scene.conditions import COMPONENTS, SupportSpec
from comparisons.scene.names import Names, listed
from comparisons.scene.record import Unjudged
from comparisons.scene.rules import FieldError, Point

if TYPE_CHECKING:
    from comparisons.scene.records import Scene
    from comparisons.scene.stages import StageSpec, SupportMove


def stage_rules(scene: Scene, names: Names) -> Iterator[FieldError]:
    """Yield what is wrong in stages: names that appear twice, and changes of pins, supports and loads that are not there."""
    seen: set[str] = set()
    for i, stage in enumerate(scene.stages):
        key = f"stage[{i}]."
        with suppress(Unjudged):
            if stage.name in seen:
                yield FieldError(f"{key}name", stage.name, "must not appear twice")
            seen |= {stage.name} if stage.name is not None else set()
        for rule in (_pins(stage, names, key), _supports(scene, stage, key), _loads(stage, names, key)):
            with suppress(Unjudged):
                yield from rule


def _pins(stage: StageSpec, names: Names, key: str) -> Iterator[FieldError]:
    seen: set[str] = set()
    for j, move in enumerate(stage.pin):
        with suppress(Unjudged):
            if not names.is_pin(move.name):
                rule = f"must name a pin: {listed(names.pins())}"
                yield FieldError(f"{key}pin[{j}].name", move.name, rule)
            elif move.name in seen:
                yield FieldError(f"{key}pin[{j}].name", move.name, "must not appear twice")
            seen.add(move.name)


def _supports(scene: Scene, stage: StageSpec, key: str) -> Iterator[FieldError]:
    supports = {scene.place(support.node): support for support in scene.all_supports}
    beams = {beam.name for beam in scene.beams}
    seen: set[Point] = set()
    for j, move in enumerate(stage.support):
        where = f"{key}support[{j}]."
        with suppress(Unjudged):
            place = scene.place(move.node) if move.beam in beams else None
            if place is None or place not in supports:
                known = listed(support.node for support in supports.values())
                yield FieldError(f"{where}end", move.node, f"must name an end with a support: {known}")
                continue
            if place in seen:
                yield FieldError(f"{where}end", move.node, "must not appear twice")
            seen.add(place)
            yield from _held(supports[place], move, where)


def _held(support: SupportSpec, move: SupportMove, where: str) -> Iterator[FieldError]:
    for component, value in zip(COMPONENTS, move.motion, strict=True):
        if value and component not in support.held:
            field = "rotation" if component == "rotation" else "displacement"
            rule = f"must be zero in {component}, which is free"
            yield FieldError(f"{where}{field}", getattr(move, field), rule)


def _loads(stage: StageSpec, names: Names, key: str) -> Iterator[FieldError]:
    seen: set[str] = set()
    for j, load in enumerate(stage.load):
        where = f"{key}load[{j}]."
        with suppress(Unjudged):
            yield from names.not_a_beam(f"{where}beam", load.beam)
        with suppress(Unjudged):
            if load.node in seen:
                yield FieldError(f"{where}{load.key}", load.node, "must not appear twice")
            seen.add(load.node)
