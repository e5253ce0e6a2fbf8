"""Checks between the load parameters of an answer: no node passes through a beam, contacts change at events only, and these are true."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from comparisons.answer import Array, ContactEvent, Response
from comparisons.answer.axis import place_of
from comparisons.referee.distance import gap_off, largest_force
from comparisons.referee.grip import UnknownFrictionError
from comparisons.referee.guess import answer_state
from comparisons.referee.newton import equilibrium
from comparisons.referee.path import CLOSES, OPENS, PASSES, STAYS, at_rest, changes_of, reach, same, way_to
from comparisons.referee.rod import axis_at_rest, cross, face_of
from comparisons.referee.state import Equilibrium
from comparisons.scene import ContactSpec, Scene

if TYPE_CHECKING:
    from comparisons.referee.friction import History

KINDS = (*CLOSES, *OPENS, *STAYS, PASSES)
"""Kinds of contact events."""
CRITICAL = ("limit-point", "bifurcation")
"""Kinds of events without a contact."""
ENDING = ("line-contact", "end-contact")
"""Kinds of events at which a contact ends the solution."""
SAMPLES = 101
"""Positions of a node between two load parameters at which its side of the beam is determined."""
_STEPS = 32
"""Steps in which a path is followed where a node gets behind a beam."""
_UNSURE, _NEARLY = 0.5, 0.1
"""Distance of a crossing from the beam's end, over the node's path, within which chords do not tell whether the node passes around the end,
and those of a followed path do not of a node that ends beyond it."""


class Passage(NamedTuple):
    """A sentence on a node that gets behind a beam: through it, if that is certain."""

    sentence: str
    certain: bool


Moment = tuple[float, Array, Array]
"""A load parameter, with the axis of a beam and the place of a node."""


@lru_cache(maxsize=1)
def history_of(response: Response, scene: Scene) -> "History | None":
    """Return how friction holds the contacts of an answer; None in a scene without friction, for which nothing of it is loaded."""
    if not any(spec.friction for spec in scene.contacts):
        return None
    from comparisons.referee.friction import History

    return History(response, scene)


def passages(response: Response, scene: Scene) -> Iterator[Passage]:
    """Yield every open pair whose node passed through the beam, or may have."""
    follow = cache(lambda k: _followed(response, scene, k))
    for spec in scene.contacts:
        yield from _Pair(response, scene, spec, follow).passed_through()


def changes(response: Response, scene: Scene) -> Iterator[str]:
    """Yield a sentence for every pair that closes or opens without an event, if the answer records events."""
    if response.events is None:
        return
    times = np.concatenate([[0.0], response.load_parameter])
    for spec in scene.contacts:
        contact = response.contacts[spec.pair]
        own = [event for event in changes_of(response, spec.pair) if event.kind not in STAYS]
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

    def __init__(
        self, response: Response, scene: Scene, spec: ContactSpec, follow: Callable[[int], list[Equilibrium]]
    ) -> None:
        self.response, self.scene, self.spec, self.follow = response, scene, spec, follow
        self.near, self.face = 1e-6 * scene.beam(spec.beam).length, face_of(scene, spec)

    def passed_through(self) -> Iterator[Passage]:
        """Yield the first passage of the open node that is certain, or one that is not; none after a slip-off."""
        # axes and ends move in straight lines; where a node gets behind the beam, along the path that is followed
        pair, unsure, moment = self.spec.pair, "", cache(self.moment)
        contact = self.response.contacts[pair]
        closed, stated = np.append(False, contact.force > 0.0), self.response.events is not None
        for k, t in enumerate(map(float, self.response.load_parameter)):
            if t >= contact.slip_off:
                break
            if closed[k + 1]:
                continue
            last, now, held = moment(k - 1), moment(k), bool(closed[k])
            depth = self.depth(last, now, held)
            if depth < -_UNSURE or (held and not stated and self.place(now)[1] < 0.0):
                continue
            way = self.follow(k)
            if self.passes(way, held) if way else depth > _UNSURE and not held:
                words = f"{pair} is open and its node goes through the beam up to load parameter {t:.6g}"
                yield Passage(words, certain=True)
                return
            if not way:
                unsure = unsure or (
                    f"the path up to load parameter {t:.6g} is not found, on which the node of {pair} "
                    "gets behind the beam, through it or past its end"
                )
        if unsure:
            yield Passage(unsure, certain=False)

    def passes(self, way: list[Equilibrium], before: bool) -> bool:
        """Whether the node, first at the pair's side or closed, passes through the beam on a way, and does not return."""
        beam, node, through = self.spec.beam, self.spec.node, False
        arcs = self.response.axis_line(beam, 0)[0]
        steps = [(one.load_parameter, one.shape(beam, arcs).position, one.place(node)) for one in way]
        for begin, end in pairwise(steps):
            gap, inside = self.place(end)
            through = through or self.depth(begin, end, before) >= (_NEARLY if inside < 0.0 else 0.0)
            before = gap >= -self.near
            through = through and not before
        return through

    def depth(self, begin: Moment, end: Moment, before: bool) -> float:
        """How far inside the beam's ends the node gets from `before` the beam behind it, over its path; -inf if it does not."""
        if self.place(end)[0] >= -self.near:
            return -math.inf
        parts = np.linspace(0.0, 1.0, SAMPLES)
        times, lines, nodes = (
            [(1.0 - u) * a + u * b for u in parts] for a, b in zip(begin, end, strict=True)
        )
        if "." not in self.spec.node:
            nodes = [np.array(self.scene.pin(self.spec.node).position(float(t))) for t in times]
        moved = lines[-1] - lines[0]
        way = np.hypot(*(nodes[-1] - nodes[0] - moved[[0, -1]]).T).max() + self.near
        gaps, insides = np.transpose([self.place(item) for item in zip(times, lines, nodes, strict=True)])
        # a node whose nearest point becomes another one does not cross the beam
        most = np.hypot(*np.diff(nodes, axis=0).T).max() + np.hypot(*moved.T).max() / SAMPLES
        ahead = gaps >= -self.near
        ahead[0] |= before
        through = ahead[:-1] & ~ahead[1:] & (gaps[1:] >= np.minimum(gaps[:-1], 0.0) - 2.0 * most)
        return float(np.max(insides[1:][through] / way, initial=-math.inf))

    def moment(self, k: int) -> Moment:
        """The beam and the node at load parameter k; undeformed for k = -1."""
        arc, line = self.response.axis_line(self.spec.beam, max(k, 0))
        node = place_of(self.response, self.scene, self.spec.node, k)
        if k < 0:
            return 0.0, axis_at_rest(self.scene.beam(self.spec.beam), arc), node
        return float(self.response.load_parameter[k]), line, node

    def place(self, now: Moment) -> tuple[float, float]:
        """Gap of the node from the curve of touching nodes, which goes on straight beyond the ends, and distance inside the nearer end."""
        _, line, node = now
        nearest = int(np.argmin(np.hypot(*(line - node).T)))
        first, last = max(nearest - 1, 0), min(nearest + 1, len(line) - 1)
        tangent, away = line[last] - line[first], node - line[nearest]
        tangent = tangent / np.hypot(*tangent)
        arcs = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
        arc = float(arcs[nearest] + tangent @ away)
        return float(self.face.left * cross(tangent, away) - self.face.reach(arc)), min(arc, arcs[-1] - arc)


def _followed(response: Response, scene: Scene, k: int) -> list[Equilibrium]:
    """Return equilibria on the path to load parameter number k from the one before; none if it jumps, or leads elsewhere."""
    history = history_of(response, scene)

    def at(n: int) -> Equilibrium:
        if n < 0:
            return at_rest(scene)
        grips = history.grips(n) if history else {}
        return equilibrium(scene, replace(answer_state(response, scene, n), grips=grips))

    try:
        begin, end, held = at(k - 1), at(k), history.around if history else None
        way = way_to(response, begin, end.load_parameter, held, _STEPS) if end.found else []
    except UnknownFrictionError:
        return []
    return way if way and same(way[-1], end) else []


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
            for wrong in _wrong(response, specs[event.pair], event, found[k], allowed) if k in found else ():
                yield f"{event.kind} of {event.pair} at load parameter {t:.6g}: {wrong}"
    for spec in scene.contacts:
        yield from _disorder(response, spec)


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


def _wrong(
    response: Response, spec: ContactSpec, event: ContactEvent, beside: Equilibrium, allowed: float
) -> Iterator[str]:
    """Yield what an event states otherwise than the equilibrium there, whose force may vanish, if nothing else changes from the one beside it."""
    low, high = sorted((event.load_parameter, beside.load_parameter))
    if any(low <= one.load_parameter <= high for one in changes_of(response) if one is not event):
        return
    there = reach(beside, event.load_parameter, beside.layout.grips, halvings=2)
    length, contact, closes = (
        there.scene.beam(spec.beam).length,
        there.contacts.get(spec.pair),
        event.kind in CLOSES,
    )
    if not there.found:
        return
    if contact is None:
        off = gap_off(there, spec, 0.0) / length if closes else 0.0
        if not off <= allowed:
            yield f"the node is {off:.2g} L away"
        return
    off = abs(contact.arc_position - event.arc_position) / length
    force = 0.0 if closes else math.hypot(*contact.force)
    lost = abs(force - event.force) / max(largest_force(there), largest_force(beside))
    if not off <= allowed:
        yield f"arc position off by {off:.2g}"
    elif not lost <= allowed:
        yield f"contact force off by {lost:.2g}"
