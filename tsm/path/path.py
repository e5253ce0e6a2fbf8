"""Points of the equilibrium path, with their tangents; the prediction of the next one; whether a step kept to the path.

Newton's method finds some equilibrium; after a long step it may belong to another branch. A step from A to B
has followed the path if the tangents at both its ends explain it: with the displacements and rotations q, at
nodes and inside exact elements (`Newton.motion`), their rates q' and the step h of the load parameter::

    |q_B - q_A - h q'_A| <= c |q_B - q_A|,    |q_B - q_A - h q'_B| <= c |q_B - q_A|

The tangent at A does not lead to an equilibrium of another branch, nor does the tangent there lead back to A.
The decision therefore depends on the path, and not on the prescribed load parameters.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.model.contact import closed, owned
from tsm.model.model import Model
from tsm.model.pairs import PairModel
from tsm.model.state import State, Touch
from tsm.statement.status import RefusedError
from tsm.system.equilibrium import RESOLVED, Equilibrium
from tsm.system.newton import Newton

_FOLLOWED = 0.35
"""The bound c. A limit point is approached by a factor of (1 + 2 c)^2 = 2.9 a step."""
SMALLEST = 1e-12
"""Floor of the load step, as a part of the whole load."""
_SAFE = 0.8
"""Safety factor: next step over the step that the tangents would still allow."""
LONGEST = 1.0
"""Longest step whatever its tangents are, in largest Newton steps (0.3 L, 0.7 rad); the farthest equilibrium
from its prediction where no tangent is usable. With 2 instead of 1, one random pin in a hundred ends on another branch."""
_PROMISED, _FIRST, _SHORT = 0.8, 0.4, 0.3
"""Longest step at the last speed, in the same measure, and part of both bounds that its prediction may reach; longest from
a state before which none is known; longest that is tried without a look at its prediction. Most longer ones would be refused."""
_LEAST, _MOST, _NEAR, _VALUES = 6, 9, 2, 5
"""Data of the prediction, a polynomial through values of the last states, and slopes by their own tangents: at least
and at most so many, two more after every prediction from which no more than two iterations led to equilibrium. The last
number is that of the values where no tangent is usable."""
SHORTEST = 1e-6
"""Step of the load parameter below which the tangent alone predicts: the others would be round-off."""
FOLD = 100.0
"""Speed of the path, in largest Newton steps per whole load, above which a limit point is near, where it is infinite."""
_GROWING, _ROOM = 1.4, 0.6
"""Growth of the speed that shows a limit point ahead, and the next step over the distance to it."""


class Track:
    """The path up to its last point."""

    def __init__(self, point: Equilibrium) -> None:
        self.newton: Newton = point.newton
        self.last, self.before = point, point
        # of the last point that has one
        self.index = max(point.index, 0) if point.converged else 0
        self.history = [_Known(point.state, _values(point.model, point.state))]
        self.memory = _LEAST

    def accept(self, point: Equilibrium) -> None:
        """Make a point the last of the path."""
        if self.history and self.last.nearby:  # a slope that serves at the end of the path only
            self.history[-1] = self.history[-1]._replace(slope=None)
        self.memory = min(self.memory + 2, _MOST) if point.iterations <= _NEAR else _LEAST
        self.history = [*self._remembered(point), _Known(point.state, _values(point.model, point.state))]
        self.before, self.last = self.last, point
        self.before.release()
        self.index = point.index if point.index >= 0 else self.index

    def _remembered(self, point: Equilibrium) -> list[_Known]:
        """Earlier states that serve for the prediction beyond a point.

        The path has a kink where a contact passes from element to element, and one state before it serves where there is no other.
        """
        kept: list[_Known] = []
        data, most = 2, _VALUES if point.on_chords else self.memory  # 2: value and slope of the point
        for known in reversed(self.history):
            data += 1 if known.slope is None else 2
            passed = _owners(known.state) != _owners(point.state) and not point.on_chords
            if data > most or (kept and passed):
                break
            if known.state.load_parameter < point.t:
                kept.append(known)
        alike = _alike(point.model, [*(known.state for known in kept[::-1]), point.state])[:-1]
        return [
            known if state is known.state else _Known(state, _values(point.model, state))
            for state, known in zip(alike, kept[: len(alike)][::-1], strict=True)
        ]

    def predicted(self, t: float) -> State:
        """State at t from the last states and their tangents, or along the last tangent."""
        last, step, history = self.last, t - self.last.t, self.history
        steady = not last.on_chords and last.speed < FOLD  # a nearly singular tangent leads anywhere
        if steady and step >= SHORTEST and history[-1].slope is None:
            history[-1] = history[-1]._replace(slope=last.slope(t))
        if (len(history) == 1 and not last.on_chords) or (steady and step < SHORTEST):
            return last.predicted(t)
        used = [known for known in history if steady or known.slope is None]
        return self.newton.prescribed(_through(last.model, used, t), t)

    def unexplained(self, by: Equilibrium, reached: Equilibrium) -> float:
        """Part of the step to a point that the tangent at one of its ends does not explain. It may not be large."""
        _, part = self._explained(by, reached.state)
        if part > _FOLLOWED:
            raise RefusedError(part=allowed(part))
        return part

    def _explained(self, by: Equilibrium, state: State) -> tuple[float, float]:
        """Size of the motion to a state, and the part that the tangent at a point does not explain; 0 where none is usable."""
        last, newton, step = self.last, self.newton, state.load_parameter - self.last.t
        rates = None if last.on_chords else by.rates(newton.assembler.drive(last.t, state.load_parameter))
        if rates is None:
            return 0.0, 0.0
        motion = newton.motion(last.state, state, by.state)
        size, left = newton.size(motion), newton.size(motion - step * rates.motion)
        return size, left / size if min(left, size) > RESOLVED else 0.0

    def room(self, step: float) -> float:
        """The step, or the part of it that the last two speeds, the tangent and the prediction promise to follow."""
        one, two, known = self.before, self.last, len(self.history) > 1
        if known and one.t < two.t and two.speed > _GROWING * one.speed:
            step = min(step, _ROOM * (self.limit() - two.t) or step)
        if two.on_chords or two.speed >= FOLD or step * two.speed <= _SHORT:
            return step
        step = min(step, (_PROMISED if known else _FIRST) / two.speed)
        size, part = self._explained(two, self.predicted(two.t + step)) if known else (0.0, 0.0)
        return step * max(0.5, _PROMISED / max(_PROMISED, size / LONGEST, part / _FOLLOWED))

    def limit(self) -> float:
        """Load parameter of the limit point ahead, by the speeds of the path at the last two points: near it ``a/sqrt(t_c - t)``."""
        (t0, v0), (t1, v1) = ((point.t, point.speed) for point in (self.before, self.last))
        ratio = v0 / v1 if np.isfinite(v1) and v1 > v0 > 0 else 0.0
        return t1 + (t1 - t0) * ratio**2 / (1 - ratio**2)


def _owners(state: State) -> list[int]:
    return [touch.element for touch in state.touches if touch is not None]


class _Known(NamedTuple):
    """A state of the path."""

    state: State
    values: Array  # see `_values`
    slope: Array | None = None  # their rates, if they serve for the prediction


def _values(model: Model, state: State) -> Array:
    """Displacements, forces, arc positions and angles of the contacts, and angles inside the elements."""
    contacts = np.zeros(model.contact_unknowns)
    for _, pair, touch in closed(model, state):
        own = (*touch.force, pair.arc_position(touch), touch.angle)
        contacts[pair.slots] = own[: pair.target.kind.contact_unknowns]
    inside = [state.profile.angle.ravel()] if state.profile else []
    return np.concatenate([state.q, contacts, *inside])


def _alike(model: Model, states: list[State]) -> list[State]:
    return model.rods.alike(states) if model.rods else states


def extrapolate(model: Model, history: list[State], t: float) -> State:
    """State at t by the polynomial through earlier states, all with the same closed contacts."""
    return _through(model, [_Known(state, _values(model, state)) for state in _alike(model, history)], t)


def _through(model: Model, history: list[_Known], t: float) -> State:
    """State at t by the polynomial through earlier states, which has their slopes where there are any (Hermite)."""
    last, terms = history[-1].state, []
    orders = [(known.state.load_parameter, 1 if known.slope is None else 2) for known in history]
    weights = []
    for known, (time, order) in zip(history, orders, strict=True):
        others = [(other, power) for other, power in orders if other != time]
        part = math.prod(((t - other) / (time - other)) ** power for other, power in others)
        bend = sum(power / (time - other) for other, power in others) if order == 2 else 0.0
        weights.append(part * (1 - (t - time) * bend))
        terms.append(known.values)
        if known.slope is not None:
            weights.append(part * (t - time))
            terms.append(known.slope)
    values, first = np.array(weights) @ np.array(terms), model.dof_count
    q, inside = values[:first], values[first + model.contact_unknowns :]
    q[model.slaves] = q[model.masters]
    profile = last.profile and replace(last.profile, angle=inside.reshape(last.profile.angle.shape))
    placed = values[first : first + model.contact_unknowns].tolist()
    touches = tuple(
        touch and _touch(pair, touch, *placed[pair.slots])
        for pair, touch in zip(model.pairs, last.touches, strict=True)
    )
    with np.errstate(all="ignore"):  # a far prediction may be anywhere
        return owned(model, replace(last, load_parameter=t, q=q, touches=touches, profile=profile))


def _touch(pair: PairModel, last: Touch, *own: float) -> Touch:
    """Contact with other unknowns, on the element that owned it last."""
    if not own:
        return last
    x, y, arc, *angle = own
    place = last.element - pair.target.first
    xi = (arc - pair.target.arcs[place]) / pair.target.lengths[place]
    return replace(last, xi=xi, force=(x, y), angle=angle[0] if angle else 0.0)


def allowed(unexplained: float) -> float:
    """Return the fraction of a step that its tangents would explain; `unexplained` is the fraction that they do not explain."""
    return _SAFE * _FOLLOWED / max(unexplained, 1e-9)
