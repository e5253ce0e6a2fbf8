"""The deflected axis of exact elements between their Gauss nodes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation, interpolation
from tsm.elements.properties import Array
from tsm.rods.assembly import Rods, profile_of
from tsm.rods.records import Entry
from tsm.state import State


class Station(NamedTuple):
    """Points of the axis."""

    position: Array  # position; shape (m, 2)
    angle: Array  # angle of the section from the x axis; shape (m,)
    moment: Array  # bending moment; shape (m,)
    force: Array  # internal force; shape (m, 2)


class Stations(NamedTuple):
    """Short lines along a beam. Neighbours share no point: section forces may jump between them."""

    arc: Array  # distance along the undeformed axis; shape (c, 2)
    position: Array  # deformed position; shape (c, 2, 2)
    rotation: Array  # rotation from the undeformed state; shape (c, 2)
    forces: Array  # axial force, shear force and moment; shape (c, 2, 3)


class RodShape:
    """Polynomials of angle, moment and position in every segment.

    ``first, last`` (r,): first and last segment of every element. ``arc, length`` (s,): arc position of the
    start within the element, and undeformed length, of every segment. ``force`` (2, s): internal force at the
    start of every segment. ``start`` (4, s) or (6, s): position (x, y), angle and moment at the start of
    every segment, and the internal force where it varies. ``rates`` (4, s, p) or (6, s, p): their derivatives
    in the arc position at the Gauss nodes.
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
        stations = Station(*(np.empty((len(arc), *value.shape[1:])) for value in parts[0]))
        for n, part in zip(np.unique(within), parts, strict=True):
            for whole, value in zip(stations, part, strict=True):
                whole[within == n] = value
        return stations

    def within(self, segment: int, sigma: Array) -> Station:
        """Stations at parts sigma (m,) of a segment."""
        x, y, angle, moment, *varying = self.values[:, segment] @ interpolation(self.order, sigma).T
        force = np.empty((len(sigma), 2))
        force[:] = np.array(varying).T if varying else self.force[:, segment]
        return Station(np.array([x, y]).T, angle, moment, force)


def plain_shape(rods: Rods, state: State, entry: Entry) -> RodShape:
    """Polynomials through what is known at the Gauss nodes."""
    segments, field, place = entry.segments, entry.field, entry.place
    x, y = rods.start[:, place.owner] + state.q[rods.dofs[:2]][:, place.owner]
    length = segments.length[:, 0]
    arc = np.zeros(len(length))
    for element, _ in profile_of(state).cuts:
        for s in range(place.first[element], place.last[element]):
            arc[s + 1] = arc[s] + length[s]
            x[s + 1], y[s + 1] = x[s] + entry.vector[0, s], y[s] + entry.vector[1, s]
    start = np.stack([x, y, entry.start[:, 0], entry.moment[:, 0]])
    rates = np.stack([*field.values[1:], rods.turning(entry), field.values[0]])
    force, force_rate = rods.along(entry)
    if force_rate is not None:
        start, rates = np.concatenate([start, force]), np.concatenate([rates, force_rate])
    return RodShape(place.first, place.last, arc, length, force, start, rates)


def tangent_at(rods: Rods, element: int, arc: float, at: Station) -> tuple[Array, Array]:
    """Tangent vector r' of the axis at a single station of an element, and its derivative along the arc."""
    section = rods.section(element, arc)
    x, y = at.force[0].tolist()
    axis = rod.tangent(section.stretch, section.shear, (x, y), float(at.angle[0]))
    turn = section.bend * float(at.moment[0]) + section.curvature
    return np.array(axis.vector), np.array(axis.turned) * turn


def pieces(rods: Rods, shape: RodShape, element: int, count: int) -> Stations:
    """Lines along an element, `count` for every segment."""
    lines = []
    for s in range(shape.first[element], shape.last[element] + 1):
        sigma = np.linspace(0, 1, count + 1)
        at = shape.within(s, sigma)
        c, sn = np.cos(at.angle), np.sin(at.angle)
        nx, ny = at.force.T
        forces = np.stack([nx * c + ny * sn, ny * c - nx * sn, at.moment], axis=1)
        arc = shape.arc[s] + sigma * shape.length[s]
        lines.append((arc, at.position, at.angle - rods.undeformed_angle(element, arc), forces))
    pairs = np.arange(count)[:, None] + np.arange(2)
    return Stations(
        *(np.concatenate([part[pairs] for part in column]) for column in zip(*lines, strict=True))
    )
