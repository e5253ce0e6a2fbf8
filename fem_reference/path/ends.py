"""Ends of strips: what a pin or a node meets beyond the last point of a contact curve.

The end of an axis is a point, that of a thick strip the line between its corners. A pin meets it at its radius; a point goes through.
"""

import numpy as np
from numpy.polynomial.polynomial import polyval

from fem_reference.contact.contact import Pair
from fem_reference.path.track import Accepted, cubic, located
from fem_reference.statement.arrays import Floats
from fem_reference.system.state import State

_SAMPLES, _PARTS = 4000, 20
"""Largest number of places within a step at which a node is sought over an end, and places on the way of one radius."""
_MET = 1e-9
"""Part of the length of the longest strip at which a node has met an end."""
_BESIDE = 1e-6
"""Part of the half height by which a node in contact with a face may be below it."""


def room(pair: Pair, u: Floats, node: Floats, *, inside: bool) -> float:
    """Least distance of the node's surface from the free ends; negative where they overlap, infinite beside the strip."""
    beyond, behind = list[float](), list[float]()
    for end, corners in pair.ends.items():
        first, last = corners.points(u) @ (1, 1j)
        half = abs(last - first) / 2
        away = (complex(*node) - (first + last) / 2) * 2 * half / (last - first)
        half = half if pair.contact.surface == "face" else 0.0
        ahead, aside = -away.imag if end == "end" else away.imag, abs(away.real) - half
        if ahead > 0 or (aside >= 0 and not inside):
            beyond.append(float(np.hypot(ahead, max(aside, 0.0))) - pair.radius)
        elif aside < -_BESIDE * half:
            behind.append(ahead)
    return min(beyond, default=-min(map(abs, behind), default=-np.inf))


def nearest_end(pair: Pair, state: State) -> str:
    """Name of the end of a pair's strip that is nearest to the node."""
    node = pair.position(state.u, state.t)
    return min(pair.ends, key=lambda end: np.hypot(*(pair.ends[end].points(state.u).mean(axis=0) - node)))


def end_contact(last: Accepted, candidate: Accepted) -> tuple[Accepted, int] | None:
    """State in a step at which a node first meets an end, before it touches between the ends, and the pair; None without one."""
    found = list[tuple[Accepted, int]]()
    for number, pair in enumerate(last.state.model.pairs):
        over = _overlap(pair, number, last, candidate) if pair.ends else None
        if over is None:
            continue

        def distance(at: Accepted, pair: Pair = pair, number: int = number) -> float:
            state = at.state
            node = pair.position(state.u, at.t)
            return min(room(pair, state.u, node, inside=state.touches[number].at.inside), state.model.length)

        met = located(last, over, distance) if distance(last) >= 0 else None
        if met is not None and distance(met) <= _MET * last.state.model.length:
            found.append((met, number))
    return min(found, key=lambda one: one[0].t, default=None)


def _overlap(pair: Pair, number: int, last: Accepted, candidate: Accepted) -> float | None:
    """First load parameter in a step at which an open contact's node is over an end."""
    before, after = last.state, candidate.state
    if before.touches[number].closed:
        return None
    span = after.t - before.t
    first = last.rate(before.t, after.t).u
    end, final = before.u + span * first, first
    if before.contact_set == after.contact_set:
        end, final = after.u, candidate.rate(before.t, after.t).u
    path = cubic((before.u, end), (span * first, span * final))
    way = pair.position(end, after.t) - pair.position(before.u, before.t)
    moved = np.hypot(*way) + span * np.abs(first).max()
    size = pair.radius or pair.curve.stations[-1] / _PARTS
    count = int(np.clip(np.ceil(_PARTS * moved / size), 2, _SAMPLES))
    ahead = True
    for t in np.linspace(before.t, after.t, count + 1).tolist():
        u = polyval((t - before.t) / span, path)
        node = pair.position(u, t)
        was_ahead, ahead = ahead, 0 < room(pair, u, node, inside=True) < np.inf
        # the projection is dear, and decides only beside an end
        if t == before.t or room(pair, u, node, inside=False) >= 0:
            continue
        at = pair.project(u, t)
        if at.inside and not was_ahead and pair.gap(at) < 0:
            return None  # it has touched between the ends before
        if room(pair, u, node, inside=at.inside) < 0:
            return float(t)
    return None
