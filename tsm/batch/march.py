"""March of many structures: each Newton iteration runs for all structures, and each structure has a load step of its own.

A structure whose iteration ends accepts its configuration and starts its next load step while the others still iterate. Four cases are
left to the `Stepper`: a step that does not converge soon, a contact that opens or closes, a corner of a pin's path, and a change of the
determinant's sign. The stepper goes on from the last accepted configurations to the next prescribed load parameter and then returns
the structure to the batch. Only the stepper finds events and critical points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tsm.batch.checks import balanced, eventless, follows, norm
from tsm.batch.constants import constants_of, take
from tsm.batch.equations import OWN, BatchLinearisation, Equations
from tsm.batch.geometry import measure, project, slide
from tsm.batch.record import Record, empty
from tsm.batch.state import (
    BatchState,
    newest,
    predict,
    remember,
    replace_history,
    states_of,
    undeformed,
)
from tsm.contact_set import initial_state
from tsm.elements.properties import Array
from tsm.events import ROUND_OFF, Passage
from tsm.model import Model
from tsm.newton import LONGEST
from tsm.projection import AT_NODE
from tsm.scaling import largest
from tsm.settings import Settings
from tsm.status import Status
from tsm.stepping import Stepper
from tsm.structure import Structure

_ENTRIES = 20_000
"""Elements in one pass: enough to outweigh the cost of the calls, and few enough for the arrays to stay in the cache."""
_SOON = 12
"""Iterations after which a structure is left to the stepper; a step that follows its path closely takes three or four."""


class March:
    """March of the structures of one topology over the same load parameters.

    Parameters
    ----------
    structures : sequence of Structure
        All numbered alike.
    model : Model
        Numbering, taken from the first structure.
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
            batches = [self._at_rest(part) for part in parts]
            for batch in batches:
                self._march(batch)
        return self.record

    def _at_rest(self, part: Array) -> BatchState:
        """Some structures, undeformed."""
        constants = constants_of([self.structures[n] for n in part], self.model)
        batch = undeformed(self.equations, constants, part)
        self._close(batch)
        return batch

    def _march(self, batch: BatchState) -> None:
        self._start(batch)
        while (alive := batch.target < len(self.targets)).any():
            if not alive.all():
                batch = take(batch, alive)
            self._iterate(batch)

    def _close(self, batch: BatchState) -> None:
        """Close pairs whose node lies on the surface, without force."""
        iterate, constants, everywhere = batch.iterate, batch.constants, np.arange(len(batch.structure))
        small = ROUND_OFF * constants.sizes.length
        closest = [
            project(self.equations, constants, iterate, k, everywhere) for k in range(len(self.model.pairs))
        ]
        for k, seen in enumerate(closest):
            over = seen.overshoot <= small
            for n in np.flatnonzero(over & (seen.gap < -small)):
                self._refuse(int(batch.structure[n]))
            iterate.closed[k] = over & (seen.gap <= small)
            iterate.element[k] = np.where(iterate.closed[k], seen.element, iterate.element[k])
            iterate.xi[k] = np.where(iterate.closed[k], np.clip(seen.xi, 0.0, 1.0), 0.0)

    def _refuse(self, n: int) -> None:
        """Say in the stepper's words that a node starts behind its surface."""
        try:
            initial_state(Model(self.structures[n]))
        except ValueError as error:
            raise ValueError(f"structures[{n}]: {error}") from error

    def _start(self, batch: BatchState) -> None:
        """Accept the undeformed configurations and set off."""
        everywhere = np.arange(len(batch.structure))
        residual = norm(self.equations, batch, self.equations.linearise(batch.constants, batch.iterate))
        at_rest = residual <= self.settings.tolerance
        started = everywhere[at_rest]
        remember(batch, started)
        batch.normal[:, started], batch.arc[:, started] = measure(
            self.equations, batch.constants, batch.iterate, started
        )
        for n in everywhere[~at_rest]:
            self._alone(batch, int(n))
        self._depart(batch, everywhere)

    def _iterate(self, batch: BatchState) -> None:
        """One iteration of all structures; those whose step ends set off on their next."""
        system = self.equations.linearise(batch.constants, batch.iterate)
        residual = norm(self.equations, batch, system)
        twice = np.maximum(batch.residual, residual)
        converged = (residual <= self.settings.tolerance) | (twice <= batch.constants.scales.noise)
        stuck = ~converged & ~(np.isfinite(residual) & (batch.iteration < self.soon))
        arrived = np.flatnonzero(converged)
        normal, arc = measure(self.equations, batch.constants, batch.iterate, arrived)
        tolerance = self.settings.tolerance
        plain = eventless(self.equations, batch, arrived, normal, arc, tolerance)
        plain &= follows(self.equations, batch, arrived) & balanced(
            self.equations, batch, system, arrived, tolerance
        )
        self._accept(batch, arrived[plain], system, normal[:, plain], arc[:, plain])
        for n in [*arrived[~plain].tolist(), *np.flatnonzero(stuck).tolist()]:
            self._alone(batch, n)
        ended = converged | stuck
        if not ended.all():
            self._move(batch, system)
        batch.residual[:] = residual
        batch.iteration[:] += 1
        self._depart(batch, np.flatnonzero(ended))

    def _move(self, batch: BatchState, system: BatchLinearisation) -> None:
        """Newton's steps, each shortened as by `Newton.update`."""
        iterate, constants = batch.iterate, batch.constants
        dq, dz, sign = self.equations.solve(system)
        size = largest(np.concatenate([dq, dz]), constants.scales.step)
        factor = np.where(size > LONGEST, LONGEST / size, 1.0)
        iterate.q[self.model.free] += factor * dq
        change = (factor * dz).reshape(-1, OWN, len(factor))
        everywhere, l0 = np.arange(len(factor)), constants.properties.l0
        iterate.force[:] += change[:, :2]
        for k, pair in enumerate(self.model.pairs):
            xi = iterate.xi[k] + change[k, 2] / l0[iterate.element[k], everywhere]
            iterate.element[k], iterate.xi[k] = slide(
                l0, pair.target, iterate.element[k], xi, everywhere, AT_NODE
            )
        batch.last[:] = sign
        batch.first[:] = np.where(batch.iteration == 0, sign, batch.first)

    def _accept(
        self, batch: BatchState, which: Array, system: BatchLinearisation, normal: Array, arc: Array
    ) -> None:
        """Take the iterates of some structures as their configurations."""
        self._note_passes(batch, which, normal, arc)
        batch.normal[:, which], batch.arc[:, which] = normal, arc
        iterate, constants = batch.iterate, batch.constants
        for k in range(len(self.model.pairs)):
            part = which[~(batch.armed[k, which] | iterate.closed[k, which])]
            if len(part):
                seen = project(self.equations, constants, iterate, k, part)
                small = ROUND_OFF * constants.sizes.length[part]
                batch.armed[k, part] = (seen.overshoot > small) | (seen.gap > small)
        remember(batch, which)
        last = batch.last[which]
        batch.orientation[which] = np.where(last != 0, last, batch.orientation[which])
        batch.step[which] = np.minimum(2 * batch.step[which], 1.0)
        batch.spent[which] += batch.iteration[which]
        asked = batch.goal[which] == self.targets[batch.target[which]]
        self._enter(batch, which[asked], system.nodal[self.model.fixed[:, None], which[asked]])

    def _note_passes(self, batch: BatchState, which: Array, normal: Array, arc: Array) -> None:
        """Note changes of owner since the last configurations."""
        iterate, history = batch.iterate, batch.history
        place = newest(history, which)
        before = history.element[place, :, which].T
        for k, m in np.argwhere(iterate.closed[:, which] & (before != iterate.element[:, which])):
            n = which[m]
            passage = Passage(
                pair=int(k),
                t=(float(history.t[place[m], n]), float(batch.goal[n])),
                element=(int(before[k, m]), int(iterate.element[k, n])),
                arc=(float(batch.arc[k, n]), float(arc[k, m])),
                force=(float(batch.normal[k, n]), float(normal[k, m])),
            )
            self.record.events[batch.structure[n]].append(passage)

    def _enter(self, batch: BatchState, which: Array, reaction: Array) -> None:
        """Record configurations at prescribed load parameters, and what the supports exert in them."""
        record, iterate = self.record, batch.iterate
        n, k = batch.structure[which], batch.target[which]
        record.q[n, k] = iterate.q[:, which].T
        for row, now in (
            (record.closed, iterate.closed),
            (record.armed, batch.armed),
            (record.element, iterate.element),
            (record.xi, iterate.xi),
        ):
            row[n, k] = now[:, which].T
        record.force[n, k] = iterate.force[..., which].transpose(2, 0, 1)
        record.normal[n, k], record.arc[n, k] = batch.normal[:, which].T, batch.arc[:, which].T
        record.reaction[n, k] = reaction.T
        record.iterations[n, k] = batch.spent[which]
        record.reached[n] += 1
        batch.spent[which] = 0
        batch.target[which] += 1

    def _alone(self, batch: BatchState, n: int) -> None:
        """Leave structure n to the stepper up to its next prescribed load parameter."""
        record, structure = self.record, int(batch.structure[n])
        stepper = self.steppers.get(structure)
        if stepper is None:
            stepper = Stepper(Model(self.structures[structure]), self.settings)
            self.steppers[structure] = stepper
        if batch.history.entered[n]:
            stepper.resume(states_of(batch, n), float(batch.step[n]))
        target = int(batch.target[n])
        steps = list(stepper.march(self.targets[target : target + 1]))
        record.cutbacks[structure] += sum(step.cutbacks for step in steps)
        record.events[structure].extend(event for step in steps for event in step.events)
        batch.spent[n] += sum(step.iterations for step in steps)
        status = steps[-1].status
        if status is not Status.CONVERGED:
            record.status[structure] = status
            record.end[structure] = steps[-1]
            batch.target[n] = len(self.targets)
            return
        replace_history(batch, n, stepper.track.history)
        which = np.array([n])
        batch.normal[:, which], batch.arc[:, which] = measure(
            self.equations, batch.constants, batch.iterate, which
        )
        batch.step[n], batch.orientation[n] = stepper.control.step, 0
        reaction = steps[-1].equilibrium.system.nodal[self.model.fixed]
        self._enter(batch, which, reaction[:, None])

    def _turning(self, batch: BatchState, which: Array, t: Array) -> Array:
        """Whether a pin turns on the way from the load parameters t to the goals, shape (m,)."""
        places, goals = batch.structure[which].tolist(), batch.goal[which].tolist()
        return np.array(
            [
                any(now < turn < goal for turn in self.turns.get(n, ()))
                for n, now, goal in zip(places, t.tolist(), goals, strict=True)
            ],
            dtype=bool,
        )

    def _depart(self, batch: BatchState, which: Array) -> None:
        """Set off for the next prescribed load parameters, as far as the steps go, where there is one."""
        which = which[batch.target[which] < len(self.targets)]
        if not len(which):
            return
        goal = self.targets[batch.target[which]]
        t = batch.history.t[newest(batch.history, which), which]
        left, step = goal - t, batch.step[which]
        batch.goal[which] = np.where(left <= step * (1 + 1e-6), goal, t + step)
        turning = self._turning(batch, which, t)
        for n in which[turning].tolist():
            self._alone(batch, n)
        self._depart(batch, which[turning])
        which = which[~turning]
        predict(self.equations, batch, which)
        batch.iteration[which] = 0
        batch.residual[which] = np.inf
        batch.first[which] = batch.last[which] = 0.0
