"""Geometry of contact: where a node lies relative to a beam, and which element owns it.

A contacting node has exactly one owner, the element that it touches. If the arc position is an unknown, the owner is the element in
which the arc position lies. When the contact passes a beam node, the owner changes inside the iteration; at the beam node, both
neighbours describe the same point.

If the position follows from a projection on chords, the owner is the element whose chord has the projection inside. On the convex
side of a kink no chord has it, and on the concave side two chords may. The owner is then the nearer element, or the first of two at
the same distance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tsm.elements.properties import Array
from tsm.groups.shape import recut
from tsm.model import Model
from tsm.pairs import BeamModel, PairModel
from tsm.projection import project_on_chords, slide
from tsm.state import State, Touch


def with_touches(model: Model, state: State, touches: tuple[Touch | None, ...]) -> State:
    """State with other contacts."""
    after = replace(state, touches=touches)
    return recut(model.rods, state, after) if model.rods else after


def handed_over(model: Model, state: State, touches: tuple[Touch | None, ...], past: float = 0.0) -> State:
    """State with moved contacts; a contact that left its element by a part of its length is handed over to the neighbour."""
    owned: list[Touch | None] = []
    for pair, touch in zip(model.pairs, touches, strict=True):
        if touch is None:
            owned.append(None)
            continue
        first = pair.target.first
        k, xi = slide(pair.target.lengths, touch.element - first, touch.xi, max(past, pair.group.past_node))
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
