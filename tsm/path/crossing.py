"""Crossings: within one step, a node goes through a beam and on past the beam's end, or a round pin through an end and on.

After such a step the node no longer projects onto the beam, or is clear of its end, so that the end of the
step does not show the missed contact. All points are assumed to move on straight lines in the step.
"""

from __future__ import annotations

import math

import numpy as np

from tsm.contact.contact_set import forbidden
from tsm.contact.ends import clearance
from tsm.contact.events import ROUND_OFF, EventKind
from tsm.contact.root import find_root
from tsm.model.model import Model
from tsm.model.pairs import PairModel
from tsm.model.projection import Projection
from tsm.model.state import State
from tsm.path.path import extrapolate
from tsm.statement.status import Status

_CROSSED = 1e-14
"""Tolerance of a crossing: its gap over the longest beam, and the width of the bracket of its load parameter."""
_SAMPLES, _NARROWED = 33, 5
"""States of a step at which a clearance is measured, and how often as many are measured about the least of them."""


def crossing(model: Model, before: State, after: State) -> tuple[float, int] | None:
    """Load parameter and pair of the first crossing between two configurations with the same closed contacts.

    The contact surface is extended beyond the beam's ends along its tangents.
    """
    crossings = []
    for k, (pair, armed) in enumerate(zip(model.pairs, before.armed, strict=True)):
        if after.touches[k] is None and armed and not _over(model, last := model.project(pair, after)):
            t = _passage(model, pair, before, after, last.gap)
            if t is not None:
                crossings.append((t, k))
    return min(crossings, default=None)


def through_end(model: Model, before: State, after: State) -> float | None:
    """Load parameter at which a pin or node, clear of its beam's ends at two configurations, is deepest in an end between them."""
    small, t0, t1 = ROUND_OFF * model.length, before.load_parameter, after.load_parameter
    moved, dips = np.abs((after.q - before.q).reshape(-1, 3)[: len(model.coordinates), :2]).max(), []
    for k, pair in enumerate(model.pairs):
        if pair.pair.offset == 0 or before.touches[k] or after.touches[k]:
            continue
        nodes = [model.node_position(pair, state.q, state.load_parameter) for state in (before, after)]
        way = 2.0 * math.dist(*nodes) + 3.0 * moved
        if not -small <= clearance(model, after, k).distance <= way:
            continue
        over = before.armed[k] and _over(model, model.project(pair, before))

        def depth(t: float, k: int = k, over: bool = over) -> float:
            here = clearance(model, extrapolate(model, [before, after], t), k)
            return math.inf if over and not here.beyond else here.distance

        low, high = t0, t1
        for _ in range(_NARROWED):
            step = (high - low) / (_SAMPLES - 1)
            least, deepest = min((depth(low + n * step), low + n * step) for n in range(1, _SAMPLES - 1))
            low, high = max(t0, deepest - step), min(t1, deepest + step)
            if not -small <= least <= way * step / (t1 - t0):
                break
        if least < -small:
            dips.append(deepest)
    return min(dips, default=None)


def overlapping(model: Model, state: State) -> int | None:
    """First pair whose pin or node overlaps an end of its beam, or a side that it does not touch."""
    thick = (k for k, pair in enumerate(model.pairs) if pair.pair.offset > 0)
    deep = -ROUND_OFF * model.length
    return next((k for k in thick if clearance(model, state, k).distance < deep), None)


def on_held_end(model: Model, state: State) -> bool:
    """Whether a contact lies on a held end, which takes any force: nothing that happens there has a tangent."""
    there = zip(model.pairs, state.touches, strict=True)
    closed = ((pair, pair.arc_position(touch)) for pair, touch in there if touch is not None)
    return any(
        min(arc, pair.target.beam.length - arc) <= ROUND_OFF * model.length
        and forbidden(model, EventKind.SLIP_OFF, pair, arc, alone=False) is Status.FOLDED
        for pair, arc in closed
    )


def _over(model: Model, seen: Projection) -> bool:
    return seen.overshoot <= ROUND_OFF * model.length


def _passage(model: Model, pair: PairModel, before: State, after: State, gap: float) -> float | None:
    """Load parameter at which the gap goes through zero over the beam."""
    t0, t1, small = before.load_parameter, after.load_parameter, ROUND_OFF * model.length

    def seen(t: float) -> Projection:
        return model.project(pair, extrapolate(model, [before, after], t))

    first = model.project(pair, before)
    if gap >= -small or first.gap < -small:
        return None
    if first.gap <= small:
        return t0 if _over(model, first) else None
    start, end = seen(t0).gap, seen(t1).gap
    if not start > 0.0 > end:
        return None
    t = find_root(
        lambda t: (seen(t).gap, t), (t0, start), (t1, end), small=_CROSSED * model.length, apart=_CROSSED
    )
    return t if t is not None and _over(model, seen(t)) else None
