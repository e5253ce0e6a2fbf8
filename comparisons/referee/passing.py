"""Checks between the load parameters of an answer: no node passes through a beam, contacts change at events only, and these are true."""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.distance import gap_off, largest_force
from comparisons.referee.guess import answer_state
from comparisons.referee.newton import solve
from comparisons.referee.path import PASSES, at_rest, changes_of, events_between, on_the_way, reach
from comparisons.referee.rod import axis_at_rest, cross, face_of, left
from comparisons.referee.state import Equilibrium
from comparisons.response import ContactEvent, ContactHistory, Response
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
        through = _passed_through(response, scene, spec, response.contacts[spec.pair])
        if through is not None:
            yield f"{spec.pair} is open and its node goes through the beam up to load parameter {through:.6g}"


def changes(response: Response, scene: Scene) -> Iterator[str]:
    """Yield a sentence for every pair that closes or opens without an event, if the answer records events."""
    if response.events is None:
        return
    times = np.concatenate([[0.0], response.load_parameter])
    slipped = {event.pair for event in response.events if event.kind == "slip-off"}
    for spec in scene.contacts:
        contact = response.contacts[spec.pair]
        if np.isfinite(contact.slip_off) and spec.pair not in slipped:
            yield f"{spec.pair} slips off at load parameter {contact.slip_off:.6g} without an event"
        closed = contact.force != 0.0
        own = [event for event in response.events if event.pair == spec.pair and event.kind not in _CLOSED]
        events = np.array([event.load_parameter for event in own])
        for k in np.flatnonzero(closed[1:] != closed[:-1]) + 1:
            if not np.any((events >= times[k]) & (events <= times[k + 1])):
                what = "closes" if closed[k] else "opens"
                yield f"{spec.pair} {what} without an event up to load parameter {times[k + 1]:.6g}"


def _passed_through(
    response: Response, scene: Scene, spec: ContactSpec, contact: ContactHistory
) -> float | None:
    """Load parameter by which the node of an open pair has passed through the deflected axis; None if it has not.

    Between two load parameters the axis and the ends of beams move in straight lines; where these cross, along the path that is followed.
    After a closed contact the node is followed only if it ends behind the axis, and after a slip-off it is not followed.
    """
    closed = contact.force > 0.0
    now = _moment(response, scene, spec, -1)
    where = _whereabouts(now.line, now.node, scene, spec)
    for k, t in enumerate(map(float, response.load_parameter)):
        if t >= contact.slip_off:
            return None
        if closed[k]:
            where = "before"
            continue
        now = _moment(response, scene, spec, k)
        last, where = where, _whereabouts(now.line, now.node, scene, spec)
        if where == "before" or (k > 0 and closed[k - 1] and where != "behind"):
            continue
        if _goes_through(scene, spec, _moment(response, scene, spec, k - 1), now, last):
            way = _followed(response, scene, spec, k)
            if not way or _goes_through_on(scene, spec, way, last):
                return t
    return None


def _goes_through_on(scene: Scene, spec: ContactSpec, way: list[_Moment], where: str) -> bool:
    """Whether a node, first at the side `where`, passes through the axis on a followed way and does not return."""
    through = False
    for first, last in pairwise(way):
        before, where = where, _whereabouts(last.line, last.node, scene, spec)
        through = where != "before" and (through or _goes_through(scene, spec, first, last, before))
    return through


def _followed(response: Response, scene: Scene, spec: ContactSpec, k: int) -> list[_Moment]:
    """States on the path to load parameter k from the one before; none if it rubs, jumps, or leads elsewhere."""
    way, arcs = [_moment(response, scene, spec, k - 1)], response.axis_line(spec.beam, k)[0]
    end = _moment(response, scene, spec, k)
    now = at_rest(scene) if k == 0 else solve(scene, answer_state(response, scene, k - 1))
    if not now.found:
        return []
    events = events_between(response, way[0].t, end.t)
    found = on_the_way(now, events, np.linspace(way[0].t, end.t, _STEPS + 1)[1:].tolist())
    for solution in found:
        exact = Equilibrium(solution)
        line = exact.shape(spec.beam, arcs).position
        way.append(_Moment(exact.load_parameter, line, exact.place(spec.node)))
    apart = np.hypot(*(way[-1].line - end.line).T).max()
    return way if found and apart <= _SAME * scene.beam(spec.beam).length else []


def _goes_through(scene: Scene, spec: ContactSpec, begin: _Moment, end: _Moment, where: str) -> bool:
    """Whether a node, first at the side `where`, passes through the axis between two moments and does not return.

    A node that returns may have been in contact in between.
    """
    line, line_after = begin.line, end.line
    parts = np.linspace(0.0, 1.0, SAMPLES)
    touched = np.concatenate([line, line_after])
    if "." in spec.node:
        nodes = (1.0 - parts)[:, None] * begin.node + parts[:, None] * end.node
    else:
        pin = scene.pin(spec.node)
        nodes = np.array([pin.position(float((1.0 - u) * begin.t + u * end.t)) for u in parts])
    apart = np.maximum(nodes.min(axis=0) - touched.max(axis=0), touched.min(axis=0) - nodes.max(axis=0))
    if apart.max() > float(np.max(_reach(line, scene, spec))):
        return False
    leaves = _whereabouts(line_after, nodes[-1], scene, spec) == "beyond"
    way = np.hypot(*((nodes[-1] - nodes[0]) - (line_after - line)[[0, -1]]).T)
    through = False
    for u, (start, node) in zip(parts[1:], pairwise(nodes), strict=True):
        moved = (1.0 - u) * line + u * line_after
        before, where = where, _whereabouts(moved, node, scene, spec)
        if before == "before" and where != "before":
            through = where == "behind" or _cuts(moved, start, node, scene, spec)
            short = np.hypot(*(node - moved[[0, -1]]).T) - np.max(_reach(moved, scene, spec))
            # so near to an end that the node may have passed around the end
            through = through and not (leaves and bool((short <= _AROUND * way).any()))
        through = through and where != "before"
    return through


def _moment(response: Response, scene: Scene, spec: ContactSpec, k: int) -> _Moment:
    """A beam and a node at load parameter k; undeformed for k = -1."""
    t, line = float(response.load_parameter[k]) if k >= 0 else 0.0, _line(response, scene, spec.beam, k)
    if "." not in spec.node:
        return _Moment(t, line, np.array(scene.pin(spec.node).position(t)))
    beam, end = spec.node.split(".")
    if k >= 0 and end == scene.tip(beam):
        return _Moment(t, line, np.asarray(response.tips[beam][k]))
    return _Moment(t, line, np.asarray(_line(response, scene, beam, k)[0 if end == "start" else -1]))


def _line(response: Response, scene: Scene, beam: str, k: int) -> Array:
    """Axis of a beam at load parameter k; undeformed for k = -1 and if nothing acts on the beam."""
    if k >= 0 and not _at_rest(response, scene, beam, k):
        return response.axis_line(beam, k)[1]
    return axis_at_rest(scene.beam(beam), response.axis_line(beam, 0)[0])


def _at_rest(response: Response, scene: Scene, beam: str, k: int) -> bool:
    """Whether a beam has one fixed clamp and no load, joint or closed contact, so that it is undeformed."""
    ends, held = (f"{beam}.start", f"{beam}.end"), scene.supports_of(beam)
    spec = scene.beam(beam)
    joined = any({spec.start, spec.end} & {item.start, item.end} for item in scene.beams if item is not spec)
    still = len(held) == 1 and None not in held[0].motion and not scene.prescribed_motions[held[0].node].moves
    loaded = any(item.load.beam == beam for item in scene.load_histories) or spec.density is not None
    if joined or not still or loaded:
        return False
    pairs = [contact.pair for contact in scene.contacts if contact.beam == beam or contact.node in ends]
    return all(response.contacts[pair].force[k] == 0.0 for pair in pairs)


def _cuts(line: Array, start: Array, end: Array, scene: Scene, spec: ContactSpec) -> bool:
    """Whether the segment from start to end crosses the curve of touching nodes from the pair's side."""
    near = 1e-6 * scene.beam(spec.beam).length
    side = left(spec)
    pieces, way, offset = np.diff(line, axis=0), end - start, _reach(line[:-1], scene, spec)
    lengths = np.hypot(*pieces.T)
    before, after = (side * cross(pieces, node - line[:-1]) / lengths - offset for node in (start, end))
    aside = np.reshape(side * offset / lengths, (-1, 1)) * np.column_stack([-pieces[:, 1], pieces[:, 0]])
    first, last = (cross(way, ends + aside - start) > 0.0 for ends in (line[:-1], line[1:]))
    return bool(((before > near) & (after < -near) & (first != last)).any())


def _whereabouts(line: Array, node: Array, scene: Scene, spec: ContactSpec) -> str:
    """Position of a node: "beyond" an end of the axis, "before" the axis on the pair's side, or "behind" the axis."""
    near = 1e-6 * scene.beam(spec.beam).length
    nearest = int(np.argmin(np.hypot(*(line - node).T)))
    first, last = max(nearest - 1, 0), min(nearest + 1, len(line) - 1)
    tangent, away = line[last] - line[first], node - line[nearest]
    tangent = tangent / np.hypot(*tangent)
    along = float(tangent @ away)
    if (nearest == 0 and along < -near) or (nearest == len(line) - 1 and along > near):
        return "beyond"
    reach = np.broadcast_to(_reach(line, scene, spec), len(line))[nearest]
    gap = left(spec) * cross(tangent, away) - reach - face_of(scene, spec).slope * along
    return "behind" if gap < -near else "before"


def _reach(line: Array, scene: Scene, spec: ContactSpec) -> Array | float:
    """Distances at which a node touches at the points of an axis."""
    face = face_of(scene, spec)
    if not face.slope:
        return face.start
    return np.asarray(face.reach(np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))))


def misstated(
    response: Response, scene: Scene, found: Mapping[int, Equilibrium], allowed: float
) -> Iterator[str]:
    """Yield events that are not those of the answer's states, or at which the exact contact is elsewhere or has another force.

    An event beside one of the exact equilibria `found`, by the numbers of their load parameters, is compared with the equilibrium that
    follows from it: at a contact that is closed there, arc position and force; of one that is open, the gap. With friction,
    `friction.rubbing` compares the events instead.
    """
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
        # the load parameter of a pass-through is interpolated
        if event.kind == PASSES or any(spec.friction for spec in scene.contacts):
            continue
        for k in (after - 1, after)[: 1 if event.kind in OPENS else 2]:
            there = _at(found.get(k), t) if _alone(response, event, k) else None
            wrong = "" if there is None else _wrong(specs[event.pair], event, there, allowed)
            if wrong:
                yield f"{event.kind} of {event.pair} at load parameter {t:.6g}: {wrong}"
    for spec in scene.contacts:
        yield from _disorder(response, spec)


def _alone(response: Response, event: ContactEvent, k: int) -> bool:
    """Whether nothing else changes between an event and a load parameter beside it."""
    if not 0 <= k < len(response.load_parameter):
        return False
    low, high = sorted((event.load_parameter, float(response.load_parameter[k])))
    return not any(low <= one.load_parameter <= high for one in changes_of(response) if one is not event)


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


def _at(near: Equilibrium | None, t: float) -> Equilibrium | None:
    """Return the equilibrium with the same contacts at an event beside a load parameter; None if there is none."""
    found = None if near is None else reach(near.solution, t, near.solution.layout.grips, halvings=2)
    return Equilibrium(found) if found and found.found else None


def _wrong(spec: ContactSpec, event: ContactEvent, there: Equilibrium, allowed: float) -> str:
    """Return what an event states otherwise than the equilibrium there; empty if it states the same."""
    length = there.scene.beam(spec.beam).length
    contact = there.contacts.get(spec.pair)
    if contact is None and event.kind not in CLOSES:
        return ""
    if contact is None:
        off = gap_off(there, spec, 0.0) / length
        return "" if off <= allowed else f"the node is {off:.2g} L away"
    off = abs(contact.arc_position - event.arc_position) / length
    if not off <= allowed:
        return f"arc position off by {off:.2g}"
    force = 0.0 if event.kind in CLOSES else float(np.hypot(*contact.force))
    off = abs(force - event.force) / largest_force(there)
    return "" if off <= allowed else f"contact force off by {off:.2g}"
