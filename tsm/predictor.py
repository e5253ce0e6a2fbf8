"""Extrapolation of accepted states."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from tsm.contact import handed_over
from tsm.contact_set import owned
from tsm.model import Model
from tsm.pairs import PairModel
from tsm.state import State, Touch


def _weighted(weights: Sequence[float], values: Iterable[Any]) -> Any:
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
    moved = replace(last, load_parameter=t, q=_weighted(weights, [state.q for state in history]))
    if last.profile:
        angle = _weighted(weights, [state.profile.angle for state in history if state.profile])
        moved = replace(moved, profile=replace(last.profile, angle=angle))
    trails = zip(*(state.touches for state in history), strict=True)
    touches = [
        _touch(pair, weights, trail) if all(trail) else None
        for pair, trail in zip(model.pairs, trails, strict=True)
    ]
    return owned(model, handed_over(model, moved, tuple(touches)))


def _touch(pair: PairModel, weights: list[float], trail: Sequence[Touch]) -> Touch:
    """Extrapolated contact, on the element that owned it last."""
    last = trail[-1]
    arc = _weighted(weights, map(pair.arc_position, trail))
    place = last.element - pair.target.first
    xi = (arc - pair.target.arcs[place]) / pair.target.lengths[place]
    x, y = (_weighted(weights, [touch.force[c] for touch in trail]) for c in range(2))
    return replace(last, xi=xi, force=(x, y), angle=_weighted(weights, [touch.angle for touch in trail]))
