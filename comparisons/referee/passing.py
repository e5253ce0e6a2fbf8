"""Checks between the load parameters of an answer: no node passes through a beam, contacts change at events only, and these are true."""

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import ContactEvent, Response
from comparisons.referee.distance import gap_off, largest_force
from comparisons.referee.guess import answer_state, end_of
from comparisons.referee.newton import equilibrium
from comparisons.referee.path import PASSES, at_rest, changes_of, events_between, on_the_way, reach
from comparisons.referee.rod import axis_at_rest, cross, face_of
from comparisons.referee.state import Equilibrium
from comparisons.scene import ContactSpec, Scene

Array = NDArray[np.float64]

OPENS, CLOSES = ("release", "slip-off"), ("touch",)
KINDS = (*OPENS, *CLOSES, "slip", "stick", PASSES)
"""Kinds of contact events."""
CRITICAL = ("limit-point", "bifurcation")
"""Kinds of events without a contact."""
ENDING = ("line-contact", "end-contact")
"""Kinds of events at which a contact ends the solution."""
SAMPLES = 101
"""Positions of a node between two load parameters at which its side of the beam is determined."""
_CLOSED = ("pass-through", "slip", "stick")
"""Kinds of events at which a contact stays closed."""
_STEPS, _SAME = 32, 1e-2
"""Steps in which a path is followed where chords cross, and largest distance of its end from the answer, over the length."""
_AROUND = 0.2
"""Distance from touching an end, over the node's path, within which a node may have passed around the end."""


class _Moment(NamedTuple):
    """A load parameter, with the axis of a beam and the place of a node."""

    t: float
    line: Array
    node: Array


def passages(response: Response, scene: Scene) -> Iterator[str]:
    """Yield a sentence for every open pair whose node passed through the beam."""
    for spec in scene.contacts:
        through = _Pair(response, scene, spec).passed_through()
        if through is not None:
            yield f"{spec.pair} is open and its node goes through the beam up to load parameter {through:.6g}"


def changes(response: Response, scene: Scene) -> Iterator[str]:
    """Yield a sentence for every pair that closes or opens without an event, if the answer records events."""
    if response.events is None:
        return
    times = np.concatenate([[0.0], response.load_parameter])
    for spec in scene.contacts:
        contact = response.contacts[spec.pair]
        own = [event for event in response.events if event.pair == spec.pair and event.kind not in _CLOSED]
        if np.isfinite(contact.slip_off) and not any(event.kind == "slip-off" for event in own):
            yield f"{spec.pair} slips off at load parameter {contact.slip_off:.6g} without an event"
        closed = contact.force != 0.0
        events = np.array([event.load_parameter for event in own])
        for k in np.flatnonzero(closed[1:] != closed[:-1]) + 1:
            if not np.any((events >= times[k]) & (events <= times[k + 1])):
                what = "closes" if closed[k] else "opens"
                yield f"{spec.pair} {what} without an event up to load parameter {times[k + 1]:.6g}"


class _Pair:
    """A node that may pass through the deflected axis of a beam."""

    def __init__(self, response: Response, scene: Scene, spec: ContactSpec) -> None:
        self.response, self.scene, self.spec = response, scene, spec
        self.near, self.face = 1e-6 * scene.beam(spec.beam).length, face_of(scene, spec)

    def passed_through(self) -> float | None:
        """Load parameter by which the open node has passed through; None if it has not, and after a slip-off."""
        # axes and ends move in straight lines; where these cross, along the path that is followed
        contact = self.response.contacts[self.spec.pair]
        closed, where = contact.force > 0.0, self.whereabouts(self.moment(-1))
        for k, t in enumerate(map(float, self.response.load_parameter)):
            if t >= contact.slip_off:
                return None
            if closed[k]:
                where = "before"
                continue
            last, now = where, self.moment(k)
            where = self.whereabouts(now)
            if where == "before" or (k > 0 and closed[k - 1] and where != "behind"):
                continue
            if self.goes_through(self.moment(k - 1), now, last):
                way, through = self.followed(k), False
                for first, after in pairwise(way):
                    before, last = last, self.whereabouts(after)
                    through = last != "before" and (through or self.goes_through(first, after, before))
                if through or not way:
                    return t
        return None

    def followed(self, k: int) -> list[_Moment]:
        """States on the path to load parameter k from the one before; none if it rubs, jumps, or leads elsewhere."""
        begin, end, scene, beam = self.moment(k - 1), self.moment(k), self.scene, self.spec.beam
        now = equilibrium(scene, answer_state(self.response, scene, k - 1)) if k else at_rest(scene)
        if not now.found:
            return []
        way, arcs = [begin], self.response.axis_line(beam, k)[0]
        stops = np.linspace(begin.t, end.t, _STEPS + 1)[1:].tolist()
        for exact in on_the_way(now, events_between(self.response, begin.t, end.t), stops):
            line = exact.shape(beam, arcs).position
            way.append(_Moment(exact.load_parameter, line, exact.place(self.spec.node)))
        apart = np.hypot(*(way[-1].line - end.line).T).max()
        return way if len(way) > 1 and apart <= _SAME * scene.beam(beam).length else []

    def goes_through(self, begin: _Moment, end: _Moment, where: str) -> bool:
        """Whether the node, first at the side `where`, passes between two moments and does not return from a contact in between."""
        parts, touched = np.linspace(0.0, 1.0, SAMPLES), np.concatenate([begin.line, end.line])
        nodes = (1.0 - parts)[:, None] * begin.node + parts[:, None] * end.node
        if "." not in self.spec.node:
            pin = self.scene.pin(self.spec.node)
            nodes = np.array([pin.position(float((1.0 - u) * begin.t + u * end.t)) for u in parts])
        apart = np.maximum(nodes.min(axis=0) - touched.max(axis=0), touched.min(axis=0) - nodes.max(axis=0))
        if apart.max() > self.reach(begin.line).max():
            return False
        leaves = self.whereabouts(end._replace(node=nodes[-1])) == "beyond"
        way = np.hypot(*((nodes[-1] - nodes[0]) - (end.line - begin.line)[[0, -1]]).T)
        through = False
        for u, (start, node) in zip(parts[1:], pairwise(nodes), strict=True):
            now = _Moment(u, (1.0 - u) * begin.line + u * end.line, node)
            before, where = where, self.whereabouts(now)
            if before == "before" and where != "before":
                through = where == "behind" or self.cuts(now, start)
                short = np.hypot(*(node - now.line[[0, -1]]).T) - self.reach(now.line).max()
                # so near to an end that the node may have passed around the end
                through = through and not (leaves and bool((short <= _AROUND * way).any()))
            through = through and where != "before"
        return through

    def moment(self, k: int) -> _Moment:
        """The beam and the node at load parameter k; undeformed for k = -1."""

        def axis(beam: str) -> tuple[Array, Array]:
            arc, line = self.response.axis_line(beam, max(k, 0))
            return arc, line if k >= 0 else axis_at_rest(self.scene.beam(beam), arc)

        t, (beam, _, end) = (
            float(self.response.load_parameter[k]) if k >= 0 else 0.0,
            self.spec.node.partition("."),
        )
        if not end:
            node = np.array(self.scene.pin(beam).position(t))
        else:
            tip = k >= 0 and end == self.scene.tip(beam)
            node = self.response.tips[beam][k] if tip else end_of(self.spec.node, axis)
        return _Moment(t, axis(self.spec.beam)[1], np.asarray(node))

    def cuts(self, now: _Moment, start: Array) -> bool:
        """Whether the way of the node from `start` crosses the curve of touching nodes from the pair's side."""
        line, way, left = now.line, now.node - start, self.face.left
        pieces, offset = np.diff(line, axis=0), self.reach(line[:-1])
        lengths = np.hypot(*pieces.T)
        before, after = (
            left * cross(pieces, node - line[:-1]) / lengths - offset for node in (start, now.node)
        )
        aside = (left * offset / lengths)[:, None] * np.column_stack([-pieces[:, 1], pieces[:, 0]])
        first, last = (cross(way, ends + aside - start) > 0.0 for ends in (line[:-1], line[1:]))
        return bool(((before > self.near) & (after < -self.near) & (first != last)).any())

    def whereabouts(self, now: _Moment) -> str:
        """Position of the node: "beyond" an end of the axis, "before" the axis on the pair's side, or "behind" the axis."""
        line, near = now.line, self.near
        nearest = int(np.argmin(np.hypot(*(line - now.node).T)))
        first, last = max(nearest - 1, 0), min(nearest + 1, len(line) - 1)
        tangent, away = line[last] - line[first], now.node - line[nearest]
        tangent = tangent / np.hypot(*tangent)
        along = float(tangent @ away)
        if (nearest == 0 and along < -near) or (nearest == len(line) - 1 and along > near):
            return "beyond"
        gap = self.face.left * cross(tangent, away) - self.reach(line)[nearest] - self.face.slope * along
        return "behind" if gap < -near else "before"

    def reach(self, line: Array) -> Array:
        """Distances (m,) at which the node touches at the points of an axis."""
        if not self.face.slope:
            return np.full(len(line), self.face.start)
        return np.asarray(self.face.reach(np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))))


def misstated(
    response: Response, scene: Scene, found: Mapping[int, Equilibrium], allowed: float
) -> Iterator[str]:
    """Yield events that are not those of the answer's states, or not those of the exact equilibria `found` beside them."""
    specs, times = {spec.pair: spec for spec in scene.contacts}, response.load_parameter
    for event in response.events or ():
        t = event.load_parameter
        if event.kind in CRITICAL or (
            event.kind in ENDING and event.pair in specs and not response.completed
        ):
            continue
        last = times[-1] if response.completed else scene.times[-1]
        if event.kind not in KINDS or event.pair not in specs or not 0.0 <= t <= last:
            yield f"no contact of the scene has the event {event.kind} of {event.pair} at load parameter {t:.6g}"
            continue
        after = int(np.searchsorted(times, t))
        # the load parameter of a pass-through is interpolated; `friction.rubbing` compares the events with friction
        if event.kind == PASSES or any(spec.friction for spec in scene.contacts):
            continue
        for k in (after - 1, after)[: 1 if event.kind in OPENS else 2]:
            there = _beside(response, event, found.get(k))
            wrong = "" if there is None else _wrong(specs[event.pair], event, there, allowed)
            if wrong:
                yield f"{event.kind} of {event.pair} at load parameter {t:.6g}: {wrong}"
    for spec in scene.contacts:
        yield from _disorder(response, spec)


def _beside(response: Response, event: ContactEvent, near: Equilibrium | None) -> Equilibrium | None:
    """Return the equilibrium at an event that follows from one beside it, if nothing else changes in between."""
    if near is None:
        return None
    low, high = sorted((event.load_parameter, near.load_parameter))
    if any(low <= one.load_parameter <= high for one in changes_of(response) if one is not event):
        return None
    found = reach(near, event.load_parameter, near.layout.grips, halvings=2)
    return found if found.found else None


def _disorder(response: Response, spec: ContactSpec) -> Iterator[str]:
    """Yield an event that closes a closed contact, or that opens or moves an open one."""
    own = [event for event in response.events or () if event.pair == spec.pair and event.kind in KINDS]
    force, times = response.contacts[spec.pair].force, response.load_parameter
    closed = bool(own) and own[0].kind not in CLOSES
    for event in own:
        # a contact may begin without force, closed from the start
        if closed == (event.kind in CLOSES) and not (event is own[0] and force[0] != 0.0):
            yield f"{event.kind} of {spec.pair} at load parameter {event.load_parameter:.6g} where it is {'closed' if closed else 'open'}"
        closed = event.kind not in OPENS
    if own and own[-1].load_parameter < times[-1] and closed != (force[-1] != 0.0):
        yield f"{spec.pair} is {'open' if closed else 'closed'} at the end, not as its last event says"


def _wrong(spec: ContactSpec, event: ContactEvent, there: Equilibrium, allowed: float) -> str:
    """Return what an event states otherwise than the equilibrium there; empty if it states the same."""
    length, contact = there.scene.beam(spec.beam).length, there.contacts.get(spec.pair)
    if contact is None:
        off = gap_off(there, spec, 0.0) / length if event.kind in CLOSES else 0.0
        return "" if off <= allowed else f"the node is {off:.2g} L away"
    off = abs(contact.arc_position - event.arc_position) / length
    if not off <= allowed:
        return f"arc position off by {off:.2g}"
    force = 0.0 if event.kind in CLOSES else math.hypot(*contact.force)
    off = abs(force - event.force) / largest_force(there)
    return "" if off <= allowed else f"contact force off by {off:.2g}"
