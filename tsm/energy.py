"""Work and dissipation of a structure whose contacts have friction.

The work of pins, supports and loads is stored as strain energy or dissipated by friction. Both are integrals
over the load parameter of a power that follows from the equilibrium and its rates, by Lobatto's rule inside
every step.
"""

from __future__ import annotations

import numpy as np

from tsm.elements.properties import Array
from tsm.friction import grips, slip_rate, traction_at
from tsm.path import Point, Track
from tsm.predictor import extrapolate
from tsm.rolling import LOBATTO, rolled
from tsm.system import Drive

_FIVE = np.array([9, 49, 64, 49, 9]) / 180
_THREE = np.array([1, 0, 4, 0, 1]) / 6
_APART = 1e-7
"""Largest difference of the rules of five and three points, over EI/L; the error of the former is then about 1e-12."""
_SHORT = 2e-3
"""Length of an interval of the load parameter below which the mean of the ends will do."""
_DEPTH = 20
"""Number of times that a step is halved at most."""
_NEAR = 1e-6
"""Part of a step before its end at which a state along the tangent stands for the tangent."""


def power(point: Point, drive: Drive) -> Array | None:
    """Work of pins, supports and loads for a unit of the load parameter, then the dissipation of every pair, (1 + pairs,).

    None where the tangent is singular.
    """
    model, state, system = point.model, point.state, point.system
    by = point.rates(drive)
    if by is None:
        return None
    spent = np.zeros(1 + len(model.pairs))
    spent[0] = system.nodal[model.fixed] @ by.dofs[model.fixed] + model.loads.dot(point.t, by.dofs)
    if model.along.loaded:
        spent[0] += sum(
            group.load_power(state, tangent, by.dofs, by.contacts)
            for group, tangent in zip(model.groups, system.tangent.groups, strict=True)
        )
    for k, (fx, fy) in system.forces.items():
        if model.pairs[k].pin is not None:
            spent[0] += fx * drive.velocities[k][0] + fy * drive.velocities[k][1]
    for k, grip in grips(state):
        if grip.slip:
            spent[1 + k] = traction_at(point, k).tangential * slip_rate(point, by, k)
    return spent


def spent(track: Track, end: Point, drive: Drive) -> tuple[Array, list[Point]] | None:
    """Work and dissipation from the last point of a path to the next one, and points in between, in order.

    None where a tangent is singular at an end, or no equilibrium is found in between. A short part without
    one counts by the mean of its ends.
    """
    newton, begin = track.newton, track.last
    tangent = end.predicted(end.t - _NEAR * (end.t - begin.t))
    trail = [*track.history[-1][1:], tangent, begin.state, end.state]
    between: list[Point] = []

    def at(t: float) -> Array | None:
        near = [*trail, *(inner.state for inner in between[-3:])]
        start = newton.prescribed(extrapolate(newton.model, near, t), t)
        reached = rolled(newton, near[-1], newton.solve(start))
        if not reached.converged:
            return None
        between.append(Point(newton, reached))
        return power(between[-1], drive)

    def over(start: float, stop: float, first: Array, last: Array) -> Array | None:
        length = stop - start
        inner = [at(start + part * length) for part in LOBATTO]
        powers = np.array([first, *(value for value in inner if value is not None), last])
        if len(powers) < 5:
            mean: Array = length * (first + last) / 2
            return None if length > _SHORT else mean
        apart = np.abs((_FIVE - _THREE) @ powers).max() * length
        if apart <= _APART * newton.model.force_scale * newton.model.length or length <= least:
            whole: Array = length * (_FIVE @ powers)
            return whole
        middle = start + length / 2
        late = over(middle, stop, powers[2], last)
        early = None if late is None else over(start, middle, first, powers[2])
        return None if late is None or early is None else late + early

    first, last, least = power(begin, drive), power(end, drive), (end.t - begin.t) / 2**_DEPTH
    total = None if first is None or last is None else over(begin.t, end.t, first, last)
    return None if total is None else (total, sorted(between, key=lambda point: point.t))
