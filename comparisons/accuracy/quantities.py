"""How far two responses to one scene are apart, in the quantity that a user asks for."""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from comparisons.models.options import QUANTITIES
from comparisons.models.translate.to_solid import rectangle
from comparisons.response import Array, Response
from comparisons.scene import Scene

Ints = NDArray[np.integer]
STATIONS = np.linspace(0.0, 1.0, 101)
"""Points of an axis, and of a face, at which two models are compared."""
AWAY = 1.5
"""Heights beside clamp and contact within which a solid's stress is that of a point force."""


def difference(one: Response, other: Response, scene: Scene, quantity: str) -> float:
    """Return the largest difference over the load parameters that both reached, relative as `QUANTITIES` says.

    Nothing is interpolated in the load parameter; without a shared one the difference is infinite.
    """
    _, a, b = np.intersect1d(one.load_parameter, other.load_parameter, return_indices=True)
    if not len(a):
        return np.inf
    return _COMPARE[quantity](one, other, a, b, scene)


def _force(one: Response, other: Response, a: Ints, b: Ints, _: Scene) -> float:
    ours, theirs = _driving(one, a), _driving(other, b)
    return _over_largest(ours, theirs)


def _driving(response: Response, ks: Ints) -> dict[str, Array]:
    """Return the forces of the contacts, without contacts those of the supports."""
    if response.contacts:
        return {pair: contact.force[ks] for pair, contact in response.contacts.items()}
    return {beam: support.force[ks] for beam, support in response.supports.items()}


def _moment(one: Response, other: Response, a: Ints, b: Ints, _: Scene) -> float:
    ours, theirs = (
        {beam: support.moment[ks] for beam, support in response.supports.items()}
        for response, ks in ((one, a), (other, b))
    )
    return _over_largest(ours, theirs)


def _over_largest(ours: Mapping[str, Array], theirs: Mapping[str, Array]) -> float:
    size = max((float(np.abs(values).max()) for values in theirs.values()), default=0.0)
    apart = max((float(np.abs(ours[name] - theirs[name]).max()) for name in theirs), default=0.0)
    return apart / size if size else apart


def _arc(one: Response, other: Response, a: Ints, b: Ints, scene: Scene) -> float:
    worst = 0.0
    for contact in scene.contacts:
        pair, length = contact.pair, scene.beam(contact.beam).length
        ours, theirs = one.contacts[pair].arc_position[a], other.contacts[pair].arc_position[b]
        closed = np.isfinite(ours) & np.isfinite(theirs)
        if np.any(np.isfinite(ours) != np.isfinite(theirs)):
            return np.inf
        worst = max(worst, float(np.abs(ours - theirs)[closed].max(initial=0.0)) / length)
    return worst


def _tip(one: Response, other: Response, a: Ints, b: Ints, scene: Scene) -> float:
    return max(
        float(np.hypot(*(one.tips[beam.name][a] - other.tips[beam.name][b]).T).max()) / beam.length
        for beam in scene.beams
    )


def _shape(one: Response, other: Response, a: Ints, b: Ints, scene: Scene) -> float:
    worst = 0.0
    for beam in scene.beams:
        for k, j in zip(a.tolist(), b.tolist(), strict=True):
            apart = _axis(one, beam.name, k) - _axis(other, beam.name, j)
            worst = max(worst, float(np.hypot(*apart.T).max()) / beam.length)
    return worst


def _axis(response: Response, beam: str, k: int) -> Array:
    from scipy.interpolate import CubicSpline

    arc, line = response.axis_line(beam, k)
    return np.asarray(CubicSpline((arc - arc[0]) / (arc[-1] - arc[0]), line)(STATIONS))


def _stress(one: Response, other: Response, a: Ints, b: Ints, scene: Scene) -> float:
    ours = np.array([_face_stress(one, scene, k) for k in a.tolist()])
    theirs = np.array([_face_stress(other, scene, k) for k in b.tolist()])
    both = np.isfinite(ours) & np.isfinite(theirs)
    return float(np.abs(ours - theirs)[both].max(initial=0.0) / np.abs(theirs[both]).max(initial=1e-300))


def _face_stress(response: Response, scene: Scene, k: int) -> Array:
    """Principal stress of the larger magnitude along both faces of the one beam, nan beside clamp, tip and contacts."""
    beam, grid = scene.beams[0], response.grid(k)
    (tx, ty), height = beam.direction, rectangle(beam)[1]
    from_start = grid.points - np.array(beam.start)
    arc, across = from_start @ (tx, ty), from_start @ (-ty, tx)
    xx, yy, xy = grid.point_data["cauchy_stress"].T
    stress = (xx + yy) / 2 + np.sign(xx + yy) * np.hypot((xx - yy) / 2, xy)
    at = STATIONS * beam.length
    near = [0.0, beam.length, *(contact.arc_position[k] for contact in response.contacts.values())]
    close = np.any([np.abs(at - place) < AWAY * height for place in near], axis=0)
    found = []
    for side in (-1.0, 1.0):
        face = np.flatnonzero(np.abs(across - side * height / 2) < 1e-6 * height)
        face = face[np.argsort(arc[face])]
        found.append(np.where(close, np.nan, np.interp(at, arc[face], stress[face])))
    return np.concatenate(found)


_COMPARE: dict[str, Callable[[Response, Response, Ints, Ints, Scene], float]] = {
    "force": _force,
    "arc": _arc,
    "moment": _moment,
    "tip": _tip,
    "shape": _shape,
    "stress": _stress,
}
assert set(_COMPARE) == set(QUANTITIES), "every quantity can be compared"
