"""Assembly and solution of the linear system: a band with a border.

::

    [ A  B ] [ dq ]     [ r ]
    [ C  D ] [ dz ] = - [ s ]

A is the banded tangent of the beams (LAPACK ``gbsv``), the border holds the unknowns of the closed contacts; its
Schur complement is small and dense. The cost is linear in the number of elements.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tsm.border import Border, Bordered, Units
from tsm.elements import beam
from tsm.elements.properties import Array
from tsm.lapack import lapack
from tsm.model import Model, PairModel
from tsm.rods.assembly import RodBalance
from tsm.rods.layout import OWN
from tsm.state import State, Touch
from tsm.structure import Point

_EPS = float(np.finfo(float).eps)
_WEAK = 1e-12
"""Pivot of the band, in parts of its column, below which only the contacts hold the beams: their Schur complement would have no digits."""


@dataclass(kw_only=True, eq=False)
class Linearisation:
    """Residual at a configuration, and its tangent when it is asked for.

    Attributes
    ----------
    nodal : ndarray, shape (dofs,)
        Forces of beams and contacts on all degrees of freedom; on the prescribed ones, the reactions.
    residual : ndarray, shape (equations + contact unknowns,)
        Unbalanced forces and what exact elements miss on arrival, then the residuals of the contacts: position (2), direction of the
        force, and of exact elements the angle.
    forces : dict
        Force on the beam of every closed pair.
    closed_force : ndarray, shape (6, c)
        Nodal forces of the elements in closed form, contact included.
    noise : float
        Round-off of the residual by contact stiffness, ``4 eps k_c L``.
    crowded : bool
        Whether two nodes touch one element of the paper's, which knows one contact only.
    rods : RodBalance or None
        The exact elements.
    """

    nodal: Array
    residual: Array
    forces: dict[int, tuple[float, float]]
    closed_force: Array
    noise: float
    crowded: bool
    rods: RodBalance | None
    assemble: Callable[[], Bordered] = field(repr=False)

    @cached_property
    def tangent(self) -> Bordered:
        """Tangent at the configuration."""
        return self.assemble()


class Drag(NamedTuple):
    """Viscous resistance to leaving a configuration.

    Attributes
    ----------
    per_way : ndarray, shape (dofs,)
        Force per displacement.
    start : ndarray, shape (dofs,)
        Displacements without resistance.
    """

    per_way: Array
    start: Array


class Assembler:
    """Scatter maps of a model, made once."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.k = model.bandwidth
        self.ldab = 3 * self.k + 1
        self.units = Units(model, self.k) if model.rods else None
        banded, last = model.banded, model.equations
        self.nodal_dofs = model.dofs[:, model.closed]
        maps = [_pairs(model.equation[dofs]) for dofs in (self.nodal_dofs, model.exact_dofs)]
        rows, columns = (np.concatenate(part) for part in zip(*maps, strict=True))
        self.band_size = banded * self.ldab
        flat = columns * self.ldab + 2 * self.k + rows - columns
        self.scatter = np.where((rows < banded) & (columns < banded), flat, self.band_size)
        self.closed_dofs, self.exact_dofs = self.nodal_dofs.ravel(), model.exact_dofs.ravel()
        width, height = model.border, last + 1
        self.size = width * height
        in_right = (rows < last) & (columns >= banded) & (columns < last)
        in_below = (rows >= banded) & (rows < last) & (columns < banded)
        self.scatter_right = np.where(in_right, rows * width + columns - banded, self.size)
        self.scatter_below = np.where(in_below, (rows - banded) * height + columns, self.size)

    def linearise(self, state: State, drag: Drag | None = None) -> Linearisation:
        """Residual and tangent at a state, against a drag if there is one."""
        model = self.model
        border = Border(model)
        force, tangent = self._closed_form(state, border)
        nodal: Array = np.bincount(self.closed_dofs, weights=force.ravel(), minlength=model.dof_count)
        rods = None
        if model.rods:
            rods = model.rods.balance(state)
            nodal = nodal + self._gather(rods.residual)
            border.balance(rods, state)
        for dof, reaction in border.pushed:
            nodal[dof : dof + 2] += reaction
        if drag is not None:
            nodal = nodal + drag.per_way * (state.q - drag.start)
        if len(model.structure.loads):
            nodal = nodal - state.load_parameter * model.load
        return Linearisation(
            nodal=nodal,
            residual=np.concatenate([nodal[model.free], border.own]),
            forces=border.forces,
            closed_force=force,
            noise=4 * _EPS * border.stiffest * model.length,
            crowded=border.crowded,
            rods=rods,
            assemble=lambda: self._tangent(state, tangent, border, rods, drag),
        )

    def _tangent(
        self,
        state: State,
        closed: Array,
        border: Border,
        balance: RodBalance | None,
        drag: Drag | None = None,
    ) -> Bordered:
        model = self.model
        values, rods, carried = closed.ravel(), None, None
        if model.rods and balance:
            rods = model.rods.linearise(state, balance)
            for part in rods.cut:
                border.cut(part)
            values = np.concatenate([values, rods.tangent.ravel()])
            carried = np.concatenate([self._gather(rods.carried)[model.free], border.carried])
        band = np.bincount(self.scatter, weights=values, minlength=self.band_size + 1)[:-1]
        band = band.reshape(model.banded, self.ldab)
        if model.border_dofs:
            self._cross(values, border)
        if drag is not None:
            resistance = drag.per_way[model.free]
            band[:, 2 * self.k] += resistance[: model.banded]
            aside = np.arange(model.border_dofs)
            border.corner[aside, aside] += resistance[model.banded :]
        return Bordered(
            band=band,
            right=border.right,
            below=border.below,
            corner=border.corner,
            carried=carried,
            rods=rods,
        )

    def _gather(self, values: Array) -> Array:
        """Sum what the exact elements (9, r) give on all degrees of freedom."""
        count = self.model.dof_count
        total: Array = np.bincount(self.exact_dofs, weights=values.ravel(), minlength=count)
        return total

    def _closed_form(self, state: State, border: Border) -> tuple[Array, Array]:
        """Forces (6, c) and tangents (36, c) of the elements in closed form; their contacts enter the border."""
        model = self.model
        if model.coefficients:
            force, tangent = beam.response(model.coefficients, state.q[self.nodal_dofs])
        else:
            force, tangent = np.empty((6, 0)), np.empty((36, 0))
        for k, (pair, touch) in enumerate(zip(model.pairs, state.touches, strict=True)):
            if touch is None:
                border.leave_open(pair)
            elif not pair.cuts:
                place = model.place[touch.element]
                gradient, block = self._contact(pair, touch, state)
                if pair.slot < 0:
                    force[:, place] = tangent[:, place] = 0.0
                force[:, place] += gradient[:6]
                tangent[:, place] += block[:6, :6].ravel()
                border.close(k, pair, touch, gradient, block)
        return force, tangent

    def velocities(self, begin: float, end: float | None = None) -> tuple[Point, ...]:
        """Velocities of the pairs' pins at a load parameter, or their means up to another one."""
        end, still = begin if end is None else end, (0.0, 0.0)
        return tuple(pair.pin.velocity(begin, end) if pair.pin else still for pair in self.model.pairs)

    def rate(self, state: State, velocities: tuple[Point, ...] | None = None) -> Array:
        """Derivative of the residual in the load parameter: loads, prescribed displacements, moving pins (the present ones if none)."""
        model = self.model
        velocities = self.velocities(state.load_parameter) if velocities is None else velocities
        nodal, own = -model.load, np.zeros(model.contact_unknowns)
        for pair, touch, velocity in zip(model.pairs, state.touches, velocities, strict=True):
            if touch is not None and pair.pin is not None and pair.cuts:
                own[pair.slot : pair.slot + 2] = -np.array(velocity)
            elif touch is not None and pair.pin is not None:
                _, block = self._contact(pair, touch, state)
                moved = block[:, 6:8] @ np.array(velocity)
                nodal[model.dofs[:, touch.element]] += moved[:6]
                if pair.slot >= 0:
                    own[pair.slots] = moved[8:]
        if model.fixed_values.any():
            q = self.prescribed_rate()
            pulled = np.empty(0)
            if model.coefficients:
                _, tangent = beam.response(model.coefficients, state.q[self.nodal_dofs])
                pulled = np.einsum("ijn,jn->in", tangent.reshape(6, 6, -1), q[self.nodal_dofs]).ravel()
            if model.rods:
                rods, x = model.rods.linearise(state, model.rods.balance(state)), q[model.exact_dofs]
                by_rods = np.einsum("ijn,jn->in", rods.tangent.reshape(OWN, OWN, -1), x)
                pulled = np.concatenate([pulled, by_rods.ravel()])
                for part in rods.cut:
                    own[model.rods.slots(part.pairs)] += part.tangent[OWN:, :OWN] @ x[:, part.element]
            dofs = np.concatenate([self.closed_dofs, self.exact_dofs])
            nodal = nodal + np.bincount(dofs, weights=pulled, minlength=model.dof_count)
        return np.concatenate([nodal[model.free], own])

    def prescribed_rate(self) -> Array:
        """Derivative of the prescribed displacements in the load parameter, over all degrees of freedom."""
        q = np.zeros(self.model.dof_count)
        q[self.model.fixed] = self.model.fixed_values
        return q

    def energy(self, state: State) -> float:
        """Strain energy of a state in equilibrium."""
        model = self.model
        total = 0.0
        if model.coefficients:
            total += float(beam.energy(model.coefficients, state.q[self.nodal_dofs]).sum())
        if model.rods:
            total += model.rods.energy(state)
        for k, (pair, touch) in enumerate(zip(model.pairs, state.touches, strict=True)):
            if touch is None or pair.cuts:
                continue
            p, x, lever = self._place(pair, touch, state)
            coupling = pair.law.coupling
            total += pair.law.energy(p, x, lever, touch.xi, touch.force, pair.side, pair.pair.offset)
            for other in state.touches[:k]:
                if coupling and other is not None and other.element == touch.element:
                    dot = touch.force[0] * other.force[0] + touch.force[1] * other.force[1]
                    total += coupling.dent(p, touch.xi, other.xi) * dot
        return total

    def _place(
        self, pair: PairModel, touch: Touch, state: State
    ) -> tuple[Any, list[float], tuple[float, float]]:
        """Constants and displacements of the owner, and the vector from the node to its end i."""
        model = self.model
        cx, cy = model.node_position(pair, state.q, state.load_parameter)
        x = state.q[model.dofs[:, touch.element]].tolist()
        start_x, start_y = model.element_start[touch.element]
        return model.element[touch.element], x, (start_x + x[0] - cx, start_y + x[1] - cy)

    def _contact(self, pair: PairModel, touch: Touch, state: State) -> tuple[Array, Array]:
        p, x, lever = self._place(pair, touch, state)
        return pair.law.response(p, x, lever, touch.xi, touch.force, pair.side, pair.pair.offset)

    def _cross(self, values: Array, border: Border) -> None:
        """Couple beam ends that touch chord elements, whose equations lie in the border."""
        model, right, below, corner = self.model, border.right, border.below, border.corner
        right += np.bincount(self.scatter_right, values, self.size + 1)[:-1].reshape(right.shape)
        below += np.bincount(self.scatter_below, values, self.size + 1)[:-1].reshape(below.shape)
        for pair, e, block in border.coupled:
            eq, node_eq = model.element_equations[:, e], model.equation[3 * pair.node : 3 * pair.node + 2]
            free = node_eq < model.equations
            unknown = (node_eq - model.banded)[free]
            right[np.ix_(eq, unknown)] += block[:6, 6:8][:, free]
            right[np.ix_(node_eq, unknown)] += block[6:8, 6:8][:, free]
            below[np.ix_(unknown, eq)] += block[6:8, :6][free]
        own = slice(model.banded, model.equations)
        corner[: model.border_dofs] = right[own]
        corner[model.border_dofs :, : model.border_dofs] = below[model.border_dofs :, own]

    def solve(self, system: Linearisation, *more: Array) -> Array | None:
        """Solve the linear system.

        Parameters
        ----------
        system : Linearisation
            Residual and tangent.
        more : ndarray, shape (equations + contact unknowns,)
            Right-hand sides besides the residual's negative.

        Returns
        -------
        ndarray, shape (equations + contact unknowns, 1 + right-hand sides) or None
            The first column is the Newton step; None if the tangent is singular.
        """
        model = self.model
        banded, border, count = model.banded, model.border, 1 + len(more)
        rhs = np.empty((banded, count + border), order="F")
        tangent = system.tangent
        residual = system.residual if tangent.carried is None else system.residual + tangent.carried
        given = np.stack([-residual, *more], axis=1)
        if self.units:
            tangent, given = self.units.without(tangent, given)
        rhs[:, :count] = given[:banded]
        rhs[:, count:] = tangent.right[:banded]
        lu, _, X, info = lapack().dgbsv(self.k, self.k, tangent.band.T, rhs, overwrite_b=True)
        if border and (
            info != 0 or (np.abs(lu[2 * self.k]) <= _WEAK * np.abs(tangent.band).max(axis=1)).any()
        ):
            return self._solve_whole(tangent, given)
        if info != 0:
            return None
        if not border:
            return self._with_units(X)
        reduced = tangent.below[:, :banded] @ X
        _, _, z, info = lapack().dgesv(
            tangent.corner - reduced[:, count:], given[banded:] - reduced[:, :count]
        )
        if info != 0:
            return None
        return self._with_units(np.concatenate([X[:, :count] - X[:, count:] @ z, z]))

    def _with_units(self, x: Array) -> Array:
        return x if self.units is None else x * self.units.columns[:, None]

    def _solve_whole(self, tangent: Bordered, given: Array) -> Array | None:
        """Solve without the division into band and border: beams that only their contacts hold have a singular band."""
        from scipy.sparse.linalg import splu

        try:
            lu = splu(self.whole(tangent))
        except RuntimeError:
            return None
        return self._with_units(lu.solve(given))

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
