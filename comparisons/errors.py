"""The measure of the difference between two responses to one scene.

A quantity is compared at the load parameters that both responses have; nothing is interpolated in the load parameter. The error
is the largest difference over all contacts, supports and beams. Forces, moments and stresses are relative to the largest value of
the reference, positions to the length of their beam.

A value that is not a number has an infinite error. The arc position has an infinite error where its pair is open in one response
and closed in the other. The error of the arc position is nan where the pair is open in both, and where the scene has no contact. The
error of the moment is nan if no support has a moment. The friction is treated like the arc position; it has an infinite error if only
one of the responses has a material force.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.quantities import COMPARED, KEPT, SCOPES
from comparisons.response import Array, Response
from comparisons.response.axis import STATIONS, axes_at_stations
from comparisons.response.material import frictions
from comparisons.scene import Scene

AWAY = 1.5
"""Distance from clamp and contact, over the height, within which the stress of a solid is local; it is not compared there."""

Errors = Mapping[str, Mapping[str, float]]
"""Errors by scope and quantity."""
Steps = NDArray[np.integer]
Columns = Mapping[str, Array]
"""Values over load parameters by pair, support or beam."""


@dataclass(frozen=True, kw_only=True)
class Scales:
    """The largest force and moment of the reference, by which errors are divided; 1 where the largest is zero."""

    force: float
    moment: float


def scales(reference: Response, steps: Steps | slice = slice(None)) -> Scales:
    """Return the scales of a reference over all its load parameters, or over the given ones."""
    force = [values[steps] for values in forces(reference).values()]
    moment = [values[steps] for values in moments(reference).values()]
    return Scales(force=_largest_size(force), moment=_largest_size(moment))


def _largest_size(columns: Iterable[Array]) -> float:
    return max((float(size(values).max(initial=0.0)) for values in columns), default=0.0) or 1.0


def forces(response: Response) -> dict[str, Array]:
    """Return the contact forces, shape (s,) by pair. Without contact, return the support forces, shape (s, 2) by supported end."""
    if response.contacts:
        return {pair: contact.force for pair, contact in response.contacts.items()}
    return {node: support.force for node, support in response.supports.items()}


def moments(response: Response) -> dict[str, Array]:
    """Return the support moments, shape (s,) by supported end."""
    return {node: support.moment for node, support in response.supports.items()}


def size(values: Array) -> Array:
    """Return the magnitudes of numbers, shape (s,), or of vectors, shape (..., 2)."""
    return np.abs(values) if values.ndim == 1 else np.hypot(values[..., 0], values[..., 1])


def _distance(difference: Array) -> Array:
    """Return the magnitudes of differences, infinite where a value is not a number."""
    return np.nan_to_num(size(difference), nan=np.inf)


def errors(
    response: Response,
    reference: Response,
    scene: Scene,
    *,
    scale: Scales | None = None,
    end: float | None = None,
    quantities: Iterable[str] = KEPT,
) -> Errors:
    """Return the errors of a response by scope and quantity; nan for a response that does not reach the reference's end.

    Parameters
    ----------
    response, reference : Response
        Two responses to the same scene; the first may have fewer load parameters.
    scene : Scene
        Source of the beams' lengths.
    scale : Scales, optional
        Divisors of forces and moments; by default the largest values of the reference.
    end : float, optional
        The load parameter of the scope ``end``, the reference's last if not given.
    quantities : iterable of str
        Keys of `comparisons.quantities.COMPARED`.
    """
    names = tuple(quantities)
    last = reference.load_parameter[-1:]
    if not len(last) or last[0] not in response.load_parameter:
        return {scope: dict.fromkeys(names, np.nan) for scope in SCOPES}
    shared, found = error_histories(response, reference, scene, scale=scale, quantities=names)
    at_end = shared == (last[0] if end is None else end)
    return {
        "end": {name: largest(values[at_end]) for name, values in found.items()},
        "path": {name: largest(values) for name, values in found.items()},
    }


def difference(response: Response, reference: Response, scene: Scene, quantity: str) -> float:
    """Return the largest error of a quantity over the load parameters that both responses reached.

    Forces and moments are relative to the largest value of the reference at these load parameters. The error is infinite if the
    responses share no load parameter. It is nan if neither response has the quantity: a scene without contact has no arc position.
    """
    _, _, steps = _shared(response, reference)
    if not len(steps):
        return np.inf
    _, found = error_histories(
        response, reference, scene, scale=scales(reference, steps), quantities=[quantity]
    )
    return largest(found[quantity])


def worst_place(response: Response, reference: Response, scene: Scene, quantity: str) -> str:
    """Return the pair, support or beam, and the load parameter, where a quantity has its largest error; empty if there is none."""
    shared, _, _ = _shared(response, reference)
    if quantity == "event":
        events = event_differences(response, reference)
        most = max(events, key=lambda item: item.apart, default=None)
        return "" if most is None or not most.apart else most.line(response.model, reference.model)
    columns = error_columns(response, reference, scene, quantity)
    worst = {name: largest(values) for name, values in columns.items()}
    worst = {name: size for name, size in worst.items() if size > 0.0}
    if not worst:
        return ""
    name = max(worst, key=lambda name: worst[name])
    return f"{name} at load parameter {shared[int(np.nanargmax(columns[name]))]:.6g}"


@dataclass(frozen=True, kw_only=True)
class EventDifference:
    """An event of a pair in two responses; a load parameter is nan where a response has no such event."""

    kind: str
    pair: str
    own: float
    true: float

    @property
    def apart(self) -> float:
        """Difference of the load parameters, infinite where one response has no such event."""
        return float(np.nan_to_num(abs(self.own - self.true), nan=np.inf))

    def line(self, own: str, true: str) -> str:
        """Return the difference as a sentence about two responses by their names."""
        first, other, t = (own, true, self.own) if np.isfinite(self.own) else (true, own, self.true)
        last = f"{other} has at {self.true:.6g}" if np.isfinite(self.apart) else f"{other} does not have"
        return f"{first} has a {self.kind} of {self.pair} at load parameter {t:.6g}, which {last}"


def event_differences(response: Response, reference: Response) -> list[EventDifference]:
    """Return the events of both responses up to the last load parameter that both have, without the passing of nodes and the touch at rest.

    A model may state its slip-offs alone; they are compared where both have one.
    """
    shared, _, _ = _shared(response, reference)
    both = [_events(item, shared[-1]) if len(shared) else {} for item in (response, reference)]
    stated = response.events is not None and reference.events is not None
    return [
        EventDifference(kind=kind, pair=pair, own=own, true=true)
        for kind, pair in sorted(
            both[0].keys() | both[1].keys() if stated else both[0].keys() & both[1].keys()
        )
        for own, true in _nearest(*(item.get((kind, pair), []) for item in both))
    ]


def _nearest(own: list[float], true: list[float]) -> list[tuple[float, float]]:
    """Pair load parameters so that the sum of their differences is least; nan stands beside those that are left over."""
    from scipy.optimize import linear_sum_assignment

    rows, columns = linear_sum_assignment(np.abs(np.subtract.outer(own, true)))
    pairs = [(own[i], true[j]) for i, j in zip(rows, columns, strict=True)]
    pairs += [(t, np.nan) for i, t in enumerate(own) if i not in rows]
    pairs += [(np.nan, t) for j, t in enumerate(true) if j not in columns]
    return sorted(pairs, key=lambda pair: float(np.fmin(*pair)))


def _events(response: Response, last: float) -> dict[tuple[str, str], list[float]]:
    """Load parameters up to the last one, by kind and pair."""
    found: dict[tuple[str, str], list[float]] = {}
    if response.events is None:
        slips = {("slip-off", pair): item.slip_off for pair, item in response.contacts.items()}
        return {key: [t] for key, t in slips.items() if t <= last}
    for event in response.events:
        if (
            event.pair in response.contacts
            and event.kind != "pass-through"
            and 0.0 < event.load_parameter <= last
        ):
            found.setdefault((event.kind, event.pair), []).append(event.load_parameter)
    return found


def error_histories(
    response: Response,
    reference: Response,
    scene: Scene,
    *,
    scale: Scales | None = None,
    quantities: Iterable[str] = KEPT,
) -> tuple[Array, dict[str, Array]]:
    """Return the n load parameters that both responses have, and the errors there, shape (n,) by quantity."""
    shared, own, true = _shared(response, reference)
    pair = _Pair(response, reference, own, true, scene, scale or scales(reference))
    none = np.full(len(shared), np.nan)
    return shared, {
        name: np.asarray(np.fmax.reduce([none, *_MEASURES[name](pair).values()])) for name in quantities
    }


def error_columns(response: Response, reference: Response, scene: Scene, quantity: str) -> Columns:
    """Return the errors of every pair, support or beam, shape (n,), at the n load parameters that both responses have."""
    _, own, true = _shared(response, reference)
    return _MEASURES[quantity](_Pair(response, reference, own, true, scene, scales(reference)))


def _shared(response: Response, reference: Response) -> tuple[Array, Steps, Steps]:
    return np.intersect1d(response.load_parameter, reference.load_parameter, return_indices=True)


@dataclass(frozen=True)
class _Pair:
    """Two responses, and the numbers of the n load parameters that both have."""

    response: Response
    reference: Response
    own_steps: Steps
    reference_steps: Steps
    scene: Scene
    scale: Scales


def _force(pair: _Pair) -> Columns:
    own, true = forces(pair.response), forces(pair.reference)
    return {
        name: _distance(own[name][pair.own_steps] - values[pair.reference_steps]) / pair.scale.force
        for name, values in true.items()
    }


def _moment(pair: _Pair) -> Columns:
    own, true = moments(pair.response), moments(pair.reference)
    return {
        name: _distance(own[name][pair.own_steps] - values[pair.reference_steps]) / pair.scale.moment
        for name, values in true.items()
        if values.any() or own[name].any()
    }


def _arc(pair: _Pair) -> Columns:
    columns = {}
    for contact in pair.scene.contacts:
        own = pair.response.contacts[contact.pair].arc_position[pair.own_steps]
        true = pair.reference.contacts[contact.pair].arc_position[pair.reference_steps]
        apart = np.abs(own - true) / pair.scene.beam(contact.beam).length
        columns[contact.pair] = np.where(np.isfinite(own) == np.isfinite(true), apart, np.inf)
    return columns


def _gap(pair: _Pair) -> Columns:
    columns = {}
    for contact in pair.scene.contacts:
        own, true = pair.response.contacts[contact.pair], pair.reference.contacts[contact.pair]
        apart = np.abs(own.gap[pair.own_steps] - true.gap[pair.reference_steps])
        closed = (own.force[pair.own_steps] != 0.0) & (true.force[pair.reference_steps] != 0.0)
        columns[contact.pair] = np.where(closed, np.nan, apart / pair.scene.beam(contact.beam).length)
    return columns


def _event(pair: _Pair) -> Columns:
    """Differences of events, each at the first load parameter behind it in one of the responses."""
    times = pair.response.load_parameter[pair.own_steps]
    columns: dict[str, Array] = {}
    for item in event_differences(pair.response, pair.reference):
        column = columns.setdefault(item.pair, np.full(len(times), np.nan))
        k = int(np.searchsorted(times, np.fmin(item.own, item.true)))
        column[k] = np.fmax(column[k], item.apart)
    return columns


def _friction(pair: _Pair) -> Columns:
    own, true = frictions(pair.response, pair.scene), frictions(pair.reference, pair.scene)
    columns = {}
    for beam in own.keys() | true.keys():
        if beam not in own or beam not in true:
            columns[beam] = np.full(len(pair.own_steps), np.inf)
            continue
        found, exact = own[beam][pair.own_steps], true[beam][pair.reference_steps]
        columns[beam] = np.where(np.isfinite(found) == np.isfinite(exact), np.abs(found - exact), np.inf)
    return columns


def _tip(pair: _Pair) -> Columns:
    own, true = pair.response.tips, pair.reference.tips
    return {
        beam.name: _distance(own[beam.name][pair.own_steps] - true[beam.name][pair.reference_steps])
        / beam.length
        for beam in pair.scene.beams
    }


def _shape(pair: _Pair, norm: Callable[..., Array]) -> Columns:
    columns = {}
    for beam in pair.scene.beams:
        own = axes_at_stations(pair.response, beam.name, pair.own_steps)
        true = axes_at_stations(pair.reference, beam.name, pair.reference_steps)
        columns[beam.name] = norm(_distance(own - true), axis=1) / beam.length
    return columns


def _stress(pair: _Pair) -> Columns:
    own = np.array([_face_stress(pair.response, pair.scene, int(k)) for k in pair.own_steps])
    true = np.array([_face_stress(pair.reference, pair.scene, int(k)) for k in pair.reference_steps])
    both = np.isfinite(own) & np.isfinite(true)
    apart = np.where(both, np.abs(own - true), 0.0).max(axis=1, initial=0.0)
    return {pair.scene.beams[0].name: np.asarray(apart / np.abs(true[both]).max(initial=1e-300))}


def _face_stress(response: Response, scene: Scene, k: int) -> Array:
    """Principal stress of the larger magnitude along both faces of the only beam, nan near clamp, tip and contacts (`AWAY`)."""
    beam, grid = scene.beams[0], response.grid(k)
    (tx, ty), height = beam.direction, beam.rectangle_height
    from_start = grid.points - np.array(beam.start)
    arc, across = from_start @ (tx, ty), from_start @ (-ty, tx)
    xx, yy, xy = (grid.point_data[name] for name in ("stress_xx", "stress_yy", "stress_xy"))
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


_MEASURES: dict[str, Callable[[_Pair], Columns]] = {
    "force": _force,
    "arc": _arc,
    "friction": _friction,
    "gap": _gap,
    "event": _event,
    "moment": _moment,
    "tip": _tip,
    "shape": lambda pair: _shape(pair, np.max),
    "shape_mean": lambda pair: _shape(pair, np.mean),
    "stress": _stress,
}
assert set(_MEASURES) == set(COMPARED), "every quantity can be compared"


def largest(values: Array) -> float:
    """Return the largest of the values that are numbers; nan if none is."""
    return float(np.fmax.reduce(values, initial=np.nan))
