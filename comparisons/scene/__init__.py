"""The scene: one file that states beams, supports, loads, pins and contacts for every model."""

from comparisons.scene.conditions import LoadSpec, SupportSpec
from comparisons.scene.contact import ContactSpec, PinSpec
from comparisons.scene.read import built_in_scenes, load_scene, read_scene
from comparisons.scene.records import BeamSpec, Scene
from comparisons.scene.rules import FieldError
from comparisons.scene.tables import InputError, SceneError
from comparisons.scene.toml import to_tables, to_toml

__all__ = [
    "BeamSpec",
    "ContactSpec",
    "FieldError",
    "InputError",
    "LoadSpec",
    "PinSpec",
    "Scene",
    "SceneError",
    "SupportSpec",
    "built_in_scenes",
    "load_scene",
    "read_scene",
    "to_tables",
    "to_toml",
]
