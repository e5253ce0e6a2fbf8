"""A scene as one clamped rod in its local frame: clamp at the origin, beam along +x, the pin pushes to +y."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.options import ModelError
from comparisons.scene import BeamSpec, Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class RodScene:
    """One cantilever under one pin, and the way back to the scene's frame.

    Attributes
    ----------
    beam : BeamSpec
        The cantilever.
    pair : str
        Name of the contact pair.
    offset : float
        Distance of the contact surface from the axis.
    path : ndarray, shape (p, 2)
        The pin's start, its positions at the scene's load parameters and its corners, in the local frame.
    hits : ndarray of int, shape (s,)
        Those points of `path` that belong to the load parameters.
    origin, axes : ndarray, shape (2,) and (2, 2)
        The clamp; the local x and y axes as columns.
    """

    beam: BeamSpec
    pair: str
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
        return self.beam.clamped == ("end",)

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
    if len(scene.beams) > 1 or len(scene.pins) > 1 or len(scene.contacts) > 1:
        raise ModelError("the exact models have one beam, one pin and one contact")
    beam, pin, contact = scene.beams[0], scene.pins[0], scene.contacts[0]
    if len(beam.clamped) != 1:
        raise ModelError(f'the exact models clamp one end, beam "{beam.name}" has two')
    along = np.array(beam.direction) * (1.0 if beam.clamped == ("start",) else -1.0)
    left = np.array([-beam.direction[1], beam.direction[0]])
    axes = np.stack([along, left if contact.side == "right" else -left], axis=1)
    origin = np.array(beam.start if beam.clamped == ("start",) else beam.end)
    stations = np.union1d(np.array([0.0, *scene.times]), np.array(pin.corners))
    return RodScene(
        beam=beam,
        pair=contact.pair,
        offset=scene.offset(contact),
        path=(np.array([pin.position(float(t)) for t in stations]) - origin) @ axes,
        hits=np.searchsorted(stations, scene.times),
        origin=origin,
        axes=axes,
    )
