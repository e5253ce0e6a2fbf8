"""Assembly and solution of the linear system: a band with a border.

::

    [ A  B ] [ dq ]     [ r ]
    [ C  D ] [ dz ] = - [ s ]

A is the banded tangent of the beams (LAPACK ``gbsv``), the border holds the unknowns of the closed contacts; its
Schur complement is small and dense. The cost is linear in the number of elements.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dgbsv

from tsm.contact import node_position
from tsm.elements import beam
from tsm.elements.properties import Array
from tsm.model import Model, PairModel
from tsm.state import State, Touch


@dataclass(frozen=True, kw_only=True)
class Linearisation:
    """Residual and tangent at a configuration.

    Attributes
    ----------
    nodal : ndarray, shape (dofs,)
        Forces of beams and contacts on all degrees of freedom; on the prescribed ones, the reactions.
    residual : ndarray, shape (equations + contact unknowns,)
        Unbalanced forces, then the residuals of the closed contacts: position (2), direction of the force.
    band : ndarray, shape (banded, ldab)
        LAPACK band storage, one row per column of the matrix.
    right, below : ndarray, shapes (equations + 1, border), (border, equations + 1)
        Border columns and rows.
    corner : ndarray, shape (contact unknowns, contact unknowns)
        Derivatives of the contacts' own residuals with respect to their own unknowns.
    active : ndarray of int
        Border unknowns in use.
    forces : dict
        Force on the beam of every closed pair.
    element_force : ndarray, shape (elements, 6)
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
    active: Array
    forces: dict[int, tuple[float, float]]
    element_force: Array
    noise: float


class Assembler:
    """Scatter maps of a model, made once."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.k = model.bandwidth
        self.ldab = 3 * self.k + 1
        eq, banded = model.element_equations, model.banded
        rows, columns = (
            np.broadcast_to(eq[:, :, None], (*eq.shape, 6)),
            np.broadcast_to(eq[:, None, :], (*eq.shape, 6)),
        )
        self.band_size = banded * self.ldab
        flat = columns * self.ldab + 2 * self.k + rows - columns
        in_band = (rows < banded) & (columns < banded)
        self.scatter = np.where(in_band, flat, self.band_size).ravel()
        self.has_border = model.border_dofs > 0
        in_right = (rows < model.equations) & (columns >= banded) & (columns < model.equations)
        in_below = (rows >= banded) & (rows < model.equations) & (columns < banded)
        width, height = model.border, model.equations + 1
        self.scatter_right = np.where(in_right, rows * width + columns - banded, height * width).ravel()
        self.scatter_below = np.where(in_below, (rows - banded) * height + columns, height * width).ravel()
        self.dofs_flat = model.dofs.ravel()

    def linearise(self, state: State, load: Array | None = None) -> Linearisation:
        """Residual and tangent at a state, under given nodal forces if any."""
        model = self.model
        x = state.q[model.dofs]
        force = np.empty((len(model.dofs), 6))
        tangent = np.empty((len(model.dofs), 6, 6))
        for group in model.groups:
            part = group.elements
            force[part], tangent[part] = beam.response(group.properties, group.coefficients, x[part])
        right = np.zeros((model.equations + 1, model.border))
        below = np.zeros((model.border, model.equations + 1))
        corner = np.zeros((model.contact_unknowns, model.contact_unknowns))
        own = np.zeros(model.contact_unknowns)
        at_nodes: list[tuple[int, Array]] = []
        forces: dict[int, tuple[float, float]] = {}
        stiffest = 0.0
        active = list(range(model.border_dofs))
        for k, (pair, touch) in enumerate(zip(model.pairs, state.touches, strict=True)):
            if touch is None:
                continue
            gradient, block = self._contact(pair, touch, state)
            e = touch.element
            if pair.slot < 0:
                force[e], tangent[e] = 0.0, 0.0
                stiffest = max(stiffest, float(np.abs(block[6:8, 6:8]).max()))
            force[e] += gradient[:6]
            tangent[e] += block[:6, :6]
            forces[k] = (float(gradient[6]), float(gradient[7]))
            if pair.node >= 0:
                at_nodes.append((pair.node, gradient[6:8]))
            slots = slice(pair.slot, pair.slot + 3) if pair.slot >= 0 else None
            if slots is not None:
                own[slots] = gradient[8:]
                active.extend(range(model.border_dofs + pair.slot, model.border_dofs + pair.slot + 3))
            self._border(pair, block, e, slots, right, below, corner)
        nodal = np.bincount(self.dofs_flat, weights=force.ravel(), minlength=model.dof_count)
        for node, reaction in at_nodes:
            nodal[3 * node : 3 * node + 2] += reaction
        if load is not None:
            nodal -= load
        values = tangent.ravel()
        band = np.bincount(self.scatter, weights=values, minlength=self.band_size + 1)[:-1]
        if self.has_border:
            size = right.size
            right += np.bincount(self.scatter_right, values, size + 1)[:-1].reshape(right.shape)
            below += np.bincount(self.scatter_below, values, size + 1)[:-1].reshape(below.shape)
        return Linearisation(
            nodal=nodal,
            residual=np.concatenate([nodal[model.free], own]),
            band=band.reshape(model.banded, self.ldab),
            right=right,
            below=below,
            corner=corner,
            active=np.array(active, dtype=int),
            forces=forces,
            element_force=force,
            noise=4 * float(np.finfo(float).eps) * stiffest * model.length,
        )

    def _contact(self, pair: PairModel, touch: Touch, state: State) -> tuple[Array, Array]:
        model = self.model
        e = touch.element
        cx, cy = node_position(model, pair, state.q, state.load_parameter)
        i = model.element_nodes[e, 0]
        x = state.q[model.dofs[e]].tolist()
        lever = (float(model.coordinates[i, 0]) + x[0] - cx, float(model.coordinates[i, 1]) + x[1] - cy)
        return pair.element_type.contact(
            model.element[e], x, lever, touch.xi, touch.force, pair.side, pair.pair.offset
        )

    def _border(
        self,
        pair: PairModel,
        block: Array,
        e: int,
        slots: slice | None,
        right: Array,
        below: Array,
        corner: Array,
    ) -> None:
        """Couple element, contacting node and the contact's own unknowns across the band."""
        model = self.model
        eq = model.element_equations[e]
        shift = model.border_dofs
        node_eq = model.equation[[3 * pair.node, 3 * pair.node + 1]] if pair.node >= 0 else None
        if slots is not None:
            columns = slice(slots.start + shift, slots.stop + shift)
            right[eq, columns] += block[:6, 8:]
            below[columns, eq] += block[8:, :6]
            corner[slots, slots] += block[8:, 8:]
            if node_eq is not None:
                right[node_eq, columns] += block[6:8, 8:]
                below[columns, node_eq] += block[8:, 6:8]
        elif node_eq is not None:
            free = node_eq < model.equations
            own = (node_eq - model.banded)[free]
            right[np.ix_(eq, own)] += block[:6, 6:8][:, free]
            right[np.ix_(node_eq, own)] += block[6:8, 6:8][:, free]
            below[np.ix_(own, eq)] += block[6:8, :6][free]

    def solve(self, system: Linearisation) -> tuple[Array, Array] | None:
        """Newton step ``(dq of the equations, dz of the contacts' unknowns)``, None if the tangent is singular."""
        model = self.model
        active, banded = system.active, model.banded
        rhs = np.empty((banded, 1 + len(active)), order="F")
        rhs[:, 0] = -system.residual[:banded]
        rhs[:, 1:] = system.right[:banded, active]
        _, _, X, info = dgbsv(self.k, self.k, system.band.T, rhs, overwrite_ab=True, overwrite_b=True)
        if info != 0:
            return None
        dq, dz = np.zeros(model.equations), np.zeros(model.contact_unknowns)
        dq[:banded] = X[:, 0]
        if len(active):
            C = system.below[active, :banded]
            D = np.zeros((model.border, model.border))
            D[: model.border_dofs] = system.right[banded : model.equations]
            D[model.border_dofs :, : model.border_dofs] = system.below[
                model.border_dofs :, banded : model.equations
            ]
            D[model.border_dofs :, model.border_dofs :] = system.corner
            s = system.residual[banded:][active]
            try:
                z = np.linalg.solve(D[np.ix_(active, active)] - C @ X[:, 1:], -s - C @ X[:, 0])
            except np.linalg.LinAlgError:
                return None
            dq[:banded] -= X[:, 1:] @ z
            inner = np.zeros(model.border)
            inner[active] = z
            dq[banded:], dz = inner[: model.border_dofs], inner[model.border_dofs :]
        return dq, dz
