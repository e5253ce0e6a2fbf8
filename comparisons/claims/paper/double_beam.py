"""Fig. 9: two cantilevers pressed by one pin, stage by stage, against the exact rods."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comparisons.claims.problems.double_beam import EVENTS, HAND_OVER, LOWER, TIP, UPPER
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.response import Array, Response
from comparisons.scene import Scene, load_scene
from tsm.elements import EULER_BERNOULLI_CANTILEVER, EULER_BERNOULLI_SIMPLE, TIMOSHENKO

Report = Callable[[str], None]

SCENE = "double-beam"
PAIRS = (UPPER, TIP, LOWER)
FINER = 10
"""Load parameters of the picture per load parameter of the scene."""
TRIED = tuple(HAND_OVER)
"""Places of the pin [m] at which the paper's elements are tried: on a beam node, and a tenth of an element beside it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class History:
    """One contact pair over the depths: force [N] and arc position [m], measured and exact, nan where the pair is open."""

    force: Array
    arc: Array
    exact_force: Array
    exact_arc: Array

    def errors(self, part: NDArray[np.bool_]) -> tuple[float, float]:
        """Largest errors where both are closed and `part` holds: of the force over its largest, and of the arc position."""
        both = part & np.isfinite(self.arc) & np.isfinite(self.exact_arc)
        if not both.any():
            return np.nan, np.nan
        force = np.abs(self.force - self.exact_force)[both].max() / self.exact_force[both].max()
        return float(force), float(np.abs(self.arc - self.exact_arc)[both].max())


@dataclass(frozen=True, kw_only=True)
class Happened:
    """A contact event at a depth [m]; `released` is the strain energy that a slip-off sets free [N m]."""

    kind: str
    depth: float
    pair: str
    element: int
    arc: float
    force: float
    released: float


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A stage of the paper's figure; `index` counts the depths, -1 is the undeformed state."""

    key: str
    title: str
    depth: float
    index: int


@dataclass(frozen=True, kw_only=True)
class Attempt:
    """How far `tsm.solve` comes with a formulation and a place of the pin [m].

    Attributes
    ----------
    element, place, status : str, float, str
        Formulation, place of the pin [m], how it ended.
    depth : float
        Last depth [m] with an answer.
    passes : int
        Beam nodes passed.
    at_hand_over : bool
        Whether what stops it is the second contact on an element that knows one, where the exact rods hand over: between the last depth with
        an answer and the next one.
    """

    element: str
    place: float
    status: str
    depth: float
    passes: int
    at_hand_over: bool

    @property
    def to_the_end(self) -> bool | None:
        """Whether it went through; None if it ends at the hand-over, where this program ends and the paper's went on."""
        return None if self.at_hand_over else self.status == "COMPLETED"


@dataclass(frozen=True, kw_only=True)
class Check:
    """Largest errors of a stage against the exact rods: force over its largest, arc position over the length."""

    stage: str
    pair: str
    force: float
    arc: float


@dataclass(frozen=True, kw_only=True, eq=False)
class DoubleBeam:
    """What Fig. 9 shows.

    Attributes
    ----------
    depth : ndarray, shape (s,)
        Depths of the pin [m].
    histories : dict of History
        By pair.
    events : tuple of Happened
        In order.
    checks : tuple of Check
        By stage and pair.
    stages : tuple of Stage
        (a) to (f).
    iterations, seconds : int, float
        Newton iterations and wall time of `mixed` at the scene's own load parameters.
    attempts : tuple of Attempt
        Attempts with the other formulations.
    stopped : tuple of str
        What did not go through.
    """

    depth: Array
    histories: dict[str, History]
    events: tuple[Happened, ...]
    checks: tuple[Check, ...]
    stages: tuple[Stage, ...]
    iterations: int
    seconds: float
    attempts: tuple[Attempt, ...]
    stopped: tuple[str, ...]
    scene: Scene
    response: Response

    def events_of(self, kind: str, pair: str) -> list[Happened]:
        """Return the events of a kind and a pair."""
        return [event for event in self.events if (event.kind, event.pair) == (kind, pair)]

    def at_hand_over(self, pair: str) -> list[Happened]:
        """Return the events of a pair at the depth where the pin leaves the upper beam."""
        over = [event.depth for event in self.events_of("slip-off", UPPER)]
        return [event for event in self.events if event.pair == pair and event.depth in over]


def double_beam(*, quick: bool, report: Report) -> DoubleBeam:
    """Solve the scene; `quick` keeps the scene's load parameters and tries only the paper's Timoshenko element."""
    scene = load_scene(SCENE)
    report("mixed, 10 + 10 elements")
    own = solve(scene, TSM.name)
    finer = scene if quick else replace(scene, load_parameters=FINER * scene.load_parameters)
    response = own if quick else solve(finer, TSM.name)
    travel = abs(scene.pins[0].points[1][1])
    depth = travel * response.load_parameter
    report("exact rods")
    exact = solve(finer, ROD.name)
    histories = {}
    for pair in PAIRS:
        contact = response.contacts[pair]
        rods, closed = exact.contacts[pair], np.isfinite(contact.arc_position)
        histories[pair] = History(
            force=np.where(closed, contact.force, np.nan),
            arc=contact.arc_position,
            exact_force=np.where(np.isfinite(rods.arc_position), rods.force, np.nan),
            exact_arc=rods.arc_position,
        )
    events = tuple(
        Happened(
            kind=event.kind,
            depth=travel * event.load_parameter,
            pair=event.pair,
            element=event.element,
            arc=event.arc_position,
            force=event.force,
            released=event.released,
        )
        for event in response.events or ()
    )
    elements = (TIMOSHENKO.name,) if quick else (
        TIMOSHENKO.name,
        EULER_BERNOULLI_SIMPLE.name,
        EULER_BERNOULLI_CANTILEVER.name,
    )  # fmt: skip
    report("the paper's elements")
    attempts = tuple(_attempt(scene, element, place) for element in elements for place in TRIED)
    return DoubleBeam(
        depth=depth,
        histories=histories,
        events=events,
        checks=_checks(depth, histories),
        stages=_stages(depth),
        iterations=own.iterations,
        seconds=own.wall_seconds,
        attempts=attempts,
        stopped=tuple(
            f"{one.setting or one.model}: {one.status}: {one.message}"
            for one in (own, response, exact)
            if not one.completed
        ),
        scene=finer,
        response=response,
    )


def _checks(depth: Array, histories: dict[str, History]) -> tuple[Check, ...]:
    before, after = depth < EVENTS["touch"], depth > EVENTS["hand-over"]
    parts = (
        ("one rod under the pin", UPPER, before),
        ("coupled", UPPER, ~before & ~after),
        ("coupled", TIP, ~before & ~after),
        ("the other rod under the pin", LOWER, after),
    )
    found = []
    for stage, pair, part in parts:
        force, arc = histories[pair].errors(part)
        found.append(Check(stage=stage, pair=pair, force=force, arc=arc))
    return tuple(found)


def _stages(depth: Array) -> tuple[Stage, ...]:
    """The paper's stages; none if the run does not reach the last."""
    touch, over, off = EVENTS["touch"], EVENTS["hand-over"], EVENTS["slip-off"]
    if depth[-1] < off:
        return ()
    chosen = (
        ("a", "contact about to occur", -1),
        ("b", "both contacts begin", int(np.argmax(depth >= touch))),
        ("c", "both contacts slide", int(np.argmax(depth >= (touch + over) / 2.0))),
        ("d", "just before the hand-over", int(np.argmax(depth >= over)) - 1),
        ("e", "pin on the lower beam", int(np.argmax(depth >= over + 0.02))),
        ("f", "about to leave the lower beam", int(np.argmax(depth >= off)) - 1),
    )
    return tuple(
        Stage(key=key, title=title, depth=0.0 if k < 0 else float(depth[k]), index=k)
        for key, title, k in chosen
    )


def _attempt(scene: Scene, element: str, place: float) -> Attempt:
    pin = replace(scene.pins[0], start=(place, scene.pins[0].points[0][1]))
    response = solve(replace(scene, pins=(pin,)), TSM.name, Options(element=element))
    travel = abs(pin.points[1][1])
    events = response.events or ()
    reached = float(response.load_parameter[-1]) if len(response.load_parameter) else 0.0
    over = HAND_OVER[place] / travel
    return Attempt(
        element=element,
        place=place,
        status=response.status,
        depth=travel * reached,
        passes=sum(event.kind == "pass-through" for event in events),
        at_hand_over=response.status == "TWO_CONTACTS"
        and reached < over <= reached + 1.0 / scene.load_parameters,
    )
