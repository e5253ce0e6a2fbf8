"""Crossings: within one step, a node goes through a beam and on past the beam's end, or a round pin through an end and on.

After such a step the node no longer projects onto the beam, or is clear of its end, so that the end of the
step does not show the missed contact. All points are assumed to move on straight lines in the step.
"""

from __future__ import annotations

import math

import numpy as np

from tsm.contact.contact_set import end_beside
from tsm.contact.ends import clearance
from tsm.contact.events import ROUND_OFF, over
from tsm.contact.root import find_root
from tsm.model.contact import closed
from tsm.model.model import Model
from tsm.model.pairs import PairModel
from tsm.model.projection import Projection
from tsm.model.state import State
from tsm.path.path import extrapolate
from tsm.statement.status import Status, StopError

_CROSSED = 1e-14
"""Tolerance of a crossing: its gap over the longest beam, and the width of the bracket of its load parameter."""
_UNSURE = 0.3
"""Distance past the beam's end at a crossing, over that at the end of the step, up to which the step is taken anew to the crossing."""
_SAMPLES, _NARROWED = 33, 5
"""States of a step at which a clearance is measured, and how often as many are measured about the least of them."""


def crossing(model: Model, before: State, after: State) -> tuple[float, int] | None:
    """Load parameter and pair of the first crossing between two configurations with the same closed contacts.

    The contact surface is extended beyond the beam's ends along its tangents.
    """
    armed = (k for k, flag in enumerate(before.armed) if flag and after.touches[k] is None)
    crossings = ((_passage(model, model.pairs[k], before, after), k) for k in armed)
    return min(((t, k) for t, k in crossings if t is not None), default=None)


def _passage(model: Model, pair: PairModel, before: State, after: State) -> float | None:
    """Load parameter at which the gap of a node that ends off the beam goes through zero over the beam."""
    t0, t1, small = before.load_parameter, after.load_parameter, ROUND_OFF * model.length
    last = model.project(pair, after)
    if last.gap >= -small or over(model, last):
        return None

    def seen(t: float) -> Projection:
        return model.project(pair, extrapolate(model, [before, after], t))

    first = model.project(pair, before)
    if first.gap <= small:
        return t0 if first.gap >= -small and over(model, first) else None
    ends = (t0, first.gap), (t1, last.gap)
    t = find_root(lambda t: (seen(t).gap, t), *ends, small=_CROSSED * model.length, apart=_CROSSED)
    if t is None or over(model, seen(t)):
        return t
    # where points move on curves, the node may have been over the beam: a shorter step will tell
    there = _past(model, pair, extrapolate(model, [before, after], t))
    return t if there <= _UNSURE * _past(model, pair, after) else None


def _past(model: Model, pair: PairModel, state: State) -> float:
    """Distance of a node past the nearer end of its beam, along the tangent there."""
    group = model.group_of(pair.target)
    ends = ((*group.end(pair, state, last=last), 2.0 * last - 1.0) for last in (False, True))
    (px, py), (tx, ty), way = min(ends, key=lambda end: math.hypot(*end[0]))
    return -way * float(px * tx + py * ty) / math.hypot(tx, ty)


def through_end(model: Model, before: State, after: State) -> tuple[float, int] | None:
    """Load parameter and pair of a pin or node, clear of its beam's ends at two configurations, where it is deepest in an end between them."""
    small, t0, t1 = ROUND_OFF * model.length, before.load_parameter, after.load_parameter
    dips = []
    for k, pair in enumerate(model.pairs):
        if pair.pair.offset == 0 or before.touches[k] or after.touches[k]:
            continue
        moved = np.abs((after.q - before.q).reshape(-1, 3)[: len(model.coordinates), :2]).max()
        nodes = [model.node_position(pair, state.q, state.load_parameter) for state in (before, after)]
        way = 2.0 * math.dist(*nodes) + 3.0 * moved
        if not -small <= clearance(model, after, k).distance <= way:
            continue
        above = before.armed[k] and over(model, model.project(pair, before))

        def depth(t: float, k: int = k, above: bool = above) -> float:
            here = clearance(model, extrapolate(model, [before, after], t), k)
            return math.inf if above and not here.beyond else here.distance

        low, high = t0, t1
        for _ in range(_NARROWED):
            step = (high - low) / (_SAMPLES - 1)
            least, deepest = min((depth(low + n * step), low + n * step) for n in range(1, _SAMPLES - 1))
            low, high = max(t0, deepest - step), min(t1, deepest + step)
            if not -small <= least <= way * step / (t1 - t0):
                break
        if least < -small:
            dips.append((deepest, k))
    return min(dips, default=None)


def check_ends(model: Model, state: State, stopped: State) -> None:
    """Raise StopError, for a path that ends in another state, if a node overlaps an end of its beam or a side that it does not touch."""
    for k, pair in enumerate(model.pairs):
        if pair.pair.offset > 0 and clearance(model, state, k).distance < -ROUND_OFF * model.length:
            raise StopError(Status.END_CONTACT, (stopped, k))


def on_held_end(model: Model, state: State) -> bool:
    """Whether a contact lies on a held end, which takes any force: nothing that happens there has a tangent."""
    ends = (end_beside(model, pair, touch) for _, pair, touch in closed(model, state))
    return any(held and away <= ROUND_OFF * model.length for _, held, away in ends)
