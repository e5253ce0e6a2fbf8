"""The response of the exact rod under one pin with Coulomb friction."""

from dataclasses import replace
from time import perf_counter

import numpy as np

from comparisons.exact import FrictionPath, FrictionState, Surface, rod_with_friction
from comparisons.exact.outcome import Outcome
from comparisons.exact.reissner import Flexibility
from comparisons.exact.section import Section, integrate
from comparisons.models.exact import POINTS, LocalStates, local_response
from comparisons.models.rod import ROD
from comparisons.models.translate import RodScene
from comparisons.response import Array, ContactEvent, FrictionHistory, Response
from comparisons.scene import Scene

STOPS = {
    FrictionState.JAMMED: "the contact can neither stick nor slip",
}
"""Reasons why an exact solution with friction stops, besides those without."""


def solve_rod_with_friction(scene: Scene, local: RodScene) -> Response:
    """Solve `scene` as a Reissner rod under a pin with friction; `local` is the scene in the rod's frame."""
    beam, hits, contact = local.beam, local.hits, local.contact
    radius = scene.radius(contact)
    began = perf_counter()
    path = rod_with_friction(
        local.path,
        friction=contact.friction,
        EA=beam.EA,
        GA=beam.GA,
        EI=beam.EI,
        length=beam.length,
        surface=Surface(offset=local.offset - radius, radius=radius),
        side=1,
    )
    seconds = perf_counter() - began
    slipped = [event.load_parameter for event in path.events if event.after is FrictionState.SLIPPED]
    states = LocalStates(
        visited=tuple(_outcome(state) for state in path.state),
        hits=hits,
        force=path.force[hits],
        arc_position=path.arc_position[hits],
        clamp_moment=path.clamp_moment[hits],
        tip=path.tip[hits],
        iterations=np.zeros(len(hits), dtype=np.int64),
        shape=lambda k: _shape(path, local, int(hits[k])),
        slip_off=slipped[0] if slipped else np.nan,
    )
    response = local_response(ROD.name, scene, local, states, unknowns=4, seconds=seconds)
    reached = hits[: len(response.load_parameter)]
    sense = -1 if local.from_end else 1
    friction = FrictionHistory(
        tangential=sense * path.tangential[reached],
        normal=path.normal[reached],
        slip=np.array([sense * path.state[k].sense for k in reached], dtype=np.int64),
        dissipated=path.dissipated[reached],
    )
    (history,) = response.contacts.values()
    ended = next((state for state in path.state if state in STOPS), None)
    stopped = not response.completed and ended is not None
    return replace(
        response,
        contacts={contact.pair: replace(history, friction=friction)},
        work=path.work[reached],
        events=_events(path, local),
        index=np.full(len(reached), -1, dtype=np.int64),
        status=ended.name if stopped and ended else response.status,
        message=f"{STOPS[ended]}; {response.message}" if stopped and ended else response.message,
    )


def _outcome(state: FrictionState) -> Outcome:
    if state.touches:
        return Outcome.CONTACT
    kept = {FrictionState.OPEN: Outcome.OPEN, FrictionState.SLIPPED: Outcome.SLIPPED}
    return kept.get(state, Outcome.LOST)


def _events(path: FrictionPath, local: RodScene) -> tuple[ContactEvent, ...]:
    """Return the located changes of state."""
    found = []
    for event in path.events:
        kind = "stick" if event.after is FrictionState.STICK else "slip"
        if not event.after.touches:
            kind = "slip-off" if event.after is FrictionState.SLIPPED else "release"
        elif not event.before.touches:
            kind = "touch"
        if event.after.ends or event.load_parameter == 0.0:
            continue
        found.append(
            ContactEvent(
                kind=kind,
                load_parameter=event.load_parameter,
                pair=local.contact.pair,
                element=0,
                arc_position=float(local.arc(np.array(event.arc_position))),
                force=event.magnitude,
                released=0.0,
            )
        )
    return tuple(found)


def _shape(path: FrictionPath, local: RodScene, k: int) -> Array:
    """Return points (n, 2) of the axis from clamp to tip: the loaded part, then the straight tail."""
    beam = local.beam
    length, unit = beam.length, beam.EI / beam.length**2
    arc = np.linspace(0.0, length, POINTS)
    touching = path.state[k].touches
    loaded = min(float(path.arc_position[k]), length) if touching else 0.0
    fx, fy = path.force[k] / unit
    zero = np.zeros(POINTS)
    start = Section(zero, zero, zero, zero - path.clamp_moment[k] / unit / length)
    flexibility = Flexibility(stretch=unit / beam.EA, shear=unit / beam.GA)
    at = integrate(start, (zero + fx, zero + fy), np.minimum(arc, loaded) / length, flexibility)
    tail = np.maximum(arc - loaded, 0.0)
    rotation = path.tip_rotation[k] if touching else 0.0
    x, y = at.x * length + tail * np.cos(rotation), at.y * length + tail * np.sin(rotation)
    return np.stack([x, y], axis=1)
