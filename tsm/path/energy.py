"""Work and dissipation of a structure whose contacts have friction, and how far contacts have slipped that stick.

The work of pins, supports and loads is stored as strain energy or dissipated by friction. Both are integrals over
the load parameter of a power that follows from the equilibrium and its rates, by Lobatto's rule inside every step.

Contacts that stick on a face or under a round pin roll, and their slip rate ``v = A s' + rho'`` is zero all along.
A depends on more than s, so v is the rate of no quantity, and the path between two states decides. With the
values * of the state before::

    int v = (A + A*)/2 (s - s*) + rho - rho* - c,   c = (A - A*)/2 (s - s*) - int (A - A*) ds

The row of a stick is the trapezium, without c. The area c between the path and its chord in the plane of s
and A follows from equilibria at Lobatto's points, and the angle of the held place takes it. Every equilibrium
of a path is then the held place of the next one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.polynomial import Polynomial

from tsm.contact.events import traction
from tsm.elements.properties import Array
from tsm.model.pairs import PairModel
from tsm.model.state import Grip, Place, State
from tsm.path.friction import grips, slip_rate, with_grips
from tsm.path.path import SHORTEST, Track, extrapolate
from tsm.statement.status import RefusedError, Status
from tsm.system.equilibrium import Equilibrium
from tsm.system.system import Drive

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
LOBATTO = (0.5 - (3 / 28) ** 0.5, 0.5, 0.5 + (3 / 28) ** 0.5)
"""Inner points of Lobatto's rule of order 8 in the unit interval."""
_ZERO = 1e-14
"""Area, in longest beams, that counts as zero."""
_LARGE = 1e-10
"""Largest area, in longest beams, for which three points will do."""
_AREAS = 1e-9
"""Largest difference of the areas by five and three points, in longest beams; the error of the former is then about 1e-12."""
_WHOLE = 1e-3
"""Length of an interval of the load parameter that is not halved; mixed elements have jumps at their nodes."""
_SWEEPS = 12
"""Largest number of corrections of the areas; each leaves about the strain times the error before."""

Held = dict[int, Place]


def rolled(before: State, reached: Equilibrium) -> Equilibrium:
    """Equilibrium whose contacts in stick have not slipped since an equilibrium before, and are held in their own places.

    ``before``: in whose places the contacts of `reached` are held, so that their rows are the trapezium since
    then. Returns one that has not converged where none is found.
    """
    newton, model = reached.newton, reached.model
    held = {
        k: grip.held
        for k, grip in grips(reached.state).items()
        if grip.held is not None and (model.pairs[k].lever or model.pairs[k].roll)
    }
    if not held or not reached.converged:
        return reached
    begin, end = before.load_parameter, reached.state.load_parameter
    found = {1.0: reached}
    for part, least in ((LOBATTO[1], _ZERO), (LOBATTO[0], _LARGE), (LOBATTO[2], _LARGE)):
        arcs, stretches = np.ptp(_curves(held, list(found.values())), axis=-1)
        if (arcs * stretches).max() <= least * model.length:
            break
        t = begin + part * (end - begin)
        start = extrapolate(model, [before, *(node.state for node in reversed(found.values()))], t)
        found[part] = newton.solve(newton.prescribed(start, t))
        if not found[part].converged:
            return found[part]
    if len(found) == 1:
        return _anchored(held, reached)
    places, nodes = np.array([0, *sorted(found)]), [found[part] for part in sorted(found)]
    middle, areas = found[0.5], _areas(held, nodes, places)
    fewer = _areas(held, [middle, reached], np.array([0, 0.5, 1]))
    apart = np.abs(areas - fewer[:, 1:])[:, -1].max()
    if apart > _AREAS * model.length and abs(end - begin) > _WHOLE:
        first = rolled(before, middle)
        there = {k: grip for k, grip in grips(first.state).items() if k in held}
        second = newton.solve(with_grips(reached.state, there))
        return rolled(first.state, second) if first.converged else first
    for _ in range(_SWEEPS):
        nodes = [_corrected(held, node, area) for node, area in zip(nodes, areas.T, strict=True)]
        last, areas = areas, _areas(held, nodes, places)
        if np.abs(areas - last).max() <= _ZERO * model.length:
            return _anchored(held, nodes[-1])
    return replace(reached, status=Status.ITERATION_LIMIT)


def _curves(held: Held, nodes: list[Equilibrium]) -> Array:
    """Arc positions s and lengths A of the contacts in their held places and at equilibria, shape (2, contacts, 1 + nodes)."""
    trails = [[place, *(traction(node, k).place for node in nodes)] for k, place in held.items()]
    points = np.array([[(place.arc, place.stretch) for place in trail] for trail in trails])
    return np.moveaxis(points, -1, 0)


def _areas(held: Held, nodes: list[Equilibrium], places: Array) -> Array:
    """Area c between path and chord of every contact up to every equilibrium, shape (contacts, nodes)."""
    areas = []
    for s, A in np.moveaxis(_curves(held, nodes), 1, 0):
        arc, stretch = (Polynomial.fit(places, x - x[0], len(places) - 1, domain=[0, 1]) for x in (s, A))
        below = (stretch * arc.deriv()).integ(lbnd=0)
        areas.append(((A - A[0]) * (s - s[0]) / 2 - below(places))[1:])
    return np.array(areas)


def _shifted(pair: PairModel, place: Place, by: float) -> Place:
    """Place from which the trapezium is smaller by a distance."""
    if pair.roll:
        return place._replace(direction=place.direction + by / pair.roll)
    return place._replace(shear=place.shear + by / pair.lever)


def _corrected(held: Held, node: Equilibrium, areas: Array) -> Equilibrium:
    """One iteration towards the equilibrium in which the trapezium of every contact is the area."""
    shifted = zip(held.items(), areas.tolist(), strict=True)
    places = {k: Grip(0, _shifted(node.model.pairs[k], place, area)) for (k, place), area in shifted}
    held_there = node.with_state(with_grips(node.state, places))
    solved = node.newton.assembler.solve(held_there.system)
    if solved is None:
        return node
    return node.with_state(
        node.newton.update(held_there.state, solved[:, 0], held_there.system, residual=True)
    )


def _anchored(held: Held, node: Equilibrium) -> Equilibrium:
    """Equilibrium whose contacts are held in their own places, with what is left of their rows, so that it does not add up."""
    places = {}
    for k, grip in grips(node.state).items():
        if k in held and grip.held is not None:
            pair, here = node.model.pairs[k], traction(node, k).place
            places[k] = Grip(0, _shifted(pair, here, -pair.slid(here, grip.held)))
    return node.with_state(with_grips(node.state, places))


def power(point: Equilibrium, drive: Drive) -> Array | None:
    """Work of pins, supports and loads for a unit of the load parameter, then the dissipation of every pair, (1 + pairs,).

    None where the tangent is singular.
    """
    model, state, system = point.model, point.state, point.system
    by = point.rates(drive)
    if by is None:
        return None
    spent = np.zeros(1 + len(model.pairs))
    spent[0] = system.nodal[model.fixed] @ by.dofs[model.fixed] + model.loads.dot(point.t, by.dofs)
    if model.along.loaded and (rods := model.rods):
        tangent = system.tangent.groups[rods.number]
        spent[0] += rods.load_power(state, tangent, by.dofs, by.contacts)
    for k, (fx, fy) in system.forces.items():
        if model.pairs[k].pin is not None:
            spent[0] += fx * drive.velocities[k][0] + fy * drive.velocities[k][1]
    for k, grip in grips(state).items():
        if grip.slip:
            spent[1 + k] = traction(point, k).tangential * slip_rate(point, by, k)
    return spent


def spent(track: Track, end: Equilibrium, drive: Drive) -> tuple[Array, list[Equilibrium]]:
    """Work and dissipation from the last point of a path to the next one, and points in between, in order.

    Refuses a step with a singular tangent at an end, or a part without an equilibrium inside, unless it is short.
    """
    newton, begin = track.newton, track.last
    near, trail = _NEAR * (end.t - begin.t), [begin.state, end.state]
    if end.t - begin.t > SHORTEST:
        trail = [begin.predicted(begin.t + near), end.predicted(end.t - near), *trail]
    between: list[Equilibrium] = []

    def at(t: float) -> Array | None:
        near = [*trail, *(inner.state for inner in between[-3:])]
        start = newton.prescribed(extrapolate(newton.model, near, t), t)
        reached = rolled(near[-1], newton.solve(start))
        if not reached.converged:
            return None
        between.append(reached)
        return power(between[-1], drive)

    def over(start: float, stop: float, first: Array, last: Array) -> Array:
        length, inner = stop - start, []
        for part in LOBATTO:
            value = at(start + part * length)
            if value is None and length > _SHORT:
                raise RefusedError
            if value is None:
                return length * (first + last) / 2
            inner.append(value)
        powers = np.array([first, *inner, last])
        apart = np.abs((_FIVE - _THREE) @ powers).max() * length
        if apart <= _APART * newton.model.force_scale * newton.model.length or length <= least:
            return length * (_FIVE @ powers)
        middle = start + length / 2
        return over(middle, stop, powers[2], last) + over(start, middle, first, powers[2])

    least = (end.t - begin.t) / 2**_DEPTH
    first, last = power(begin, drive), power(end, drive)
    if first is None or last is None:
        raise RefusedError
    return over(begin.t, end.t, first, last), sorted(between, key=lambda point: point.t)
