"""The deflected axis of exact elements between their Gauss nodes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.collocation import collocation, interpolation
from tsm.elements.properties import Array


class Station(NamedTuple):
    """Points of the axis.

    Attributes
    ----------
    position : ndarray, shape (m, 2)
        Position.
    angle : ndarray, shape (m,)
        Angle of the section from the x axis.
    moment : ndarray, shape (m,)
        Bending moment.
    force : ndarray, shape (m, 2)
        Internal force.
    """

    position: Array
    angle: Array
    moment: Array
    force: Array


class Stations(NamedTuple):
    """Short lines along a beam, each with its own two ends: section forces may jump from one to the next.

    Attributes
    ----------
    arc : ndarray, shape (c, 2)
        Distance along the undeformed axis.
    position : ndarray, shape (c, 2, 2)
        Deformed position.
    rotation : ndarray, shape (c, 2)
        Rotation from the undeformed state.
    forces : ndarray, shape (c, 2, 3)
        Axial force, shear force and moment.
    """

    arc: Array
    position: Array
    rotation: Array
    forces: Array


class RodShape:
    """Polynomials of angle, moment and position in every segment.

    Parameters
    ----------
    first, last : ndarray of int, shape (r,)
        First and last segment of every element.
    arc, length : ndarray, shape (s,)
        Arc position of the start within the element, and undeformed length, of every segment.
    force : ndarray, shape (2, s)
        Internal force of every segment.
    start : ndarray, shape (4, s)
        Position (x, y), angle and moment at the start of every segment.
    rates : ndarray, shape (4, s, p)
        Their derivatives in the arc position at the Gauss nodes.
    """

    def __init__(
        self,
        first: Array,
        last: Array,
        arc: Array,
        length: Array,
        force: Array,
        start: Array,
        rates: Array,
    ) -> None:
        self.first, self.last, self.arc, self.length, self.force = first, last, arc, length, force
        self.order = rates.shape[2]
        risen = start[:, :, None] + rates @ collocation(self.order).once.T * length[:, None]
        self.values = np.concatenate([start[:, :, None], risen], axis=2)

    def at(self, element: int, arc: Array) -> Station:
        """Stations of an element, counted over the exact ones, at arc positions (m,) within it."""
        first, last = int(self.first[element]), int(self.last[element])
        segment = first + np.searchsorted(self.arc[first + 1 : last + 1], arc, side="right")
        length = self.length[segment]
        sigma = np.divide(arc - self.arc[segment], length, out=np.zeros(len(arc)), where=length != 0)
        return self.within(segment, sigma)

    def within(self, segment: Array | int, sigma: Array) -> Station:
        """Stations at parts sigma (m,) of segments: one, or one for each."""
        segment = np.broadcast_to(segment, sigma.shape)
        x, y, angle, moment = np.einsum(
            "mp,imp->im", interpolation(self.order, sigma), self.values[:, segment]
        )
        return Station(np.stack([x, y], axis=1), angle, moment, self.force[:, segment].T)
