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

from tsm.contact.contact_set import initial_state, rearm
from tsm.contact.events import Event, EventKind, passes
from tsm.elements.properties import Array
from tsm.model.contact import crowded, on_rigid_nodes
from tsm.model.model import Model
from tsm.model.state import UNDECIDED, State
from tsm.path.critical import CriticalKind, critical_point, locate_bifurcation, mechanism
from tsm.path.crossing import check_ends, crossing, on_held_end, through_end
from tsm.path.energy import rolled, spent
from tsm.path.fall import Fall
from tsm.path.friction import grips, regripped
from tsm.path.margins import Margin, Search, broken, margins
from tsm.path.path import FOLD, LONGEST, SMALLEST, Track, allowed
from tsm.path.step import NEAR, Step, ends
from tsm.statement.settings import Settings
from tsm.statement.stages import stage_of
from tsm.statement.status import RefusedError, Status, StopError
from tsm.system.equilibrium import Equilibrium
from tsm.system.newton import Newton
from tsm.system.system import Drive

_STRAIGHT = 0.02
"""A step across which the index changes holds a bifurcation if at most this part of it is unexplained; else it may have left the path."""
_AHEAD = 1e-4
"""Load parameter beyond a critical point at which a fall starts."""
_MOST_ATTEMPTS = 1000
"""Largest number of load steps, with refused ones, between two prescribed load parameters."""
_MOST_CHANGES = 6
"""Largest number of contact events at one load parameter, for each contact pair."""
_NAMED = {
    Status.NOT_FINITE,
    Status.SINGULAR_TANGENT,
    Status.INACCURATE,
    Status.TWO_CONTACTS,
    Status.PING_PONG,
    Status.JAMMED,
}
"""Failures that end the path under their own name; others end it as `CUTBACK_FLOOR`."""


class Follower:
    """One march."""

    def __init__(self, model: Model, settings: Settings) -> None:
        self.model, self.branch = model, settings.branch
        self.newton = Newton(model, settings)
        self.step = 1.0  # length of the next load step
        self.target = 0.0  # load parameter to reach next
        self.turned = -1.0  # load parameter of the last corner; -1 before any
        start = self.newton.solve(initial_state(model))
        self.track = Track(start)
        self.log = Step(equilibrium=start)  # since the last yielded step
        if model.rubbed:
            self.log.spent = np.zeros(1 + len(model.pairs))
        self.chatter: Counter[tuple[int, float]] = Counter()  # number of changes by pair and load parameter
        # margins of the events that the contacts of the last point may have next
        self.margins = self._measure(start) if start.converged else []

    def _measure(self, point: Equilibrium) -> list[Margin]:
        return margins(point, self._drive(point.t))

    def _drive(self, t: float) -> Drive:
        """Drive from the last point to t; from t to the target where t is not beyond the last point."""
        begin = self.track.last.t
        return self.newton.assembler.drive(*((begin, t) if t > begin else (t, max(t, self.target))))

    def march(self, load_parameters: Array) -> Iterator[Step]:
        """Yield accepted steps up to the last load parameter or the first failure."""
        times = load_parameters.tolist()
        asked = frozenset(times)
        try:
            self._check_start()
            for target in ends(times, self.model.turns, self.track.last.t):
                self.target = target
                for attempt in count():
                    if self.track.last.t >= target:
                        break
                    if self._try_step(attempt):
                        yield self._record(requested=self.track.last.t == target and target in asked)
            self.track.last.release()
        except StopError as stop:
            if stop.met is not None:
                self.log.note_end(self.model, *stop.met)
            yield self._record(stop.status)

    def _check_start(self) -> None:
        start = self.track.last
        if mechanism(start, self._drive(0.0)):
            raise StopError(Status.MECHANISM)
        if not start.converged:
            raise StopError(start.status)
        check_ends(self.model, start.state, start.state)

    def _try_step(self, attempt: int) -> bool:
        """Take a step or fall from a limit point; False if refused."""
        if attempt == _MOST_ATTEMPTS:
            raise StopError(Status.STEP_LIMIT)
        step = self.track.room(min(self.step, self.target - self.track.last.t))
        try:
            self._take(step)
        except RefusedError as refused:
            self.log.cutbacks += 1
            self.step = step * refused.part
            if self.step >= SMALLEST:
                return False
            if on_held_end(self.model, self.track.last.state):
                raise StopError(Status.FOLDED) from refused
            if refused.status in _NAMED:
                raise StopError(refused.status) from refused
            last = self.track.last
            if not last.speed > FOLD or on_rigid_nodes(self.model, last.state):
                raise StopError(Status.CUTBACK_FLOOR) from refused
            self._meet_limit_point()
        return True

    def _take(self, step: float) -> None:
        """Advance the load parameter by a step, or to the target if no more is left."""
        if step < SMALLEST:
            raise RefusedError
        self._turn_corner()
        last = self.track.last.t
        self._reach(self.target if self.target - last <= step * (1 + 1e-6) else last + step)

    def _turn_corner(self) -> None:
        """Restart the path at a corner: at the start, at a corner of a pin's path, or where a stage begins.

        Only with friction or stages. Contacts may then slip or stick anew. A stage begins just after
        the load parameter at which the last one ends, so that all rates are its own. States before the corner
        do not enter predictions.
        """
        here, t = self.track.last, self.track.last.t
        if t == self.turned or not (self.model.rubbed or self.model.stages > 1):
            return
        if t > 0 and all(abs(t - turn) > NEAR for turn in self.model.turns):
            return
        if 0 < t < self.model.stages and t == round(t):
            here = here.with_state(self.newton.prescribed(here.state, math.nextafter(t, math.inf)))
            if mechanism(here, self._drive(here.t)):
                raise StopError(Status.MECHANISM)
        self.turned = here.t
        self._begin(self._gripped(here, here.state))

    def _gripped(self, point: Equilibrium, last: State) -> Equilibrium:
        """Equilibrium with slip or stick chosen anew where there is friction; `last`: state before. Logs the changes."""
        if not self.model.rubbed:
            return point
        before, gripped = grips(point.state), regripped(point, self._drive(point.t), last)
        for k, grip in grips(gripped.state).items():
            if before[k] != UNDECIDED and before[k].slip != grip.slip:
                self.log.note(EventKind.SLIP if grip.slip else EventKind.STICK, gripped, gripped.state, k)
        return gripped

    def _record(self, status: Status = Status.CONVERGED, *, requested: bool = False) -> Step:
        """The step that ends here; the log starts anew."""
        log, last, stage = self.log, self.track.last, 1 + stage_of(self.target, self.model.stages)
        log.equilibrium, log.index, log.status, log.requested = last, last.index, status, requested
        if stage > 1:
            log.events = [replace(event, stage=stage) for event in log.events]
        self.log = Step(equilibrium=last, spent=log.spent)
        return log

    def _reach(self, goal: float) -> None:
        """Go to a load parameter or to the first event before it."""
        last, reached = self.track.last, self._solve(goal)
        passed = crossing(self.model, last.state, reached.state) or through_end(
            self.model, last.state, reached.state
        )
        if passed is not None:
            t, k = passed
            if t > last.t:
                return self._reach(t)
            # the node crosses as soon as it leaves the last point: it touches there
            return self._switch(last, [m for m in self.margins if (m.kind, m.pair) == (EventKind.TOUCH, k)])
        after = self._measure(reached)
        numbers, search = broken(self.margins, after), self._search(goal)
        if numbers:
            return self._switch(*search.first(after, numbers))
        search.check_pulls()
        return self._advance(reached)

    def _search(self, goal: float) -> Search:
        return Search(self.track.last, self.margins, goal, self._solve, self._measure)

    def _solve(self, t: float) -> Equilibrium:
        """Equilibrium at t from the prediction; refused if it is off the path."""
        last, start = self.track.last, self.track.predicted(t)
        reached = self._converged(start, last.state)
        reached.behind = self.track.unexplained(last, reached)
        if self.newton.apart(start if last.on_chords else last.state, reached.state) > LONGEST:
            raise RefusedError
        return reached

    def _converged(self, start: State, before: State | None = None) -> Equilibrium:
        """Converged point near `start`; contacts in stick have no slip since `before`."""
        point = self.newton.solve(start)
        if before is not None and self.model.rubbed:
            point = rolled(before, point)
        self.log.iterations += point.iterations
        if not point.converged:
            raise RefusedError(point.status)
        return point

    def _advance(self, reached: Equilibrium) -> None:
        """Accept a point, or meet the bifurcation before it; refuse a step that may have left the path."""
        last, track = self.track.last, self.track
        if reached.index != track.index:
            reached = reached.sharpened()
        unexplained = max(reached.behind, track.unexplained(reached, reached))
        if 0 <= reached.index != track.index and (reached.index > track.index or last.index == track.index):
            if unexplained > _STRAIGHT:
                raise RefusedError
            self._meet_bifurcation(reached)
            return
        if self.model.rubbed:
            more, between = spent(track, reached, self._drive(reached.t))
            self._search(reached.t).check_dips([*between, reached])
            self.log.spent = self.log.spent + more
        self.log.events += passes(last, reached)
        self._accept(reached)
        # the next step, after one that could have been `fitting` times as long
        fitting, taken = allowed(unexplained), reached.t - last.t
        self.step = min(max(min(2.0, fitting) * taken, self.step if fitting >= 1 else 0.0), 1.0)

    def _accept(self, point: Equilibrium) -> None:
        """Make a point the last of the path."""
        state = rearm(self.model, point.state)
        if state is not point.state:
            point = replace(point, state=state)
        self.track.accept(point)
        self.margins = self._measure(point)

    def _begin(self, point: Equilibrium) -> None:
        """Make a point the last of the path, and the first one with its contacts."""
        self.track.history = []
        self._accept(point.sharpened())

    def _meet_bifurcation(self, reached: Equilibrium) -> None:
        """At a bifurcation within a step, end the path, turn to the stable branch, or accept the point beyond."""
        singular = locate_bifurcation(self.track.last, reached, self._solve)
        self._note_critical(CriticalKind.BIFURCATION, singular, singular.t)
        ahead = reached if self.branch == "primary" else singular
        self.log.events += passes(self.track.last, ahead)
        self._accept(ahead)
        if self.branch != "primary":
            self._end_or_fall(singular, Status.BIFURCATION)

    def _meet_limit_point(self) -> None:
        """End the path beside a limit point, or let the structure fall to the stable branch."""
        self._note_critical(CriticalKind.LIMIT_POINT, self.track.last, self.track.limit())
        self._end_or_fall(self.track.last, Status.LIMIT_POINT)

    def _note_critical(self, kind: CriticalKind, point: Equilibrium, load_parameter: float) -> None:
        self.log.critical.append(critical_point(kind, point, load_parameter))
        self.log.events.append(Event(kind=EventKind[kind.name], load_parameter=load_parameter))

    def _end_or_fall(self, critical: Equilibrium, status: Status) -> None:
        """End the path, or let the structure fall from a critical point, pushed along its mode in both directions."""
        if self.branch != "stable":
            raise StopError(status)
        ahead = critical.t + min(_AHEAD, (self.target - critical.t) / 2)
        rest, released = self._fall().beside(critical, ahead)
        check_ends(self.model, rest.state, critical.state)
        self.log.release(EventKind[status.name], released)
        self._begin(rest)
        self.step = 1.0

    def _fall(self) -> Fall:
        return Fall(newton=self.newton, measure=self._measure, log=self.log)

    def _switch(self, event: Equilibrium, changes: list[Margin]) -> None:
        """Accept the configuration of the events, then open and close its contacts."""
        if event is not self.track.last:
            self._advance(event)
            if self.track.last.system is not event.system:
                return
        state, noted = event.state, len(self.log.events)
        kinds = {margin.kind for margin in changes}
        for margin in changes:
            self.chatter[margin.pair, state.load_parameter] += 1
            if self.chatter[margin.pair, state.load_parameter] > _MOST_CHANGES:
                raise StopError(Status.CHATTER)
            state = self.log.applied(event, state, margin, alone=len(kinds) == 1)
        if crowded(self.model, state):
            raise StopError(Status.TWO_CONTACTS)
        try:
            self._resume(event, state, jump=EventKind.SLIP_OFF in kinds)
        except RefusedError:
            del self.log.events[noted:]
            raise

    def _resume(self, event: Equilibrium, state: State, *, jump: bool) -> None:
        """Accept the new contacts; a higher index is a limit point."""
        if jump:
            found, released = self._fall().after(event, state)
            self.log.release(EventKind.SLIP_OFF, released)
            if grips(found.state):
                raise StopError(Status.REST_UNKNOWN)
        else:
            found = self._converged(state)
        check_ends(self.model, found.state, event.state)
        gripped, before = self._gripped(found, event.state), self.track.index
        self._begin(gripped)
        if self.track.index > before and self.branch != "primary":
            self._meet_limit_point()
