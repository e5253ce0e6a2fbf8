"""Events of the equilibrium path.

============= ==============================================================================
touch         the gap of an open pair falls below zero, its node on the stated side
release       the force of a closed pair falls below zero
slip-off      the position of a closed pair leaves the beam past an end
pass-through  the owner of a closed pair changes from an element to its neighbour
slip          the force of a pair that sticks reaches the edge of its cone ``|F_t| <= mu F_n``
stick         the slip rate of a pair that slips falls to zero
end-contact   a node or a round pin meets an end of its beam, or the side that its contact does not have
line-contact  the curvature of the beam at a closed pair reaches the contact surface's
limit-point   the load parameter is stationary along the path
bifurcation   another branch crosses the path, which goes on unstable
============= ==============================================================================

The first three events change the set of closed contacts, slip and stick the state of a contact with friction.
A pass-through changes neither; its load parameter is interpolated. The others are located, see `tsm.path.margins`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from tsm.model.model import Model
from tsm.model.projection import Projection, arc_position
from tsm.model.state import Traction, touch_of
from tsm.system.equilibrium import Equilibrium

ROUND_OFF = 1e-10
"""Absolute margin below which a margin counts as zero."""


class EventKind(Enum):
    """Kind of a contact event."""

    TOUCH = "touch"
    RELEASE = "release"
    SLIP_OFF = "slip-off"
    PASS_THROUGH = "pass-through"
    SLIP = "slip"
    STICK = "stick"
    LINE_CONTACT = "line-contact"
    END_CONTACT = "end-contact"
    LIMIT_POINT = "limit-point"
    BIFURCATION = "bifurcation"


@dataclass(frozen=True, kw_only=True)
class Event:
    """A located event; limit points and bifurcations belong to no contact.

    Attributes
    ----------
    kind : EventKind
        Kind of the event.
    load_parameter : float
        Load parameter of the event.
    pair : str
        Name of the pair.
    element : int
        Number of the owner, from 0 at the beam's start; after a pass-through, number of the new owner.
    arc_position : float
        Distance along the undeformed axis [length].
    force : float
        Contact force, before the event.
    released : float
        Potential energy (strain energy less the work of the loads) that is released in the jump after a
        slip-off.
    stage : int
        Number of the stage of the load, from 1. An event at the load parameter at which a stage begins
        belongs to that stage if it happens because the load goes on.
    """

    kind: EventKind
    load_parameter: float
    pair: str = ""
    element: int = -1
    arc_position: float = math.nan
    force: float = 0.0
    released: float = 0.0
    stage: int = 1


def over(model: Model, seen: Projection) -> bool:
    """Whether a node lies over its beam, not past an end."""
    return seen.overshoot <= ROUND_OFF * model.length


def traction(point: Equilibrium, k: int) -> Traction:
    """Force and place of closed pair k, which has friction."""
    rods = point.model.rods
    assert rods is not None, "a contact with friction cuts its element"
    return rods.traction(k, point.system.groups[rods.number])


def normal_force(point: Equilibrium, k: int) -> float:
    """Contact force of closed pair k, friction included, positive where it pushes the beam away from the node's side."""
    fx, fy = point.system.forces[k]
    pair, state, touch = point.model.pairs[k], point.state, touch_of(point.state, k)
    if touch.grip is not None:
        return math.copysign(math.hypot(fx, fy), traction(point, k).normal)
    dx, dy = point.model.direction(pair, touch, state)
    size = float((fx * fx + fy * fy) ** 0.5)
    return size if pair.side * (fy * dx - fx * dy) >= 0 else -size


def passes(before: Equilibrium, after: Equilibrium) -> Iterator[Event]:
    """Yield the pass-throughs of the contacts between two equilibria, one per beam node, interpolated linearly in the arc."""
    t0, t1 = before.t, after.t
    for k, (old, new) in enumerate(zip(before.state.touches, after.state.touches, strict=True)):
        if old is None or new is None or old.element == new.element:
            continue
        pair, ahead = before.model.pairs[k], 1 if new.element > old.element else -1
        start, end = pair.arc_position(old), pair.arc_position(new)
        push, pushed = normal_force(before, k), normal_force(after, k)
        for element in range(old.element + ahead, new.element + ahead, ahead):
            arc = arc_position(pair.target, element, 0.0 if ahead > 0 else 1.0)
            # an end of the step on a node is beside it but for round-off
            part = min(max((arc - start) / (end - start), 0.0), 1.0) if end != start else 1.0
            yield Event(
                kind=EventKind.PASS_THROUGH,
                load_parameter=t0 + part * (t1 - t0),
                pair=pair.pair.name,
                element=element - pair.target.first,
                arc_position=arc,
                force=push + part * (pushed - push),
            )
