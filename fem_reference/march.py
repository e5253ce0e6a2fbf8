"""March along the load parameters with adaptive steps between them, through slip-offs that are allowed."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fem_reference.active_set import equilibrium
from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.newton import Attempt
from fem_reference.settings import Settings
from fem_reference.state import Condition, State, Touch, at_rest, state
from fem_reference.status import Status

_NEAR = 1e-9
"""Turns of a pin that are as close as this to an end of a step are there."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Step:
    """The way to one common load parameter.

    Parameters
    ----------
    status
        ``Status.CONVERGED`` if ``load_parameter`` is the common one; otherwise why the march ended here.
    cause, pair
        Status of the last attempt, and the number of the contact it is about.
    load_parameter, state
        The last accepted load parameter and state.
    iterations, cutbacks, substeps
        Linear solutions, attempts given up and states accepted since the common load parameter before.
    slips
        Contacts that slipped off, with their load parameters.
    """

    status: Status
    cause: Status
    pair: int | None
    load_parameter: float
    state: State
    iterations: int
    cutbacks: int
    substeps: int
    slips: tuple[tuple[int, float], ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Track:
    """Accepted states that the next step starts from, oldest first."""

    states: tuple[State, ...]

    @property
    def last(self) -> State:
        return self.states[-1]

    def predict(self, model: Model, t: float, order: int) -> State:
        """State at ``t`` by Lagrange's polynomial through the last ``order + 1`` states, contacts as in the last."""
        states = self.states[-order - 1 :]
        times = [at.t for at in states]
        weights = [float(np.prod([(t - tj) / (ti - tj) for tj in times if tj != ti])) for ti in times]
        u = sum((w * at.u for w, at in zip(weights, states, strict=True)), np.zeros_like(self.last.u))
        conditions = []
        for number, now in enumerate(self.last.conditions):
            force = sum(w * at.touches[number].force for w, at in zip(weights, states, strict=True))
            wanted = model.pairs[number].contact.penetration is not None
            conditions.append(replace(now, force=force, multiplier=force if wanted else 0.0))
        return state(model, u, t, tuple(conditions))

    def advance(self, at: State, keep: int) -> "_Track":
        return _Track(states=(*self.states, at)[-keep:])


def march(model: Model, load_parameters: Floats, settings: Settings) -> Iterator[Step]:
    """Yield the accepted state at every load parameter; if one cannot be reached, a last step says why.

    Between two load parameters, and places where a pin turns, the step is cut back to a half after a failure and doubled after a
    success.
    """
    track = _Track(states=(at_rest(model),))
    trial = float(load_parameters[0])
    for target in map(float, load_parameters):
        step, track, trial = _reach(model, target, track, trial, settings)
        yield step
        if step.status is not Status.CONVERGED:
            return


def _reach(
    model: Model, target: float, track: _Track, trial: float, settings: Settings
) -> tuple[Step, _Track, float]:
    """Go from the track's end to ``target``; return the step, the track and the next trial step."""
    iterations = cutbacks = substeps = 0
    slips: list[tuple[int, float]] = []
    order, status, longest = settings.predictor_order, Status.CONVERGED, trial
    while track.last.t < target:
        if cutbacks + substeps >= settings.max_attempts:
            status = Status.STEP_LIMIT
            break
        t = track.last.t
        end = next((turn for turn in model.problem.turns if t + _NEAR < turn < target - _NEAR), target)
        remaining = end - t
        # A remainder that is all but covered is taken whole, so that no sliver is left.
        whole = trial >= remaining * (1 - 1e-6)
        goal = end if whole else t + trial
        attempt = equilibrium(model, track.predict(model, goal, order), settings)
        iterations += attempt.iterations
        if attempt.status is Status.CONVERGED:
            track = track.advance(attempt.state, settings.predictor_order + 1)
            trial = 2 * trial
            order = settings.predictor_order
            substeps += 1
            continue
        cutbacks += 1
        trial = min(trial, remaining) / 2
        # After a failure the extrapolation itself is in doubt.
        order = max(order - 1, 0)
        if trial < settings.min_step:
            after = _after_slip(model, track.last, goal, attempt, settings)
            if after is None or after.status is not Status.CONVERGED:
                status = attempt.status if attempt.status is Status.LOST_CONTACT else Status.CUTBACK_FLOOR
                break
            assert attempt.pair is not None, "a slip-off is about a pair"
            iterations += after.iterations
            substeps += 1
            slips.append((attempt.pair, goal))
            track, trial = _Track(states=(after.state,)), longest
    step = Step(
        status=status,
        cause=attempt.status,
        pair=attempt.pair,
        load_parameter=track.last.t,
        state=track.last,
        iterations=iterations,
        cutbacks=cutbacks,
        substeps=substeps,
        slips=tuple(slips),
    )
    return step, track, trial


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
