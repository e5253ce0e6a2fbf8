"""Extrapolation of the last accepted states."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tsm.contact import arc_position, owner_at
from tsm.contact_set import owned
from tsm.model import Model
from tsm.state import State, Touch


def extrapolate(model: Model, history: list[State], t: float) -> State:
    """State at t by the polynomial through earlier states, all with the same closed contacts."""
    at = [state.load_parameter for state in history]
    weights = [
        math.prod((t - other) / (own - other) for k, other in enumerate(at) if k != n)
        for n, own in enumerate(at)
    ]
    q = sum((w * state.q for w, state in zip(weights, history, strict=True)), np.zeros(model.dof_count))
    last = history[-1]
    touches: list[Touch | None] = []
    for k, pair in enumerate(model.pairs):
        trail = [state.touches[k] for state in history]
        known = [touch for touch in trail if touch is not None]
        if len(known) < len(trail):
            touches.append(None)
            continue
        arc = sum(
            w * arc_position(model, pair.target, touch.element, touch.xi)
            for w, touch in zip(weights, known, strict=True)
        )
        element, xi = owner_at(model, pair.target, arc)
        force = tuple(
            sum(w * touch.force[c] for w, touch in zip(weights, known, strict=True)) for c in range(2)
        )
        angle = sum(w * touch.angle for w, touch in zip(weights, known, strict=True))
        touches.append(Touch(element=element, xi=xi, force=(force[0], force[1]), angle=angle))
    moved = replace(last, load_parameter=t, q=q)
    if model.rods is None:
        return owned(model, replace(moved, touches=tuple(touches)))
    return owned(model, model.rods.extrapolated(history, weights, moved, tuple(touches)))
