"""The scene: one file that states beams, pins and contacts for every model."""

from comparisons.scene.read import SceneError, built_in_scenes, load_scene, read_scene
from comparisons.scene.records import BeamSpec, ContactSpec, PinSpec, Scene
from comparisons.scene.rules import FieldError
from comparisons.scene.toml import to_toml

__all__ = [
    "BeamSpec",
    "ContactSpec",
    "FieldError",
    "PinSpec",
    "Scene",
    "SceneError",
    "built_in_scenes",
    "load_scene",
    "read_scene",
    "to_toml",
]
