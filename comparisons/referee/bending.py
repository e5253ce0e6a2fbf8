"""Whether the axis of a beam bends as the stated forces bend it, at every load parameter, without an equilibrium."""

from collections.abc import Iterator

import numpy as np

from comparisons.response import Array, Response
from comparisons.scene import BeamSpec, Scene

_OFF = 0.35
"""Largest difference of the two bends, over the larger one; the bend of a tripled force is off by two thirds."""
_PLACES = 1e-3
"""Errors of the places at which forces act, over the length, in the bend by these forces."""
_STATIONS = np.linspace(0.0, 1.0, 41)
"""Arc lengths between which the axis turns, over the length."""
_LEAST = 1e-3
"""Smallest bend that is compared [rad]."""


def bent_otherwise(response: Response, scene: Scene) -> Iterator[str]:
    """Yield a sentence for each beam whose axis does not turn by the integral of M/EI and the angles V/GA.

    M follows from the stated force and moment at the beam's start, the contact forces, and the places on the axis. Beams are left out
    that are curved or vary, that meet another beam or a spring at their start, or that carry loads elsewhere than at their end.
    """
    if response.outside or response.continuum or any(spec.friction for spec in scene.contacts):
        return
    for beam in scene.beams:
        if not _plain(response, scene, beam):
            continue
        lines = [response.axis_line(beam.name, k) for k in range(len(response.load_parameter))]
        arc = _STATIONS * beam.length
        place = np.array([[np.interp(arc, at, line[:, c]) for c in range(2)] for at, line in lines]).swapaxes(
            1, 2
        )
        stated, found, slack = _bends(response, scene, beam, place)
        size = np.maximum(np.ptp(stated, axis=1), np.ptp(found, axis=1))
        wrong = np.ptp(stated - found, axis=1) > _OFF * size + slack + _LEAST
        if wrong.any():
            t = response.load_parameter[np.argmax(wrong)]
            yield f"{beam.name} does not bend as the forces on it do at load parameter {t:.6g}"


def _plain(response: Response, scene: Scene, beam: BeamSpec) -> bool:
    """Whether the forces on a beam are stated from its start on."""
    start = f"{beam.name}.start"
    places = [scene.place(f"{other.name}.{end}") for other in scene.beams for end in ("start", "end")]
    taken = [*(item.node for item in scene.springs), *(item.node for item in scene.contacts)]
    loaded = any(
        history.load.beam == beam.name and history.load.node != f"{beam.name}.end"
        for history in scene.load_histories
    )
    alone = places.count(beam.start) == 1 and start not in taken and not loaded
    known = all(
        response.contacts[spec.pair].vector is not None for spec in scene.contacts if spec.beam == beam.name
    )
    return alone and known and not (beam.tapers or beam.turn or beam.density)


def _bends(response: Response, scene: Scene, beam: BeamSpec, place: Array) -> tuple[Array, Array, Array]:
    """Directions of the axis between the stations, what the forces say of them, each (s, m - 1), and a bound of errors (s,)."""
    arc, support = _STATIONS * beam.length, response.supports.get(f"{beam.name}.start")
    force, moment = np.zeros((*place.shape[:2], 2)), np.zeros(place.shape[:2])
    if support is not None:
        force += support.force[:, None]
        moment += support.moment[:, None] + _cross(place[:, :1] - place, support.force[:, None])
    for spec in scene.contacts:
        contact = response.contacts[spec.pair]
        if spec.beam != beam.name or contact.vector is None:
            continue
        vector = np.where((contact.force != 0.0)[:, None], contact.vector, 0.0)
        at = np.nan_to_num(contact.arc_position)
        there = np.stack(
            [[np.interp(a, arc, line[:, c]) for c in range(2)] for a, line in zip(at, place, strict=True)]
        )
        behind = np.asarray((arc >= at[:, None])[..., None] * vector[:, None], dtype=np.float64)
        force += behind
        moment += _cross(there[:, None] - place, behind)
    middle = (moment[:, 1:] + moment[:, :-1]) / 2.0
    turned = -np.cumsum(middle * np.diff(arc), axis=1) / beam.EI
    way, size = np.diff(place, axis=1), np.hypot(*np.moveaxis(force, -1, 0))
    sheared = _cross(way, force[:, :-1]) / np.maximum(np.hypot(*np.moveaxis(way, -1, 0)), 1e-300) / beam.GA
    slack = size.max(axis=1) * _PLACES * beam.length**2 / beam.EI
    return np.unwrap(np.arctan2(way[..., 1], way[..., 0]), axis=1), turned - sheared, slack


def _cross(arm: Array, force: Array) -> Array:
    return np.asarray(arm[..., 0] * force[..., 1] - arm[..., 1] * force[..., 0])
