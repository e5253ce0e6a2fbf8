"""One case of a sweep: a scene, a model and its options, complete and hashable."""

import hashlib
import json
from dataclasses import field
from pathlib import Path
from typing import Any

from comparisons.frozen import Value
from comparisons.models import Model, find
from comparisons.models.model import Options
from comparisons.scene import Scene, to_toml
from comparisons.version import version


class Case(Value):
    """A scene with a model and its options: all that a result depends on.

    Element order, penalty and load steps are entries of the scene, elements and meshes are options. An unknown model is a `ModelError`.
    """

    scene: Scene
    model: str
    options: Options = field(default_factory=Options)

    def _settle(self) -> None:
        find(self.model)

    @property
    def found(self) -> Model:
        """The model itself."""
        return find(self.model)

    @property
    def key(self) -> str:
        """SHA-256 of scene, mesh files, model, options and the version of the sources, in hexadecimal digits."""
        files = [_digest(beam.solid_mesh_file) for beam in self.scene.beams]
        content = {**self.description, "mesh_files": files, "identity": self.found.identity}
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    @property
    def given(self) -> dict[str, Any]:
        """The options that are given."""
        return {name: value for name, value in vars(self.options).items() if value is not None}

    @property
    def description(self) -> dict[str, object]:
        """What the case is, for the file of its result."""
        return {
            "scene": to_toml(self.scene),
            "model": self.found.name,
            "options": self.given,
            "version": version(),
        }

    @property
    def label(self) -> str:
        """Short text for people: ``tsm mixed 10``, ``solid Q2 50x2``."""
        setting = self.found.setting(self.scene, self.options)
        return " ".join(filter(None, (self.found.name, setting, self.options.branch)))

    @property
    def family(self) -> str:
        """Name of the cases that differ from this one in resolution, load steps and contact only."""
        return self.found.family(self.scene, self.options)

    @property
    def resolution(self) -> float:
        """Number of elements along a beam, nan of an exact model."""
        return self.found.resolution(self.options)


def case(scene: Scene, model: Model, **options: Any) -> Case:
    """Return a case of a model with options."""
    return Case(scene=scene, model=model.name, options=Options(**options))


def _digest(mesh_file: str | None) -> str | None:
    """Return a digest of what a mesh file holds; None where there is none, which the solution will say."""
    path = None if mesh_file is None else Path(mesh_file)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path is not None and path.is_file() else None
