"""The follower of the equilibrium path: it predicts, corrects, looks for events, and accepts.

A step goes to the next prescribed load parameter, or less far after a cut-back. Newton's method starts from
the prediction of the path. If an event lies inside the step, the step ends at the event. The contact is then
opened or closed, and the march goes on from there.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from itertools import count

import numpy as np

from tsm.contact.contact_set import crowded, initial_state, rearm
from tsm.contact.events import Event, EventKind, passes
from tsm.elements.properties import Array
from tsm.model.model import Model
from tsm.model.state import UNDECIDED, State
from tsm.path.critical import CriticalKind, critical_point, locate_bifurcation, mechanism
from tsm.path.crossing import crossing, on_held_end, overlapping, through_end
from tsm.path.energy import rolled, spent
from tsm.path.fall import Fall
from tsm.path.friction import grips, regripped
from tsm.path.margins import Margin, Search, broken, margins
from tsm.path.path import FOLLOWED, SMALLEST, Point, StepControl, Track, allowed
from tsm.path.step import NEAR, Step, ends
from tsm.statement.settings import Settings
from tsm.statement.stages import stage_of
from tsm.statement.status import Status
from tsm.system.newton import Newton
from tsm.system.system import Drive

_STRAIGHT = 0.02
"""Largest unexplained fraction of a step that passes a bifurcation. A step that changes the index with a larger one may have left the path."""
_AHEAD = 1e-4
"""Load parameter beyond a critical point at which a fall starts."""
_MOST_ATTEMPTS = 1000
"""Largest number of load steps, with refused ones, between two prescribed load parameters."""
_MOST_CHANGES = 6
"""Largest number of contact events at one load parameter, for each contact pair."""


class Follower:
    """One march."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model, self.branch = model, settings.branch
        self.newton = Newton(model, settings)
        self.control = StepControl()
        self.target = 0.0  # next prescribed load parameter
        self.turned = -1.0  # last corner of a pin's path
        start = Point(self.newton, self.newton.solve(initial_state(model)))
        self.track = Track(start)
        self.log = Step(equilibrium=start.equilibrium)  # since the last yielded step
        if model.rubbed:
            self.log.spent = np.zeros(1 + len(model.pairs))
        self.chatter: Counter[tuple[int, float]] = Counter()  # changes of every pair at every load parameter
        self.status = start.equilibrium.status
        if mechanism(start, self._drive(0.0)):
            self.status = Status.MECHANISM
        # margins of the events that the contacts of the last point may have next
        self.margins = self._measure(start) if self.status is Status.CONVERGED else []
        met = overlapping(model, start.state) if self.margins else None
        if met is not None:
            self.status = self.log.note_end(model, start.state, met)

    def _measure(self, point: Point) -> list[Margin]:
        return margins(point, self._drive(point.t))

    def _drive(self, t: float) -> Drive:
        """What changes on the way to t; at the last point, on the way ahead."""
        begin = self.track.last.t
        return self.newton.assembler.drive(*((begin, t) if t > begin else (t, max(t, self.target))))

    def march(self, load_parameters: Array) -> Iterator[Step]:
        """Yield accepted steps up to the last load parameter or the first failure."""
        if self.status is not Status.CONVERGED:
            yield self._record(self.status)
            return
        times = load_parameters.tolist()
        asked = frozenset(times)
        for target in ends(times, self.model.turns, self.track.last.t):
            self.target = target
            for attempt in count():
                if self.track.last.t >= target:
                    break
                status = self._try_step() if attempt < _MOST_ATTEMPTS else Status.STEP_LIMIT
                if status is None:
                    continue
                reached = status is Status.CONVERGED and self.track.last.t == target
                yield self._record(status, requested=reached and target in asked)
                if status is not Status.CONVERGED:
                    return

    def _try_step(self) -> Status | None:
        """Take a step, or give it up; None where a shorter one is to be tried."""
        t = self.track.last.t
        left, step = self.target - t, min(self.control.step, self.track.room())
        goal = self.target if left <= step * (1 + 1e-6) else t + step
        status = self.control.refuse()
        if step >= SMALLEST:
            status = self._turn_corner()
            status = self._reach(goal) if status is Status.CONVERGED else status
        if status is Status.CONVERGED or status is not self.control.failure:
            return status
        self.log.cutbacks += 1
        if not self.control.cut_back(min(step, left)):
            return None
        if on_held_end(self.model, self.track.last.state):
            return Status.FOLDED
        status = self.control.verdict(self.track.folds())
        return self._meet_limit_point() if status is Status.LIMIT_POINT else status

    def _turn_corner(self) -> Status:
        """Go on as the load does, at the start, where a path has a corner and where a stage begins.

        Contacts with friction may slip or stick from there. A stage begins just after the load parameter at
        which the last one ends, so that all rates are its own. The path has a kink there, and no state before
        it serves for a prediction.
        """
        here, t = self.track.last, self.track.last.t
        goes_on = t == self.turned or not (self.model.rubbed or self.model.stages > 1)
        if goes_on or (t > 0 and all(abs(t - turn) > NEAR for turn in self.model.turns)):
            return Status.CONVERGED
        if 0 < t < self.model.stages and t == round(t):
            here = here.with_state(self.newton.prescribed(here.state, math.nextafter(t, math.inf)))
            if mechanism(here, self._drive(here.t)):
                return Status.MECHANISM
        self.turned = here.t
        gripped = self._gripped(here, here.state)
        if isinstance(gripped, Status):
            return gripped
        self._begin(gripped)
        return Status.CONVERGED

    def _gripped(self, point: Point, last: State) -> Point | Status:
        """Point whose contacts with friction slip or stick from here, after a state `last`; a change is an event."""
        before = dict(grips(point.state))
        gripped = regripped(point, self._drive(point.t), last) if before else point
        if isinstance(gripped, Status):
            return gripped
        for k, grip in grips(gripped.state):
            if before[k] != UNDECIDED and before[k].slip != grip.slip:
                self.log.note(EventKind.SLIP if grip.slip else EventKind.STICK, gripped, gripped.state, k)
        return gripped

    def _record(self, status: Status, *, requested: bool = False) -> Step:
        """The step that ends here; the log starts anew."""
        last, stage = self.track.last, 1 + stage_of(self.target, self.model.stages)
        step = replace(
            self.log,
            equilibrium=last.equilibrium,
            requested=requested,
            status=status,
            index=last.index,
            events=[replace(event, stage=stage) for event in self.log.events],
        )
        self.log = Step(equilibrium=last.equilibrium, spent=self.log.spent)
        return step

    def _reach(self, goal: float) -> Status:
        """Go to a load parameter or to the first event before it."""
        last, reached = self.track.last, self._solve(goal)
        if reached is None:
            return self.control.failure
        crossed = crossing(self.model, last.state, reached.state)
        if crossed is not None and crossed[0] <= last.t:
            touch = next(m for m in self.margins if (m.kind, m.pair) == (EventKind.TOUCH, crossed[1]))
            return self._switch(last, [touch])
        inside = crossed[0] if crossed is not None else through_end(self.model, last.state, reached.state)
        if inside is not None:
            return self._reach(inside)
        after = self._measure(reached)
        numbers, search = broken(self.margins, after), self._search(goal)
        if numbers:
            found = search.first(after, numbers)
            return found if isinstance(found, Status) else self._switch(*found)
        if search.pulls_at_first():
            return self.control.failure
        return self._advance(reached)

    def _search(self, goal: float) -> Search:
        return Search(self.track.last, self.margins, goal, self._solve, self._measure, self.control)

    def _solve(self, t: float) -> Point | None:
        """Point at t from the predicted state, if the tangent leads to it."""
        last, start = self.track.last, self.track.predicted(t)
        equilibrium = rolled(self.newton, last.state, self.newton.solve(start))
        self.log.iterations += equilibrium.iterations
        if not equilibrium.converged:
            self.control.fail(equilibrium.status)
            return None
        reached = Point(self.newton, equilibrium)
        reached.behind = left = self.track.unexplained(last, reached)
        if left > FOLLOWED or self.track.strays(start, reached.state):
            self.control.refuse(allowed(left) if left > FOLLOWED else 1 / 2)
            return None
        return reached

    def _advance(self, reached: Point) -> Status:
        """Accept a point if the step has no event, has followed the path and has passed no critical point."""
        last, track = self.track.last, self.track
        unexplained = max(reached.behind, track.unexplained(reached, reached))
        fitting = allowed(unexplained)
        if unexplained > FOLLOWED:
            return self.control.refuse(fitting)
        if 0 <= reached.index != track.index and (reached.index > track.index or last.index == track.index):
            return self._meet_bifurcation(reached) if unexplained <= _STRAIGHT else self.control.refuse()
        if self.model.rubbed:
            more = spent(track, reached, self._drive(reached.t))
            part = 1 / 2 if more is None else self._search(reached.t).dips([*more[1], reached])
            if more is None or part is not None:
                return self.control.refuse(part or 1 / 2)
            self.log.spent = self.log.spent + more[0]
        self.log.events += passes(self.model, last.equilibrium, reached.equilibrium)
        self._accept(reached)
        self.control.grow(reached.t - last.t, fitting)
        return Status.CONVERGED

    def _accept(self, point: Point) -> None:
        """Make a point the last of the path."""
        state = rearm(self.model, point.state)
        if state is not point.state:
            point = Point(self.newton, replace(point.equilibrium, state=state))
        self.track.accept(point)
        self.margins = self._measure(point)

    def _begin(self, point: Point) -> None:
        """Make a point the last of the path, and the first one with its contacts."""
        self.track.history = []
        self._accept(point)

    def _meet_bifurcation(self, reached: Point) -> Status:
        """At a bifurcation within a step, end the path, turn to the stable branch, or accept the point beyond."""
        singular = locate_bifurcation(self.track.last, reached, self._solve)
        if singular is None:
            return self.control.refuse()
        self._note_critical(CriticalKind.BIFURCATION, singular, singular.t)
        ahead = reached if self.branch == "primary" else singular
        self.log.events += passes(self.model, self.track.last.equilibrium, ahead.equilibrium)
        self._accept(ahead)
        if self.branch == "primary":
            return Status.CONVERGED
        return self._turn(singular) if self.branch == "stable" else Status.BIFURCATION

    def _meet_limit_point(self) -> Status:
        """End the path beside a limit point, or let the structure fall to the stable branch."""
        self._note_critical(CriticalKind.LIMIT_POINT, self.track.last, self.track.limit())
        return self._turn(self.track.last) if self.branch == "stable" else Status.LIMIT_POINT

    def _note_critical(self, kind: CriticalKind, point: Point, load_parameter: float) -> None:
        self.log.critical.append(critical_point(kind, point, load_parameter))
        self.log.events.append(Event(kind=EventKind[kind.name], load_parameter=load_parameter))

    def _turn(self, critical: Point) -> Status:
        """Let the structure fall from a critical point, pushed along its mode in both directions; accept the point of less energy."""
        kind = self.log.events[-1].kind
        ahead = critical.t + min(_AHEAD, (self.target - critical.t) / 2)
        found = self._fall().beside(critical, ahead)
        if isinstance(found, Status):
            return found
        rest, released = found
        met = overlapping(self.model, rest.state)
        if met is not None:
            return self.log.note_end(self.model, critical.state, met)
        self.log.release(kind, released)
        self._begin(rest)
        self.control.step = 1.0
        return Status.CONVERGED

    def _fall(self) -> Fall:
        return Fall(newton=self.newton, measure=self._measure, log=self.log)

    def _switch(self, event: Point, changes: list[Margin]) -> Status:
        """Accept the configuration of the events, then open and close its contacts."""
        if event is not self.track.last:
            status = self._advance(event)
            if status is not Status.CONVERGED or self.track.last.system is not event.system:
                return status
        state, noted = event.state, len(self.log.events)
        kinds = {margin.kind for margin in changes}
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

    def _change(self, event: Point, state: State, margin: Margin, *, alone: bool) -> State | Status:
        """State with a contact opened or closed, slipping or sticking; `alone` if no contact takes over."""
        k = margin.pair
        self.chatter[k, state.load_parameter] += 1
        if self.chatter[k, state.load_parameter] > _MOST_CHANGES:
            return Status.CHATTER
        after: State | Status = Status.END_CONTACT
        if margin.kind is not EventKind.END_CONTACT:
            after = self.log.applied(event, state, margin, alone=alone)
        return self.log.note_end(self.model, state, k) if after is Status.END_CONTACT else after

    def _resume(self, event: Point, state: State, *, jump: bool) -> Status:
        """Find equilibrium with the changed contacts and accept it."""
        found = self._jumped(event, state) if jump else self._settled(state)
        if isinstance(found, Status):
            return found
        met = overlapping(self.model, found.state)
        if met is not None:
            return self.log.note_end(self.model, event.state, met)
        gripped = self._gripped(found, event.state)
        if isinstance(gripped, Status):
            return gripped
        held = self.track.index
        self._begin(gripped)
        if self.track.index > held and self.branch != "primary":
            return self._meet_limit_point()
        return Status.CONVERGED

    def _jumped(self, event: Point, state: State) -> Point | Status:
        """Point after a slip-off."""
        found = self._fall().after(event, state)
        if isinstance(found, Status):
            return found
        rest, released = found
        self.log.release(EventKind.SLIP_OFF, released)
        return Status.REST_UNKNOWN if grips(rest.state) else rest

    def _settled(self, state: State) -> Point | Status:
        """Point with changed contacts, without a jump."""
        equilibrium = self.newton.solve(state)
        self.log.iterations += equilibrium.iterations
        self.control.fail(equilibrium.status)
        return Point(self.newton, equilibrium) if equilibrium.converged else self.control.failure
