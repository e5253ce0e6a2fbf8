"""Geometry of contact: where a node lies relative to a beam, and which element owns it.

A node has exactly one owner. While the arc position is an unknown, the owner is the element that holds it: passing
a beam node is a change of owner inside the iteration, and both neighbours describe the same point. Where the
position follows from a projection on chords, the owner is the element whose projection falls inside; on the convex side
of a kink, where none does, and on the concave side, where two do, it is the nearer one, the first of two equals.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tsm.elements.curve import Curve
from tsm.elements.properties import Array
from tsm.model import BeamModel, Model, PairModel
from tsm.rods.accuracy import deflected
from tsm.rods.profile import recut
from tsm.rods.shape import RodShape, tangent_at
from tsm.state import State, Touch

_SAMPLES = 33
"""Points of an exact element among which the nearest is looked for."""
AT_NODE = 1e-9
"""Part of an element's length that a contact may lie past its end: at a node, round-off would send it back and forth for ever."""
PROJECTIONS, PROJECTED = 20, 1e-14
"""Newton steps of a projection at most, and the step at which the closest point is found."""


class Projection(NamedTuple):
    """Closest point of a beam's deflected axis to a node.

    Attributes
    ----------
    element : int
        Global number of the owner.
    xi : float
        Position on it.
    gap : float
        Distance from the contact surface to the node, positive on the stated side.
    overshoot : float
        How far the closest point lies beyond the beam's ends, along the axis [length]; 0 within.
    """

    element: int
    xi: float
    gap: float
    overshoot: float


def arc_position(target: BeamModel, element: int, xi: float) -> float:
    """Distance along the undeformed axis from the beam's start."""
    k = element - target.first
    return (1.0 - xi) * target.arcs[k] + xi * target.arcs[k + 1]


def slide(lengths: Sequence[float], k: int, xi: float, past: float = 0.0) -> tuple[int, float]:
    """Hand a position that left element k of a beam by more than a part of its length over to the neighbour.

    Parameters
    ----------
    lengths : sequence of float
        Undeformed lengths of the beam's elements.
    k, xi : int, float
        Element, counted from the beam's start, and position on it.
    past : float
        Part of the length by which a position may lie past a node.
    """
    if not math.isfinite(xi):
        return k, xi
    while xi > 1.0 + past and k < len(lengths) - 1:
        xi, k = (xi - 1.0) * (lengths[k] / lengths[k + 1]), k + 1
    while xi < -past and k > 0:
        xi, k = 1.0 + xi * (lengths[k] / lengths[k - 1]), k - 1
    return k, xi


def handed_over(model: Model, state: State, touches: tuple[Touch | None, ...]) -> State:
    """State with moved contacts; those that left their element belong to the neighbour."""
    owned: list[Touch | None] = []
    for pair, touch in zip(model.pairs, touches, strict=True):
        if touch is None:
            owned.append(None)
            continue
        first = pair.target.first
        past = 0.0 if pair.cuts else AT_NODE
        k, xi = slide(pair.target.lengths, touch.element - first, touch.xi, past)
        owned.append(touch if first + k == touch.element else replace(touch, element=first + k, xi=xi))
    if model.rods is None:
        return replace(state, touches=tuple(owned))
    return recut(model.rods, replace(state, touches=touches), tuple(owned))


def nearest_chord(model: Model, target: BeamModel, q: Array, node: tuple[float, float]) -> tuple[int, float]:
    """Owner by projection on the chords."""
    positions = model.coordinates[target.nodes] + q.reshape(-1, 3)[target.nodes, :2]
    owner, xi = project_on_chords(positions, np.array(node))
    return target.first + int(owner), float(xi)


def project_on_chords(positions: Array, node: Array) -> tuple[Array, Array]:
    """Chord that is nearest to a node, and the position of the node's projection on it.

    Parameters
    ----------
    positions : ndarray, shape (nodes, 2, ...)
        Ends of the chords of one beam, or of many in the last axis.
    node : ndarray, shape (2, ...)
        Position of the node.
    """
    d = np.diff(positions, axis=0)
    r = node - positions[:-1]
    xi = np.einsum("ij...,ij...->i...", d, r) / np.einsum("ij...,ij...->i...", d, d)
    apart = r - np.clip(xi, 0.0, 1.0)[:, None] * d
    owner = np.argmin(np.einsum("ij...,ij...->i...", apart, apart), axis=0)
    return owner, np.take_along_axis(xi, owner[None], axis=0)[0]


def chord_owner(model: Model, pair: PairModel, state: State, touch: Touch) -> Touch:
    """Touch with its owner and position renewed by projection on the chords."""
    node = model.node_position(pair, state.q, state.load_parameter)
    element, xi = nearest_chord(model, pair.target, state.q, node)
    return Touch(element=element, xi=min(max(xi, 0.0), 1.0), force=touch.force)


def project(model: Model, pair: PairModel, state: State) -> Projection:
    """Closest point of the deflected axis, with the dents of the contacts that are closed.

    The chords give the owner, Newton's method on the owner's curve the point.
    """
    if pair.cuts:
        assert model.rods is not None, "the pair touches an exact element"
        shape = deflected(model.rods, state)
        seen: dict[int, Projection] = model.rods.memo.closest if model.rods.memo else {}
        if pair.slot not in seen:
            seen[pair.slot] = _project_on_rods(model, pair, state, shape)
        return seen[pair.slot]
    q = state.q
    node = model.node_position(pair, q, state.load_parameter)
    element, xi = nearest_chord(model, pair.target, q, node)
    first = pair.target.first
    for _ in range(PROJECTIONS):
        rx, ry, curve = _lever(model, element, q, node)
        step, (px, py), (tx, ty) = curve.approach(xi, rx, ry)
        k, xi = slide(pair.target.lengths, element - first, xi - step)
        element = first + k
        if abs(step) < PROJECTED:
            break
    coupling = pair.law.coupling
    for touch in state.touches:
        if coupling and touch is not None and touch.element == element:
            dent = coupling.dent(model.element[element], xi, touch.xi)
            px, py = px + dent * touch.force[0], py + dent * touch.force[1]
    height = (py * tx - px * ty) / math.hypot(tx, ty)
    beyond = _beyond(pair.target, arc_position(pair.target, element, xi))
    return Projection(element, xi, pair.side * height - pair.pair.offset, beyond)


def _beyond(target: BeamModel, arc: float) -> float:
    """How far an arc position lies outside the beam."""
    return max(arc - target.beam.length, -arc, 0.0)


def _project_on_rods(model: Model, pair: PairModel, state: State, shape: RodShape) -> Projection:
    """Closest point of exact elements: of points along the axis the nearest, and Newton's method from there."""
    assert model.rods is not None, "the pair touches an exact element"
    target = pair.target
    node = np.array(model.node_position(pair, state.q, state.load_parameter))
    first, xi = int(model.place[target.first]), np.linspace(0, 1, _SAMPLES)
    points = np.array([shape.at(first + e, xi * l0).position for e, l0 in enumerate(target.lengths)]) - node
    nearest = np.argmin(np.einsum("emi,emi->em", points, points))
    e, sample = divmod(int(nearest), _SAMPLES)
    arc = float(xi[sample]) * target.lengths[e]
    for _ in range(30):
        l0 = target.lengths[e]
        inside = min(max(arc, 0.0), l0)
        at = shape.at(first + e, np.array([inside]))
        tangent, bend = tangent_at(model.rods, first + e, at)
        apart = at.position[0] + (arc - inside) * tangent - node
        slope = float(tangent @ tangent) + (float(bend @ apart) if inside == arc else 0.0)
        step = float(apart @ tangent) / slope if slope > 0 else 0.0
        arc -= min(max(step, -l0 / _SAMPLES), l0 / _SAMPLES)
        e, at_xi = slide(target.lengths, e, arc / l0)
        arc = at_xi * target.lengths[e]
        if abs(step) < PROJECTED * l0:
            break
    height = float(apart[1] * tangent[0] - apart[0] * tangent[1]) / float(np.hypot(*tangent))
    beyond = _beyond(target, arc_position(target, target.first + e, at_xi))
    return Projection(target.first + e, at_xi, pair.side * height - pair.pair.offset, beyond)


def _lever(model: Model, element: int, q: Array, node: tuple[float, float]) -> tuple[float, float, Curve]:
    x = q[model.dofs[:, element]].tolist()
    start_x, start_y = model.element_start[element]
    rx, ry = start_x + x[0] - node[0], start_y + x[1] - node[1]
    return rx, ry, Curve(model.element[element], x)
