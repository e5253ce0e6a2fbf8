"""The quantities that are compared between two responses to one scene: each is a row of `QUANTITIES`, and nothing else knows it."""

from collections.abc import Callable, Mapping
from functools import partial
from itertools import zip_longest
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import Array, Response
from comparisons.answer.axis import STATIONS, axes_at_stations
from comparisons.answer.material import AWAY, UNDEFINED, clamped, frictions, frictions_found, rubbing
from comparisons.frozen import Frozen
from comparisons.scene import Scene

SCOPES = ("end", "path")
"""``end``: the error at one load parameter; ``path``: the largest error over all load parameters that both responses have."""

Steps = NDArray[np.integer]
Columns = Mapping[str, Array]
"""Values over load parameters by pair, support or beam."""
Scales = Mapping[str, float]
"""The largest values of a reference, by which errors are divided, by quantity; 1 where the largest is zero."""


class Pair(Frozen):
    """A response and a reference, each with the numbers of the n load parameters that both have; their scene and the scales."""

    sides: tuple[tuple[Response, Steps], ...]
    scene: Scene
    scale: Scales


class Quantity(Frozen):
    """How a quantity is read and compared, and how it is called."""

    meaning: str  #: What is compared, and what its errors are relative to.
    words: str  #: Its name in a table.
    #: Its values by pair, support or beam, shape (s,) or (s, 2), nan where there is none. The error is infinite where one response alone
    #: has a value.
    read: Callable[[Response], Columns] = lambda _: {}
    compare: Callable[[Pair], Columns] | None = None  #: Its errors (n,), if not value by value.
    unit: str = "length"  #: Kind of its unit: ``force``, ``length``, ``moment``, ``stress`` or ``number``.
    #: What its errors are relative to: ``largest`` value, ``length`` of the beam, or what its values are relative to already.
    over: str = "length"
    #: ``mesh``: read from fields that beams and stored responses do not have. ``path``: tells that two responses follow one path, and is
    #: no accuracy that can be asked for.
    kind: str = ""
    column: int = 0  #: Its place among the columns of a comparison's table; 0 without one.
    acting: bool = False  #: Whether a pair or support is left out where it is zero in both responses.
    title: Callable[[Scene], str] | None = None  #: Its name on a page, if not `words`.
    drawn: Callable[[Response, Scene], Columns] | None = None  #: What a page draws.
    #: Why a scene, or its models, bodies if the second argument is true, do not have it; None if they do.
    refusal: Callable[[Scene, bool], str | None] = lambda _, __: None
    absent: Callable[[Response, Response], str] = lambda _, __: ""  #: Why both do not have it.
    place: Callable[[Response, Response], str] | None = None  #: Where the error is largest, in words.

    def columns(self, pair: Pair) -> Columns:
        """Return the errors by pair, support or beam, shape (n,)."""
        if self.compare is not None:
            return self.compare(pair)
        (response, own_steps), (reference, steps) = pair.sides
        own, true = self.read(response), self.read(reference)
        found = {}
        for name in {**true, **own}:
            if name not in own or name not in true:
                found[name] = np.full(len(steps), np.inf)
            elif not self.acting or own[name].any() or true[name].any():
                mine, other = own[name][own_steps], true[name][steps]
                alike = np.isfinite(size(mine)) == np.isfinite(size(other))
                length = pair.scene.beam(name.rpartition("->")[2]).length if self.over == "length" else 1.0
                found[name] = np.where(alike, size(mine - other), np.inf) / pair.scale.get(self.words, length)
        return found

    def called(self, scene: Scene) -> str:
        """Return its name on a page about a scene."""
        return self.words if self.title is None else self.title(scene)

    @property
    def relative_to(self) -> str:
        """What its errors are relative to, in words."""
        return f"the largest {self.unit}" if self.over == "largest" else f"the {self.over}"


def scales(reference: Response, steps: Steps | slice = slice(None)) -> Scales:
    """Return the scales of a reference over all its load parameters, or over the given ones."""
    found = {}
    for row in QUANTITIES.values():
        if row.over == "largest":
            sizes = [float(size(values[steps]).max(initial=0.0)) for values in row.read(reference).values()]
            found[row.words] = max(sizes, default=0.0) or 1.0
    return found


def names(*without: str) -> tuple[str, ...]:
    """Return the names of the quantities, but for those of some kinds, ``path`` or ``mesh``."""
    return tuple(name for name, row in QUANTITIES.items() if row.kind not in without)


def table_columns() -> dict[str, Quantity]:
    """Return the quantities with a column in a comparison's table, in its order."""
    rows = [(name, row) for name, row in QUANTITIES.items() if row.column]
    return dict(sorted(rows, key=lambda item: item[1].column))


def size(values: Array) -> Array:
    """Return the magnitudes of numbers, shape (s,), or of vectors, shape (..., 2)."""
    return np.abs(values) if values.ndim == 1 else np.hypot(values[..., 0], values[..., 1])


def forces(response: Response) -> dict[str, Array]:
    """Return the contact forces, shape (s,) by pair. Without contact, return the support forces, shape (s, 2) by supported end."""
    return _each(response.contacts, "force") or _each(response.supports, "force")


def moments(response: Response) -> dict[str, Array]:
    """Return the support moments, shape (s,) by supported end."""
    return _each(response.supports, "moment")


def _arcs(response: Response) -> dict[str, Array]:
    return _each(response.contacts, "arc_position")


def _each(records: Mapping[str, object], field: str) -> dict[str, Any]:
    return {name: getattr(one, field) for name, one in records.items()}


def _gap(pair: Pair) -> Columns:
    columns = {}
    for contact in pair.scene.contacts:
        found = [(one.contacts[contact.pair], steps) for one, steps in pair.sides]
        apart = np.abs(np.subtract(*(one.gap[steps] for one, steps in found)))
        closed = np.all([one.force[steps] for one, steps in found], axis=0)
        columns[contact.pair] = np.where(closed, np.nan, apart / pair.scene.beam(contact.beam).length)
    return columns


def _shape(norm: Callable[..., Array], pair: Pair) -> Columns:
    columns = {}
    for beam in pair.scene.beams:
        own, true = (axes_at_stations(one, beam.name, steps) for one, steps in pair.sides)
        columns[beam.name] = norm(np.nan_to_num(size(own - true), nan=np.inf), axis=1) / beam.length
    return columns


def _stress(pair: Pair) -> Columns:
    found = ([_face_stress(one, pair.scene, k) for k in steps.tolist()] for one, steps in pair.sides)
    own, true = map(np.array, found)
    both = np.isfinite(own) & np.isfinite(true)
    apart = np.where(both, np.abs(own - true), 0.0).max(axis=1, initial=0.0)
    return {pair.scene.beams[0].name: np.asarray(apart / np.abs(true[both]).max(initial=1e-300))}


def _face_stress(response: Response, scene: Scene, k: int) -> Array:
    """Principal stress of the larger magnitude along both faces of the only beam, nan near clamp, tip and contacts (`AWAY`)."""
    beam = scene.beams[0]
    grid = response.grid(beam.name, k)
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


def _friction_title(scene: Scene) -> str:
    if rubbing(scene):
        return "friction found"
    return "friction" if any(contact.friction for contact in scene.contacts) else "spurious friction"


class EventDifference(NamedTuple):
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

    They are paired so that the sum of the differences is least. A model may state its slip-offs alone, which are compared where both
    have one.
    """
    from scipy.optimize import linear_sum_assignment

    last = np.intersect1d(response.load_parameter, reference.load_parameter).max(initial=0.0)
    own, true = (_events(item, float(last)) for item in (response, reference))
    stated = response.events is not None and reference.events is not None
    found = []
    for key in sorted(own.keys() | true.keys() if stated else own.keys() & true.keys()):
        sides = zip_longest(own.get(key, ()), true.get(key, ()), fillvalue=np.nan)
        first, second = np.array(list(sides)).T
        # an event without another one costs nothing, as there are as many of them in every assignment
        rows, columns = linear_sum_assignment(np.nan_to_num(np.abs(np.subtract.outer(first, second))))
        pairs = zip(first[rows], second[columns], strict=True)
        found += [EventDifference(*key, *pair) for pair in sorted(pairs, key=lambda pair: np.fmin(*pair))]
    return found


def _events(response: Response, last: float) -> dict[tuple[str, str], list[float]]:
    """Load parameters up to the last one, by kind and pair."""
    found: dict[tuple[str, str], list[float]] = {}
    if response.events is None:
        slips = _each(response.contacts, "slip_off")
        return {("slip-off", pair): [t] for pair, t in slips.items() if t <= last}
    for event in response.events:
        known = event.pair in response.contacts and event.kind != "pass-through"
        if known and 0.0 < event.load_parameter <= last:
            found.setdefault((event.kind, event.pair), []).append(event.load_parameter)
    return found


def _event(pair: Pair) -> Columns:
    """Differences of events, each at the first load parameter behind it in one of the responses."""
    (response, steps), (reference, _) = pair.sides
    times, columns = response.load_parameter[steps], dict[str, Array]()
    for item in event_differences(response, reference):
        column = columns.setdefault(item.pair, np.full(len(times), np.nan))
        k = int(np.searchsorted(times, np.fmin(item.own, item.true)))
        column[k] = np.fmax(column[k], item.apart)
    return columns


def _worst_event(response: Response, reference: Response) -> str:
    events = event_differences(response, reference)
    most = max(events, key=lambda item: item.apart, default=None)
    return "" if most is None or not most.apart else most.line(response.model, reference.model)


def _no_events(response: Response, reference: Response) -> str:
    silent = [one.model for one in (reference, response) if one.events is None]
    words = "states no events of this scene; compare two models that do, --against tsm"
    return f"{silent[0]} {words}" if silent else ""


QUANTITIES: dict[str, Quantity] = {
    "force": Quantity(
        meaning="contact forces, of a scene without contact the support forces, over the largest",
        words="force", unit="force", over="largest", column=1, read=forces, drawn=lambda response, _: forces(response),
        title=lambda scene: "contact force" if scene.contacts else "support force",
    ),
    "arc": Quantity(
        meaning="arc positions of the contacts over the length",
        words="arc position", column=2, read=_arcs, drawn=lambda response, _: _arcs(response),
    ),
    "moment": Quantity(
        meaning="support moments over the largest",
        words="moment", unit="moment", over="largest", column=3, acting=True, read=moments,
        drawn=lambda response, _: moments(response), title=lambda _: "support moment",
    ),
    "friction": Quantity(
        meaning="material force at the clamp of a beam with a free end, over the contact forces on the beam",
        words="friction", unit="number", over="contact forces", column=5, read=frictions, title=_friction_title,
        drawn=lambda response, scene: frictions_found(response, scene) or frictions(response),
        refusal=lambda scene, _: None if clamped(scene) else UNDEFINED,
    ),
    "tip": Quantity(
        meaning="positions of the beams' ends over the length",
        words="tip", column=4, read=lambda response: response.tips,
    ),
    "shape": Quantity(
        meaning="deflected axes at equal arc lengths, the largest distance over the length",
        words="shape", compare=partial(_shape, np.max),
    ),
    "shape_mean": Quantity(
        meaning="deflected axes at equal arc lengths, the mean distance over the length",
        words="mean shape", compare=partial(_shape, np.mean),
    ),
    "stress": Quantity(
        meaning="stress at the faces over the largest, away from clamp, tip and contacts; of one beam, by the solid",
        words="stress", unit="stress", over="largest", kind="mesh", compare=_stress,
        refusal=lambda scene, continuum: None if continuum and len(scene.beams) == 1 else "is measured between two solids of a single beam",
    ),
    "gap": Quantity(
        meaning="gaps of contacts that are open in one of the two, over the length",
        words="gap", kind="path", compare=_gap,
    ),
    "event": Quantity(
        meaning="load parameters of events and slip-offs, as absolute differences; infinite where one of the two has no such event",
        words="event", unit="number", over="", kind="path", compare=_event, absent=_no_events, place=_worst_event,
    ),
}  # fmt: skip
"""The quantities by name. `crossval compare --max-error` can bound each, `crossval solve --accuracy` takes those that are not of the path."""
KEPT = names("path", "mesh")
"""The quantities that every model states and that a stored response keeps."""
