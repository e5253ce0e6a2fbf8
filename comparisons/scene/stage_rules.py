"""What the stages of a scene must obey together with its other records."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.scene.conditions import COMPONENTS
from comparisons.scene.rules import FieldError, shown

if TYPE_CHECKING:
    from comparisons.scene.records import Scene
    from comparisons.scene.stages import StageSpec


def check_stages(scene: Scene) -> None:
    """Raise `FieldError` for the first rule that a stage breaks."""
    names = [stage.name for stage in scene.stages]
    for i, stage in enumerate(scene.stages):
        key = f"stage[{i}]."
        if stage.name is not None and stage.name in names[:i]:
            raise FieldError(f"{key}name", stage.name, "must not appear twice")
        _check_pins(scene, stage, key)
        _check_supports(scene, stage, key)
        _check_loads(scene, stage, key)


def _check_pins(scene: Scene, stage: StageSpec, key: str) -> None:
    pins, seen = [pin.name for pin in scene.pins], set()
    for j, move in enumerate(stage.pin):
        if move.name not in pins:
            known = ", ".join(map(shown, pins))
            raise FieldError(f"{key}pin[{j}].name", move.name, f"must name a pin: {known}")
        if move.name in seen:
            raise FieldError(f"{key}pin[{j}].name", move.name, "must not appear twice")
        seen.add(move.name)


def _check_supports(scene: Scene, stage: StageSpec, key: str) -> None:
    supports = {scene.place(support.node): support for support in scene.all_supports}
    seen = set()
    for j, move in enumerate(stage.support):
        where = f"{key}support[{j}]."
        support = None
        if move.beam in {beam.name for beam in scene.beams}:
            support = supports.get(scene.place(move.node))
        if support is None:
            known = ", ".join(shown(support.node) for support in supports.values())
            raise FieldError(f"{where}end", move.node, f"must name an end with a support: {known}")
        if support.node in seen:
            raise FieldError(f"{where}end", move.node, "must not appear twice")
        seen.add(support.node)
        for component, value in zip(COMPONENTS, move.motion, strict=True):
            if value and component not in support.held:
                field = "rotation" if component == "rotation" else "displacement"
                rule = f"must be zero in {component}, which is free"
                raise FieldError(f"{where}{field}", getattr(move, field), rule)


def _check_loads(scene: Scene, stage: StageSpec, key: str) -> None:
    seen = set()
    for j, load in enumerate(stage.load):
        where = f"{key}load[{j}]."
        if load.beam not in {beam.name for beam in scene.beams}:
            known = ", ".join(shown(beam.name) for beam in scene.beams)
            raise FieldError(f"{where}beam", load.beam, f"must name a beam: {known}")
        if load.node in seen:
            raise FieldError(f"{where}{load.key}", load.node, "must not appear twice")
        seen.add(load.node)
