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

from tsm.model.groups.shape import recut
from tsm.model.model import Model
from tsm.model.pairs import PairModel
from tsm.model.projection import AT_NODE, nearest_chord, slide
from tsm.model.state import State, Touch

_AT_NODE = 1e-6
"""Part of an element's length from a node within which a contact lies on it."""


def closed(model: Model, state: State) -> list[tuple[int, PairModel, Touch]]:
    """Closed pairs with their numbers and contacts."""
    there = enumerate(zip(model.pairs, state.touches, strict=True))
    return [(k, pair, touch) for k, (pair, touch) in there if touch is not None]


def on_rigid_nodes(model: Model, state: State) -> list[PairModel]:
    """Pairs whose contact lies on a node of the paper's elements, which do not give way there."""
    there = ((pair, touch) for _, pair, touch in closed(model, state) if pair.slot < 0)
    return [pair for pair, touch in there if min(touch.xi, 1 - touch.xi) < _AT_NODE]


def crowded(model: Model, state: State) -> bool:
    """Whether two nodes touch one element of the paper's, whose matrix knows a single contact."""
    owners = [touch.element for _, pair, touch in closed(model, state) if pair.slot < 0]
    return len(set(owners)) < len(owners)


def with_touches(model: Model, state: State, touches: tuple[Touch | None, ...]) -> State:
    """State with other contacts."""
    after = state if touches == state.touches else replace(state, touches=touches)
    return recut(model.rods, state, after) if model.rods else after


def owned(model: Model, state: State, past: float = 0.0) -> State:
    """State whose contacts have the elements on which they lie; `past`: part of an element's length by which one may lie past its end."""
    touches = list(state.touches)
    for number, pair, touch in closed(model, state):
        if pair.slot < 0:
            touches[number] = chord_owner(model, pair, state, touch)
            continue
        first, least = pair.target.first, 0.0 if pair.cuts else AT_NODE
        k, xi = slide(pair.target.lengths, touch.element - first, touch.xi, max(past, least))
        if touch.element != first + k:
            touches[number] = replace(touch, element=first + k, xi=xi)
    return with_touches(model, state, tuple(touches))


def chord_owner(model: Model, pair: PairModel, state: State, touch: Touch) -> Touch:
    """Touch with its owner and position renewed by projection on the chords."""
    owner, xi = nearest_chord(
        model.positions(pair.target, state.q), model.node_position(pair, state.q, state.load_parameter)
    )
    return Touch(element=pair.target.first + owner, xi=min(max(xi, 0.0), 1.0), force=touch.force)
