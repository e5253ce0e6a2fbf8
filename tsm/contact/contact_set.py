"""The set of closed contacts: its initial state, its changes, and the rules for opening and closing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tsm.contact.events import ROUND_OFF, EventKind, over
from tsm.model.contact import owned, with_touches
from tsm.model.groups.shape import undeformed
from tsm.model.model import Model
from tsm.model.pairs import PairModel
from tsm.model.projection import Projection
from tsm.model.state import UNDECIDED, State, Touch, touch_of
from tsm.statement.status import Status, StopError


def changed(model: Model, state: State, k: int, touch: Touch | None, *, armed: bool) -> State:
    """State with pair k closed by a touch, or open and armed or not."""
    touches, flags = list(state.touches), list(state.armed)
    touches[k], flags[k] = touch, armed
    return with_touches(model, replace(state, armed=tuple(flags)), tuple(touches))


def closed_at(pair: PairModel, seen: Projection) -> Touch:
    """Closed contact without force at the closest point."""
    grip = UNDECIDED if pair.rubs else None
    return Touch(element=seen.element, xi=min(max(seen.xi, 0.0), 1.0), force=(0.0, 0.0), grip=grip)


def rearm(model: Model, state: State) -> State:
    """State in which a passed pair may close again once its node is off the beam or back on the stated side."""
    if all(flag or touch for flag, touch in zip(state.armed, state.touches, strict=True)):
        return state
    armed = list(state.armed)
    for k, pair in enumerate(model.pairs):
        if state.touches[k] is None and not armed[k]:
            seen = model.project(pair, state)
            armed[k] = not over(model, seen) or seen.gap > ROUND_OFF * model.length
    return replace(state, armed=tuple(armed))


def initial_state(model: Model) -> State:
    """Undeformed state; pairs whose node lies on the surface are closed with zero force.

    Raises ValueError if a node starts on the wrong side of its beam.
    """
    q, count, small = np.zeros(model.dof_count), len(model.pairs), ROUND_OFF * model.length
    start = State(load_parameter=0.0, q=q, touches=(None,) * count, armed=(True,) * count)
    if model.rods:
        start = undeformed(model.rods, start)
    touches: list[Touch | None] = []
    for pair in model.pairs:
        seen = model.project(pair, start)
        if over(model, seen) and seen.gap < -small:
            position = model.node_position(pair, q, 0.0)
            raise ValueError(
                f"ContactPair({pair.pair.name}).side = {pair.pair.side!r}: "
                f"the node starts at {position}, {-seen.gap:.3g} behind the surface"
            )
        touches.append(closed_at(pair, seen) if over(model, seen) and seen.gap <= small else None)
    return owned(model, with_touches(model, start, tuple(touches)))


def opened(model: Model, state: State, k: int, kind: EventKind, *, alone: bool) -> State:
    """State without a contact that was released or slipped off; `alone` if no other contact takes over.

    Raises StopError where the path ends because the contact may not open.
    """
    pair, slips = model.pairs[k], kind is EventKind.SLIP_OFF
    end, held, _ = end_beside(model, pair, touch_of(state, k))
    if slips and held:
        raise StopError(Status.FOLDED)
    if pair.pair.keep:
        raise StopError(Status.SLIPPED_OFF if slips else Status.LOST_CONTACT)
    if slips and alone and pair.pair.radius > 0 and end in model.free_ends[pair.pair.beam]:
        raise StopError(Status.END_CONTACT, (state, k))
    return changed(model, state, k, None, armed=not slips)


def end_beside(model: Model, pair: PairModel, touch: Touch) -> tuple[tuple[int, bool], bool, float]:
    """End of its beam that a contact is nearer to, its node and whether it is the last one; whether it is held; how far it is."""
    arc, length = pair.arc_position(touch), pair.target.beam.length
    last = arc >= length / 2
    node = model.end_node(f"{pair.target.beam.name}.{'end' if last else 'start'}")
    return (node, last), any(3 * node + c in model.prescribed for c in range(3)), min(arc, length - arc)
