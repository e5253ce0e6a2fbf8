"""Responses of the two exact models: Reissner's rod and the elastica."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from comparisons.exact.elastica import ElasticaState, elastica_under_pin
from comparisons.exact.outcome import Outcome
from comparisons.exact.rod import rod_under_pin
from comparisons.models.options import ModelError, Options
from comparisons.models.progress import Watch, unwatched
from comparisons.models.rod import ELASTICA, ROD
from comparisons.models.translate import RodScene, to_rod
from comparisons.response import Array, ContactHistory, Response, SupportHistory
from comparisons.response.axis import axis_grid
from comparisons.scene import Scene, unstated
from comparisons.scene.ends import BeamEnd
from comparisons.scene.keys import ONE_ROD

POINTS = 401
"""Points of a deflected axis in pictures. The solution does not depend on this number."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LocalStates:
    """States of a cantilever in its local frame (`RodScene`), one for each load parameter; the pin exerts the force.

    `visited` has one outcome for each point of the path, and `hits` the indices of the points that belong to load parameters.
    """

    visited: Sequence[Outcome]
    hits: NDArray[np.int64]
    force: Array
    arc_position: Array
    clamp_moment: Array
    tip: Array
    iterations: NDArray[np.int64]
    shape: Callable[[int], Array]
    slip_off: float


STOPS = {
    "LOST": "no stable equilibrium is connected with the straight beam",
    "LOST_CONTACT": "a contact that must persist was released",
    "SLIPPED_OFF": "a contact that must persist slipped off the beam",
    "END_CONTACT": "contact with the end of a beam is not modelled",
}
"""Reasons why an exact solution stops."""


def solve_rod(scene: Scene, local: RodScene) -> Response:
    """Solve `scene` as a Reissner rod; `local` is the scene in the rod's frame."""
    beam, hits = local.beam, local.hits
    stiffness = {"EA": beam.EA, "GA": beam.GA, "EI": beam.EI, "length": beam.length}
    began = perf_counter()
    path = rod_under_pin(local.path, offset=local.offset, **stiffness)
    seconds = perf_counter() - began
    states = LocalStates(
        visited=path.outcome,
        hits=hits,
        force=path.force[hits],
        arc_position=path.arc_position[hits],
        clamp_moment=path.clamp_moment[hits],
        tip=path.tip[hits],
        iterations=np.diff(np.cumsum(path.iterations)[hits], prepend=0),
        shape=lambda k: path.shape(int(hits[k]), POINTS)[:, :2],
        slip_off=path.slip_off,
    )
    return local_response(ROD.name, scene, local, states, unknowns=path.unknowns.shape[1], seconds=seconds)


def elastica_scene(scene: Scene) -> RodScene:
    """Return `scene` as the elastica states it.

    Raises
    ------
    ModelError
        Unless a pin on the axis pushes one cantilever.
    """
    unknown = unstated(scene, "the elastica", ONE_ROD)
    if unknown is not None:
        raise ModelError(unknown)
    local = to_rod(scene)
    if local.contact.friction:
        raise ModelError("the elastica has no friction here, the scene has some")
    if local.offset:
        raise ModelError(
            "the elastica has a point in contact on its axis only, the scene has a face or a round pin"
        )
    return local


def solve_elastica(scene: Scene, _: Options, _watch: Watch = unwatched) -> Response:
    """Solve `scene` as an elastica, in closed form."""
    local = elastica_scene(scene)
    beam = local.beam
    began = perf_counter()
    path: list[ElasticaState] = []
    for x, y in local.points:
        state = elastica_under_pin(float(x), float(y), EI=beam.EI, length=beam.length)
        if y > 0.0 and path and path[-1].outcome is Outcome.SLIPPED:
            state = path[-1]
        path.append(state)
    seconds = perf_counter() - began
    states = LocalStates(
        visited=tuple(state.outcome for state in path),
        hits=np.arange(len(path)),
        force=np.array([state.force for state in path]),
        arc_position=np.array([state.arc_position for state in path]),
        clamp_moment=np.array([state.clamp_moment for state in path]),
        tip=np.array([state.tip for state in path]),
        iterations=np.zeros(len(path), dtype=np.int64),
        shape=lambda k: path[k].shape(POINTS),
        slip_off=next(
            (t for t, state in zip(scene.times, path, strict=True) if state.outcome is Outcome.SLIPPED),
            np.nan,
        ),
    )
    return local_response(ELASTICA.name, scene, local, states, unknowns=1, seconds=seconds)


def local_response(
    model: str, scene: Scene, local: RodScene, states: LocalStates, *, unknowns: int, seconds: float
) -> Response:
    """Return the response in the scene's frame, up to the last load parameter at which an equilibrium was found."""
    name, length = local.beam.name, local.beam.length
    times = np.array(scene.times)
    stop, reached = _end(states, times, keep=local.contact.keep)
    met = _end_contact(scene, local, states)
    if times[:reached].max(initial=0.0) >= met or (stop == "LOST" and met <= times[reached]):
        stop, reached = "END_CONTACT", int(np.searchsorted(times, met))
    when = f" at load parameter {times[reached]:.6g}" if stop else ""
    if stop == "END_CONTACT":
        end = "start" if local.from_end else "end"
        when = f": {local.contact.node} meets the {end} of {name} at load parameter {met:.9g}"

    @cache
    def axis_line(_: str, k: int) -> tuple[Array, Array]:
        arc, line = np.linspace(0.0, length, POINTS), local.position(states.shape(k))
        return (arc, line[::-1]) if local.from_end else (arc, line)

    support = SupportHistory(
        force=-local.vector(states.force[:reached]), moment=local.moment(states.clamp_moment[:reached])
    )
    return Response(
        model=model,
        scene=scene.name,
        status=stop or "COMPLETED",
        message=(f"{STOPS[stop]}{when}" if stop else "all load parameters were reached"),
        completed=stop is None,
        load_parameter=times[:reached],
        contacts=_contacts(scene, local, states, reached),
        supports={f"{name}.{local.clamp}": support},
        tips={name: local.position(states.tip[:reached])},
        newton_iterations=states.iterations[:reached],
        cutbacks=0,
        unknowns=unknowns,
        wall_seconds=seconds,
        axis_line=axis_line,
        grid=lambda k: axis_grid(scene, axis_line, k),
    )


def _end(states: LocalStates, times: Array, *, keep: bool) -> tuple[str | None, int]:
    """Return the reason why the solution stops, None if it does not, and the number of load parameters reached before."""
    closed = False
    slipped = np.searchsorted(times, states.slip_off) if keep else len(times)
    for k, state in enumerate(states.visited):
        before = int(np.searchsorted(states.hits, k))
        if before > slipped:
            break
        if state is Outcome.LOST:
            return "LOST", before
        if keep and closed and state is Outcome.OPEN:
            return "LOST_CONTACT", before
        closed = closed or state is Outcome.CONTACT
    return ("SLIPPED_OFF", int(slipped)) if slipped < len(times) else (None, len(times))


def _end_contact(scene: Scene, local: RodScene, states: LocalStates) -> float:
    """Load parameter at which the pin meets the tip while the rod is straight, or rolls onto its corner; inf if it does not."""
    if not local.offset:
        return math.inf
    radius, path = scene.radius(local.contact), local.path - [local.beam.length, 0.0]
    tip = BeamEnd("", (0.0, 0.0), (-1.0, 0.0), local.offset - radius, radius)
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    corner = states.slip_off if radius and not np.isnan(states.slip_off) else math.inf
    for k, (start, end) in enumerate(pairwise(path)):
        if states.visited[k] is Outcome.CONTACT or reached[k] >= corner * reached[-1]:
            continue
        part = tip.meeting((start[0], start[1]), (end[0], end[1]))
        x, y = start + part * (end - start)
        up = (-local.offset - start[1]) / (y - start[1]) if start[1] <= -local.offset < y else 1.0
        if start[0] + up * (x - start[0]) > -1e-12 * local.beam.length:
            return min(corner, float((1.0 - part) * reached[k] + part * reached[k + 1]) / float(reached[-1]))
    return corner


def _contacts(scene: Scene, local: RodScene, states: LocalStates, reached: int) -> dict[str, ContactHistory]:
    outcome = np.array(states.visited, dtype=object)[states.hits[:reached]]
    closed, slipped = outcome == Outcome.CONTACT, outcome == Outcome.SLIPPED
    below = -local.points[:reached, 1] - local.offset
    history = ContactHistory(
        force=np.hypot(*states.force[:reached].T),
        arc_position=np.where(closed, local.arc(states.arc_position[:reached]), np.nan),
        gap=np.where(closed, 0.0, np.where(slipped, np.nan, below)),
        slip_off=states.slip_off if reached and states.slip_off <= scene.times[reached - 1] else np.nan,
        vector=local.vector(states.force[:reached]),
    )
    return {local.contact.pair: history}
