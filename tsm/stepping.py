"""March along the load: predictor, step control, contact events.

A step goes to the next prescribed load parameter, or less far after a cut-back. It starts from the extrapolation of the
last accepted states, or from the last one itself. Where an event lies inside the step, the step ends on the event, the
contact is opened or closed, and the march goes on from there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tsm.contact import arc_position, chord_owner, node_position, owner_at, project
from tsm.elements.properties import Array
from tsm.events import ROUND_OFF, Event, EventKind, Margin, broken, locate, margins, normal_force
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.settings import Settings
from tsm.state import State, Touch
from tsm.status import Status

_MEMORY = 4
"""States that the predictor extrapolates from: a cubic in the load parameter."""


@dataclass(frozen=True, kw_only=True)
class Step:
    """An accepted step, or the end of the march.

    Attributes
    ----------
    equilibrium : Equilibrium
        Last accepted configuration.
    requested : bool
        Whether it lies on a prescribed load parameter.
    status : Status
        CONVERGED, or why the march ends here.
    iterations : int
        Newton iterations spent since the step before, failed attempts and location of events included.
    cutbacks : int
        Attempts given up since the step before.
    events : tuple of Event
        Contact events since the step before.
    """

    equilibrium: Equilibrium
    requested: bool
    status: Status
    iterations: int
    cutbacks: int
    events: tuple[Event, ...]


class Stepper:
    """One march; holds what the predictor and the step control remember."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model = model
        self.settings = settings
        self.newton = Newton(model, tolerance=settings.tolerance, max_iterations=settings.max_iterations)
        self.iterations = 0
        self.cutbacks = 0
        self.events: list[Event] = []
        self.chatter: Counter[tuple[int, float]] = Counter()
        start = self.newton.solve(initial_state(model))
        self.accepted = start
        self.history = [start.state]
        self.margins = self._measure(start)
        self.step = 1.0

    def _measure(self, equilibrium: Equilibrium) -> list[Margin]:
        return margins(self.model, equilibrium, max(self.newton.tolerance, self.newton.noise))

    def march(self, load_parameters: Array) -> Iterator[Step]:
        """Yield accepted steps up to the last load parameter or the first failure."""
        for target in load_parameters.tolist():
            while (t := self.accepted.state.load_parameter) < target:
                left = target - t
                goal = target if left <= self.step * (1 + 1e-6) else t + self.step
                status = self._attempt(goal)
                if status is Status.CONVERGED:
                    yield self._record(self.accepted.state.load_parameter == target, status)
                elif status in {Status.CHATTER, Status.UNBALANCED}:
                    yield self._record(False, status)
                    return
                else:
                    self.cutbacks += 1
                    self.step = min(self.step, left) / 2
                    if self.step < self.settings.smallest_step:
                        yield self._record(False, Status.CUTBACK_FLOOR)
                        return

    def _record(self, requested: bool, status: Status) -> Step:
        step = Step(
            equilibrium=self.accepted,
            requested=requested,
            status=status,
            iterations=self.iterations,
            cutbacks=self.cutbacks,
            events=tuple(self.events),
        )
        self.iterations = self.cutbacks = 0
        self.events = []
        return step

    def _attempt(self, goal: float) -> Status:
        """Go to a load parameter or to the first event before it."""
        reached = self._solve(goal)
        if reached is None:
            return Status.ITERATION_LIMIT
        events = broken(self.margins, self._measure(reached))
        if not events and not self._balanced(reached):
            return Status.UNBALANCED
        if not events:
            self._accept(reached)
            self.step = min(2 * self.step, 1.0)
            return Status.CONVERGED
        return self._stop_at_first(events, goal)

    def _balanced(self, equilibrium: Equilibrium) -> bool:
        """Whether support reactions and pin forces add up to nothing."""
        model, system = self.model, equilibrium.system
        held = np.zeros(model.dof_count)
        held[model.fixed] = system.nodal[model.fixed]
        pushed = [force for k, force in system.forces.items() if model.pairs[k].pin is not None]
        total = held.reshape(-1, 3)[:, :2].sum(axis=0) + np.sum(pushed, axis=0, initial=0.0)
        largest = max((float(np.hypot(*force)) for force in pushed), default=0.0)
        noise = max(self.newton.noise, self.newton.tolerance) * model.force_scale + system.noise
        return bool(np.abs(total).max() <= 1e-8 * largest + len(model.coordinates) * noise)

    def _solve(self, t: float) -> Equilibrium | None:
        starts = [replace(self.history[-1], load_parameter=t)]
        if len(self.history) > 1:
            starts.insert(0, extrapolate(self.model, self.history, t))
        for start in starts:
            equilibrium = self.newton.solve(start)
            self.iterations += equilibrium.iterations
            if equilibrium.status is Status.CONVERGED:
                return equilibrium
        return None

    def _stop_at_first(self, events: list[tuple[Margin, Margin]], goal: float) -> Status:
        t = self.accepted.state.load_parameter
        first: tuple[Equilibrium, Margin] | None = None
        for before, after in events:
            if before.value <= ROUND_OFF:
                found: tuple[Equilibrium, Margin] | None = (self.accepted, before)
            else:
                found = locate((t, before), (goal, after), self._solve, self._measure)
            if found is None:
                return Status.ITERATION_LIMIT
            if first is None or found[0].state.load_parameter < first[0].state.load_parameter:
                first = found
        assert first is not None, "events is not empty"
        return self._switch(*first)

    def _switch(self, at: Equilibrium, margin: Margin) -> Status:
        """Accept the event's configuration, then open or close its contact."""
        if at is not self.accepted:
            self._accept(at)
        model, k = self.model, margin.pair
        pair, state = model.pairs[k], at.state
        self.chatter[k, state.load_parameter] += 1
        if self.chatter[k, state.load_parameter] > self.settings.max_chatter:
            return Status.CHATTER
        if margin.kind is EventKind.TOUCH:
            seen = project(model, pair, state.q, state.load_parameter)
            if margin.value < -ROUND_OFF:
                return self._resume(_with(state, k, None, armed=False))
            element, xi = seen.element, min(max(seen.xi, 0.0), 1.0)
            self._note(margin.kind, k, element, arc_position(model, pair.target, element, xi), 0.0)
            return self._resume(_with(state, k, Touch(element=element, xi=xi, force=(0.0, 0.0)), armed=True))
        touch = state.touches[k]
        assert touch is not None, "only a closed contact opens"
        arc, force = arc_position(model, pair.target, touch.element, touch.xi), normal_force(model, at, k)
        self._note(margin.kind, k, touch.element, arc, force)
        return self._resume(
            _with(state, k, None, armed=margin.kind is EventKind.RELEASE), at.system.forces[k], touch
        )

    def _resume(
        self, state: State, force: tuple[float, float] = (0.0, 0.0), touch: Touch | None = None
    ) -> Status:
        """Find equilibrium with the contact changed; a force that is lost is taken away in parts."""
        load = self._consistent(force, touch) if touch is not None else None
        part, step = 1.0, 1.0
        while True:
            goal = max(part - step, 0.0)
            equilibrium = self.newton.solve(state, None if load is None else goal * load)
            self.iterations += equilibrium.iterations
            if equilibrium.status is Status.CONVERGED:
                state, part, step = equilibrium.state, goal, 2 * step
                if part == 0.0:
                    break
            else:
                step /= 2
                if step < 1e-4:
                    return equilibrium.status
        self.history = []
        self._accept(equilibrium)
        return Status.CONVERGED

    def _consistent(self, force: tuple[float, float], touch: Touch) -> Array:
        """Nodal forces that stand for the lost contact force."""
        i, j = self.model.element_nodes[touch.element]
        load = np.zeros(self.model.dof_count)
        for node, part in ((i, 1 - touch.xi), (j, touch.xi)):
            load[3 * node : 3 * node + 2] = part * np.array(force)
        return load

    def _note(self, kind: EventKind, k: int, element: int, arc: float, force: float) -> None:
        pair = self.model.pairs[k]
        self.events.append(
            Event(
                kind=kind,
                load_parameter=self.accepted.state.load_parameter,
                pair=pair.pair.name,
                element=element - pair.target.first,
                arc_position=arc,
                force=force,
            )
        )

    def _accept(self, equilibrium: Equilibrium) -> None:
        if self.history:
            self._note_passes(equilibrium)
        state = rearm(self.model, equilibrium.state)
        self.accepted = replace(equilibrium, state=state)
        self.history = [*self.history[1 - _MEMORY :], state]
        self.margins = self._measure(self.accepted)

    def _note_passes(self, equilibrium: Equilibrium) -> None:
        """Note changes of owner since the last state, at linearly interpolated load parameters."""
        model, before, after = self.model, self.accepted, equilibrium
        for k, (old, new) in enumerate(zip(before.state.touches, after.state.touches, strict=True)):
            if old is None or new is None or old.element == new.element:
                continue
            pair = model.pairs[k]
            arcs = [arc_position(model, pair.target, touch.element, touch.xi) for touch in (old, new)]
            forces = [normal_force(model, at, k) for at in (before, after)]
            ahead = 1 if new.element > old.element else -1
            for element in range(old.element + ahead, new.element + ahead, ahead):
                arc = arc_position(model, pair.target, element, 0.0 if ahead > 0 else 1.0)
                part = (arc - arcs[0]) / (arcs[1] - arcs[0])
                t0, t1 = before.state.load_parameter, after.state.load_parameter
                self.events.append(
                    Event(
                        kind=EventKind.PASS_THROUGH,
                        load_parameter=t0 + part * (t1 - t0),
                        pair=pair.pair.name,
                        element=element - pair.target.first,
                        arc_position=arc,
                        force=forces[0] + part * (forces[1] - forces[0]),
                    )
                )


def _with(state: State, k: int, touch: Touch | None, *, armed: bool) -> State:
    touches, flags = list(state.touches), list(state.armed)
    touches[k], flags[k] = touch, armed
    return replace(state, touches=tuple(touches), armed=tuple(flags))


def rearm(model: Model, state: State) -> State:
    """State in which a passed pair may close again once its node is off the beam or back on the stated side."""
    if all(flag or touch for flag, touch in zip(state.armed, state.touches, strict=True)):
        return state
    armed = list(state.armed)
    for k, pair in enumerate(model.pairs):
        if state.touches[k] is None and not armed[k]:
            seen = project(model, pair, state.q, state.load_parameter)
            armed[k] = seen.overshoot > ROUND_OFF * model.length or seen.gap > ROUND_OFF * model.length
    return replace(state, armed=tuple(armed))


def initial_state(model: Model) -> State:
    """Undeformed state; pairs whose node lies on the surface are closed with zero force.

    Raises
    ------
    ValueError
        If a node starts on the wrong side of its beam.
    """
    q = np.zeros(model.dof_count)
    touches: list[Touch | None] = []
    for pair in model.pairs:
        seen = project(model, pair, q, 0.0)
        small = ROUND_OFF * model.length
        over = seen.overshoot <= small
        if over and seen.gap < -small:
            position = node_position(model, pair, q, 0.0)
            raise ValueError(
                f"ContactPair({pair.pair.name}).side = {pair.pair.side!r}: "
                f"the node starts at {position}, {-seen.gap:.3g} behind the surface"
            )
        closed = over and seen.gap <= small
        touches.append(
            Touch(element=seen.element, xi=min(max(seen.xi, 0.0), 1.0), force=(0.0, 0.0)) if closed else None
        )
    state = State(load_parameter=0.0, q=q, touches=tuple(touches), armed=(True,) * len(touches))
    return _owned(model, state)


def _owned(model: Model, state: State) -> State:
    """State with the owners of projected contacts renewed."""
    touches = [
        chord_owner(model, pair, state, touch) if touch is not None and pair.slot < 0 else touch
        for pair, touch in zip(model.pairs, state.touches, strict=True)
    ]
    return replace(state, touches=tuple(touches))


def extrapolate(model: Model, history: list[State], t: float) -> State:
    """State at t by the polynomial through earlier states, all with the same closed contacts."""
    at = [state.load_parameter for state in history]
    weights = [
        float(np.prod([(t - other) / (own - other) for k, other in enumerate(at) if k != n]))
        for n, own in enumerate(at)
    ]
    q = sum((w * state.q for w, state in zip(weights, history, strict=True)), np.zeros(model.dof_count))
    last = history[-1]
    touches: list[Touch | None] = []
    for k, pair in enumerate(model.pairs):
        trail = [state.touches[k] for state in history]
        known = [touch for touch in trail if touch is not None]
        if len(known) < len(trail):
            touches.append(None)
            continue
        arc = sum(
            w * arc_position(model, pair.target, touch.element, touch.xi)
            for w, touch in zip(weights, known, strict=True)
        )
        element, xi = owner_at(model, pair.target, arc)
        force = tuple(
            sum(w * touch.force[c] for w, touch in zip(weights, known, strict=True)) for c in range(2)
        )
        touches.append(Touch(element=element, xi=xi, force=(force[0], force[1])))
    return _owned(model, replace(last, load_parameter=t, q=q, touches=tuple(touches)))
