"""March along the load: predictor, step control, contact events.

A step goes to the next prescribed load parameter, or less far after a cut-back. It starts from the extrapolation of the
last accepted states. Where an event lies inside the step, the step ends on the event, the
contact is opened or closed, and the march goes on from there.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tsm.contact import arc_position, project
from tsm.contact_set import changed, crowded, forbidden, initial_state, rearm
from tsm.critical import (
    Bracket,
    CriticalKind,
    CriticalPoint,
    critical_point,
    limit_load,
    locate_bifurcation,
    mode_shape,
)
from tsm.crossing import crossing
from tsm.elements.properties import Array
from tsm.events import (
    ROUND_OFF,
    Event,
    EventKind,
    Margin,
    Passage,
    broken,
    locate,
    margins,
    normal_force,
    passed,
)
from tsm.fall import Fall, descends, met
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.path import FOLLOWED, LONGEST_STEP, PathTangent
from tsm.predictor import extrapolate
from tsm.settings import Settings
from tsm.state import State, Touch
from tsm.status import Status

MEMORY = 4
"""States that the predictor extrapolates from, a cubic in the load parameter: a path has kinks where contacts pass from element to element."""
_MEMORY_WHOLE = 8
"""The same where nothing is passed."""
_FOLD = 100.0
"""Faster than this, in largest Newton steps per whole load, a path nears a limit point: there the speed is infinite."""
FAR = 1.0
"""Longest way of an equilibrium from its prediction, in largest Newton steps; of 2, one random pin in a hundred ends on another branch."""
_FEW = 3
"""Fewer states than these are extrapolated along the tangent."""
_SAFE = 0.8
"""Part of the step that the tangents would still allow, of which the next one is tried."""
_SHORTENED = 0.1
"""Shortest part of a refused step that is tried next."""
_STRAIGHT = 0.02
"""A step that changes the index, and misses its tangents by less, has passed a bifurcation; another may have left the path."""
_AHEAD, _PUSH = 1e-4, 0.006
"""Load parameter beyond a critical point, and displacement along its mode in parts of the longest beam, from where a structure falls."""
_GROWING, _ROOM = 1.4, 0.6
"""Growth of the speed that shows a limit point ahead, and the part of the way there of the next step, a little less than tangents explain."""
_NEAR = 1e-9
"""Turns of a pin that are as close as this to a prescribed load parameter are there."""
_COINCIDENT = 1e-6
"""Touch and slip-off closer than this, in parts of the longest beam, are one event: a hand-over."""


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
    critical : tuple of CriticalPoint
        Critical points since the step before.
    index : int
        Index of the equilibrium, see `tsm.stability`.
    """

    equilibrium: Equilibrium
    requested: bool
    status: Status
    iterations: int
    cutbacks: int
    events: tuple[Event, ...]
    critical: tuple[CriticalPoint, ...] = ()
    index: int = -1


class Stepper:
    """One march; holds what the predictor and the step control remember."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model = model
        self.settings = settings
        self.newton = Newton(model, settings)
        self.iterations = 0
        self.cutbacks = 0
        self.events: list[Event] = []
        self.chatter: Counter[tuple[int, float]] = Counter()
        start = self.newton.solve(initial_state(model))
        self.accepted = start
        self.history = [start.state]
        self.margins = self._measure(start) if start.status is Status.CONVERGED else []
        self.step = 1.0
        self.failure = start.status
        self.memory = _MEMORY_WHOLE if model.whole else MEMORY
        self.shortened = 1 / 2
        self.tangent = PathTangent(self.newton, start)
        self.critical: list[CriticalPoint] = []
        self.target, self.earlier = 0.0, self.tangent
        self.index = max(self.tangent.index, 0) if start.status is Status.CONVERGED else 0

    def resume(self, accepted: list[State], step: float) -> None:
        """Go on from configurations that were accepted elsewhere, oldest first, instead of from the start.

        Parameters
        ----------
        accepted : list of State
            In equilibrium, all with the same closed contacts.
        step : float
            Longest next step.
        """
        state = accepted[-1]
        self.accepted = Equilibrium(
            state=state,
            status=Status.CONVERGED,
            iterations=0,
            residuals=(),
            system=self.newton.assembler.linearise(state),
        )
        self.history = accepted
        self.margins = self._measure(self.accepted)
        self.step = step
        self.tangent = PathTangent(self.newton, self.accepted)

    def _measure(self, equilibrium: Equilibrium) -> list[Margin]:
        return margins(self.model, equilibrium, max(self.newton.tolerance, self.newton.noise))

    def march(self, load_parameters: Array) -> Iterator[Step]:
        """Yield accepted steps up to the last load parameter or the first failure."""
        if self.accepted.status is not Status.CONVERGED:
            yield self._record(False, self.accepted.status)
            return
        asked = frozenset(load_parameters.tolist())
        for target in self._ends(load_parameters.tolist()):
            attempts, self.target = 0, target
            while (t := self.accepted.state.load_parameter) < target:
                if attempts == self.settings.max_attempts:
                    yield self._record(False, Status.STEP_LIMIT)
                    return
                attempts += 1
                left = target - t
                step = min(self.step, self._room())
                goal = target if left <= step * (1 + 1e-6) else t + step
                here = step < self.settings.smallest_step
                status = self._refuse(1 / 2) if here else self._attempt(goal)
                if status is Status.CONVERGED:
                    reached = self.accepted.state.load_parameter
                    yield self._record(reached == target and target in asked, status)
                elif status is not self.failure:
                    yield self._record(False, status)
                    return
                else:
                    self.cutbacks += 1
                    self.step = min(step, left) * self.shortened
                    if self.step < self.settings.smallest_step:
                        status = self._verdict()
                        if status is Status.LIMIT_POINT:
                            status = self._meet_limit_point()
                        yield self._record(False, status)
                        if status is not Status.CONVERGED:
                            return

    def _ends(self, load_parameters: list[float]) -> list[float]:
        """Where steps must end: at the load parameters, and where a pin turns on the way to the last of them."""
        turns = self.model.turns
        begin, end = self.accepted.state.load_parameter, load_parameters[-1]
        ahead = turns[bisect_right(turns, begin + _NEAR) : bisect_left(turns, end)]
        places = [bisect_left(load_parameters, turn - _NEAR) for turn in ahead]
        apart = [t for t, n in zip(ahead, places, strict=True) if load_parameters[n] > t + _NEAR]
        return sorted([*load_parameters, *apart])

    def _verdict(self) -> Status:
        """Why no step goes on from here, as precisely as it can be told."""
        told = {
            Status.NOT_FINITE,
            Status.SINGULAR_TANGENT,
            Status.INACCURATE,
            Status.TWO_CONTACTS,
            Status.PING_PONG,
        }
        if self.failure in told or self.settings.smallest_step > 0.5:
            return self.failure
        return Status.LIMIT_POINT if self.tangent.speed() > _FOLD else Status.CUTBACK_FLOOR

    def _record(self, requested: bool, status: Status) -> Step:
        step = Step(
            equilibrium=self.accepted,
            requested=requested,
            status=status,
            iterations=self.iterations,
            cutbacks=self.cutbacks,
            events=tuple(self.events),
            critical=tuple(self.critical),
            index=self.tangent.index,
        )
        self.iterations = self.cutbacks = 0
        self.events, self.critical = [], []
        return step

    def _attempt(self, goal: float) -> Status:
        """Go to a load parameter or to the first event before it."""
        reached = self._solve(goal)
        if reached is None:
            return self.failure
        crossed = crossing(self.model, self.accepted.state, reached.state)
        if crossed is not None and crossed[0] > self.accepted.state.load_parameter:
            return self._attempt(crossed[0])
        if crossed is not None:
            touch = next(m for m in self.margins if (m.kind, m.pair) == (EventKind.TOUCH, crossed[1]))
            return self._switch(self.accepted, [touch])
        events = broken(self.margins, self._measure(reached))
        if events:
            return self._stop_at_first(events, goal)
        if not self._balanced(reached):
            return Status.UNBALANCED
        return self._advance(reached)

    def _advance(self, reached: Equilibrium) -> Status:
        """Accept an equilibrium without an event on the way, if the step has followed the path and passed no critical point."""
        before, tangent = self.accepted.state, PathTangent(self.newton, reached)
        missed = max(self._missed(self.tangent, reached), self._missed(tangent, reached))
        fitting = _SAFE * FOLLOWED / max(missed, 1e-9)
        if missed > FOLLOWED:
            return self._refuse(fitting)
        old, new = self.index, tangent.index
        changed = 0 <= new != old and (new > old or self.tangent.index == old)
        if changed:
            if missed > _STRAIGHT:
                return self._refuse(1 / 2)
            bracket = Bracket((before.load_parameter, old), (reached.state.load_parameter, new))
            return self._meet_bifurcation(bracket, reached)
        self._accept(reached, tangent)
        taken = reached.state.load_parameter - before.load_parameter
        self.step = min(max(min(2.0, fitting) * taken, self.step if fitting >= 1 else 0.0), 1.0)
        return Status.CONVERGED

    def _meet_bifurcation(self, bracket: Bracket, reached: Equilibrium) -> Status:
        """End the path at the bifurcation within a step, turn to the stable branch there, or go on to what was reached."""
        at = locate_bifurcation(self.newton, bracket, self._solve)
        if at is None:
            return self._refuse(1 / 2)
        self._note_critical(CriticalKind.BIFURCATION, at, at.state.load_parameter)
        primary = self.settings.branch == "primary"
        self._accept(reached if primary else at)
        if primary:
            return Status.CONVERGED
        return self._turn(at) if self.settings.branch == "stable" else Status.BIFURCATION

    def _room(self) -> float:
        """Part of the way to a limit point ahead, if the last two speeds of the path show one, that a step can follow."""
        (t0, v0), (t1, v1) = ((one.state.load_parameter, one.speed()) for one in (self.earlier, self.tangent))
        if len(self.history) < 2 or t0 >= t1 or not v1 > _GROWING * v0:
            return float("inf")
        return _ROOM * (limit_load((t0, v0), (t1, v1)) - t1) or float("inf")

    def _meet_limit_point(self) -> Status:
        """End the path beside a limit point, or let the structure fall to the stable branch."""
        load = limit_load(*((one.state.load_parameter, one.speed()) for one in (self.earlier, self.tangent)))
        self._note_critical(CriticalKind.LIMIT_POINT, self.accepted, load)
        return self._turn(self.accepted) if self.settings.branch == "stable" else Status.LIMIT_POINT

    def _note_critical(self, kind: CriticalKind, at: Equilibrium, load_parameter: float) -> None:
        self.critical.append(critical_point(self.newton, kind, at, load_parameter))
        self.events.append(
            Event(
                kind=EventKind[kind.name],
                load_parameter=load_parameter,
                pair="",
                element=-1,
                arc_position=float("nan"),
                force=0.0,
            )
        )

    def _turn(self, at: Equilibrium) -> Status:
        """Let the structure fall from beside a critical point, pushed along its mode both ways; take the rest of least energy."""
        t, model = at.state.load_parameter, self.model
        ahead = t + min(_AHEAD, (self.target - t) / 2)
        found_mode = mode_shape(self.newton, at)
        if found_mode is None:
            return Status.FALLING
        push = found_mode[0] * (_PUSH * model.length)
        held = self.newton.prescribed(at.state, ahead)
        found: list[tuple[float, Equilibrium]] = []
        for way in (1.0, -1.0):
            start = self.newton.update(held, way * push, at.system)
            fall = Fall(newton=self.newton, measure=self._measure, close=self._close)
            rest = fall.rest(start, self.newton.potential(start))
            self.iterations += fall.iterations
            if rest is not None and PathTangent(self.newton, rest).index <= 0:
                found.append((self.newton.potential(rest.state), rest))
        if not found:
            return Status.FALLING
        least, rest = min(found, key=lambda pair: pair[0])
        self.events[-1] = replace(self.events[-1], released=self.newton.potential(held) - least)
        self.history = []
        self._accept(rest)
        self.step = 1.0
        return Status.CONVERGED

    def _refuse(self, part: float) -> Status:
        """Try a part of the step."""
        self.failure, self.shortened = Status.ITERATION_LIMIT, min(max(part, _SHORTENED), 1 / 2)
        return self.failure

    def _balanced(self, equilibrium: Equilibrium) -> bool:
        """Whether support reactions and pin forces add up to nothing."""
        model, system = self.model, equilibrium.system
        held = np.zeros(model.dof_count)
        held[model.fixed] = system.nodal[model.fixed]
        pushed = [force for k, force in system.forces.items() if model.pairs[k].pin is not None]
        loads = equilibrium.state.load_parameter * model.load
        total = (held + loads).reshape(-1, 3)[:, :2].sum(axis=0) + np.sum(pushed, axis=0, initial=0.0)
        largest = max((float(np.hypot(*force)) for force in pushed), default=0.0) + float(np.abs(loads).max())
        noise = max(self.newton.noise, self.newton.tolerance) * model.force_scale + system.noise
        return bool(np.abs(total).max() <= 1e-8 * largest + len(model.coordinates) * noise)

    def _solve(self, t: float) -> Equilibrium | None:
        """Equilibrium at t from the predicted state, if the tangent leads to it."""
        start = self._predicted(t)
        equilibrium = self.newton.solve(start)
        self.iterations += equilibrium.iterations
        self.shortened = 1 / 2
        if equilibrium.status is not Status.CONVERGED:
            self.failure = equilibrium.status
            return None
        missed = self._missed(self.tangent, equilibrium)
        if missed > FOLLOWED or self._strays(start, equilibrium):
            self._refuse(_SAFE * FOLLOWED / missed if missed > FOLLOWED else 1 / 2)
            return None
        return equilibrium

    def _predicted(self, t: float) -> State:
        """State at t from the last states, or along the tangent where they are few."""
        if len(self.history) < _FEW and not self._chord_contact():
            return self.tangent.predicted(self.accepted.state, t)
        return self.newton.prescribed(extrapolate(self.model, self.history, t), t)

    def _missed(self, tangent: PathTangent, found: Equilibrium) -> float:
        """Part of the step to an equilibrium that a tangent does not explain; nothing is asked of contacts without an energy."""
        if self._chord_contact():
            return 0.0
        return tangent.missed(self.accepted.state, found.state)

    def _strays(self, predicted: State, found: Equilibrium) -> bool:
        """Whether an equilibrium lies too far away; where contacts on chords allow no tangent, too far from its prediction."""
        if self._chord_contact():
            return self.newton.apart(predicted, found.state) > FAR
        return self.newton.apart(self.accepted.state, found.state) > LONGEST_STEP

    def _chord_contact(self) -> bool:
        """Whether a contact is closed whose stiffness grows without bound at the nodes: its tangents are round-off there."""
        touches = self.accepted.state.touches
        return any(
            touch is not None and pair.slot < 0 for pair, touch in zip(self.model.pairs, touches, strict=True)
        )

    def _stop_at_first(self, events: list[tuple[Margin, Margin]], goal: float) -> Status:
        """End the step on its first event; where a force or position jumps instead, the step was too large to tell."""
        t = self.accepted.state.load_parameter
        first: tuple[Equilibrium, Margin] | None = None
        for before, after in events:
            if before.value <= ROUND_OFF:
                found: tuple[Equilibrium, Margin] | None = (self.accepted, before)
            else:
                found = locate((t, before), (goal, after), self._solve, self._measure)
            if found is None:
                return self.failure
            if after.kind is EventKind.TOUCH and before.value < 1.0 and found[1].value < -ROUND_OFF:
                self.failure = Status.ITERATION_LIMIT
                return self.failure
            if first is None or found[0].state.load_parameter < first[0].state.load_parameter:
                first = found
        assert first is not None, "events is not empty"
        at, margin = first
        past = [other for other in self._measure(at) if other.value < -_COINCIDENT]
        if any(other.kind is not EventKind.TOUCH or other.pair != margin.pair for other in past):
            self.failure = Status.ITERATION_LIMIT
            return self.failure
        together = [
            other
            for before, other in zip(self.margins, self._measure(at), strict=True)
            if {other.kind, margin.kind} == {EventKind.TOUCH, EventKind.SLIP_OFF}
            and other.value <= _COINCIDENT
            and other.value < before.value
        ]
        return self._switch(at, sorted([margin, *together], key=lambda m: m.kind is EventKind.TOUCH))

    def _switch(self, at: Equilibrium, changes: list[Margin]) -> Status:
        """Accept the events' configuration, then open and close its contacts."""
        if at is not self.accepted:
            status = self._advance(at)
            if status is not Status.CONVERGED or self.accepted.system is not at.system:
                return status
        model, state, jump = self.model, at.state, False
        noted = len(self.events)
        for margin in changes:
            k, pair = margin.pair, model.pairs[margin.pair]
            self.chatter[k, state.load_parameter] += 1
            if self.chatter[k, state.load_parameter] > self.settings.max_chatter:
                return Status.CHATTER
            if margin.kind is EventKind.TOUCH:
                state = self._close(state, margin)
                continue
            touch = state.touches[k]
            assert touch is not None, "only a closed contact opens"
            arc = arc_position(pair.target, touch.element, touch.xi)
            self._note(margin.kind, k, touch.element, arc, normal_force(model, at, k))
            if margin.kind is EventKind.LINE_CONTACT:
                return Status.LINE_CONTACT
            refused = forbidden(model, margin.kind, pair, arc)
            if refused is not None:
                return refused
            jump |= margin.kind is EventKind.SLIP_OFF
            state = changed(model, state, k, None, armed=margin.kind is EventKind.RELEASE)
        if crowded(model, state):
            return Status.TWO_CONTACTS
        status = self._resume(at, state, jump=jump)
        if status is not Status.CONVERGED and status is self.failure:
            del self.events[noted:]
        return status

    def _close(self, state: State, margin: Margin) -> State:
        """State with an open pair closed without force, or, where its node is on the far side, no longer armed."""
        k, pair = margin.pair, self.model.pairs[margin.pair]
        if margin.value < -ROUND_OFF:
            return changed(self.model, state, k, None, armed=False)
        seen = project(self.model, pair, state)
        element, xi = seen.element, min(max(seen.xi, 0.0), 1.0)
        self._note(EventKind.TOUCH, k, element, arc_position(pair.target, element, xi), 0.0)
        return changed(self.model, state, k, Touch(element=element, xi=xi, force=(0.0, 0.0)), armed=True)

    def _resume(self, at: Equilibrium, state: State, *, jump: bool) -> Status:
        """Find equilibrium with the contacts changed; contacts that a jump would make pull are released in it."""
        energy = began = self.newton.potential(at.state)
        while True:
            equilibrium = self._settled(state, energy if jump else None)
            if equilibrium is None:
                return Status.FALLING if jump else self.failure
            state = equilibrium.state
            energy = self.newton.potential(state)
            pulling = [
                (normal_force(self.model, equilibrium, k), k)
                for k, touch in enumerate(state.touches)
                if touch is not None and jump
            ]
            least, k = min(pulling, default=(0.0, -1))
            if least >= -ROUND_OFF * self.model.force_scale:
                break
            touch = state.touches[k]
            assert touch is not None, "a pulling contact is closed"
            pair = self.model.pairs[k]
            before = normal_force(self.model, at, k) if at.state.touches[k] is not None else 0.0
            arc = arc_position(pair.target, touch.element, touch.xi)
            self._note(EventKind.RELEASE, k, touch.element, arc, before)
            if pair.pair.keep:
                return Status.LOST_CONTACT
            state = changed(self.model, state, k, None, armed=True)
        if jump:
            self._note_release(began - energy)
        self.history = []
        held = self.index
        self._accept(equilibrium)
        if self.index > held and self.settings.branch != "primary":
            return self._meet_limit_point()
        return Status.CONVERGED

    def _settled(self, state: State, energy: float | None) -> Equilibrium | None:
        """Equilibrium with other contacts: near the state, or, where a jump frees `energy`, to which the structure falls."""
        equilibrium = self.newton.solve(state)
        self.iterations += equilibrium.iterations
        found = equilibrium.status is Status.CONVERGED
        near = found and self.newton.apart(state, equilibrium.state) <= FAR
        down = near and (energy is None or descends(self.newton, energy, equilibrium.state))
        if energy is not None and not (down and not met(self._measure(equilibrium))):
            fall = Fall(newton=self.newton, measure=self._measure, close=self._close)
            rest = fall.rest(state, energy)
            self.iterations += fall.iterations
            return rest
        self.failure = equilibrium.status
        return equilibrium if found else None

    def _note_release(self, released: float) -> None:
        """Enter the energy of a jump with the slip-off that set it off, the last one noted."""
        n = max(n for n, event in enumerate(self.events) if event.kind is EventKind.SLIP_OFF)
        self.events[n] = replace(self.events[n], released=released)

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

    def _accept(self, equilibrium: Equilibrium, tangent: PathTangent | None = None) -> None:
        """Make an equilibrium the last of the path."""
        if self.history:
            self._note_passes(equilibrium)
        state = rearm(self.model, equilibrium.state)
        self.accepted = replace(equilibrium, state=state)
        earlier = [old for old in self.history if old.load_parameter < state.load_parameter]
        self.history = [*earlier[1 - self.memory :], state]
        self.margins = self._measure(self.accepted)
        self.earlier, self.tangent = self.tangent, tangent or PathTangent(self.newton, self.accepted)
        self.earlier.release()
        self.index = self.tangent.index if self.tangent.index >= 0 else self.index

    def _note_passes(self, equilibrium: Equilibrium) -> None:
        """Note changes of owner since the last state, at linearly interpolated load parameters."""
        model, before, after = self.model, self.accepted, equilibrium
        for k, (old, new) in enumerate(zip(before.state.touches, after.state.touches, strict=True)):
            if old is None or new is None or old.element == new.element:
                continue
            arcs = [arc_position(model.pairs[k].target, touch.element, touch.xi) for touch in (old, new)]
            passage = Passage(
                pair=k,
                t=(before.state.load_parameter, after.state.load_parameter),
                element=(old.element, new.element),
                arc=(arcs[0], arcs[1]),
                force=(normal_force(model, before, k), normal_force(model, after, k)),
            )
            self.events.extend(passed(model, passage))
