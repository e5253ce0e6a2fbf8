"""Assembly and solution of the linear system: a band with a border.

::

    [ A  B ] [ dq ]     [ r ]
    [ C  D ] [ dz ] = - [ s ]

A is the banded tangent of the beams, factorised by LAPACK's ``gbsv``. The border B, C, D holds the unknowns of the closed contacts. Its
Schur complement is small and dense; with a wide border, the whole matrix is sparse. The cost is linear in the numbers of elements and beams.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial, reduce
from typing import Any, NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.model.contact_block import Bordered, ContactBlock, Units
from tsm.model.groups import GroupForces
from tsm.model.model import Model
from tsm.model.state import State
from tsm.statement.beam import Point
from tsm.statement.stages import stage_of
from tsm.system.inertia import WIDE
from tsm.system.lapack import lapack

_EPS = float(np.finfo(float).eps)
_WEAK = 1e-12
"""Smallest pivot of the band, over its column, for which the Schur complement has digits. A smaller pivot means that only contacts hold
the beams, and the whole matrix is solved instead."""


@dataclass(kw_only=True, eq=False)
class Linearisation:
    """Residual at a configuration, and its tangent when it is asked for."""

    # forces of beams and contacts on all degrees of freedom. On prescribed degrees of freedom they are the
    # reactions; shape (dofs,)
    nodal: Array
    # unbalanced forces and end residuals of exact elements, then the residuals of the contacts: position
    # (2), direction of the force, and on exact elements the angle; shape (equations + contact unknowns,)
    residual: Array
    forces: dict[int, tuple[float, float]]  # force on the beam of every closed pair
    noise: float  # round-off of the residual by contact stiffness, ``4 eps k_c L``
    groups: tuple[GroupForces, ...]  # forces of the element groups
    state: State  # the configuration
    assemble: Callable[[], Bordered] = field(repr=False)

    @cached_property
    def tangent(self) -> Bordered:
        """Tangent at the configuration."""
        return self.assemble()


class Drag(NamedTuple):
    """Viscous resistance to leaving a configuration."""

    per_way: Array  # force per displacement; shape (dofs,)
    start: Array  # displacements without resistance; shape (dofs,)


class Drive(NamedTuple):
    """What changes in proportion to the load parameter."""

    velocities: tuple[Point, ...]  # velocities of the pairs' pins, zero for beam ends
    stage: int  # number, from 0, of the stage, which has the rates of loads and prescribed displacements


class Assembler:
    """Scatter maps of a model, made once."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.k = model.bandwidth
        self.ldab = 3 * self.k + 1
        self.internal = any(group.internal for group in model.groups)
        self.units = Units(model, self.k) if self.internal else None
        banded, last = model.banded, model.equations
        springs = [model.springs.dofs] if model.springs else []
        maps = [_pairs(model.equation[dofs]) for dofs in (*(group.dofs for group in model.groups), *springs)]
        rows, columns = (np.concatenate(part) for part in zip(*maps, strict=True))
        self.band_size = banded * self.ldab
        flat = columns * self.ldab + 2 * self.k + rows - columns
        self.scatter = np.where((rows < banded) & (columns < banded), flat, self.band_size)
        self.dofs = [group.dofs.ravel() for group in model.groups]
        self.spring_values = model.springs.values if model.springs else np.zeros(0)
        self.steady: Drive | None = None
        if model.stages == 1 and all(len(pin.path) < 3 for pin in model.structure.pins):
            self.steady = self.drive(0.0, 1.0)
        width, height = model.border, last + 1
        self.size = width * height
        if model.border_dofs:
            in_right = (rows < last) & (columns >= banded) & (columns < last)
            in_below = (rows >= banded) & (rows < last) & (columns < banded)
            self.scatter_right = np.where(in_right, rows * width + columns - banded, self.size)
            self.scatter_below = np.where(in_below, (rows - banded) * height + columns, self.size)

    def linearise(self, state: State, drag: Drag | None = None) -> Linearisation:
        """Residual and tangent at a state, against a drag if there is one."""
        model = self.model
        contacts = ContactBlock(model)
        groups = tuple(group.forces(state, contacts) for group in model.groups)
        nodal = self._gather([forces.nodal for forces in groups])
        for dof, reaction in contacts.pushed:
            nodal[dof : dof + 2] += reaction
        if model.springs is not None:
            nodal = nodal + model.springs.forces(state.q)
        if drag is not None:
            nodal = nodal + drag.per_way * (state.q - drag.start)
        if len(model.structure.loads):
            nodal = nodal - model.loads.at(state.load_parameter)
        return Linearisation(
            nodal=nodal,
            residual=np.concatenate([nodal[model.free], contacts.residual]),
            forces=contacts.forces,
            noise=4 * _EPS * contacts.stiffest * model.length,
            groups=groups,
            state=state,
            assemble=partial(self._tangent, state, groups, contacts, drag),
        )

    def _tangent(
        self, state: State, groups: tuple[GroupForces, ...], entered: ContactBlock, drag: Drag | None
    ) -> Bordered:
        model, contacts = self.model, entered.copy()
        tangents = tuple(
            group.tangent(state, forces, contacts) for group, forces in zip(model.groups, groups, strict=True)
        )
        values = np.concatenate([*(tangent.tangent.ravel() for tangent in tangents), self.spring_values])
        condensed: Array | float = 0.0
        if self.internal:
            nodal = self._gather([tangent.condensed_residual for tangent in tangents])
            condensed = np.concatenate([nodal[model.free], contacts.condensed_residual])
        band = np.bincount(self.scatter, weights=values, minlength=self.band_size + 1)[:-1]
        band = band.reshape(model.banded, self.ldab)
        if model.border_dofs:
            self._cross(values, contacts)
        if drag is not None:
            resistance = drag.per_way[model.free]
            band[:, 2 * self.k] += resistance[: model.banded]
            aside = np.arange(model.border_dofs)
            contacts.corner[aside, aside] += resistance[model.banded :]
        return Bordered(
            band=band,
            right=contacts.right,
            below=contacts.below,
            corner=contacts.corner,
            condensed_residual=condensed,
            groups=tangents,
            contacts=contacts,
        )

    def _gather(self, values: list[Array]) -> Array:
        """Sum the values (n, e) of the groups on all degrees of freedom."""
        count = self.model.dof_count
        sums = [
            np.bincount(dofs, weights=part.ravel(), minlength=count)
            for dofs, part in zip(self.dofs, values, strict=True)
        ]
        return reduce(np.add, sums)

    def drive(self, begin: float, end: float | None = None) -> Drive:
        """What changes at a load parameter, or between it and another one in the same stage."""
        if self.steady is not None:
            return self.steady
        end, still = begin if end is None else end, (0.0, 0.0)
        velocities = tuple(pair.pin.velocity(begin, end) if pair.pin else still for pair in self.model.pairs)
        return Drive(velocities, stage_of(max(begin, end), self.model.stages))

    def rate(self, system: Linearisation, drive: Drive | None = None) -> Array:
        """Derivative of the residual in the load parameter, from loads, prescribed displacements and pin velocities (by default at the state)."""
        model, tangent = self.model, system.tangent
        drive = self.drive(system.state.load_parameter) if drive is None else drive
        q, contacts = self.prescribed_rate(drive.stage), tangent.contacts.by_load.copy()
        nodal = -model.loads.rows[drive.stage]
        for k, (element, block) in tangent.contacts.blocks.items():
            pair, dofs = model.pairs[k], model.dofs[:, element]
            node = slice(3 * pair.node, 3 * pair.node + 2)
            moved = block[:, 6:8] @ (drive.velocities[k] if pair.pin else q[node])
            moved[6:] += block[6:, :6] @ q[dofs]
            nodal[dofs] += moved[:6]
            if pair.node >= 0:
                nodal[node] += moved[6:8]
            contacts[pair.slots] += moved[8:]
        if model.along.loaded:
            nodal = nodal + self._gather([part.by_load for part in tangent.groups])
        if model.moves:
            parts = zip(model.groups, tangent.groups, strict=True)
            rates = [
                np.einsum("ijn,jn->in", part.tangent.reshape(-1, *group.dofs.shape), q[group.dofs])
                for group, part in parts
            ]
            nodal = nodal + self._gather(rates)
            if model.springs is not None:
                nodal = nodal + model.springs.forces(q)
        return np.concatenate([nodal[model.free], contacts])

    def prescribed_rate(self, stage: int) -> Array:
        """Derivative of the prescribed displacements in the load parameter during a stage, over all degrees of freedom."""
        q = np.zeros(self.model.dof_count)
        q[self.model.fixed] = self.model.motions.rows[stage]
        return q

    def energy(self, state: State) -> float:
        """Strain energy of a state in equilibrium, springs included."""
        springs = self.model.springs.energy(state.q) if self.model.springs else 0.0
        return sum(group.energy(state) for group in self.model.groups) + springs

    def _cross(self, values: Array, contacts: ContactBlock) -> None:
        """Couple beam ends that touch chord elements, whose equations lie in the border."""
        model, right, below, corner = self.model, contacts.right, contacts.below, contacts.corner
        right += np.bincount(self.scatter_right, values, self.size + 1)[:-1].reshape(right.shape)
        below += np.bincount(self.scatter_below, values, self.size + 1)[:-1].reshape(below.shape)
        for k, (e, block) in contacts.blocks.items():
            pair = model.pairs[k]
            if pair.slot >= 0 or pair.node < 0:
                continue
            eq, node_eq = model.element_equations[:, e], model.equation[3 * pair.node : 3 * pair.node + 2]
            free = node_eq < model.equations
            unknown = (node_eq - model.banded)[free]
            right[np.ix_(eq, unknown)] += block[:6, 6:8][:, free]
            right[np.ix_(node_eq, unknown)] += block[6:8, 6:8][:, free]
            below[np.ix_(unknown, eq)] += block[6:8, :6][free]
        bordered = slice(model.banded, model.equations)
        corner[: model.border_dofs] = right[bordered]
        corner[model.border_dofs :, : model.border_dofs] = below[model.border_dofs :, bordered]

    def solve(self, system: Linearisation, *more: Array) -> Array | None:
        """Newton step and the solutions for further right-hand sides, as columns; None if the tangent is singular."""
        model = self.model
        banded, border, count = model.banded, model.border, 1 + len(more)
        tangent = system.tangent
        sides = np.array([-(system.residual + tangent.condensed_residual), *more]).T
        if self.units:
            tangent, sides = self.units.without(tangent, sides)
        if border > WIDE:
            return self._solve_whole(tangent, sides)
        rhs = np.concatenate([sides[:banded], tangent.right[:banded]], axis=1)
        lu, _, X, info = lapack().dgbsv(self.k, self.k, tangent.band.T, rhs)
        if border and (
            info != 0 or (np.abs(lu[2 * self.k]) <= _WEAK * np.abs(tangent.band).max(axis=1)).any()
        ):
            return self._solve_whole(tangent, sides)
        if border:
            reduced = tangent.below[:, :banded] @ X
            left, right = tangent.corner - reduced[:, count:], sides[banded:] - reduced[:, :count]
            _, _, z, info = lapack().dgesv(left, right)
            X = np.concatenate([X[:, :count] - X[:, count:] @ z, z])
        return None if info != 0 else self._with_units(X)

    def _with_units(self, x: Array) -> Array:
        return x if self.units is None else x * self.units.columns[:, None]

    def _solve_whole(self, tangent: Bordered, sides: Array) -> Array | None:
        """Solve band and border as one matrix. The band is singular if only contacts hold the beams."""
        from scipy.sparse.linalg import splu

        try:
            return self._with_units(splu(self.whole(tangent)).solve(sides))
        except RuntimeError:
            return None

    def whole(self, tangent: Bordered) -> Any:
        """Tangent as one sparse matrix, by columns."""
        from scipy.sparse import block_array, coo_array

        banded = self.model.banded
        columns, entries = np.nonzero(tangent.band)
        rows = columns + entries - 2 * self.k
        band = coo_array((tangent.band[columns, entries], (rows, columns)), shape=(banded, banded))
        right, below = coo_array(tangent.right[:banded]), coo_array(tangent.below[:, :banded])
        return block_array([[band, right], [below, coo_array(tangent.corner)]], format="csc")


def _pairs(equations: Array) -> tuple[Array, Array]:
    """Row and column of every entry of the elements' matrices, flat."""
    shape = (len(equations), *equations.shape)
    return (
        np.broadcast_to(equations[:, None], shape).ravel(),
        np.broadcast_to(equations[None], shape).ravel(),
    )
