"""The exact states of one rod under one pin as a response."""

import math
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from comparisons.answer import Array, ContactEvent, ContactHistory, FrictionHistory, Response, SupportHistory
from comparisons.exact import Outcome, RodPath
from comparisons.models.cantilever import RodScene
from comparisons.models.shared import POINTS
from comparisons.scene.ends import BeamEnd

STOPS = {
    "LOST": "no stable equilibrium is connected with the straight beam",
    "LOST_CONTACT": "a contact that must persist was released",
    "SLIPPED_OFF": "a contact that must persist slipped off the beam",
    "END_CONTACT": "contact with the end of a beam is not modelled",
    "JAMMED": "the contact can neither stick nor slip",
}
"""Reasons why an exact solution stops."""
_LOST = [state.name for state in Outcome if state.ends]


def _events(path: RodPath, local: RodScene) -> Iterator[ContactEvent]:
    """Yield the located changes of state."""
    kinds = {Outcome.OPEN: "release", Outcome.SLIPPED: "slip-off", Outcome.STICK: "stick"}
    for event in path.events:
        if event.after.ends or event.load_parameter == 0.0:
            continue
        touch = event.after.touches and not event.before.touches
        yield ContactEvent(
            kind="touch" if touch else kinds.get(event.after, "slip"),
            load_parameter=event.load_parameter,
            pair=local.scene.contacts[0].pair,
            element=0,
            arc_position=float(local.arc(event.arc_position)),
            force=event.magnitude,
            released=0.0,
        )


def local_response(local: RodScene, path: RodPath, *, unknowns: int) -> Response:
    """Return the response in the scene's frame, up to the last load parameter at which an equilibrium was found."""
    scene, sense = local.scene, local.sense
    (beam,), (contact,), times = scene.beams, scene.contacts, np.array(scene.times)
    stop, reached = _end(path, local, times)
    met = _end_contact(local, path)
    if times[:reached].max(initial=0.0) >= met or (stop in _LOST and met <= times[reached]):
        stop, reached = "END_CONTACT", int(np.searchsorted(times, met))
    when = f" at load parameter {times[reached]:.6g}" if stop else ""
    if stop == "END_CONTACT":
        when = f": {contact.node} meets the {scene.tip(beam.name)} of {beam.name} at load parameter {met:.9g}"

    @cache
    def axis_line(_: str, k: int) -> tuple[Array, Array]:
        line = local.position(path.shape(int(local.hits[k]), POINTS)[:, :2])
        return np.linspace(0.0, beam.length, POINTS), line[::sense]

    at = local.hits[:reached]
    force, outcome = path.force[at] @ local.axes.T, [path.outcome[k] for k in at]
    arcs = local.arc(path.arc_position[at])
    slipped = np.array([one is Outcome.SLIPPED for one in outcome], dtype=bool)
    more: dict[str, Any] = {}
    friction = None
    if contact.friction:
        friction = FrictionHistory(
            tangential=sense * path.tangential[at],
            normal=path.normal[at],
            slip=np.array([sense * one.sense for one in outcome], dtype=np.int64),
            dissipated=path.dissipated[at],
        )
        more = {"work": path.work[at], "events": tuple(_events(path, local)), "index": np.full(reached, -1)}
    history = ContactHistory(
        force=np.hypot(*force.T),
        arc_position=arcs,
        gap=np.where(
            np.isfinite(arcs), 0.0, np.where(slipped, np.nan, -local.path[at, 1] - scene.offset(contact))
        ),
        slip_off=path.slip_off if reached and path.slip_off <= times[reached - 1] else np.nan,
        vector=force,
        friction=friction,
    )
    # the local frame may be a mirror image, in which moments change their sign
    moment = np.round(np.linalg.det(local.axes)) * path.clamp_moment[at]
    return Response(
        status=stop or "COMPLETED",
        message=f"{STOPS[stop]}{when}" if stop else "all load parameters were reached",
        load_parameter=times[:reached],
        contacts={contact.pair: history},
        supports={local.clamp.node: SupportHistory(force=-force, moment=moment)},
        tips={beam.name: local.position(path.tip[at])},
        newton_iterations=np.diff(np.cumsum(path.iterations)[at], prepend=0),
        unknowns=unknowns,
        axis_line=axis_line,
        **more,
    )


def _end(path: RodPath, local: RodScene, times: Array) -> tuple[str | None, int]:
    """Return the reason why the solution stops, None if it does not, and the number of load parameters reached before."""
    closed, keep = False, local.scene.contacts[0].keep
    slipped = np.searchsorted(times, path.slip_off) if keep else len(times)
    for k, state in enumerate(path.outcome):
        before = int(np.searchsorted(local.hits, k))
        if before > slipped:
            break
        if state.ends:
            return state.name, before
        if keep and closed and state is Outcome.OPEN:
            return "LOST_CONTACT", before
        closed = closed or state.touches
    return ("SLIPPED_OFF", int(slipped)) if slipped < len(times) else (None, len(times))


def _end_contact(local: RodScene, found: RodPath) -> float:
    """Load parameter at which the pin meets the tip while the rod is straight, or rolls onto its corner; inf if it does not."""
    (contact,), (beam,), t = local.scene.contacts, local.scene.beams, found.load_parameter
    offset, radius, length = local.scene.offset(contact), local.scene.radius(contact), beam.length
    if not offset:
        return math.inf
    path = local.path - [length, 0.0]
    tip = BeamEnd("", (0.0, 0.0), (-1.0, 0.0), offset - radius, radius)
    corner = found.slip_off if radius and not np.isnan(found.slip_off) else math.inf
    for k, (start, end) in enumerate(pairwise(path)):
        if found.outcome[k].touches or t[k] >= corner:
            continue
        part = tip.meeting((start[0], start[1]), (end[0], end[1]))
        x, y = start + part * (end - start)
        up = (-offset - start[1]) / (y - start[1]) if start[1] <= -offset < y else 1.0
        if start[0] + up * (x - start[0]) > -1e-12 * length:
            return min(corner, float((1.0 - part) * t[k] + part * t[k + 1]))
    return corner
