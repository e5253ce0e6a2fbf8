"""One rod, clamped at one end, under one pin: the scene in the rod's frame."""

from typing import Any, NamedTuple

import numpy as np

from comparisons.answer import Array, Ints
from comparisons.models.model import ModelError
from comparisons.scene import Scene, SupportSpec
from comparisons.scene.keys import unstated


class RodScene(NamedTuple):
    """One cantilever under one pin in a local frame: the clamp at the origin, the beam along +x, the pin pushes towards +y."""

    scene: Scene
    clamp: SupportSpec
    path: Array  #: Places (p, 2) of the pin: at the start, at the load parameters and at the corners of its path.
    hits: Ints  #: Indices (s,) of the load parameters among them.
    axes: Array  #: The local x and y axes (2, 2) as columns.

    @property
    def sense(self) -> int:
        """1 where the local x runs from the beam's start to its end, -1 where it runs from end to start."""
        return 1 if self.clamp.end == "start" else -1

    def position(self, local: Array) -> Array:
        """Return points (..., 2) of the local frame in the scene's."""
        return local @ self.axes.T + self.scene.place(self.clamp.node)

    def arc(self, local: Any) -> Any:
        """Return distances from the clamp as distances from the beam's start."""
        return local if self.sense > 0 else self.scene.beams[0].length - local


def to_rod(scene: Scene, who: str = "the exact rod") -> RodScene:
    """Return `scene` as the exact models state it; `who` refuses it.

    Raises
    ------
    ModelError
        Unless the scene is one beam, clamped at one end, under one pin.
    """
    if (unknown := unstated(scene, who)) is not None:
        raise ModelError(unknown)
    have, beam = "the exact models have", scene.beams[0]
    if max(len(scene.beams), len(scene.pins), len(scene.contacts)) > 1:
        raise ModelError(f"{have} one beam, one pin and one contact")
    if scene.loads:
        raise ModelError(f'{have} no dead loads, the scene loads "{scene.loads[0].node}"')
    clamp, *others = scene.supports_of(beam.name)
    if len(clamp.held) < 3:
        raise ModelError(f'{have} one end clamped, none of beam "{beam.name}" is')
    if scene.prescribed_motions[clamp.node].moves:
        raise ModelError(f'{have} the clamp at rest, "{clamp.node}" moves')
    if others:
        raise ModelError(f'{have} one support, beam "{beam.name}" has two')
    pin, contact = scene.pins[0], scene.contacts[0]
    (c, s), along = beam.direction, 1.0 if clamp.end == "start" else -1.0
    left = 1.0 if contact.side == "right" else -1.0
    axes = np.array([[along * c, -left * s], [along * s, left * c]])
    stations = np.union1d([0.0, *scene.times], pin.corners)
    path = (np.array([pin.position(float(t)) for t in stations]) - scene.place(clamp.node)) @ axes
    return RodScene(scene, clamp, path, np.searchsorted(stations, scene.times), axes)
