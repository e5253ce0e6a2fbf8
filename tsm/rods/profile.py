"""Inner angles of the exact elements. When contacts move, open or close, the elements are cut again and the angles interpolated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.rods.assembly import Rods, profile_of, touch_of
from tsm.rods.layout import layout
from tsm.rods.shape import RodShape, plain_shape
from tsm.state import Cuts, Profile, State, Touch

START_ORDER = 14
"""Gauss nodes of an undeformed element whose accuracy decides on their number."""


def cuts_of(rods: Rods, touches: tuple[Touch | None, ...]) -> Cuts:
    """Where touches cut the elements."""
    contacts_on: dict[int, list[tuple[float, int]]] = {}
    for k, (pair, touch) in enumerate(zip(rods.model.pairs, touches, strict=True)):
        if touch is not None and pair.cuts:
            contacts_on.setdefault(int(rods.model.place[touch.element]), []).append((touch.xi, k))
    return tuple((element, tuple(k for _, k in sorted(on))) for element, on in sorted(contacts_on.items()))


def undeformed(rods: Rods, touches: tuple[Touch | None, ...]) -> Profile:
    """Profile of the undeformed elements."""
    cuts = cuts_of(rods, touches)
    order = rods.nodes or START_ORDER
    place, nodes, inside = layout(len(rods.length), cuts), collocation(order).c, dict(cuts)
    angle = np.empty((len(place.owner), order))
    for element, (first, last) in enumerate(zip(place.first, place.last, strict=True)):
        places = (touches[k] for k in inside.get(element, ()))
        ends = np.array([0.0, *(touch.xi for touch in places if touch is not None), 1.0])
        arcs = (ends[:-1, None] + np.diff(ends)[:, None] * nodes) * rods.length[element]
        angle[first : last + 1] = rods.undeformed_angle(element, arcs)
    return Profile(cuts=cuts, angle=angle)


def recut(rods: Rods, state: State, after: State) -> State:
    """State `after`, which has other touches, with its profile cut where they are; a new touch takes the angle that it finds."""
    touches = after.touches
    cuts = cuts_of(rods, touches)
    if cuts == profile_of(state).cuts:
        return after
    shape, touches_at_cuts, q = plain_shape(rods, state, rods.enter(state)), list(touches), state.q.copy()
    for element, pairs in cuts:
        for k in pairs:
            old, touch = state.touches[k], touches[k]
            assert touch is not None, "a cut is a closed contact"
            if old is None:
                angle = shape.at(element, np.array([touch.xi * rods.length[element]])).angle[0]
                touches_at_cuts[k] = replace(touch, angle=float(angle))
            else:
                _shift(rods, q, old.element, touch)
    cut = replace(after, q=q, touches=tuple(touches_at_cuts))
    return sampled(rods, shape, cut, cuts, profile_of(state).angle.shape[1])


def _shift(rods: Rods, q: Array, before: int, touch: Touch) -> None:
    """Correct the element forces for a contact that passed to another element: add or subtract its force at the starts in between."""
    first, last = sorted((before, touch.element))
    sign = 1 if touch.element > before else -1
    for element in range(first + 1, last + 1):
        q[rods.dofs[3:5, rods.model.place[element]]] += sign * np.array(touch.force)


def alike(rods: Rods, history: list[State]) -> list[State]:
    """The latest states that are cut alike, with as many Gauss nodes as the last."""
    cuts, order = profile_of(history[-1]).cuts, profile_of(history[-1]).angle.shape[1]
    states: list[State] = []
    for state in reversed(history):
        if profile_of(state).cuts != cuts:
            break
        same = profile_of(state).angle.shape[1] == order
        states.insert(0, state if same else resampled(rods, state, order))
    return states


def angles_at(rods: Rods, state: State, like: State) -> Array:
    """Angles (s, p) inside at the Gauss nodes of another state, nan in elements that are cut otherwise there."""
    there, order = profile_of(like), profile_of(like).angle.shape[1]
    here = profile_of(state if profile_of(state).angle.shape[1] == order else resampled(rods, state, order))
    if here.cuts == there.cuts:
        return here.angle
    angle = np.full(there.angle.shape, np.nan)
    (one, two), count = (dict(here.cuts), dict(there.cuts)), len(rods.length)
    begin, end = layout(count, here.cuts), layout(count, there.cuts)
    for e in (e for e in range(count) if one.get(e) == two.get(e)):
        angle[end.first[e] : end.last[e] + 1] = here.angle[begin.first[e] : begin.last[e] + 1]
    return angle


def resampled(rods: Rods, state: State, order: int) -> State:
    """State with another number of Gauss nodes."""
    shape = plain_shape(rods, state, rods.enter(state))
    return sampled(rods, shape, state, profile_of(state).cuts, order)


def sampled(rods: Rods, shape: RodShape, state: State, cuts: Cuts, order: int) -> State:
    """State whose angles inside are taken from a shape."""
    place = layout(len(rods.length), cuts)
    angle = np.empty((len(place.owner), order))
    nodes = collocation(order).c
    inside = dict(cuts)
    for element, (first, last) in enumerate(zip(place.first, place.last, strict=True)):
        arcs = [touch_of(state, k).xi * rods.length[element] for k in inside.get(element, ())]
        ends = np.array([0.0, *arcs, rods.length[element]])
        at = ends[:-1, None] + np.diff(ends)[:, None] * nodes
        angle[first : last + 1] = shape.at(element, at.ravel()).angle.reshape(at.shape)
    return replace(state, profile=Profile(cuts=cuts, angle=angle))
