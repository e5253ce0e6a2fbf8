"""March of many structures: one iteration of Newton's method for all of them at a time, each on its own step.

A structure whose iteration ends accepts its configuration and sets off for its next load parameter while the others still
iterate. Whatever is not plain (a step that does not converge soon, a contact that opens or closes, a change of the
determinant's sign) is left to the `Stepper`: it goes on from the last accepted configurations to the next prescribed load parameter,
and hands the structure back. So there is one stepper, and a batch finds what it finds.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tsm.batch.equations import Equations, System
from tsm.batch.front import (
    Front,
    newest,
    predict,
    remember,
    replace_history,
    states_of,
    undeformed,
)
from tsm.batch.geometry import normal_force, project, slide
from tsm.batch.numbers import collect_numbers, some
from tsm.batch.record import Record, empty
from tsm.contact_set import initial_state
from tsm.elements.properties import Array
from tsm.events import ROUND_OFF, Passage
from tsm.model import Model
from tsm.newton import LONGEST, SHARP
from tsm.settings import Settings
from tsm.status import Status
from tsm.stepping import FAR, Stepper
from tsm.structure import Structure

_SOON = 8
"""Iterations after which a structure is left to the stepper: a path that is followed closely takes three or four."""


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
        self.turning = model.kind == 2
        self.soon = min(_SOON, settings.max_iterations)

    def run(self) -> Record:
        """Solve all structures; never raises for one that stops.

        Raises
        ------
        ValueError
            Naming the structure in which a node starts behind the surface it touches.
        """
        numbers = collect_numbers(self.structures, self.model)
        front = undeformed(self.equations, numbers, len(self.structures))
        with np.errstate(all="ignore"):
            self._close(front)
            self._start(front)
            while True:
                alive = front.target < len(self.targets)
                if not alive.any():
                    return self.record
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
                self._refuse(int(n))
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
        residual = self._norm(front, self.equations.linearise(front.numbers, front.at))
        at_rest = residual <= self.settings.tolerance
        remember(front, everywhere[at_rest])
        for n in everywhere[~at_rest]:
            self._alone(front, int(n))
        self._depart(front, everywhere)

    def _iterate(self, front: Front) -> None:
        """One iteration of all structures; those whose step ends set off on their next."""
        system = self.equations.linearise(front.numbers, front.at)
        residual = self._norm(front, system)
        twice = np.maximum(front.residual, residual)
        converged = (residual <= self.settings.tolerance) | (twice <= front.numbers.noise)
        stuck = ~converged & ~(np.isfinite(residual) & (front.iteration < self.soon))
        found = np.flatnonzero(converged)
        plain = self._plain(front, system, found)
        self._accept(front, found[plain])
        for n in [*found[~plain].tolist(), *np.flatnonzero(stuck).tolist()]:
            self._alone(front, n)
        ended = converged | stuck
        if not ended.all():
            self._move(front, system)
        front.residual[:] = residual
        front.iteration[:] += 1
        self._depart(front, np.flatnonzero(ended & (front.target < len(self.targets))))

    def _norm(self, front: Front, system: System) -> Array:
        """Scaled norms of the residuals, as of `Newton`."""
        force, length = front.numbers.force, front.numbers.length
        forces = np.abs(system.nodal[self.model.free])
        largest = np.maximum(
            forces[~self.turning].max(axis=0, initial=0.0) / force,
            forces[self.turning].max(axis=0, initial=0.0) / (force * length),
        )
        own = np.abs(system.own).reshape(-1, 3, len(force))
        largest = np.maximum(largest, own[:, :2].max(axis=(0, 1)) / (SHARP * length))
        norm: Array = np.maximum(largest, own[:, 2].max(axis=0) / force)
        return norm

    def _move(self, front: Front, system: System) -> None:
        """Newton's steps, each shortened as by `Newton.update`."""
        at, numbers = front.at, front.numbers
        dq, dz, sign = self.equations.solve(system)
        longest = np.maximum(self._largest(dq, numbers.length), np.abs(dz[2::3]).max(axis=0) / (0.3 * numbers.length))
        factor = np.where(longest > LONGEST, LONGEST / longest, 1.0)
        at.q[self.model.free] += factor * dq
        own = (factor * dz).reshape(-1, 3, len(factor))
        everywhere, l0 = np.arange(len(factor)), numbers.properties.l0
        at.force[:] += own[:, :2]
        for k, pair in enumerate(self.model.pairs):
            xi = at.xi[k] + own[k, 2] / l0[at.element[k], everywhere]
            at.element[k], at.xi[k] = slide(l0, pair.target, at.element[k], xi, everywhere)
        front.last[:] = sign
        front.first[:] = np.where(front.iteration == 0, sign, front.first)

    def _largest(self, moved: Array, length: Array) -> Array:
        """Largest changes of the free displacements, in parts of 0.3 L and 0.7 rad."""
        moved = np.abs(moved)
        shift = moved[~self.turning].max(axis=0, initial=0.0) / (0.3 * length)
        largest: Array = np.maximum(shift, moved[self.turning].max(axis=0, initial=0.0) / 0.7)
        return largest

    def _plain(self, front: Front, system: System, which: Array) -> Array:
        """Whether equilibria may be accepted as they are: no event, in balance, near the prediction."""
        begun = np.where(front.orientation == 0, front.first, front.orientation)[which]
        plain = self._balanced(front, system, which) & (begun == front.last[which])
        at, numbers = front.at, front.numbers
        free = self.model.free
        moved = at.q[free[:, None], which] - front.predicted[free[:, None], which]
        plain &= self._largest(moved, numbers.length[which]) <= FAR
        tolerance = np.maximum(self.settings.tolerance, numbers.noise)
        for k in range(len(self.model.pairs)):
            closed = at.closed[k, which]
            part = which[closed]
            e = at.element[k, part]
            arc = numbers.arc[e, part] + at.xi[k, part] * numbers.properties.l0[e, part]
            inside = np.minimum(arc, numbers.span[k, part] - arc) / numbers.length[part]
            force = normal_force(self.equations, numbers, at, k, part) / numbers.force[part]
            force *= np.minimum(1.0, ROUND_OFF / tolerance[part])
            plain[closed] &= (inside >= -ROUND_OFF) & (force >= -ROUND_OFF)
            waiting = ~closed & front.armed[k, which]
            part = which[waiting]
            if len(part):
                seen = project(self.equations, numbers, at, k, part)
                over = seen.overshoot <= ROUND_OFF * numbers.length[part]
                plain[waiting] &= ~(over & (seen.gap < -ROUND_OFF * numbers.length[part]))
        return plain

    def _balanced(self, front: Front, system: System, which: Array) -> Array:
        """Whether support reactions and pin forces add up to nothing, as in `Stepper`."""
        model, at, numbers = self.model, front.at, front.numbers
        total = np.zeros((2, len(which)))
        for c in range(2):
            total[c] = system.nodal[model.fixed[model.fixed % 3 == c]][:, which].sum(axis=0)
        largest = np.zeros(len(which))
        for k, pair in enumerate(model.pairs):
            if pair.pin is not None:
                force = np.where(at.closed[k, which], at.force[k][:, which], 0.0)
                total += force
                largest = np.maximum(largest, np.hypot(*force))
        noise = np.maximum(numbers.noise, self.settings.tolerance) * numbers.force
        bound: Array = 1e-8 * largest + len(model.coordinates) * noise[which]
        balanced: Array = np.abs(total).max(axis=0) <= bound
        return balanced

    def _accept(self, front: Front, which: Array) -> None:
        """Take the iterates of some structures as their configurations."""
        self._note_passes(front, which)
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
        self._enter(front, which[front.goal[which] == self.targets[front.target[which]]])

    def _note_passes(self, front: Front, which: Array) -> None:
        """Note changes of owner since the last configuration."""
        at, history, numbers = front.at, front.history, front.numbers
        for k in range(len(self.model.pairs)):
            before = history.element[newest(history, which), k, which]
            part = which[at.closed[k, which] & (before != at.element[k, which])]
            if not len(part):
                continue
            place = newest(history, part)
            old = at._replace(
                q=at.q.copy(),
                element=at.element.copy(),
                force=at.force.copy(),
            )
            old.q[:, part] = history.q[place, :, part].T
            old.element[k, part] = history.element[place, k, part]
            old.force[k][:, part] = history.force[place, k, :, part].T
            rows = []
            for points, t, xi in (
                (old, history.t[place, part], history.xi[place, k, part]),
                (at, front.goal[part], at.xi[k, part]),
            ):
                e = points.element[k, part]
                arc = numbers.arc[e, part] + xi * numbers.properties.l0[e, part]
                force = normal_force(self.equations, numbers, points, k, part)
                rows.append([value.tolist() for value in (t, e, arc, force)])
            for n, *parts in zip(front.structure[part].tolist(), *(zip(*both, strict=True) for both in zip(*rows, strict=True)), strict=True):
                t, element, arc, force = parts
                self.record.events[n].append(Passage(pair=k, t=t, element=element, arc=arc, force=force))

    def _enter(self, front: Front, which: Array) -> None:
        """Record configurations at prescribed load parameters."""
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
        record.iterations[n, k] = front.spent[which]
        record.reached[n] += 1
        front.spent[which] = 0
        front.target[which] += 1

    def _alone(self, front: Front, n: int) -> None:
        """Leave structure n to the stepper up to its next prescribed load parameter."""
        which, record, structure = np.array([n]), self.record, int(front.structure[n])
        stepper = self.steppers.get(structure)
        if stepper is None:
            stepper = Stepper(Model(self.structures[structure]), self.settings)
            self.steppers[structure] = stepper
        if front.history.count[n]:
            stepper.resume(states_of(front, n), float(front.step[n]), int(front.orientation[n]))
        target = int(front.target[n])
        steps = list(stepper.march(self.targets[target : target + 1]))
        record.cutbacks[structure] += sum(step.cutbacks for step in steps)
        record.events[structure].extend(event for step in steps for event in step.events)
        front.spent[n] += sum(step.iterations for step in steps)
        status = steps[-1].status
        if status is not Status.CONVERGED:
            record.status[structure] = status
            record.stopped[structure] = steps[-1].equilibrium.state.load_parameter
            front.target[n] = len(self.targets)
            return
        replace_history(front, n, stepper.history)
        front.step[n], front.orientation[n] = stepper.step, stepper.orientation
        self._enter(front, which)

    def _depart(self, front: Front, which: Array) -> None:
        """Set off for the next prescribed load parameters, as far as the steps go."""
        if not len(which):
            return
        goal = self.targets[front.target[which]]
        t = front.history.t[newest(front.history, which), which]
        left, step = goal - t, front.step[which]
        front.goal[which] = np.where(left <= step * (1 + 1e-6), goal, t + step)
        predict(self.equations, front, which)
        front.iteration[which] = 0
        front.residual[which] = np.inf
        front.first[which] = front.last[which] = 0.0
