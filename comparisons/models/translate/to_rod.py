"""A scene as one clamped rod in a local frame with the clamp at the origin and the beam along +x; a pin pushes towards +y."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.models.options import ModelError
from comparisons.scene import BeamSpec, ContactSpec, Scene, SupportSpec
from comparisons.scene.keys import ONE_ROD, unstated

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class RodScene:
    """One cantilever under one pin, and the way back to the scene's frame.

    Attributes
    ----------
    beam : BeamSpec
        The cantilever.
    clamp : {"start", "end"}
        The beam's clamped end.
    contact : ContactSpec
        The contact pair.
    offset : float
        Distance of the contact surface from the axis.
    path : ndarray, shape (p, 2)
        Positions of the pin in the local frame: at the start, at the scene's load parameters and at
        the corners of the path.
    hits : ndarray of int, shape (s,)
        Indices of the points of `path` that belong to the load parameters.
    origin, axes : ndarray, shape (2,) and (2, 2)
        Position of the clamp, and the local x and y axes as columns.
    """

    beam: BeamSpec
    clamp: str
    contact: ContactSpec
    offset: float
    path: Array
    hits: NDArray[np.int64]
    origin: Array
    axes: Array

    @property
    def orientation(self) -> float:
        """Determinant of the axes: -1 where the local frame is a mirror image."""
        return float(np.round(np.linalg.det(self.axes)))

    @property
    def from_end(self) -> bool:
        """Whether the clamp is at the beam's end, so that the local x runs from end to start."""
        return self.clamp == "end"

    @property
    def points(self) -> Array:
        """The pin at the scene's load parameters (s, 2)."""
        return self.path[self.hits]

    def position(self, local: Array) -> Array:
        """Return points (..., 2) of the local frame in the scene's."""
        return self.vector(local) + self.origin

    def vector(self, local: Array) -> Array:
        """Return vectors (..., 2) of the local frame in the scene's."""
        return np.asarray(local) @ self.axes.T

    def moment(self, local: Array) -> Array:
        """Return moments of the local frame, anticlockwise positive, in the scene's."""
        return self.orientation * np.asarray(local)

    def arc(self, local: Array) -> Array:
        """Return distances from the clamp as distances from the beam's start."""
        return self.beam.length - np.asarray(local) if self.from_end else np.asarray(local)


def to_rod(scene: Scene) -> RodScene:
    """Return `scene` as the exact models state it.

    Raises
    ------
    ModelError
        Unless the scene is one beam, clamped at one end, under one pin.
    """
    unknown = unstated(scene, "the exact rod", ONE_ROD)
    if unknown is not None:
        raise ModelError(unknown)
    clamp = _clamp(scene)
    pin, contact = scene.pins[0], scene.contacts[0]
    origin, axes = _frame(
        scene, clamp.end, mirrored=contact.side == ("left" if clamp.end == "start" else "right")
    )
    stations = np.union1d(np.array([0.0, *scene.times]), np.array(pin.corners))
    return RodScene(
        beam=scene.beams[0],
        clamp=clamp.end,
        contact=contact,
        offset=scene.offset(contact),
        path=(np.array([pin.position(float(t)) for t in stations]) - origin) @ axes,
        hits=np.searchsorted(stations, scene.times),
        origin=origin,
        axes=axes,
    )


def _clamp(scene: Scene) -> SupportSpec:
    """Return the clamp of the single beam that a single pin touches."""
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
    return clamp


def _frame(scene: Scene, clamp: str, *, mirrored: bool) -> tuple[Array, Array]:
    """Return the clamp and the axes: x from the clamp along the beam, y to its left, or to its right if mirrored."""
    beam = scene.beams[0]
    along = np.array(beam.direction) * (1.0 if clamp == "start" else -1.0)
    left = np.array([-along[1], along[0]])
    return np.array(scene.place(f"{beam.name}.{clamp}")), np.stack(
        [along, -left if mirrored else left], axis=1
    )
