"""Assembly and solution of the linear system: a band with a border.

::

    [ A  B ] [ dq ]     [ r ]
    [ C  D ] [ dz ] = - [ s ]

A is the banded tangent of the beams (LAPACK ``gbsv``), the border holds the unknowns of the closed contacts; its
Schur complement is small and dense. The cost is linear in the number of elements.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgbsv, dgesv

from tsm.contact import node_position
from tsm.elements import beam
from tsm.elements.properties import Array
from tsm.model import Model, PairModel
from tsm.state import State, Touch

_EPS = float(np.finfo(float).eps)


class Linearisation(NamedTuple):
    """Residual and tangent at a configuration.

    Attributes
    ----------
    nodal : ndarray, shape (dofs,)
        Forces of beams and contacts on all degrees of freedom; on the prescribed ones, the reactions.
    residual : ndarray, shape (equations + contact unknowns,)
        Unbalanced forces, then the residuals of the contacts: position (2), direction of the force.
    band : ndarray, shape (banded, ldab)
        LAPACK band storage, one row per column of the matrix.
    right, below : ndarray, shapes (equations + 1, border), (border, equations + 1)
        Border columns and rows.
    corner : ndarray, shape (border, border)
        Where they meet; the unknowns of open contacts stand alone in it.
    forces : dict
        Force on the beam of every closed pair.
    element_force : ndarray, shape (6, elements)
        Nodal forces of the elements, contact included.
    noise : float
        Round-off of the residual by contact stiffness, ``4 eps k_c L``.
    """

    nodal: Array
    residual: Array
    band: Array
    right: Array
    below: Array
    corner: Array
    forces: dict[int, tuple[float, float]]
    element_force: Array
    noise: float


class Assembler:
    """Scatter maps of a model, made once."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.k = model.bandwidth
        self.ldab = 3 * self.k + 1
        eq, banded, last = model.element_equations, model.banded, model.equations
        shape = (6, 6, eq.shape[1])
        rows, columns = np.broadcast_to(eq[:, None], shape), np.broadcast_to(eq[None], shape)
        self.band_size = banded * self.ldab
        flat = columns * self.ldab + 2 * self.k + rows - columns
        self.scatter = np.where((rows < banded) & (columns < banded), flat, self.band_size).ravel()
        self.dofs_flat = model.dofs.ravel()
        width, height = model.border, last + 1
        self.size = width * height
        in_right = (rows < last) & (columns >= banded) & (columns < last)
        in_below = (rows >= banded) & (rows < last) & (columns < banded)
        self.scatter_right = np.where(in_right, rows * width + columns - banded, self.size).ravel()
        self.scatter_below = np.where(in_below, (rows - banded) * height + columns, self.size).ravel()

    def linearise(self, state: State, load: Array | None = None) -> Linearisation:
        """Residual and tangent at a state, under given nodal forces if any."""
        model = self.model
        force, tangent = beam.response(model.coefficients, state.q[model.dofs])
        right = np.zeros((model.equations + 1, model.border))
        corner = np.zeros((model.border, model.border))
        own = np.zeros(model.contact_unknowns)
        forces: dict[int, tuple[float, float]] = {}
        pushed: list[tuple[int, Array]] = []
        crossing: list[tuple[PairModel, int, Array]] = []
        stiffest = 0.0
        for k, (pair, touch) in enumerate(zip(model.pairs, state.touches, strict=True)):
            slots = slice(pair.slot + model.border_dofs, pair.slot + model.border_dofs + 3)
            if touch is None:
                if pair.slot >= 0:
                    corner[slots, slots] = np.eye(3)
                continue
            gradient, block = self._contact(pair, touch, state)
            e = touch.element
            if pair.slot >= 0:
                eq = model.element_equations[:, e]
                right[eq, slots] = block[:6, 8:]
                if pair.node >= 0:
                    right[model.equation[3 * pair.node : 3 * pair.node + 2], slots] = block[6:8, 8:]
                corner[slots, slots] = block[8:, 8:]
                own[pair.slot : pair.slot + 3] = gradient[8:]
            else:
                force[:, e] = tangent[:, e] = 0.0
                stiffest = max(stiffest, float(np.abs(block[6:8, 6:8]).max()))
                crossing.append((pair, e, block))
            force[:, e] += gradient[:6]
            tangent[:, e] += block[:6, :6].ravel()
            forces[k] = (float(gradient[6]), float(gradient[7]))
            if pair.node >= 0:
                pushed.append((3 * pair.node, gradient[6:8]))
        nodal = np.bincount(self.dofs_flat, weights=force.ravel(), minlength=model.dof_count)
        for dof, reaction in pushed:
            nodal[dof : dof + 2] += reaction
        if load is not None:
            nodal -= load
        values = tangent.ravel()
        band = np.bincount(self.scatter, weights=values, minlength=self.band_size + 1)[:-1]
        below = right.T
        if model.border_dofs:
            below = self._cross(values, crossing, right, corner)
        return Linearisation(
            nodal=nodal,
            residual=np.concatenate([nodal[model.free], own]),
            band=band.reshape(model.banded, self.ldab),
            right=right,
            below=below,
            corner=corner,
            forces=forces,
            element_force=force,
            noise=4 * _EPS * stiffest * model.length,
        )

    def _contact(self, pair: PairModel, touch: Touch, state: State) -> tuple[Array, Array]:
        model = self.model
        e = touch.element
        cx, cy = node_position(model, pair, state.q, state.load_parameter)
        x = state.q[model.dofs[:, e]].tolist()
        start_x, start_y = model.element_start[e]
        lever = (start_x + x[0] - cx, start_y + x[1] - cy)
        return pair.element_type.contact(
            model.element[e], x, lever, touch.xi, touch.force, pair.side, pair.pair.offset
        )

    def _cross(
        self, values: Array, crossing: list[tuple[PairModel, int, Array]], right: Array, corner: Array
    ) -> Array:
        """Couple beam ends that touch chord elements, whose equations lie in the border; return the border's rows."""
        model = self.model
        below = right.T.copy()
        right += np.bincount(self.scatter_right, values, self.size + 1)[:-1].reshape(right.shape)
        below += np.bincount(self.scatter_below, values, self.size + 1)[:-1].reshape(below.shape)
        for pair, e, block in crossing:
            if pair.node < 0:
                continue
            eq, node_eq = model.element_equations[:, e], model.equation[3 * pair.node : 3 * pair.node + 2]
            free = node_eq < model.equations
            unknown = (node_eq - model.banded)[free]
            right[np.ix_(eq, unknown)] += block[:6, 6:8][:, free]
            right[np.ix_(node_eq, unknown)] += block[6:8, 6:8][:, free]
            below[np.ix_(unknown, eq)] += block[6:8, :6][free]
        own = slice(model.banded, model.equations)
        corner[: model.border_dofs] = right[own]
        corner[model.border_dofs :, : model.border_dofs] = right[own, model.border_dofs :].T
        return below

    def solve(self, system: Linearisation) -> tuple[Array, Array] | None:
        """Newton step ``(dq of the equations, dz of the contacts' unknowns)``, None if the tangent is singular."""
        model = self.model
        banded, border = model.banded, model.border
        rhs = np.empty((banded, 1 + border), order="F")
        rhs[:, 0] = system.residual[:banded]
        rhs[:, 1:] = system.right[:banded]
        _, _, X, info = dgbsv(self.k, self.k, system.band.T, rhs, overwrite_ab=True, overwrite_b=True)
        if info != 0:
            return None
        if not border:
            return -X[:, 0], np.zeros(0)
        reduced = system.below[:, :banded] @ X
        _, _, z, info = dgesv(system.corner - reduced[:, 1:], reduced[:, 0] - system.residual[banded:])
        if info != 0:
            return None
        dq = -X[:, 0] - X[:, 1:] @ z
        if model.border_dofs:
            dq = np.concatenate([dq, z[: model.border_dofs]])
        return dq, z[model.border_dofs :]
