"""The scene: one file that states beams, supports, loads, pins and contacts for every model."""

from comparisons.scene.beam import BeamSpec
from comparisons.scene.conditions import HingeSpec, LoadSpec, SpringSpec, SupportSpec
from comparisons.scene.contact import ContactSpec, PinSpec
from comparisons.scene.keys import SPECIAL, unstated
from comparisons.scene.read import built_in_scenes, load_scene, read_scene, to_tables, to_toml
from comparisons.scene.rules import FieldError
from comparisons.scene.scene import Scene
from comparisons.scene.stages import PinMove, StageSpec, SupportMove
from comparisons.scene.tables import InputError

__all__ = [
    "SPECIAL",
    "BeamSpec",
    "ContactSpec",
    "FieldError",
    "HingeSpec",
    "InputError",
    "LoadSpec",
    "PinMove",
    "PinSpec",
    "Scene",
    "SpringSpec",
    "StageSpec",
    "SupportMove",
    "SupportSpec",
    "built_in_scenes",
    "load_scene",
    "read_scene",
    "to_tables",
    "to_toml",
    "unstated",
]


def __dir__() -> list[str]:
    return sorted(__all__)
