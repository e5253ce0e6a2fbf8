"""March along the load parameter, with checks of the path, its stability and its contacts before a step is accepted.

A step goes to the next prescribed load parameter, or less far after a cut-back. Newton's method starts from the extrapolation of the
last accepted states. If an event lies inside the step, the step ends at the event. The contact is then opened or closed, and the march
goes on from there.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from tsm.contact_set import changed, closed_at, crowded, forbidden, initial_state, rearm
from tsm.critical import CriticalKind, critical_point, locate_bifurcation
from tsm.crossing import crossing, through_end
from tsm.elements.properties import Array
from tsm.ends import clearance
from tsm.energy import spent
from tsm.events import (
    GRIPS,
    ROUND_OFF,
    SHORT,
    Event,
    EventKind,
    Margin,
    broken,
    locate,
    margins,
    normal_force,
    passed_within,
    passes,
)
from tsm.fall import Fall
from tsm.friction import grips, regripped, same, slip_rates, turned
from tsm.jump import Jump
from tsm.mechanism import mechanism
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.path import FOLLOWED, PathTangent
from tsm.rolling import rolled
from tsm.settings import Settings
from tsm.stages import stage_of
from tsm.state import State
from tsm.status import Status
from tsm.step import Step, StepLog
from tsm.step_control import NEAR, StepControl, allowed, ends
from tsm.system import Drive
from tsm.track import Track

_STRAIGHT = 0.02
"""Largest unexplained fraction of a step that passes a bifurcation. A step that changes the index with a larger one may have left the path."""
_AHEAD = 1e-4
"""Load parameter beyond a critical point at which a fall starts."""
_PROBE = 1e-3
"""Part of a step after which a margin that is zero at its start shows whether its event is there."""
_COINCIDENT = 1e-6
"""Distance over the longest beam below which a touch and a slip-off are one event, a hand-over."""


class Stepper:
    """One march.

    ``track``: the path so far, from which the next state is predicted.
    ``control``: length of the next step.
    ``log``: events, iterations and cut-backs since the last yielded step.
    ``margins``: margins of the events that the contacts of the last equilibrium may have next.
    ``chatter``: changes of every contact pair at every load parameter.
    ``target``: next prescribed load parameter.
    ``turned``: load parameter at which contacts with friction followed a corner of the pins' paths last.
    """

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model = model
        self.settings = settings
        self.newton = Newton(model, settings)
        start = self.newton.solve(initial_state(model))
        if mechanism(self.newton, start, self.newton.assembler.drive(0.0)):
            start = replace(start, status=Status.MECHANISM)
        self.track, self.log = Track(self.newton, start), StepLog()
        if model.rubbed:
            self.log.spent = np.zeros(1 + len(model.pairs))
        self.control = StepControl(settings, start.status)
        self.target, self.turned = 0.0, -1.0
        self.margins = self._measure(start) if start.status is Status.CONVERGED else []
        self.chatter: Counter[tuple[int, float]] = Counter()
        for k in self._overlapping(start.state) if self.margins else ():
            self.track.accepted = replace(start, status=self._meet_end(start.state, k))

    @property
    def accepted(self) -> Equilibrium:
        """The last equilibrium of the path."""
        return self.track.accepted

    def _measure(self, equilibrium: Equilibrium) -> list[Margin]:
        rates = slip_rates(self.newton, equilibrium, self._drive(equilibrium.state.load_parameter))
        return margins(self.newton, equilibrium, rates)

    def _drive(self, t: float) -> Drive:
        """What changes on the way to t; at the last equilibrium, on the way ahead."""
        begin = self.accepted.state.load_parameter
        return self.newton.assembler.drive(*((begin, t) if t > begin else (t, max(t, self.target))))

    def march(self, load_parameters: Array) -> Iterator[Step]:
        """Yield accepted steps up to the last load parameter or the first failure."""
        if self.accepted.status is not Status.CONVERGED:
            yield self._record(False, self.accepted.status)
            return
        times = load_parameters.tolist()
        asked = frozenset(times)
        for target in ends(times, self.model.turns, self.accepted.state.load_parameter):
            attempts, self.target = 0, target
            while (t := self.accepted.state.load_parameter) < target:
                if attempts == self.settings.max_attempts:
                    yield self._record(False, Status.STEP_LIMIT)
                    return
                attempts += 1
                left = target - t
                step = min(self.control.step, self.track.room())
                goal = target if left <= step * (1 + 1e-6) else t + step
                status = self._attempt(goal) if step >= self.settings.smallest_step else self.control.refuse()
                if status is Status.CONVERGED:
                    reached = self.accepted.state.load_parameter
                    yield self._record(reached == target and target in asked, status)
                elif status is not self.control.failure:
                    yield self._record(False, status)
                    return
                else:
                    self.log.cutbacks += 1
                    if self.control.cut_back(min(step, left)):
                        folded = self._on_held_end(self.accepted.state)
                        status = Status.FOLDED if folded else self.control.verdict(self.track.folds())
                        if status is Status.LIMIT_POINT:
                            status = self._meet_limit_point()
                        yield self._record(False, status)
                        if status is not Status.CONVERGED:
                            return

    def _turn_corner(self) -> Status:
        """Go on as the load does, at the start, where a path has a corner and where a stage begins.

        Contacts with friction may slip or stick from there. A stage begins just after the load parameter at which the last one ends, so
        that all rates are its own. The path has a kink there, and no state before it serves for an extrapolation.
        """
        t = self.accepted.state.load_parameter
        goes_on = t == self.turned or not (self.model.rubbed or self.model.stages > 1)
        if goes_on or (t > 0 and all(abs(t - turn) > NEAR for turn in self.model.turns)):
            return Status.CONVERGED
        here = self.accepted
        if 0 < t < self.model.stages and t == round(t):
            state = self.newton.prescribed(here.state, math.nextafter(t, math.inf))
            here = replace(here, state=state, system=self.newton.assembler.linearise(state))
            if mechanism(self.newton, here, self._drive(state.load_parameter)):
                return Status.MECHANISM
        self.turned = here.state.load_parameter
        gripped = self._gripped(here, here.state) if self.model.rubbed else here
        if isinstance(gripped, Status):
            return gripped
        self.track.history = []
        self.track.accept(gripped)
        self.margins = self._measure(self.accepted)
        return Status.CONVERGED

    def _gripped(self, equilibrium: Equilibrium, last: State) -> Equilibrium | Status:
        """Equilibrium whose contacts with friction slip or stick from here, after a state `last`; a change is an event."""
        before, drive = dict(grips(equilibrium.state)), self._drive(equilibrium.state.load_parameter)
        state = regripped(self.newton, equilibrium.state, drive, last)
        if isinstance(state, Status):
            return state
        if state.touches == equilibrium.state.touches:
            return equilibrium
        gripped = replace(equilibrium, state=state, system=self.newton.assembler.linearise(state))
        for k, grip in grips(state):
            if same(before[k], grip):
                continue
            touch, pair = state.touches[k], self.model.pairs[k]
            assert touch is not None, "a grip is of a closed contact"
            kind = EventKind.SLIP if grip.slip else EventKind.STICK
            self.log.note(kind, state.load_parameter, pair, touch, normal_force(self.model, gripped, k))
        return gripped

    def _record(self, requested: bool, status: Status) -> Step:
        stage = 1 + stage_of(self.target, self.model.stages)
        return self.log.hand_on(self.accepted, requested, status, self.track.tangent.index, stage)

    def _attempt(self, goal: float) -> Status:
        """Go to a load parameter or to the first event before it, past a corner where one is."""
        turned = self._turn_corner()
        return self._reach(goal) if turned is Status.CONVERGED else turned

    def _reach(self, goal: float) -> Status:
        """Go to a load parameter or to the first event before it."""
        reached = self._solve(goal)
        if reached is None:
            return self.control.failure
        crossed = crossing(self.model, self.accepted.state, reached.state)
        if crossed is not None and crossed[0] > self.accepted.state.load_parameter:
            return self._reach(crossed[0])
        if crossed is not None:
            touch = next(m for m in self.margins if (m.kind, m.pair) == (EventKind.TOUCH, crossed[1]))
            return self._switch(self.accepted, [touch])
        deep = through_end(self.model, self.accepted.state, reached.state)
        if deep is not None:
            return self._reach(deep)
        events = broken(self.margins, self._measure(reached))
        if events or self._pulls_at_first(goal):
            return self._stop_at_first(events, goal) if events else self.control.refuse(_PROBE)
        return self._advance(reached) if self.newton.balanced(reached) else Status.UNBALANCED

    def _pulls_at_first(self, goal: float) -> bool:
        """Whether a contact that has no force pulls just after it, though it may push at the goal."""
        idle = {m.pair for m in self.margins if m.kind is EventKind.RELEASE and abs(m.value) <= ROUND_OFF}
        t = self.accepted.state.load_parameter
        ahead = self._solve(t + _PROBE * (goal - t)) if idle else None
        past = [] if ahead is None else broken(self.margins, self._measure(ahead))
        return any(after.kind is EventKind.RELEASE and after.pair in idle for _, after in past)

    def _advance(self, reached: Equilibrium) -> Status:
        """Accept an equilibrium if the step has no event, has followed the path and has passed no critical point."""
        before, tangent = self.accepted.state, PathTangent(self.newton, reached)
        unexplained = max(self.track.unexplained(end, reached) for end in (self.track.tangent, tangent))
        fitting = allowed(unexplained)
        if unexplained > FOLLOWED:
            return self.control.refuse(fitting)
        old, new = self.track.index, tangent.index
        changed = 0 <= new != old and (new > old or self.track.tangent.index == old)
        if changed:
            if unexplained > _STRAIGHT:
                return self.control.refuse()
            return self._meet_bifurcation(reached, tangent)
        if self.model.rubbed:
            drive = self._drive(reached.state.load_parameter)
            more = spent(self.newton, self.track.history, (self.accepted, reached), drive)
            part = 1 / 2 if more is None else self._dips(more.between, reached)
            if more is None or part is not None:
                return self.control.refuse(part or 1 / 2)
            self.log.spent = self.log.spent + more.total
        self._accept(reached, tangent)
        self.control.grow(reached.state.load_parameter - before.load_parameter, fitting)
        return Status.CONVERGED

    def _dips(self, between: tuple[Equilibrium, ...], reached: Equilibrium) -> float | None:
        """Part of the step at which a margin of slip or stick is below zero, though not at the step's end; None if none is."""
        begin, end = self.accepted.state.load_parameter, reached.state.load_parameter
        if end - begin <= SHORT or all(margin.kind not in GRIPS for margin in self.margins):
            return None
        measured = [self.margins, *map(self._measure, (*between, reached))]
        dip = passed_within(measured, [begin, *(inner.state.load_parameter for inner in between), end])
        return (dip - begin) / (end - begin) if dip is not None else None

    def _meet_bifurcation(self, reached: Equilibrium, tangent: PathTangent) -> Status:
        """At a bifurcation within a step, end the path, turn to the stable branch, or accept the equilibrium beyond."""
        singular = locate_bifurcation(self.newton, self.track.tangent, tangent, self._solve)
        if singular is None:
            return self.control.refuse()
        self._note_critical(CriticalKind.BIFURCATION, singular, singular.state.load_parameter)
        primary = self.settings.branch == "primary"
        self._accept(reached if primary else singular)
        if primary:
            return Status.CONVERGED
        return self._turn(singular) if self.settings.branch == "stable" else Status.BIFURCATION

    def _meet_limit_point(self) -> Status:
        """End the path beside a limit point, or let the structure fall to the stable branch."""
        self._note_critical(CriticalKind.LIMIT_POINT, self.accepted, self.track.limit())
        return self._turn(self.accepted) if self.settings.branch == "stable" else Status.LIMIT_POINT

    def _note_critical(self, kind: CriticalKind, equilibrium: Equilibrium, load_parameter: float) -> None:
        self.log.critical.append(critical_point(self.newton, kind, equilibrium, load_parameter))
        self.log.events.append(Event(kind=EventKind[kind.name], load_parameter=load_parameter))

    def _turn(self, critical: Equilibrium) -> Status:
        """Let the structure fall from a critical point, pushed along its mode in both directions; accept the equilibrium of less energy."""
        t = critical.state.load_parameter
        fall = self._fall()
        found = fall.beside(critical, t + min(_AHEAD, (self.target - t) / 2))
        self.log.iterations += fall.iterations
        if isinstance(found, Status):
            return found
        rest, released = found
        for k in self._overlapping(rest.state):
            return self._meet_end(critical.state, k)
        self.log.events[-1] = replace(self.log.events[-1], released=released)
        self.track.history = []
        self._accept(rest)
        self.control.step = 1.0
        return Status.CONVERGED

    def _solve(self, t: float) -> Equilibrium | None:
        """Equilibrium at t from the predicted state, if the tangent leads to it."""
        start = self.track.predicted(t)
        equilibrium = rolled(self.newton, self.accepted.state, self.newton.solve(start))
        self.log.iterations += equilibrium.iterations
        if equilibrium.status is not Status.CONVERGED:
            self.control.fail(equilibrium.status)
            return None
        unexplained = self.track.unexplained(self.track.tangent, equilibrium)
        if unexplained > FOLLOWED or self.track.strays(start, equilibrium):
            self.control.refuse(allowed(unexplained) if unexplained > FOLLOWED else 1 / 2)
            return None
        return equilibrium

    def _stop_at_first(self, events: list[tuple[Margin, Margin]], goal: float) -> Status:
        """End the step at its first event. If a force or position jumps instead, the step is too long and is refused."""
        t = self.accepted.state.load_parameter
        first: tuple[Equilibrium, Margin] | None = None
        for before, after in events:
            if after.kind in GRIPS and before.value <= ROUND_OFF:
                return self.control.fail(Status.JAMMED)
            if before.value <= ROUND_OFF:
                if self._rises(before, t + _PROBE * (goal - t)):
                    return self.control.refuse(_PROBE)
                located: tuple[Equilibrium, Margin] | None = (self.accepted, before)
            else:
                located = locate((t, before), (goal, after), self._solve, self._measure)
            if located is None:
                return self.control.failure
            if after.kind is EventKind.TOUCH and before.value < 1.0 and located[1].value < -ROUND_OFF:
                return self.control.refuse()
            # at one load parameter a release comes last: another contact that opens may take its pull away
            order = located[0].state.load_parameter, after.kind is EventKind.RELEASE
            if first is None or order < (first[0].state.load_parameter, first[1].kind is EventKind.RELEASE):
                first = located
        assert first is not None, "events is not empty"
        event, margin = first
        past = [other for other in self._measure(event) if other.value < -_COINCIDENT]
        if any(other.kind is not EventKind.TOUCH or other.pair != margin.pair for other in past):
            return self.control.refuse()
        together = [
            other
            for before, other in zip(self.margins, self._measure(event), strict=True)
            if {other.kind, margin.kind} == {EventKind.TOUCH, EventKind.SLIP_OFF}
            and other.value <= _COINCIDENT
            and other.value < before.value
        ]
        return self._switch(event, sorted([margin, *together], key=lambda m: m.kind is EventKind.TOUCH))

    def _rises(self, margin: Margin, t: float) -> bool:
        """Whether a margin that is zero at the last equilibrium is positive at a load parameter just beyond."""
        ahead = self._solve(t)
        return ahead is not None and self._measure(ahead)[self.margins.index(margin)].value > ROUND_OFF

    def _switch(self, event: Equilibrium, changes: list[Margin]) -> Status:
        """Accept the configuration of the events, then open and close its contacts."""
        if event is not self.accepted:
            status = self._advance(event)
            if status is not Status.CONVERGED or self.accepted.system is not event.system:
                return status
        state = event.state
        noted, kinds = len(self.log.events), {margin.kind for margin in changes}
        for margin in changes:
            after = self._change(event, state, margin, alone=len(kinds) == 1)
            if isinstance(after, Status):
                return after
            state = after
        if crowded(self.model, state):
            return Status.TWO_CONTACTS
        status = self._resume(event, state, jump=EventKind.SLIP_OFF in kinds)
        if status is not Status.CONVERGED and status is self.control.failure:
            del self.log.events[noted:]
        return status

    def _change(self, event: Equilibrium, state: State, margin: Margin, *, alone: bool) -> State | Status:
        """State with a contact opened or closed, slipping or sticking; `alone` if no contact takes over."""
        k, model, pair = margin.pair, self.model, self.model.pairs[margin.pair]
        self.chatter[k, state.load_parameter] += 1
        if self.chatter[k, state.load_parameter] > self.settings.max_chatter:
            return Status.CHATTER
        if margin.kind is EventKind.TOUCH:
            return self._close(state, margin)
        if margin.kind is EventKind.END_CONTACT:
            return self._meet_end(state, k)
        touch = state.touches[k]
        assert touch is not None, "only a closed contact opens, slips or sticks"
        self.log.note(margin.kind, state.load_parameter, pair, touch, normal_force(model, event, k))
        if margin.kind in GRIPS:
            return turned(model, state, event.system, k)
        refused = forbidden(model, margin.kind, pair, pair.arc_position(touch), alone=alone)
        if refused is not None:
            return self._meet_end(state, k) if refused is Status.END_CONTACT else refused
        return changed(model, state, k, None, armed=margin.kind is EventKind.RELEASE)

    def _overlapping(self, state: State) -> list[int]:
        """Pairs whose pin or node overlaps an end of its beam, or a side that it does not touch."""
        model, deep = self.model, -ROUND_OFF * self.model.length
        thick = [k for k, pair in enumerate(model.pairs) if pair.pair.offset > 0]
        return [k for k in thick if clearance(model, state, k).distance < deep]

    def _on_held_end(self, state: State) -> bool:
        """Whether a contact lies on a held end, which takes any force: nothing that happens there has a tangent."""
        there = zip(self.model.pairs, state.touches, strict=True)
        closed = ((pair, pair.arc_position(touch)) for pair, touch in there if touch is not None)
        return any(
            min(arc, pair.target.beam.length - arc) <= ROUND_OFF * self.model.length
            and forbidden(self.model, EventKind.SLIP_OFF, pair, arc, alone=False) is Status.FOLDED
            for pair, arc in closed
        )

    def _meet_end(self, state: State, k: int) -> Status:
        """End the path where pair k meets an end, or the side that it does not touch."""
        pair, arc = self.model.pairs[k], clearance(self.model, state, k).arc
        t, kind = state.load_parameter, EventKind.END_CONTACT
        self.log.events.append(Event(kind=kind, load_parameter=t, pair=pair.pair.name, arc_position=arc))
        return Status.END_CONTACT

    def _close(self, state: State, margin: Margin) -> State:
        """State with an open pair closed without force. A pair whose node is on the far side stays open and may not close (not armed)."""
        k, pair = margin.pair, self.model.pairs[margin.pair]
        if margin.value < -ROUND_OFF:
            return changed(self.model, state, k, None, armed=False)
        seen = pair.group.project(pair, state)
        touch = closed_at(pair, seen)
        self.log.note(EventKind.TOUCH, state.load_parameter, pair, touch, 0.0)
        return changed(self.model, state, k, touch, armed=True)

    def _resume(self, event: Equilibrium, state: State, *, jump: bool) -> Status:
        """Find equilibrium with the changed contacts and accept it."""
        found = self._jump(event, state) if jump else self._settled(state)
        if isinstance(found, Status):
            return found
        for k in self._overlapping(found.state):
            return self._meet_end(event.state, k)
        gripped = self._gripped(found, event.state)
        if isinstance(gripped, Status):
            return gripped
        self.track.history = []
        held = self.track.index
        self._accept(gripped)
        if self.track.index > held and self.settings.branch != "primary":
            return self._meet_limit_point()
        return Status.CONVERGED

    def _jump(self, event: Equilibrium, state: State) -> Equilibrium | Status:
        """Equilibrium after a slip-off."""
        return Jump(fall=self._fall(), control=self.control, log=self.log).rest(event, state)

    def _settled(self, state: State) -> Equilibrium | Status:
        """Equilibrium with changed contacts, without a jump."""
        equilibrium = self.newton.solve(state)
        self.log.iterations += equilibrium.iterations
        self.control.fail(equilibrium.status)
        return equilibrium if equilibrium.status is Status.CONVERGED else self.control.failure

    def _fall(self) -> Fall:
        return Fall(newton=self.newton, measure=self._measure, close=self._close)

    def _accept(self, equilibrium: Equilibrium, tangent: PathTangent | None = None) -> None:
        """Make an equilibrium the last of the path."""
        if self.track.history:
            self.log.events.extend(passes(self.model, self.accepted, equilibrium))
        self.track.accept(replace(equilibrium, state=rearm(self.model, equilibrium.state)), tangent)
        self.margins = self._measure(self.accepted)
