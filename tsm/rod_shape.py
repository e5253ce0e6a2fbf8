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
        within = np.searchsorted(self.arc[first + 1 : last + 1], arc, side="right")
        if (within == within[0]).all():
            segment = first + int(within[0])
            length = self.length[segment]
            sigma = (arc - self.arc[segment]) / length if length else np.zeros(len(arc))
            return self.within(segment, sigma)
        parts = [self.at(element, arc[within == n]) for n in range(last - first + 1) if n in within]
        found = Station(*(np.empty((len(arc), *value.shape[1:])) for value in parts[0]))
        for n, part in zip(np.unique(within), parts, strict=True):
            for whole, value in zip(found, part, strict=True):
                whole[within == n] = value
        return found

    def within(self, segment: int, sigma: Array) -> Station:
        """Stations at parts sigma (m,) of a segment."""
        x, y, angle, moment = self.values[:, segment] @ interpolation(self.order, sigma).T
        force = np.empty((len(sigma), 2))
        force[:] = self.force[:, segment]
        return Station(np.array([x, y]).T, angle, moment, force)
