"""The deflected axis of exact elements between their Gauss nodes, and the angles inside.

When contacts move, open or close, the elements are cut again and the angles interpolated. Where the
integration is not accurate enough, they take more Gauss nodes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation, interpolation
from tsm.elements.properties import Array
from tsm.model.groups.base import Stations
from tsm.model.groups.layout import Layout, layout
from tsm.model.groups.rods import Entry, Rods
from tsm.model.projection import Projection
from tsm.model.state import Cuts, Profile, State, profile_of, touch_of

START_ORDER = 14
"""Gauss nodes of an undeformed element whose accuracy decides on their number."""
_SMOOTH = 1e-13
"""Error of an inner polynomial that counts as round-off."""


class Station(NamedTuple):
    """Points of the axis."""

    position: Array  # position; shape (m, 2)
    angle: Array  # angle of the section from the x axis; shape (m,)
    moment: Array  # bending moment; shape (m,)
    force: Array  # internal force; shape (m, 2)


class RodShape(NamedTuple):
    """Polynomials of angle, moment and position in every segment."""

    place: Layout  # elements of the segments
    arc: Array  # arc position of the start of every segment within the element; shape (s,)
    length: Array  # undeformed length of every segment; shape (s,)
    force: Array  # internal force at the start of every segment; shape (2, s)
    # position (x, y), angle and moment, and the internal force where it varies, at the start and the Gauss nodes;
    # shape (4, s, p + 1) or (6, s, p + 1)
    values: Array

    def at(self, element: Any, arc: Array) -> Station:
        """Stations of one element or of elements (m,), counted over the exact ones, at arc positions (m,) within them."""
        segment, owner = self.place.first[element] + np.zeros(len(arc), int), self.place.owner
        for cut in np.flatnonzero(owner[1:] == owner[:-1]) + 1:
            segment += (element == owner[cut]) & (arc >= self.arc[cut])
        length = self.length[segment]
        return self.within(segment, (arc - self.arc[segment]) / np.where(length, length, 1.0))

    def within(self, segment: Any, sigma: Array) -> Station:
        """Stations at parts sigma (m,) of segments (m,), or of one segment."""
        segment = np.atleast_1d(segment)
        weights = interpolation(self.values.shape[2] - 1, sigma)
        x, y, angle, moment, *varying = (self.values[:, segment] * weights).sum(axis=-1)
        force = np.array(varying) if varying else self.force[:, segment]
        return Station(np.array([x, y]).T, angle, moment, np.broadcast_to(force.T, (len(sigma), 2)))


def plain_shape(group: Rods, state: State, entry: Entry | None = None) -> RodShape:
    """Polynomials through what is known at the Gauss nodes."""
    entry = entry or group.enter(state)
    segments, field, place = entry.segments, entry.field, entry.place
    at = (group.near + state.q[group.dofs[:2]])[:, place.owner]
    for s, _ in place.cuts:
        at[:, s + 1] = at[:, s] + entry.vector[:, s]
    start = np.stack([*at, entry.start[:, 0], entry.moment[:, 0]])
    rates = np.stack([*field.values[1:], turning(entry), field.values[0]])
    force = segments.constant[:, :, 0]
    if segments.course is not None:
        force = force - group.course(segments.owner, segments.begin, state.load_parameter).resultant[:, :, 0]
        start, rates = np.concatenate([start, force]), np.concatenate([rates, -segments.course.load])
    arc, length = segments.begin[:, 0], segments.length[:, 0]
    risen = start[:, :, None] + rates @ segments.table.once.T * length[:, None]
    values = np.concatenate([start[:, :, None], risen], axis=2)
    return RodShape(place, arc, length, force, values)


def turning(entry: Entry) -> Array:
    """Derivatives (s, p) of the angles at the Gauss nodes in the arc position."""
    segments = entry.segments
    moments = rod.moments(segments, entry.field, entry.moment)
    return segments.flexibility[2] * moments + segments.curvature


def pieces(group: Rods, shape: RodShape, element: int, count: int) -> Stations:
    """Lines along an element, `count` for every segment."""
    lines = []
    for s in range(shape.place.first[element], shape.place.last[element] + 1):
        sigma = np.linspace(0, 1, count + 1)
        at = shape.within(s, sigma)
        along = at.force @ (1, 1j) * np.exp(-1j * at.angle)
        forces = np.stack([along.real, along.imag, at.moment], axis=1)
        arc = shape.arc[s] + sigma * shape.length[s]
        lines.append((arc, at.position, at.angle - group.undeformed_angle(element, arc), forces))
    pairs = np.arange(count)[:, None] + np.arange(2)
    return Stations(
        *(np.concatenate([part[pairs] for part in column]) for column in zip(*lines, strict=True))
    )


def _profile(
    group: Rods, state: State, cuts: Cuts, order: int, angle_at: Callable[[Any, Array], Array]
) -> State:
    """State whose angles inside are those of a function of elements (m,) and arc positions (m,) within them."""
    place = layout(len(group.length), cuts)
    begin, end = np.zeros(len(place.owner)), group.length[place.owner]
    for s, k in place.cuts:
        end[s] = begin[s + 1] = touch_of(state, k).xi * group.length[place.owner[s]]
    at = begin[:, None] + (end - begin)[:, None] * collocation(order).c
    angle = angle_at(np.repeat(place.owner, order), at.ravel()).reshape(at.shape)
    return replace(state, profile=Profile(cuts=cuts, angle=angle))


def undeformed(group: Rods, state: State) -> State:
    """State with the angles of the undeformed elements."""
    return _profile(group, state, _cuts(group, state), group.nodes or START_ORDER, group.undeformed_angle)


def _cuts(group: Rods, state: State) -> Cuts:
    """Where touches cut the elements."""
    contacts_on: dict[int, list[tuple[float, int]]] = {}
    for k, (pair, touch) in enumerate(zip(group.model.pairs, state.touches, strict=True)):
        if touch is not None and pair.cuts:
            contacts_on.setdefault(int(group.model.place[touch.element]), []).append((touch.xi, k))
    return tuple((element, tuple(k for _, k in sorted(on))) for element, on in sorted(contacts_on.items()))


def recut(group: Rods, state: State, after: State) -> State:
    """State `after`, which has other touches, with its profile cut where they are; a new touch takes the angle that it finds."""
    cuts = _cuts(group, after)
    if cuts == profile_of(state).cuts:
        return after
    shape, touches, q = plain_shape(group, state), list(after.touches), state.q.copy()
    for element, pairs in cuts:
        for k in pairs:
            old, touch = state.touches[k], touch_of(after, k)
            if old is None:
                angle = shape.at(element, np.array([touch.xi * group.length[element]])).angle[0]
                touches[k] = replace(touch, angle=float(angle))
            elif old.element != touch.element:
                # a contact that passed to another element takes its force along from the starts in between
                first, last = sorted((old.element, touch.element))
                between = group.model.place[first + 1 : last + 1]
                q[group.dofs[3:5, between]] += (
                    np.sign(touch.element - old.element) * np.array(touch.force)[:, None]
                )
    cut = replace(after, q=q, touches=tuple(touches))
    return _profile(group, cut, cuts, profile_of(state).angle.shape[1], lambda e, arc: shape.at(e, arc).angle)


def resampled(group: Rods, state: State, order: int) -> State:
    """State with a number of Gauss nodes."""
    profile = profile_of(state)
    if profile.angle.shape[1] == order:
        return state
    shape = plain_shape(group, state)
    return _profile(group, state, profile.cuts, order, lambda e, arc: shape.at(e, arc).angle)


def truncation(group: Rods, entry: Entry) -> float:
    """Estimated error of the integration, in positions over the longest beam's length and in angles.

    At the ends of a segment the error is the product of two interpolation errors, of the solution and of the
    influence of an error inside; both are measured by the last two Legendre coefficients of moment and
    tangent vector, and both integrations divide by p.
    """
    segments, values = entry.segments, entry.field.values
    order = values.shape[2]
    last = segments.table.legendre[-2:].T
    tail = np.abs(values @ last).max(axis=2)
    length = np.abs(segments.length[:, 0])
    turn = tail[0] * length**2 * segments.flexibility[2].max(axis=1)
    if segments.course is not None:
        turn = np.maximum(turn, np.abs(turning(entry) @ last).max(axis=1) * length)
    largest = np.maximum(turn, tail[1:].max(axis=0) * length / group.model.length).max()
    return float(largest / order) ** 2


def deflected(group: Rods, state: State) -> tuple[RodShape, dict[int, Projection]]:
    """Deflected axis, as accurate between the Gauss nodes as at the ends of the segments, and points found on it.

    With p Gauss nodes the ends of a segment have order 2p, but the polynomial between them has order p. The
    polynomial is therefore computed again with 2p nodes between the same ends.
    """
    if group.memo is None or group.memo[0] is not state:
        entry = group.enter(state)
        if math.sqrt(truncation(group, entry)) > _SMOOTH:
            entry = _finer_inside(group, state)
        group.memo = state, plain_shape(group, state, entry), {}
    return group.memo[1:]


def _finer_inside(group: Rods, state: State) -> Entry:
    """Segments between the same ends, with twice the Gauss nodes."""
    finer = resampled(group, state, 2 * profile_of(state).angle.shape[1])
    entry = group.enter(finer)
    for _ in range(5):
        arrival = rod.arrival(entry.segments, entry.field, entry.start, entry.moment, entry.end)
        if np.abs(arrival.inside).max() < _SMOOTH:
            break
        inner = rod.condense(entry.segments, entry.field, arrival).inner
        profile = profile_of(finer)
        finer = replace(finer, profile=replace(profile, angle=profile.angle + inner[:, :, 6]))
        entry = group.enter(finer)
    return entry
