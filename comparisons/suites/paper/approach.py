"""How near to a beam node Newton's method still finds equilibrium, at a fixed tolerance."""
# `tsm.solve` accepts a residual of the size of a contact's round-off; a program without such an estimate
# accepts only one below its tolerance. The contact nears the node in steps that shrink with the distance;
# where none helps, the area of [P] 4.1 begins.

from collections.abc import Iterator

import numpy as np

from comparisons.answer import Array
from comparisons.frozen import Frozen
from tsm import Settings, Structure
from tsm.contact.contact_set import initial_state
from tsm.model.model import Model
from tsm.model.projection import arc_position
from tsm.model.state import State
from tsm.path.path import extrapolate
from tsm.statement.status import Status
from tsm.system.newton import Newton

NEAREST = 2e-8
"""Distances from a node, in element lengths, that count as none.

Newton's method leaves positions uncertain by the tolerance times L/1000, which is 1.8e-8 of 18 elements at a tolerance of 1e-6.
"""

_SHRINK = 0.3  # part of the distance to the node that one step covers
_LARGEST = 0.02  # step of the load parameter
_SLOWEST = 1e-9  # element lengths per load parameter, where a contact does not move
_HALVINGS = 6
_ITERATIONS = 25
_BEHIND = (0.1, 0.2, 0.3, 0.4, 0.5)  # places inside the next element, in element lengths


class Approach(Frozen):
    """Equilibria (k,) on the way to a node at an arc position, and their distances in element lengths."""

    node: float
    load_parameter: Array
    ratio: Array

    @property
    def smallest(self) -> float:
        """Smallest ratio with equilibrium, the measured critical area; nan if there is none."""
        return float(min(self.ratio, default=np.nan))


def approaches(structure: Structure, tolerance: float) -> Iterator[Approach]:
    """Lead the only contact of a structure towards every node up to the tip, at a scaled tolerance."""
    march = _March(structure, tolerance)
    history = [initial_state(march.model)]
    for number in range(int(np.floor(march.arc(history[0]) / march.l0 + NEAREST)) + 1, march.elements + 1):
        node = number * march.l0
        trail = march.towards(history, node) if history else []
        ratio = np.array([(node - march.arc(state)) / march.l0 for state in trail])
        yield Approach(node=node, load_parameter=np.array([one.load_parameter for one in trail]), ratio=ratio)
        history = march.behind(trail, node) if number < march.elements else []


class _March:
    """The contact's model and its solver."""

    def __init__(self, structure: Structure, tolerance: float) -> None:
        self.model = Model(structure)
        self.newton = Newton(self.model, Settings(tolerance=tolerance))
        self.elements = structure.beams[0].elements
        self.l0 = structure.beams[0].length / self.elements

    def arc(self, state: State) -> float:
        """Arc position of the contact."""
        touch = state.touches[0]
        assert touch is not None, "this march opens no contact"
        return arc_position(self.model.pairs[0].target, touch.element, touch.xi)

    def rate(self, states: list[State]) -> float:
        """Element lengths that the contact slides per load parameter."""
        before, last = states[-2:]
        way = self.arc(last) - self.arc(before)
        return max(way / self.l0 / (last.load_parameter - before.load_parameter), _SLOWEST)

    def equilibrium(self, states: list[State], target: float) -> State | None:
        """Newton's method down to the tolerance, beyond what the solver takes for round-off, or None."""
        state, spent = extrapolate(self.model, states, target), 0
        while spent < _ITERATIONS:
            found = self.newton.solve(state)
            if found.residuals[-1] <= self.newton.tolerance:
                return found.state
            if found.status is not Status.CONVERGED:
                return None
            state, spent = found.state, spent + found.iterations
        return None

    def towards(self, history: list[State], node: float) -> list[State]:
        """Equilibria with the contact nearer and nearer to the node."""
        states, step = list(history), _LARGEST / 2
        while (ratio := (node - self.arc(states[-1])) / self.l0) > NEAREST:
            if len(states) > 1:
                step = min(_LARGEST, _SHRINK * ratio / self.rate(states))
            for halvings in range(_HALVINGS):
                target = states[-1].load_parameter + step / 2**halvings
                if target > 1.0:
                    return states
                found = self.equilibrium(states[-4:], target)
                if found is not None and self.arc(found) < node:
                    states.append(found)
                    break
            else:
                return states
        return states

    def behind(self, trail: list[State], node: float) -> list[State]:
        """One equilibrium inside the element behind the node, the nearest of a few places, if any."""
        # the starts are extrapolated from states that lie apart: those at the node know only its round-off
        apart: list[State] = []
        for state in reversed(trail):
            if not apart or apart[0].load_parameter - state.load_parameter > _LARGEST / 2:
                apart.insert(0, state)
        apart = apart[-3:]
        for part in _BEHIND if len(apart) > 1 else ():
            ahead = (node - self.arc(apart[-1])) / self.l0 + part
            target = apart[-1].load_parameter + ahead / self.rate(apart)
            found = self.equilibrium(apart, target) if target <= 1.0 else None
            if found is not None and node < self.arc(found) < node + self.l0:
                return [found]
        return []
