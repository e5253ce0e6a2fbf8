"""March of many structures: one iteration of Newton's method for all of them at a time, each on its own step.

A structure whose iteration ends accepts its configuration and sets off for its next load parameter while the others still
iterate. Whatever is not plain (a step that does not converge soon, a contact that opens or closes, a pin that turns, a change of the
determinant's sign) is left to the `Stepper`: it goes on from the last accepted configurations to the next prescribed load parameter,
and hands the structure back. So there is one stepper, and a batch finds what it finds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tsm.batch.checks import balanced, eventless, follows, largest_step, norm
from tsm.batch.equations import OWN, Equations, System
from tsm.batch.front import (
    Front,
    newest,
    predict,
    remember,
    replace_history,
    states_of,
    undeformed,
)
from tsm.batch.geometry import measure, project, slide
from tsm.batch.numbers import collect_numbers, some
from tsm.batch.record import Record, empty
from tsm.contact_set import initial_state
from tsm.elements.properties import Array
from tsm.events import ROUND_OFF, Passage
from tsm.model import Model
from tsm.newton import LONGEST
from tsm.settings import Settings
from tsm.status import Status
from tsm.stepping import Stepper
from tsm.structure import Structure

_ENTRIES = 20_000
"""Elements that are iterated at once: so many that a pass is not all calls, so few that its arrays stay near."""
_SOON = 12
"""Iterations after which a structure is left to the stepper: a path that is followed closely takes three or four of them."""


class March:
    """March of the structures of one topology over the same load parameters.

    Parameters
    ----------
    structures : sequence of Structure
        All numbered alike.
    model : Model
        Of the first.
    targets : ndarray, shape (s,)
        Prescribed load parameters.
    settings : Settings
        Numerical settings.

    Attributes
    ----------
    record : Record
        What was reached.
    """

    def __init__(
        self, structures: Sequence[Structure], model: Model, targets: Array, settings: Settings
    ) -> None:
        self.structures, self.model, self.targets, self.settings = structures, model, targets, settings
        self.equations = Equations(model)
        self.record = empty(model, len(structures), len(targets))
        self.steppers: dict[int, Stepper] = {}
        self.turns = {
            n: turns
            for n, one in enumerate(structures)
            if (turns := [t for pin in one.pins for t in pin.turns])
        }
        self.soon = min(_SOON, settings.max_iterations)

    def run(self) -> Record:
        """Solve all structures; never raises for one that stops.

        Raises
        ------
        ValueError
            Naming the structure in which a node starts behind the surface it touches.
        """
        places = np.arange(len(self.structures))
        parts = np.array_split(places, math.ceil(len(places) * len(self.model.element_nodes) / _ENTRIES))
        with np.errstate(all="ignore"):
            fronts = [self._at_rest(part) for part in parts]
            for front in fronts:
                self._march(front)
        return self.record

    def _at_rest(self, part: Array) -> Front:
        """Some structures, undeformed."""
        numbers = collect_numbers([self.structures[n] for n in part], self.model)
        front = undeformed(self.equations, numbers, part)
        self._close(front)
        return front

    def _march(self, front: Front) -> None:
        self._start(front)
        while (alive := front.target < len(self.targets)).any():
            if not alive.all():
                front = some(front, alive)
            self._iterate(front)

    def _close(self, front: Front) -> None:
        """Close pairs whose node lies on the surface, without force."""
        at, numbers, everywhere = front.at, front.numbers, np.arange(len(front.structure))
        small = ROUND_OFF * numbers.length
        found = [project(self.equations, numbers, at, k, everywhere) for k in range(len(self.model.pairs))]
        for k, seen in enumerate(found):
            over = seen.overshoot <= small
            for n in np.flatnonzero(over & (seen.gap < -small)):
                self._refuse(int(front.structure[n]))
            at.closed[k] = over & (seen.gap <= small)
            at.element[k] = np.where(at.closed[k], seen.element, at.element[k])
            at.xi[k] = np.where(at.closed[k], np.clip(seen.xi, 0.0, 1.0), 0.0)

    def _refuse(self, n: int) -> None:
        """Say in the stepper's words that a node starts behind its surface."""
        try:
            initial_state(Model(self.structures[n]))
        except ValueError as error:
            raise ValueError(f"structures[{n}]: {error}") from error

    def _start(self, front: Front) -> None:
        """Accept the undeformed configurations and set off."""
        everywhere = np.arange(len(front.structure))
        residual = norm(self.equations, front, self.equations.linearise(front.numbers, front.at))
        at_rest = residual <= self.settings.tolerance
        started = everywhere[at_rest]
        remember(front, started)
        front.normal[:, started], front.arc[:, started] = measure(
            self.equations, front.numbers, front.at, started
        )
        for n in everywhere[~at_rest]:
            self._alone(front, int(n))
        self._depart(front, everywhere)

    def _iterate(self, front: Front) -> None:
        """One iteration of all structures; those whose step ends set off on their next."""
        system = self.equations.linearise(front.numbers, front.at)
        residual = norm(self.equations, front, system)
        twice = np.maximum(front.residual, residual)
        converged = (residual <= self.settings.tolerance) | (twice <= front.numbers.noise)
        stuck = ~converged & ~(np.isfinite(residual) & (front.iteration < self.soon))
        found = np.flatnonzero(converged)
        normal, arc = measure(self.equations, front.numbers, front.at, found)
        tolerance = self.settings.tolerance
        plain = eventless(self.equations, front, found, normal, arc, tolerance)
        plain &= follows(self.equations, front, found) & balanced(
            self.equations, front, system, found, tolerance
        )
        self._accept(front, found[plain], system, normal[:, plain], arc[:, plain])
        for n in [*found[~plain].tolist(), *np.flatnonzero(stuck).tolist()]:
            self._alone(front, n)
        ended = converged | stuck
        if not ended.all():
            self._move(front, system)
        front.residual[:] = residual
        front.iteration[:] += 1
        self._depart(front, np.flatnonzero(ended))

    def _move(self, front: Front, system: System) -> None:
        """Newton's steps, each shortened as by `Newton.update`."""
        at, numbers = front.at, front.numbers
        dq, dz, sign = self.equations.solve(system)
        longest = np.maximum(
            largest_step(self.equations, dq, numbers.length),
            np.abs(dz[2::OWN]).max(axis=0) / (0.3 * numbers.length),
        )
        factor = np.where(longest > LONGEST, LONGEST / longest, 1.0)
        at.q[self.model.free] += factor * dq
        own = (factor * dz).reshape(-1, OWN, len(factor))
        everywhere, l0 = np.arange(len(factor)), numbers.properties.l0
        at.force[:] += own[:, :2]
        for k, pair in enumerate(self.model.pairs):
            xi = at.xi[k] + own[k, 2] / l0[at.element[k], everywhere]
            at.element[k], at.xi[k] = slide(l0, pair.target, at.element[k], xi, everywhere)
        front.last[:] = sign
        front.first[:] = np.where(front.iteration == 0, sign, front.first)

    def _accept(self, front: Front, which: Array, system: System, normal: Array, arc: Array) -> None:
        """Take the iterates of some structures as their configurations."""
        self._note_passes(front, which, normal, arc)
        front.normal[:, which], front.arc[:, which] = normal, arc
        at, numbers = front.at, front.numbers
        for k in range(len(self.model.pairs)):
            part = which[~(front.armed[k, which] | at.closed[k, which])]
            if len(part):
                seen = project(self.equations, numbers, at, k, part)
                small = ROUND_OFF * numbers.length[part]
                front.armed[k, part] = (seen.overshoot > small) | (seen.gap > small)
        remember(front, which)
        last = front.last[which]
        front.orientation[which] = np.where(last != 0, last, front.orientation[which])
        front.step[which] = np.minimum(2 * front.step[which], 1.0)
        front.spent[which] += front.iteration[which]
        asked = front.goal[which] == self.targets[front.target[which]]
        self._enter(front, which[asked], system.nodal[self.model.fixed[:, None], which[asked]])

    def _note_passes(self, front: Front, which: Array, normal: Array, arc: Array) -> None:
        """Note changes of owner since the last configurations."""
        at, history = front.at, front.history
        place = newest(history, which)
        before = history.element[place, :, which].T
        for k, m in np.argwhere(at.closed[:, which] & (before != at.element[:, which])):
            n = which[m]
            passage = Passage(
                pair=int(k),
                t=(float(history.t[place[m], n]), float(front.goal[n])),
                element=(int(before[k, m]), int(at.element[k, n])),
                arc=(float(front.arc[k, n]), float(arc[k, m])),
                force=(float(front.normal[k, n]), float(normal[k, m])),
            )
            self.record.events[front.structure[n]].append(passage)

    def _enter(self, front: Front, which: Array, reaction: Array) -> None:
        """Record configurations at prescribed load parameters, and what the supports exert in them."""
        record, at = self.record, front.at
        n, k = front.structure[which], front.target[which]
        record.q[n, k] = at.q[:, which].T
        for row, now in (
            (record.closed, at.closed),
            (record.armed, front.armed),
            (record.element, at.element),
            (record.xi, at.xi),
        ):
            row[n, k] = now[:, which].T
        record.force[n, k] = at.force[..., which].transpose(2, 0, 1)
        record.normal[n, k], record.arc[n, k] = front.normal[:, which].T, front.arc[:, which].T
        record.reaction[n, k] = reaction.T
        record.iterations[n, k] = front.spent[which]
        record.reached[n] += 1
        front.spent[which] = 0
        front.target[which] += 1

    def _alone(self, front: Front, n: int) -> None:
        """Leave structure n to the stepper up to its next prescribed load parameter."""
        record, structure = self.record, int(front.structure[n])
        stepper = self.steppers.get(structure)
        if stepper is None:
            stepper = Stepper(Model(self.structures[structure]), self.settings)
            self.steppers[structure] = stepper
        if front.history.entered[n]:
            stepper.resume(states_of(front, n), float(front.step[n]))
        target = int(front.target[n])
        steps = list(stepper.march(self.targets[target : target + 1]))
        record.cutbacks[structure] += sum(step.cutbacks for step in steps)
        record.events[structure].extend(event for step in steps for event in step.events)
        front.spent[n] += sum(step.iterations for step in steps)
        status = steps[-1].status
        if status is not Status.CONVERGED:
            record.status[structure] = status
            record.end[structure] = steps[-1]
            front.target[n] = len(self.targets)
            return
        replace_history(front, n, stepper.track.history)
        which = np.array([n])
        front.normal[:, which], front.arc[:, which] = measure(self.equations, front.numbers, front.at, which)
        front.step[n], front.orientation[n] = stepper.control.step, 0
        reaction = steps[-1].equilibrium.system.nodal[self.model.fixed]
        self._enter(front, which, reaction[:, None])

    def _turning(self, front: Front, which: Array, t: Array) -> Array:
        """Whether a pin turns on the way from the load parameters t to the goals, shape (m,)."""
        places, goals = front.structure[which].tolist(), front.goal[which].tolist()
        return np.array(
            [
                any(now < turn < goal for turn in self.turns.get(n, ()))
                for n, now, goal in zip(places, t.tolist(), goals, strict=True)
            ],
            dtype=bool,
        )

    def _depart(self, front: Front, which: Array) -> None:
        """Set off for the next prescribed load parameters, as far as the steps go, where there is one."""
        which = which[front.target[which] < len(self.targets)]
        if not len(which):
            return
        goal = self.targets[front.target[which]]
        t = front.history.t[newest(front.history, which), which]
        left, step = goal - t, front.step[which]
        front.goal[which] = np.where(left <= step * (1 + 1e-6), goal, t + step)
        turning = self._turning(front, which, t)
        for n in which[turning].tolist():
            self._alone(front, n)
        self._depart(front, which[turning])
        which = which[~turning]
        predict(self.equations, front, which)
        front.iteration[which] = 0
        front.residual[which] = np.inf
        front.first[which] = front.last[which] = 0.0
