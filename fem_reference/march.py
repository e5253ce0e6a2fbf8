"""March along the load parameters with step control, branch control and slip-off.

A step is accepted if it departs little from the tangents at both ends, and if the index is unchanged or the set of closed
contacts has changed. The steps between the requested load parameters are chosen automatically.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from fem_reference.active_set import equilibrium, slipping
from fem_reference.arrays import Floats
from fem_reference.critical import (
    CriticalPoint,
    Located,
    bifurcation,
    displacement_tolerance,
    limit_point,
    opening_limit,
    stable_branch,
)
from fem_reference.ends import end_contact
from fem_reference.events import SLIP_OFF, ContactEvent, changes, contact_event
from fem_reference.line_contact import least_clearance, line_contact
from fem_reference.model import Model
from fem_reference.newton import Attempt
from fem_reference.settings import Settings
from fem_reference.slip_events import SlipEvent, first_slip_event
from fem_reference.state import State, at_rest, build_state, with_conditions
from fem_reference.status import Status
from fem_reference.touch import Condition, Touch
from fem_reference.track import ORDER, TRACK_LENGTH, Accepted, accept, departure, predict

_LOAD_ROUND_OFF = 1e-9
"""Largest distance at which the turn of a pin's path and the end of a step coincide."""
_RATE_GROWTH = 1.5
"""Growth of the rate over a step beyond which a limit point is searched."""
_SEARCH_INTERVAL = 5
"""Number of consecutive rejected attempts after which a limit point is searched."""
_AT_END = 1e-2
"""Largest distance from an end, over the strip's length, of a contact that slips off there within the smallest step."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Step:
    """Progress to one requested load parameter.

    Parameters
    ----------
    status
        ``Status.CONVERGED`` if the requested load parameter was reached; otherwise the reason why the march ended.
    cause, pair
        Status of the last attempt, and the index of the contact to which it refers.
    load_parameter, state, index
        Last accepted state with its load parameter and index. If an event ends the path, its load parameter instead.
    iterations, cutbacks, substeps
        Numbers of linear solutions, rejected attempts and accepted states since the previous requested load parameter.
    events
        Changes of contacts since the previous requested load parameter.
    critical
        Critical points since the previous requested load parameter.
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
    events: tuple[ContactEvent, ...]
    critical: tuple[CriticalPoint, ...]


@dataclass(kw_only=True, eq=False)
class _Progress:
    """Variables of the march to one requested load parameter."""

    model: Model
    track: tuple[Accepted, ...]
    trial: float
    order: int
    iterations: int = 0
    cutbacks: int = 0
    substeps: int = 0
    failures: int = 0
    cause: Status = Status.CONVERGED
    pair: int | None = None
    events: list[ContactEvent] = field(default_factory=list)
    critical: list[CriticalPoint] = field(default_factory=list)
    ended_at: float | None = None

    @property
    def last(self) -> Accepted:
        return self.track[-1]

    def accept(self, state: Accepted, *, restart: bool = False) -> None:
        """Append an accepted state to the track, or start a new track with it."""
        self.events += changes(self.model, self.last.state, state.state)
        self.track = (state,) if restart else (*self.track, state)[-TRACK_LENGTH:]
        self.substeps += 1
        self.failures = 0

    def accept_event(self, event: SlipEvent) -> None:
        """Start a new track with the state of an event; a contact that touches or leaves there does so in the next step."""
        self.accept(event.at, restart=True)


def march(model: Model, load_parameters: Floats, settings: Settings) -> Iterator[Step]:
    """Yield a step to every load parameter; a step with another status than ``CONVERGED`` is the last."""
    start = accept(model, _start(model), settings)
    assert start is not None, "the undeformed stiffness is regular, since no strip can move without strain"
    track: tuple[Accepted, ...] = (start,)
    trial = settings.first_step
    if model.ill_conditioned or start.index > 0:
        progress = _Progress(model=model, track=track, trial=trial, order=ORDER)
        progress.cause = Status.ILL_CONDITIONED
        yield _step(progress, Status.ILL_CONDITIONED)
        return
    for target in map(float, load_parameters):
        progress = _Progress(model=model, track=track, trial=trial, order=ORDER)
        status = _advance(model, target, progress, settings)
        yield _step(progress, status)
        if status is not Status.CONVERGED:
            return
        track, trial = progress.track, progress.trial
        if target.is_integer():  # a stage may follow
            track, trial = track[-1:], settings.first_step


def _start(model: Model) -> State:
    """Undeformed state. If a strip has no clamp, contacts that touch are closed without force, since they may hold it."""
    state = at_rest(model)
    if all(strip.clamped for strip in model.problem.strips):
        return state
    return with_conditions(
        state,
        tuple(
            replace(touch.condition, closed=touch.projection.inside and abs(touch.gap) <= 1e-9 * model.length)
            for touch in state.touches
        ),
    )


def _step(progress: _Progress, status: Status) -> Step:
    """Return the completed step."""
    last = progress.last
    return Step(
        status=status,
        cause=progress.cause,
        pair=progress.pair,
        load_parameter=last.state.t if progress.ended_at is None else progress.ended_at,
        state=last.state,
        index=last.index,
        iterations=progress.iterations,
        cutbacks=progress.cutbacks,
        substeps=progress.substeps,
        events=tuple(progress.events),
        critical=tuple(progress.critical),
    )


def _advance(model: Model, target: float, progress: _Progress, settings: Settings) -> Status:
    """Advance to ``target``; return ``Status.CONVERGED``, or the reason why the path ended before."""
    while progress.last.state.t < target:
        if progress.cutbacks + progress.substeps >= settings.max_attempts:
            return Status.STEP_LIMIT
        goal = _goal(model, progress, target)
        attempt = equilibrium(model, predict(model, progress.track, goal, progress.order), settings)
        progress.iterations += attempt.iterations
        progress.cause, progress.pair = attempt.status, attempt.pair
        candidate = (
            accept(model, attempt.state, settings, progress.last)
            if attempt.status is Status.CONVERGED
            else None
        )
        met = None if candidate is None else end_contact(model, progress.last, candidate, settings)
        if met is not None:
            return _end_at(progress, Status.END_CONTACT, met)
        ended = _accept_or_shorten(model, progress, candidate, goal, settings)
        if ended is None and progress.failures:
            ended = _find_obstacle(model, progress, attempt, goal, target, settings)
        if ended is not None:
            return ended
    return Status.CONVERGED


def _goal(model: Model, progress: _Progress, target: float) -> float:
    """Load parameter of the next attempt. The step ends at a turn of a pin's path and leaves no tiny remainder."""
    t = progress.last.state.t
    end = next(
        (turn for turn in model.problem.turns if t + _LOAD_ROUND_OFF < turn < target - _LOAD_ROUND_OFF),
        target,
    )
    return end if progress.trial >= (end - t) * (1 - 1e-6) else t + progress.trial


def _accept_or_shorten(
    model: Model, progress: _Progress, candidate: Accepted | None, goal: float, settings: Settings
) -> Status | None:
    """Accept the state of an attempt or shorten the step; return a status if the path ends at a bifurcation."""
    last, reduction = progress.last, 0.5
    h = goal - last.state.t
    if candidate is not None:
        distance = departure(last, candidate, displacement_tolerance(model, settings))
        near = distance <= settings.largest_departure
        event = first_slip_event(model, last, candidate, settings) if near else None
        if event is not None:
            candidate = event.at
        tightest = least_clearance(candidate.state)
        same_set = candidate.state.contact_set == last.state.contact_set
        comparable = same_set and -1 not in (candidate.index, last.index)
        if not near:
            progress.cause = Status.ANOTHER_BRANCH
            reduction = max(0.1, min(0.5, 0.7 * settings.largest_departure / distance))
        elif event is not None and not event.first:
            progress.cause, progress.pair = Status.UNDECIDED_CONTACT, event.pair
        elif tightest is not None and tightest[1] <= 0:
            progress.cause, progress.pair = Status.LINE_CONTACT, tightest[0]
        elif not comparable and settings.branch != "primary" and candidate.index > max(last.index, 0):
            progress.cause = Status.LIMIT_POINT
        elif not comparable or candidate.index == last.index:
            if event is None:
                _accept_and_lengthen(progress, candidate, h, distance, settings)
            else:
                progress.accept_event(event)
            return None
        else:
            located = bifurcation(model, last, candidate, settings)
            if located is not None:
                return _continue_from_bifurcation(model, progress, candidate, located, settings)
            progress.cause = Status.ANOTHER_BRANCH
    progress.cutbacks += 1
    progress.failures += 1
    progress.trial = reduction * h
    # A high-order extrapolation may be the reason of the failure.
    progress.order = max(progress.order - 2, 1)
    return None


def _accept_and_lengthen(
    progress: _Progress, candidate: Accepted, h: float, distance: float, settings: Settings
) -> None:
    """Accept a state after a step h, and choose the next step from the step's departure."""
    step = h * max(0.5, min(2.0, 0.8 * settings.largest_departure / max(distance, 1e-9)))
    progress.trial = step if h >= progress.trial * (1 - 1e-6) else max(step, progress.trial)
    progress.order = ORDER
    progress.accept(candidate)


def _continue_from_bifurcation(
    model: Model, progress: _Progress, candidate: Accepted, located: Located, settings: Settings
) -> Status | None:
    """Continue on the branch of `Settings.branch`; return a status if the path ends at the bifurcation."""
    progress.critical.append(located.point)
    if settings.branch == "primary":
        progress.accept(candidate)
        return None
    t = located.point.load_parameter
    if settings.branch == "stable":
        stable = stable_branch(model, located, candidate.state.t, settings)
        if stable is not None:
            progress.accept(stable, restart=True)
            progress.trial = stable.state.t - t
            return None
    progress.cause, progress.ended_at = Status.BIFURCATION, t
    return Status.BIFURCATION


def _find_obstacle(
    model: Model, progress: _Progress, attempt: Attempt, goal: float, target: float, settings: Settings
) -> Status | None:
    """Search for line contact or a limit point ahead of a rejected attempt; return a status if the path ends there."""
    at_floor = progress.trial < settings.min_step
    line = line_contact(model, progress.track, settings)
    if line is not None and line[0] <= target:
        return _end_at(progress, Status.LINE_CONTACT, line)
    if not at_floor and progress.failures % _SEARCH_INTERVAL and not _approaches_fold(progress.track):
        return None
    located = limit_point(model, progress.last, max(progress.trial, settings.min_step), settings)
    if located is not None and progress.last.state.t <= located.point.load_parameter <= target:
        progress.critical.append(located.point)
        progress.ended_at, progress.pair = located.point.load_parameter, None
        progress.cause = Status.LIMIT_POINT
        return Status.LIMIT_POINT
    return _at_smallest_step(model, progress, attempt, goal, settings) if at_floor else None


def _end_at(progress: _Progress, status: Status, found: tuple[float, int, Accepted]) -> Status:
    """End the path at a load parameter, for a pair, with the state before."""
    progress.ended_at, progress.pair, last = found
    progress.track = (*progress.track, last)
    progress.cause = status
    return status


def _at_smallest_step(
    model: Model, progress: _Progress, attempt: Attempt, goal: float, settings: Settings
) -> Status | None:
    """Release a contact that opens or slips off; return a status if the path ends here."""
    limit = opening_limit(model, progress.last, settings)
    if limit is not None:
        progress.critical.append(limit)
        progress.cause, progress.pair = Status.LIMIT_POINT, None
        return Status.LIMIT_POINT
    lost = _slipped_off(progress.last.state, attempt)
    if lost is not None and model.pairs[lost].radius > 0 and model.pairs[lost].ends:
        # the pin pushes on, now at the corner
        return _end_at(progress, Status.END_CONTACT, (progress.last.state.t, lost, progress.last))
    after = _after_slip(model, progress.last.state, goal, lost, settings) if lost is not None else None
    released = None
    if after is not None and after.status is Status.CONVERGED:
        released = accept(model, after.state, settings)
    if lost is None or after is None or released is None:
        return Status.CUTBACK_FLOOR if lost is None else Status.LOST_CONTACT
    progress.iterations += after.iterations
    touch, before = progress.last.state.touches[lost], len(progress.events)
    progress.accept(released, restart=True)
    progress.events[before:] = [
        contact_event(SLIP_OFF, touch, lost, goal, 0),
        *(event for event in progress.events[before:] if event.pair != lost),
    ]
    progress.trial, progress.order = settings.first_step, ORDER
    return None


def _approaches_fold(track: tuple[Accepted, ...]) -> bool:
    """Whether the rate grows over the last step as before a limit point."""
    if len(track) < 2 or track[-1].state.contact_set != track[-2].state.contact_set:
        return False
    before, after = (accepted.state.t for accepted in track[-2:])
    first, second = (float(np.linalg.norm(accepted.rate(before, after).u)) for accepted in track[-2:])
    return second > _RATE_GROWTH * first


def _slipped_off(before: State, attempt: Attempt) -> int | None:
    """Contact that an attempt lost over an end which its node had reached in the state before; None without one.

    An attempt that diverges may lose a contact anywhere.
    """
    if attempt.status is not Status.LOST_CONTACT or attempt.pair is None:
        return None
    touch = before.touches[attempt.pair]
    first, last = touch.pair.curve.stations[[0, -1]]
    from_end = min(touch.projection.zeta - first, last - touch.projection.zeta)
    return attempt.pair if from_end <= _AT_END * (last - first) else None


def _after_slip(model: Model, before: State, goal: float, number: int, settings: Settings) -> Attempt | None:
    """Equilibrium after a slip-off without the contact ``number``; None if the contact must be kept.

    A clamped strip without another closed contact, support or joint springs back to rest, and all its contacts open. Every
    other contact whose gap is smaller than the strip's height is closed in the initial guess.
    """
    lost = model.pairs[number]
    if lost.contact.keep or not before.touches[number].closed:
        return None
    strip = lost.strips[0]
    name = model.problem.strips[strip].name
    tied = any(model.sections[tie.section].node.split(".")[0] == name for tie in model.ties)
    held = any(touch.pair.strips[0] == strip and touch.pair is not lost for touch in before.closed)
    free = not (held or tied)
    u = before.u.copy()
    if free:
        u[model.parts[strip]] = 0
    conditions = [
        _condition_after(model, touch, strip if free else None, own == number)
        for own, touch in enumerate(before.touches)
    ]
    guess = build_state(model, u, goal, tuple(conditions), before.tie_forces)
    return equilibrium(model, _slid_without_friction(model, guess, settings), settings)


def _slid_without_friction(model: Model, guess: State, settings: Settings) -> State:
    """Return the equilibrium without friction, with slip in the directions that lead there; the guess without friction."""
    if not guess.rubbing:
        return guess
    smooth = tuple(replace(condition, friction=None) for condition in guess.conditions)
    slid = equilibrium(model, build_state(model, guess.u, guess.t, smooth, guess.tie_forces), settings)
    if slid.status is not Status.CONVERGED:
        return guess
    conditions = tuple(
        replace(now, friction=before.friction)
        for now, before in zip(slid.state.conditions, guess.conditions, strict=True)
    )
    state = build_state(model, slid.state.u, guess.t, conditions, slid.state.tie_forces)
    return with_conditions(state, tuple(slipping(touch) for touch in state.touches))


def _condition_after(model: Model, touch: Touch, at_rest_strip: int | None, lost: bool) -> Condition:
    """Condition of a contact in the initial guess after a slip-off."""
    if lost:
        return touch.condition.opened(armed=False)
    if at_rest_strip in touch.pair.strips:
        return touch.condition.opened(armed=touch.condition.armed)
    near = (
        abs(touch.gap) < model.problem.strips[touch.pair.strips[0]].largest_height and touch.projection.inside
    )
    return replace(touch.condition, closed=touch.closed or (touch.condition.armed and near))
