"""The march along the load parameters: it tries a step, judges the state that is found, and names the reason where the path ends.

A step is accepted if it departs little from the tangents at its two ends. If the index changes within a step and the contacts do not, the
step holds a bifurcation. After rejected steps the obstacle is sought: line contact, a limit point, or a contact that slips off its strip.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from fem_reference.contact.contact import Touch
from fem_reference.contact.friction import slipping
from fem_reference.path.critical import (
    BIFURCATION,
    CriticalPoint,
    bifurcation,
    critical_point,
    limit_point,
    opening_limit,
    stable_branch,
)
from fem_reference.path.ends import end_contact
from fem_reference.path.events import SLIP_OFF, ContactEvent, changes, clearance, contact_event, first_event
from fem_reference.path.track import LARGEST_DEPARTURE, Accepted, accept, departure, located, predict
from fem_reference.statement.arrays import Floats
from fem_reference.statement.status import Status
from fem_reference.system.model import Model
from fem_reference.system.newton import Attempt, displacement_tolerance, equilibrium
from fem_reference.system.state import State, at_rest

_RESOLVED = 0.05
"""Largest ratio of the round-off of a nodal force to the forces that bend or load the strips. Measured on strips of equal bending
stiffness: at .018 the tip is right to 2e-6 of the length; at .14 Newton's corrections are round-off."""
_LOAD_ROUND_OFF = 1e-9
"""Difference of load parameters below which a turn of a pin's path counts as reached."""
_FIRST_STEP = 0.1
"""First step of the load parameter, unless the first requested load parameter is smaller."""
_RATE_GROWTH = 1.5
"""Growth of the displacements' rate over a step that suggests a limit point ahead."""
_SEARCH_INTERVAL = 5
"""Number of consecutive rejected attempts after which a limit point is sought in any case."""
_CLEARANCE_LIMIT = 0.05
"""Clearance, see `clearance`, below which line contact is sought after a rejected attempt."""
_TOUCHES_ALONG_A_LINE = 1e-2
"""Largest clearance at the last state before line contact: nearer to it Newton's method may not converge."""
_AT_END = 1e-2
"""Largest distance from an end, over the strip's length, from which a contact slips off there within the smallest step."""


@dataclass(kw_only=True, eq=False)
class Step:
    """Progress to one requested load parameter, counted since the previous one."""

    status: Status = Status.CONVERGED  # the reason why the march ended, else ``CONVERGED``
    cause: Status = Status.CONVERGED  # why the latest attempt was rejected, or the path ended
    pair: int | None = None  # index of the contact that the cause refers to
    load_parameter: float  # last accepted load parameter, or that of the event which ends the path
    state: State  # last accepted state
    index: int  # index of that state
    iterations: int = 0  # number of linear solutions
    cutbacks: int = 0  # number of rejected attempts
    substeps: int = 0  # number of accepted states
    events: list[ContactEvent] = field(default_factory=list)  # changes of contacts
    critical: list[CriticalPoint] = field(default_factory=list)  # critical points


def march(model: Model, load_parameters: Floats) -> Iterator[Step]:
    """Yield a step to every load parameter; a step with another status than ``CONVERGED`` is the last."""
    return _March(model).steps(load_parameters)


class _March:
    """A march in progress."""

    def __init__(self, model: Model) -> None:
        start = accept(_start(model))
        assert start is not None, "singular undeformed stiffness: a strip moves without strain"
        self.model, self.settings = model, model.settings
        # the last accepted state, and the one before unless the path has a corner between
        self.track: tuple[Accepted, ...] = (start,)
        # length of the next step, and number of attempts rejected since the last accepted state
        self.trial, self.failures = _FIRST_STEP, 0

    @property
    def last(self) -> Accepted:
        return self.track[-1]

    def steps(self, load_parameters: Floats) -> Iterator[Step]:
        """Yield a step to every load parameter."""
        model, largest = self.model, max(self.model.force_scale, *self.model.largest_loads)
        resolved = model.round_off <= _RESOLVED * largest and self.last.index <= 0
        for target in map(float, load_parameters):
            self.step = Step(load_parameter=self.last.t, state=self.last.state, index=self.last.index)
            self.failures = 0
            status = self.advance(target) if resolved else self.end(Status.ILL_CONDITIONED)
            step, last = self.step, self.last
            step.status, step.state, step.index = status or Status.CONVERGED, last.state, last.index
            yield step
            if status is not None:
                return
            if target.is_integer():  # a stage may follow
                self.track, self.trial = self.track[-1:], _FIRST_STEP

    def advance(self, target: float) -> Status | None:
        """Advance to ``target``; return the reason why the path ended before, None if it did not."""
        step, ended = self.step, None
        while self.last.t < target and ended is None:
            if step.cutbacks + step.substeps >= self.settings.max_attempts:
                return Status.STEP_LIMIT
            goal = self.goal(target)
            attempt = equilibrium(predict(self.track[-1:] if self.failures else self.track, goal))
            step.iterations += attempt.iterations
            step.cause, step.pair = attempt.status, attempt.pair
            candidate = accept(attempt.state, self.last) if attempt.status is Status.CONVERGED else None
            met = None if candidate is None else end_contact(self.last, candidate)
            if met is not None:
                return self.end(Status.END_CONTACT, *met)
            h = goal - self.last.t
            ended = self.shorten(h) if candidate is None else self.judge(candidate, h)
            if ended is None and self.failures:
                ended = self.obstacle(attempt, goal, target)
        return ended

    def goal(self, target: float) -> float:
        """Load parameter of the next attempt. It does not pass a turn of a pin's path, and leaves no tiny rest before one."""
        t, slack = self.last.t, _LOAD_ROUND_OFF
        end = next((turn for turn in self.model.problem.turns if t + slack < turn < target - slack), target)
        return end if self.trial >= (end - t) * (1 - 1e-6) else t + self.trial

    def end(
        self, status: Status, at: Accepted | CriticalPoint | None = None, pair: int | None = None
    ) -> Status:
        """Note why the path ends, at which state or critical point, and for which contact; return the status."""
        step = self.step
        step.cause, step.pair = status, pair
        if isinstance(at, CriticalPoint):
            step.critical.append(at)
            step.load_parameter = at.load_parameter
        elif at is not None:
            self.track, step.load_parameter = (at,), at.t
        return status

    def judge(self, candidate: Accepted, h: float) -> Status | None:
        """Accept the state that an attempt over a step ``h`` has found, or shorten the step; return a status if the path ends."""
        last, allowed = self.last, LARGEST_DEPARTURE
        distance = departure(last, candidate, displacement_tolerance(last.state))
        if not distance <= allowed:
            reduction = max(0.1, min(0.5, 0.7 * allowed / distance))
            return self.shorten(h, Status.ANOTHER_BRANCH, reduction=reduction)
        event = first_event(last, candidate)
        if event is not None:
            candidate, other = event
            if other is not None:
                return self.shorten(h, Status.UNDECIDED_CONTACT, other)
        least, pair = clearance(candidate.state)
        if least <= 0:
            return self.line_contact(candidate.t) or self.shorten(h, Status.LINE_CONTACT, pair)
        if candidate.state.contact_set == last.state.contact_set:
            if -1 not in (candidate.index, last.index) and candidate.index != last.index:
                return self.bifurcate(candidate, h)
        elif self.settings.branch != "primary" and candidate.index > max(last.index, 0):
            # a slip may come to rest in a stick that is unstable
            return self.end(Status.BIFURCATION, candidate) if event else self.shorten(h, Status.LIMIT_POINT)
        if event is None:
            longer = h * max(0.5, min(2.0, 0.8 * allowed / max(distance, 1e-9)))
            self.trial = longer if h >= self.trial * (1 - 1e-6) else max(longer, self.trial)
        self.accept(candidate, restart=event is not None)
        return None

    def bifurcate(self, candidate: Accepted, h: float) -> Status | None:
        """Go on from the bifurcation before a state as `Settings.branch` says; return a status if the path ends there."""
        near = bifurcation(self.last, candidate)
        if near is None:
            return self.shorten(h, Status.ANOTHER_BRANCH)
        point, branch = critical_point(near, BIFURCATION), self.settings.branch
        following = candidate if branch == "primary" else None
        if branch == "stable":
            following = stable_branch(near, candidate.t)
        if following is None:
            return self.end(Status.BIFURCATION, point)
        self.step.critical.append(point)
        self.accept(following, restart=following is not candidate)
        if following is not candidate:
            self.trial = following.t - near.t
        return None

    def accept(self, state: Accepted, *, restart: bool = False) -> None:
        """Append an accepted state to the track, or start a new track with it."""
        self.step.events += changes(self.last.state, state.state)
        self.track = (state,) if restart else (self.last, state)
        self.step.substeps += 1
        self.step.load_parameter = state.t
        self.failures = 0

    def shorten(
        self, h: float, cause: Status | None = None, pair: int | None = None, reduction: float = 0.5
    ) -> Status | None:
        """Reject an attempt over a step ``h``; the next one is shorter. Returns None: the path goes on."""
        step = self.step
        step.cutbacks += 1
        if cause is not None:
            step.cause, step.pair = cause, pair
        self.failures += 1
        self.trial = reduction * h
        return None

    def line_contact(self, end: float) -> Status | None:
        """End the path where the least clearance vanishes before ``end``; None if it does not."""
        last, h = self.last.state, self.settings.min_step
        at = located(self.last, end, lambda at: clearance(at.state)[0]) if clearance(last)[0] > 0 else None
        least, pair = clearance(last if at is None else at.state)
        if at is None or least > _TOUCHES_ALONG_A_LINE:
            return None
        # near line contact only short steps converge: the rest of the way is extrapolated along the tangent
        ahead = at.state.moved(at.state.u + h * at.rate(at.t, at.t + h).u, at.t + h)
        fall = (least - clearance(ahead)[0]) / h
        self.end(Status.LINE_CONTACT, at, pair)
        self.step.load_parameter += least / fall if fall > 0 else 0.0
        return Status.LINE_CONTACT

    def obstacle(self, attempt: Attempt, goal: float, target: float) -> Status | None:
        """Find out what stopped an attempt: line contact, a limit point or slip-off; return a status if the path ends."""
        last, min_step = self.last, self.settings.min_step
        at_floor = self.trial < min_step
        if clearance(last.state)[0] <= _CLEARANCE_LIMIT and attempt.status is not Status.CONVERGED:
            line = self.line_contact(goal)
            if line is not None:
                return line
        if not at_floor and self.failures % _SEARCH_INTERVAL and not self.approaches_fold():
            return None
        found = limit_point(last, max(self.trial, min_step))
        if found is not None and last.t <= found.load_parameter <= target:
            return self.end(Status.LIMIT_POINT, found)
        return self.at_smallest_step(attempt, goal) if at_floor else None

    def approaches_fold(self) -> bool:
        """Whether the rate has grown over the last step as it does before a limit point."""
        *_, a, b = (self.last, *self.track)
        if a.state.contact_set != b.state.contact_set or a is b:
            return False
        first, second = (float(np.linalg.norm(accepted.rate(a.t, b.t).u)) for accepted in (a, b))
        return second > _RATE_GROWTH * first

    def at_smallest_step(self, attempt: Attempt, goal: float) -> Status | None:
        """Where steps cannot be shortened any more, go on without a contact that slips off, or return the status that ends the path."""
        last, step = self.last, self.step
        limit = opening_limit(last)
        if limit is not None:
            return self.end(Status.LIMIT_POINT, limit)
        lost = slipped_off(last.state, attempt)
        if lost is None:
            return Status.CUTBACK_FLOOR
        if self.model.pairs[lost].radius > 0 and self.model.pairs[lost].ends:
            return self.end(Status.END_CONTACT, last, lost)  # the pin pushes on, now at the corner
        after = after_slip(last.state, goal, lost)
        released = accept(after.state) if after and after.status is Status.CONVERGED else None
        if not (after and released):
            return Status.LOST_CONTACT
        step.iterations += after.iterations
        before = len(step.events)
        self.accept(released, restart=True)
        off = contact_event(SLIP_OFF, last.state.touches[lost], lost, goal, 0)
        step.events[before:] = [off, *(event for event in step.events[before:] if event.pair != lost)]
        self.trial = _FIRST_STEP
        return None


def _start(model: Model) -> State:
    """Undeformed state. If a strip has no clamp, contacts that touch are closed without force, since they may hold it."""
    state = at_rest(model)
    if all(strip.clamped for strip in model.problem.strips):
        return state
    slack = 1e-9 * model.length
    touches = [replace(one, closed=one.at.inside and abs(one.gap) <= slack) for one in state.touches]
    return state.touching(touches)


def slipped_off(before: State, attempt: Attempt) -> int | None:
    """Index of the contact that slipped off in an attempt. Its node was near an end before: a diverging attempt may lose any contact."""
    if attempt.status is not Status.LOST_CONTACT or attempt.pair is None:
        return None
    touch = before.touches[attempt.pair]
    first, last = touch.pair.curve.stations[[0, -1]]
    from_end = min(touch.at.zeta - first, last - touch.at.zeta)
    return attempt.pair if from_end <= _AT_END * (last - first) else None


def after_slip(before: State, goal: float, number: int) -> Attempt | None:
    """Equilibrium without a lost contact; None if it must be kept. A strip that nothing else holds is sought from its undeformed shape."""
    model, lost = before.model, before.touches[number]
    if lost.pair.contact.keep or not lost.closed:
        return None
    strip = lost.pair.contact.strip
    tied = any(model.sections[tie.section].strip == strip for tie in model.ties)
    held = any(touch.pair.contact.strip == strip and touch is not lost for touch in before.closed)
    free, u = not (held or tied), before.u.copy()
    if free:
        u[model.body(strip).part] = 0
    touches = list[Touch]()
    for touch in before.touches:
        high = model.problem.strip(touch.pair.contact.strip).largest_height
        # every other contact with a gap below the strip's height is closed at first
        near = touch.armed and touch.at.inside and abs(touch.gap) < high
        if touch is lost:
            touches.append(touch.opened(armed=False))
        elif free and strip in touch.pair.strips:
            touches.append(touch.opened(armed=touch.armed))
        else:
            touches.append(replace(touch, closed=touch.closed or near))
    guess = before.touching(touches).moved(u, goal)
    return equilibrium(_slid_without_friction(guess))


def _slid_without_friction(guess: State) -> State:
    """Equilibrium without friction, with contacts that slip as they have slid to it; the guess where nothing rubs or none is found."""
    if not guess.rubbing:
        return guess
    touches = [replace(one, begin=None, direction=0, tangential=0.0) for one in guess.touches]
    smooth = equilibrium(guess.touching(touches))
    if smooth.status is not Status.CONVERGED:
        return guess
    pairs = zip(smooth.state.touches, guess.touches, strict=True)
    return smooth.state.touching([slipping(replace(now, begin=before.begin)) for now, before in pairs])
