"""The smallest distance from a beam node at which Newton's method still finds equilibrium, at a fixed tolerance.

`tsm.solve` estimates the round-off of a contact and accepts a residual of this size. This study accepts only a residual below a stated
tolerance, as a program without such an estimate does. The contact moves towards the next beam node in steps that shrink with the
distance. Round-off therefore stops it before the step length or the start of the iteration does. The critical area of [P] section 4.1
begins where no smaller step helps. Behind the node the march goes on from a state inside the next element.
"""

from dataclasses import dataclass

import numpy as np

from comparisons.response import Array
from tsm import Settings, Structure
from tsm.contact_set import initial_state
from tsm.model import Model
from tsm.newton import Newton
from tsm.path import extrapolate
from tsm.projection import arc_position
from tsm.state import State
from tsm.status import Status

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


@dataclass(frozen=True, kw_only=True, eq=False)
class Approach:
    """Equilibria on the way to a beam node, or to the tip, at an arc position.

    Load parameters and distances from the node in element lengths, l_i/l of [P], shape (k,); empty if there is none in the element.
    """

    node: float
    load_parameter: Array
    ratio: Array

    @property
    def smallest(self) -> float:
        """Smallest ratio with equilibrium, the measured critical area; nan if there is none."""
        return float(min(self.ratio, default=np.nan))


def approaches(structure: Structure, tolerance: float) -> tuple[Approach, ...]:
    """Lead the only contact of a structure, one beam under one pin, towards every beam node on its way to the tip, the last one.

    The tolerance bounds the scaled residual of `tsm.newton.Newton`, without allowance for round-off.
    """
    contact = _Contact(structure, tolerance)
    history = [initial_state(contact.model)]
    first = int(np.floor(contact.arc(history[0]) / contact.l0 + NEAREST)) + 1
    found = []
    for number in range(first, structure.beams[0].elements + 1):
        node = number * contact.l0
        trail = _towards(contact, history, node) if history else []
        ratio = np.array([(node - contact.arc(state)) / contact.l0 for state in trail])
        load_parameter = np.array([state.load_parameter for state in trail])
        found.append(Approach(node=node, load_parameter=load_parameter, ratio=ratio))
        history = _behind(contact, trail, node) if node < contact.length - NEAREST else []
    return tuple(found)


class _Contact:
    """The contact's model, its solver and where it is."""

    def __init__(self, structure: Structure, tolerance: float) -> None:
        self.model = Model(structure)
        self.newton = Newton(self.model, Settings(tolerance=tolerance))
        beam = structure.beams[0]
        self.l0 = beam.length / beam.elements
        self.length = beam.length

    def arc(self, state: State) -> float:
        """Arc position of the contact."""
        touch = state.touches[0]
        assert touch is not None, "this march opens no contact"
        return arc_position(self.model.pairs[0].target, touch.element, touch.xi)

    def equilibrium(self, state: State) -> State | None:
        """Newton's method from a start, None unless the residual falls below the tolerance.

        What the solver accepts as round-off is iterated further: a later iteration may hit the tolerance.
        """
        spent = 0
        while spent < _ITERATIONS:
            found = self.newton.solve(state)
            if found.residuals[-1] <= self.newton.tolerance:
                return found.state
            if found.status is not Status.CONVERGED:
                return None
            state, spent = found.state, spent + found.iterations
        return None


def _towards(contact: _Contact, history: list[State], node: float) -> list[State]:
    """Equilibria with the contact nearer and nearer to the node."""
    states, step = list(history), _LARGEST / 2
    while (ratio := (node - contact.arc(states[-1])) / contact.l0) > NEAREST:
        if len(states) > 1:
            step = min(_LARGEST, _SHRINK * ratio / max(_rate(contact, states), _SLOWEST))
        targets = (states[-1].load_parameter + step / 2**halvings for halvings in range(_HALVINGS))
        for target in targets:
            if target > 1.0:
                return states
            found = contact.equilibrium(extrapolate(contact.model, states[-4:], target))
            if found is not None and contact.arc(found) < node:
                states.append(found)
                break
        else:
            return states
    return states


def _rate(contact: _Contact, states: list[State]) -> float:
    """Element lengths that the contact slides per load parameter."""
    before, last = states[-2:]
    way = contact.arc(last) - contact.arc(before)
    return way / contact.l0 / (last.load_parameter - before.load_parameter)


def _behind(contact: _Contact, trail: list[State], node: float) -> list[State]:
    """One equilibrium inside the element behind the node, the nearest of a few places; none if none is found.

    The starts are extrapolated from states that lie apart: those crowded before the node know only its round-off.
    """
    apart: list[State] = []
    for state in reversed(trail):
        if len(apart) < 3 and (not apart or apart[0].load_parameter - state.load_parameter > _LARGEST / 2):
            apart.insert(0, state)
    if len(apart) < 2:
        return []
    rate, last = _rate(contact, apart), apart[-1]
    for part in _BEHIND:
        ahead = (node - contact.arc(last)) / contact.l0 + part
        target = last.load_parameter + ahead / max(rate, _SLOWEST)
        found = contact.equilibrium(extrapolate(contact.model, apart, target)) if target <= 1.0 else None
        if found is not None and node < contact.arc(found) < node + contact.l0:
            return [found]
    return []
