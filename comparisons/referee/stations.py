"""Stations of the rods: ends of beams, joints, contacts, and places inside a beam; and hinges between them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NONE = -1
"""Index of a quantity that is prescribed and not unknown."""


@dataclass(frozen=True, kw_only=True)
class Position:
    """A position, the sum of a reference position and a displacement with prescribed or unknown components.

    Attributes
    ----------
    reference : (float, float)
        Undeformed position, or the position of a pin. It may be far larger than the displacement.
    prescribed : (float, float)
        Prescribed displacement.
    unknown : (int, int)
        Indices of the unknown displacements; `NONE` for a prescribed component.
    """

    reference: tuple[float, float]
    prescribed: tuple[float, float] = (0.0, 0.0)
    unknown: tuple[int, int] = (NONE, NONE)

    def displacement(self, z: Array) -> Array:
        """Return the displacement."""
        return np.array(
            [z[k] if k != NONE else g for g, k in zip(self.prescribed, self.unknown, strict=True)]
        )

    def position(self, z: Array) -> Array:
        """Return the position."""
        return np.array(self.reference) + self.displacement(z)


@dataclass(frozen=True, kw_only=True)
class Station:
    """An end of a beam, a joint, a contact, or a place inside a beam.

    Attributes
    ----------
    place : Position
        Position of the axis; for a contact, position of the touching point.
    rotation_unknown : int
        Index of the unknown rotation; `NONE` if the rotation is prescribed.
    prescribed_rotation : float
        Prescribed rotation.
    force, moment
        Dead load. At the end of a beam the force includes the resultant of the load along the beam, since the part has c = n + W there.
    touch : int
        Index of the contact; `NONE` for an end.
    ends : tuple of str
        Ends of beams that are rigidly attached to the station.
    joint : tuple of str
        Ends of all beams at a joint, with those behind a hinge; empty for other stations.
    springs : (float, float, float)
        Stiffnesses against displacement and rotation.
    arc : float or None
        Arc position of a place inside a beam; None for other stations.
    """

    place: Position
    rotation_unknown: int
    prescribed_rotation: float = 0.0
    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0
    touch: int = NONE
    ends: tuple[str, ...] = ()
    joint: tuple[str, ...] = ()
    springs: tuple[float, float, float] = (0.0, 0.0, 0.0)
    arc: float | None = None


@dataclass(frozen=True, kw_only=True)
class Hinge:
    """A hinge between the stations `end`, of the beam's end, and `joint`, with a rotational spring."""

    end: int
    joint: int
    stiffness: float
