"""Geometry of contact: where a node lies relative to a beam, and which element owns it.

A node has exactly one owner. While the arc position is an unknown, the owner is the element that holds it: passing
a beam node is a change of owner inside the iteration, and both neighbours describe the same point. Where the
position follows from a projection on chords, the owner is the element whose projection falls inside; on the convex side
of a kink, where none does, and on the concave side, where two do, it is the nearer one, the first of two equals.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tsm.elements.properties import Array
from tsm.model import BeamModel, Model, PairModel
from tsm.projection import project_on_chords, slide
from tsm.state import State, Touch


def with_touches(model: Model, state: State, touches: tuple[Touch | None, ...]) -> State:
    """State with other contacts."""
    after = replace(state, touches=touches)
    for group in model.groups:
        after = group.with_touches(state, after)
    return after


def handed_over(model: Model, state: State, touches: tuple[Touch | None, ...]) -> State:
    """State with moved contacts; those that left their element belong to the neighbour."""
    owned: list[Touch | None] = []
    for pair, touch in zip(model.pairs, touches, strict=True):
        if touch is None:
            owned.append(None)
            continue
        first = pair.target.first
        k, xi = slide(pair.target.lengths, touch.element - first, touch.xi, pair.group.past_node)
        owned.append(touch if first + k == touch.element else replace(touch, element=first + k, xi=xi))
    return with_touches(model, replace(state, touches=touches), tuple(owned))


def nearest_chord(model: Model, target: BeamModel, q: Array, node: tuple[float, float]) -> tuple[int, float]:
    """Owner by projection on the chords."""
    positions = model.coordinates[target.nodes] + q.reshape(-1, 3)[target.nodes, :2]
    owner, xi = project_on_chords(positions, np.array(node))
    return target.first + int(owner), float(xi[owner])


def chord_owner(model: Model, pair: PairModel, state: State, touch: Touch) -> Touch:
    """Touch with its owner and position renewed by projection on the chords."""
    node = model.node_position(pair, state.q, state.load_parameter)
    element, xi = nearest_chord(model, pair.target, state.q, node)
    return Touch(element=element, xi=min(max(xi, 0.0), 1.0), force=touch.force)
