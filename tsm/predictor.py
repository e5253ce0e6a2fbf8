"""Extrapolation of the last accepted states."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from tsm.contact import handed_over
from tsm.contact_set import owned
from tsm.model import Model
from tsm.pairs import PairModel
from tsm.projection import arc_position
from tsm.state import State, Touch


def weighted(weights: Sequence[float], values: Iterable[Any]) -> Any:
    """Weighted sum."""
    return sum(weight * value for weight, value in zip(weights, values, strict=True))


def extrapolate(model: Model, history: list[State], t: float) -> State:
    """State at t by the polynomial through earlier states, all with the same closed contacts."""
    for group in model.groups:
        history = group.alike(history)
    times = [state.load_parameter for state in history]
    weights = [  # Lagrange's
        math.prod((t - other) / (time - other) for k, other in enumerate(times) if k != n)
        for n, time in enumerate(times)
    ]
    last = history[-1]
    moved = replace(last, load_parameter=t, q=weighted(weights, [state.q for state in history]))
    if last.profile:
        angle = weighted(weights, [state.profile.angle for state in history if state.profile])
        moved = replace(moved, profile=replace(last.profile, angle=angle))
    touches: list[Touch | None] = []
    for k, pair in enumerate(model.pairs):
        trail = [state.touches[k] for state in history]
        known = [touch for touch in trail if touch is not None]
        touches.append(_touch(pair, weights, known) if len(known) == len(trail) else None)
    return owned(model, handed_over(model, moved, tuple(touches)))


def _touch(pair: PairModel, weights: list[float], trail: list[Touch]) -> Touch:
    """Extrapolated contact, on the element that owned it last."""
    last = trail[-1]
    arc = weighted(weights, [arc_position(pair.target, touch.element, touch.xi) for touch in trail])
    place = last.element - pair.target.first
    xi = (arc - pair.target.arcs[place]) / pair.target.lengths[place]
    x, y = (weighted(weights, [touch.force[c] for touch in trail]) for c in range(2))
    return replace(last, xi=xi, force=(x, y), angle=weighted(weights, [touch.angle for touch in trail]))
