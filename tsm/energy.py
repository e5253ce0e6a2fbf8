"""Work and dissipation of a structure whose contacts have friction.

The work of pins, supports and loads is stored as strain energy or dissipated by friction. Both are integrals over the load parameter of
a power that follows from the equilibrium and its rates, by Lobatto's rule inside every step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.friction import grips, rates, slip_rate, traction
from tsm.newton import Equilibrium, Newton
from tsm.predictor import extrapolate
from tsm.rolling import rolled
from tsm.state import State
from tsm.status import Status
from tsm.system import Drive

_PLACES = (0.5 - (3 / 28) ** 0.5, 0.5, 0.5 + (3 / 28) ** 0.5)
"""Inner points of Lobatto's rule of order 8 in the unit interval."""
_FIVE = np.array([9, 49, 64, 49, 9]) / 180
_THREE = np.array([1, 0, 4, 0, 1]) / 6
_APART = 1e-7
"""Largest difference of the rules of five and three points, over EI/L; the error of the former is then about 1e-12."""
_SHORT = 2e-3
"""Length of an interval of the load parameter below which the mean of the ends will do."""
_DEPTH = 20
"""Number of times that a step is halved at most."""


class _Span(NamedTuple):
    """Interval of the load parameter with equilibria and powers at both ends."""

    begin: float
    end: float
    first: Array
    last: Array


def power(newton: Newton, equilibrium: Equilibrium, drive: Drive) -> Array | None:
    """Work and dissipation for a unit of the load parameter.

    Returns the work of pins, supports and loads, then the dissipation of every pair, (1 + pairs,); None where
    the tangent is singular.
    """
    model, state, system = newton.model, equilibrium.state, equilibrium.system
    by = rates(newton, system, drive)
    if by is None:
        return None
    spent = np.zeros(1 + len(model.pairs))
    q = newton.assembler.prescribed_rate(drive.stage)
    spent[0] = system.nodal[model.fixed] @ q[model.fixed]
    q[model.free] = by.unknowns[: model.equations]
    spent[0] += model.loads.dot(state.load_parameter, q)
    if model.along.loaded and (rods := model.rods):
        tangent = system.tangent.groups[rods.number]
        spent[0] += rods.load_power(state, tangent, q, by.unknowns[model.equations :])
    for k, (fx, fy) in system.forces.items():
        if model.pairs[k].pin is not None:
            spent[0] += fx * drive.velocities[k][0] + fy * drive.velocities[k][1]
    for k, grip in grips(state):
        if grip.slip:
            spent[1 + k] = traction(model, state, system, k).tangential * slip_rate(newton, state, by, k)
    return spent


class Spent(NamedTuple):
    """Work and dissipation of a step."""

    total: Array  # as for `power`, over the step; shape (1 + pairs,)
    between: tuple[Equilibrium, ...]  # equilibria inside the step, in order of the load parameter


def spent(
    newton: Newton, history: list[State], ends: tuple[Equilibrium, Equilibrium], drive: Drive
) -> Spent | None:
    """Work and dissipation between two equilibria on a smooth part of the path.

    ``history``: earlier states with the same closed contacts, oldest first, from which the states between are
    predicted. ``ends``: where the interval begins and ends. ``drive``: what changes in proportion to the load
    parameter in between. None where a tangent is singular at an end, or no equilibrium is found in between. A
    short part without one counts by the mean of its ends.
    """
    trail = [*(state for state in history if state is not ends[0].state), *(end.state for end in ends)]

    between: list[Equilibrium] = []

    def at(t: float) -> Array | None:
        near = [*trail, *(inner.state for inner in between[-3:])]
        start = newton.prescribed(extrapolate(newton.model, near, t), t)
        reached = rolled(newton, near[-1], newton.solve(start))
        if reached.status is not Status.CONVERGED:
            return None
        between.append(reached)
        return power(newton, reached, drive)

    first, last = (power(newton, end, drive) for end in ends)
    if first is None or last is None:
        return None
    times = [end.state.load_parameter for end in ends]
    whole, total = [_Span(times[0], times[1], first, last)], np.zeros_like(first)
    least = (times[1] - times[0]) / 2**_DEPTH
    while whole:
        span = whole.pop()
        length = span.end - span.begin
        inner = [at(span.begin + part * length) for part in _PLACES]
        values = [span.first, *(value for value in inner if value is not None), span.last]
        if len(values) < 5 and length > _SHORT:
            return None
        if len(values) < 5:
            total += length * (span.first + span.last) / 2
            continue
        powers = np.array(values)
        apart = np.abs((_FIVE - _THREE) @ powers).max() * length
        if apart <= _APART * newton.model.force_scale * newton.model.length or length <= least:
            total += length * (_FIVE @ powers)
        else:
            middle = span.begin + length / 2
            whole += [
                _Span(span.begin, middle, span.first, powers[2]),
                _Span(middle, span.end, powers[2], span.last),
            ]
    return Spent(total, tuple(sorted(between, key=lambda inner: inner.state.load_parameter)))
