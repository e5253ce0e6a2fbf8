"""Ends of beams: what a pin or a node meets beyond the last point of a contact surface.

The end of an axis is a point. The end of a thick beam is a segment across the axis, from one face's last point to the other's. A node lies
beyond the end where no point between the ends is closest to it. There, a pin of radius R meets the end at the distance R from it;
elsewhere it meets the contact surface, or from behind the side that the contact does not have. Ends that beams share are no ends here.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tsm.model.model import Model
from tsm.model.state import State

_TOUCHES = 1e-10
"""Depth over the longest beam at which a node that comes to the surface of its contact still touches it only."""


class Clearance(NamedTuple):
    """Distance of a node, or of its pin, from an end at an arc position, or from a side; whether the node lies beyond the end."""

    distance: float
    beyond: bool
    arc: float


def clearance(model: Model, state: State, k: int) -> Clearance:
    """Clearance of pair k from the nearer free end of its beam, at least; negative where they overlap.

    A closed contact is clear of the end that it is beside. An open one that is over the beam may come to the surface of its contact.
    """
    pair, touch, q = model.pairs[k], state.touches[k], state.q.reshape(-1, 3)
    node = model.node_position(pair, state.q, state.load_parameter)
    away, last = min(
        (
            (math.dist(model.coordinates[n] + q[n, :2], node), last)
            for n, last in model.free_ends[pair.pair.beam]
        ),
        default=(2.0 * model.extent, True),
    )
    arc, way = (pair.target.beam.length, 1.0) if last else (0.0, -1.0)
    reach, radius, steep = abs(pair.reach_at(arc)), pair.pair.radius, way * pair.side * pair.steep
    if away > 2.0 * reach and (touch is not None or state.armed[k]):
        return Clearance(away - reach, beyond=False, arc=arc)
    place, tangent = (complex(*of) for of in model.group_of(pair.target).end(pair, state, last=last))
    along = place * tangent.conjugate() / abs(tangent)
    ahead, aside = -way * along.real, abs(along.imag)
    beyond = ahead + steep * away > 0.0
    if touch is not None and (not beyond or abs(pair.arc_position(touch) - arc) < reach):
        return Clearance(reach, beyond=False, arc=arc)
    if beyond:
        ahead, half = ahead + steep * (reach - radius), (reach - radius) * math.sqrt(1.0 - steep**2)
        distance = ahead if aside < half else math.hypot(ahead, aside - half)
        return Clearance(distance - radius, beyond=True, arc=arc)
    seen = model.project(pair, state)
    here = pair.target.arcs[seen.element - pair.target.first] + seen.xi * model.properties.l0[seen.element]
    offset, free = abs(pair.reach_at(here)), state.armed[k] and seen.gap >= -_TOUCHES * model.length
    return Clearance(reach if free else abs(seen.gap + offset) - offset, beyond=False, arc=here)
