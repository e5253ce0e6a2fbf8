"""March along the load parameters: steps that stay on their branch, through slip-offs that are allowed.

A step is accepted if it departs little from the tangents at both ends, and the index is the same or the set of closed contacts
has changed. The load parameters asked for are where states are read; what lies between decides the steps.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from fem_reference.active_set import equilibrium
from fem_reference.arrays import Floats
from fem_reference.critical import (
    CriticalPoint,
    Located,
    bifurcation,
    limit_point,
    noise,
    release,
    stable_branch,
)
from fem_reference.line_contact import line_contact, tightest
from fem_reference.model import Model
from fem_reference.newton import Attempt
from fem_reference.settings import Settings
from fem_reference.state import Condition, State, Touch, at_rest, state
from fem_reference.status import Status
from fem_reference.track import KEPT, Accepted, accept, departure, predict

_NEAR = 1e-9
"""Turns of a pin that are as close as this to an end of a step are there."""
_STEEPER = 1.5
"""Growth of the rate over a step after which a limit point is looked for."""
_PATIENCE = 5
"""Attempts given up in a row, after which what stands in the way is looked for."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Step:
    """The way to one common load parameter.

    Parameters
    ----------
    status
        ``Status.CONVERGED`` if ``load_parameter`` is the common one; otherwise why the march ended here.
    cause, pair
        Status of the last attempt, and the number of the contact it is about.
    load_parameter, state, index
        The last accepted load parameter, or that of the event which ends the path; the last accepted state and its index.
    iterations, cutbacks, substeps
        Linear solutions, attempts given up and states accepted since the common load parameter before.
    slips
        Contacts that slipped off, with their load parameters.
    critical
        Critical points on the way.
    """

    status: Status
    cause: Status
    pair: int | None
    load_parameter: float
    state: State
    index: int
    iterations: int
    cutbacks: int
    substeps: int
    slips: tuple[tuple[int, float], ...]
    critical: tuple[CriticalPoint, ...]


@dataclass(kw_only=True, eq=False)
class _Walk:
    """What changes on the way to a load parameter."""

    track: tuple[Accepted, ...]
    trial: float
    order: int
    iterations: int = 0
    cutbacks: int = 0
    substeps: int = 0
    failures: int = 0
    cause: Status = Status.CONVERGED
    pair: int | None = None
    slips: list[tuple[int, float]] = field(default_factory=list)
    critical: list[CriticalPoint] = field(default_factory=list)
    ended_at: float | None = None

    @property
    def last(self) -> Accepted:
        return self.track[-1]

    def accept(self, *found: Accepted, afresh: bool = False) -> None:
        self.track = found if afresh else (*self.track, *found)[-KEPT:]
        self.substeps += 1
        self.failures = 0


def march(model: Model, load_parameters: Floats, settings: Settings) -> Iterator[Step]:
    """Yield the accepted state at every load parameter; if one cannot be reached, a last step says why."""
    start = accept(model, at_rest(model), settings)
    assert start is not None, "a strip at rest has a stiffness"
    track: tuple[Accepted, ...] = (start,)
    trial = settings.first_step
    for target in map(float, load_parameters):
        walk = _Walk(track=track, trial=trial, order=settings.predictor_order)
        status = _reach(model, target, walk, settings)
        yield _step(walk, status)
        if status is not Status.CONVERGED:
            return
        track, trial = walk.track, walk.trial


def _step(walk: _Walk, status: Status) -> Step:
    last = walk.last
    return Step(
        status=status,
        cause=walk.cause,
        pair=walk.pair,
        load_parameter=last.at.t if walk.ended_at is None else walk.ended_at,
        state=last.at,
        index=last.index,
        iterations=walk.iterations,
        cutbacks=walk.cutbacks,
        substeps=walk.substeps,
        slips=tuple(walk.slips),
        critical=tuple(walk.critical),
    )


def _reach(model: Model, target: float, walk: _Walk, settings: Settings) -> Status:
    """Go from the track's end to ``target``; return ``Status.CONVERGED`` there, or why the path ended before."""
    while walk.last.at.t < target:
        if walk.cutbacks + walk.substeps >= settings.max_attempts:
            return Status.STEP_LIMIT
        goal = _goal(model, walk, target)
        attempt = equilibrium(model, predict(model, walk.track, goal, walk.order), settings)
        walk.iterations += attempt.iterations
        walk.cause, walk.pair = attempt.status, attempt.pair
        found = accept(model, attempt.state, settings) if attempt.status is Status.CONVERGED else None
        ended = _judge(model, walk, found, goal, settings)
        if ended is None and walk.failures:
            ended = _blocked(model, walk, attempt, goal, target, settings)
        if ended is not None:
            return ended
    return Status.CONVERGED


def _goal(model: Model, walk: _Walk, target: float) -> float:
    """Load parameter of the next attempt: a remainder that is all but covered is taken whole, so that no sliver is left."""
    t = walk.last.at.t
    end = next((turn for turn in model.problem.turns if t + _NEAR < turn < target - _NEAR), target)
    return end if walk.trial >= (end - t) * (1 - 1e-6) else t + walk.trial


def _judge(
    model: Model, walk: _Walk, found: Accepted | None, goal: float, settings: Settings
) -> Status | None:
    """Accept what an attempt found or count it as a failure; return a status if the path ends at a critical point."""
    last, shorter = walk.last, 0.5
    h = goal - last.at.t
    if found is not None:
        far = departure(last, found, noise(model, settings))
        tight = tightest(found.at)
        same = found.closed == last.closed and -1 not in (found.index, last.index)
        if not far <= settings.largest_departure:
            walk.cause = Status.ANOTHER_BRANCH
            shorter = max(0.1, min(0.5, 0.7 * settings.largest_departure / far))
        elif tight is not None and tight[1] <= 0:
            walk.cause, walk.pair = Status.LINE_CONTACT, tight[0]
        elif not same and settings.branch != "primary" and found.index > max(last.index, 0):
            walk.cause = Status.LIMIT_POINT
        elif not same or found.index == last.index:
            grown = h * max(0.5, min(2.0, 0.8 * settings.largest_departure / max(far, 1e-9)))
            walk.trial = grown if h >= walk.trial * (1 - 1e-6) else max(grown, walk.trial)
            walk.order = settings.predictor_order
            walk.accept(found)
            return None
        else:
            located = bifurcation(model, last, found, settings)
            if located is not None:
                return _divide(model, walk, found, located, settings)
            walk.cause = Status.ANOTHER_BRANCH
    walk.cutbacks += 1
    walk.failures += 1
    walk.trial = shorter * h
    # After a failure the extrapolation itself is in doubt.
    walk.order = max(walk.order - 2, 1)
    return None


def _divide(
    model: Model, walk: _Walk, found: Accepted, located: Located, settings: Settings
) -> Status | None:
    """Go on from a bifurcation on the branch that is asked for; return a status if none is."""
    walk.critical.append(located.point)
    if settings.branch == "primary":
        walk.accept(found)
        return None
    t = located.point.load_parameter
    if settings.branch == "stable":
        turned = stable_branch(model, located, found.at.t, settings)
        if turned is not None:
            walk.accept(turned, afresh=True)
            walk.trial = turned.at.t - t
            return None
    walk.cause, walk.ended_at = Status.BIFURCATION, t
    return Status.BIFURCATION


def _blocked(
    model: Model, walk: _Walk, attempt: Attempt, goal: float, target: float, settings: Settings
) -> Status | None:
    """Search for what stands in the way of ever shorter steps; return a status if the path ends there."""
    floor = walk.trial < settings.min_step
    line = line_contact(model, walk.track, settings)
    if line is not None and line[0] <= target:
        walk.ended_at, walk.pair, last = line
        walk.track = (*walk.track, last)
        walk.cause = Status.LINE_CONTACT
        return Status.LINE_CONTACT
    if not floor and walk.failures % _PATIENCE and not _steeper(walk.track):
        return None
    located = limit_point(model, walk.last, max(walk.trial, settings.min_step), settings)
    if located is not None and walk.last.at.t <= located.point.load_parameter <= target:
        walk.critical.append(located.point)
        walk.ended_at, walk.pair = located.point.load_parameter, None
        walk.cause = Status.LIMIT_POINT
        return Status.LIMIT_POINT
    return _at_floor(model, walk, attempt, goal, settings) if floor else None


def _at_floor(model: Model, walk: _Walk, attempt: Attempt, goal: float, settings: Settings) -> Status | None:
    """Let go of a contact that slips off where that is allowed; return a status if the path ends here."""
    loosened = release(model, walk.last, settings)
    if loosened is not None:
        walk.critical.append(loosened)
        walk.cause, walk.pair = Status.LIMIT_POINT, None
        return Status.LIMIT_POINT
    after = _after_slip(model, walk.last.at, goal, attempt, settings)
    found = None
    if after is not None and after.status is Status.CONVERGED:
        found = accept(model, after.state, settings)
    if after is None or found is None:
        lost = attempt.status is Status.LOST_CONTACT
        return Status.LOST_CONTACT if lost else Status.CUTBACK_FLOOR
    assert attempt.pair is not None, "a slip-off is about a pair"
    walk.iterations += after.iterations
    walk.slips.append((attempt.pair, goal))
    walk.accept(found, afresh=True)
    walk.trial, walk.order = settings.first_step, settings.predictor_order
    return None


def _steeper(track: tuple[Accepted, ...]) -> bool:
    """Whether the rate has grown over the last step as it does towards a limit point."""
    if len(track) < 2 or track[-1].closed != track[-2].closed:
        return False
    before, after = (one.at.t for one in track[-2:])
    first, second = (float(np.linalg.norm(one.rate(before, after).u)) for one in track[-2:])
    return second > _STEEPER * first


def _after_slip(
    model: Model, before: State, goal: float, attempt: Attempt, settings: Settings
) -> Attempt | None:
    """Equilibrium without the contact that is lost over an end; None if none is, or if it must be kept.

    A strip that nothing else touches springs back to rest, and all its contacts open. Every other contact that its node is
    about to reach, within the strip's height, is tried closed first.
    """
    if attempt.status is not Status.LOST_CONTACT or attempt.pair is None:
        return None
    lost = model.pairs[attempt.pair]
    if lost.contact.keep or not before.touches[attempt.pair].closed:
        return None
    strip = lost.strips[0]
    free = not any(touch.pair.strips[0] == strip and touch.pair is not lost for touch in before.closed)
    u = before.u.copy()
    if free:
        u[model.parts[strip]] = 0
    conditions = [
        _condition_after(model, touch, strip if free else None, number == attempt.pair)
        for number, touch in enumerate(before.touches)
    ]
    return equilibrium(model, state(model, u, goal, tuple(conditions)), settings)


def _condition_after(model: Model, touch: Touch, at_rest_strip: int | None, lost: bool) -> Condition:
    if lost:
        return touch.condition.opened(armed=False)
    if at_rest_strip in touch.pair.strips:
        return touch.condition.opened(armed=touch.condition.armed)
    near = abs(touch.gap) < model.problem.strips[touch.pair.strips[0]].height and touch.projection.inside
    return replace(touch.condition, closed=touch.closed or (touch.condition.armed and near))
