"""Residual and tangent of many structures: `Assembler` with the structure as last axis.

Element forces and tangents are in the reduced variables of `beam` and of the contact law. Contacts are added to the forces of their
element, and one sparse product spreads the sum over the equations.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.batch.constants import BatchConstants
from tsm.batch.elimination import eliminate, reach, row_length
from tsm.elements import Coupling, beam
from tsm.elements.contact_law import UPPER
from tsm.elements.properties import Array, Properties
from tsm.model import Model
from tsm.pairs import PairModel

OWN = 3
"""Unknowns of a contact: force (x, y) and arc position."""


class Configurations(NamedTuple):
    """Configurations of N structures with p pairs.

    Attributes
    ----------
    q : ndarray, shape (dofs, N)
        Displacements of the nodes.
    closed : ndarray of bool, shape (p, N)
        Whether the pairs are closed; what follows has no meaning for open pairs.
    element : ndarray of int, shape (p, N)
        Owners.
    xi : ndarray, shape (p, N)
        Positions on them.
    force : ndarray, shape (p, 2, N)
        Forces on the beam.
    node : ndarray, shape (p, 2, N)
        Positions of the pins; of pairs of beam ends unused.
    """

    q: Array
    closed: Array
    element: Array
    xi: Array
    force: Array
    node: Array


class BatchLinearisation(NamedTuple):
    """Residual and tangent.

    Attributes
    ----------
    nodal : ndarray, shape (dofs, N)
        Forces on the nodes.
    contacts : ndarray, shape (contact unknowns, N)
        Residuals of the contacts.
    entries : ndarray, shape (10, e, N)
        Tangents of the elements, `beam.PAIRS`.
    right : ndarray, shape (1 + contact unknowns, equations + 1, N)
        Room for the residual, then the columns of the border.
    corner : ndarray, shape (contact unknowns, contact unknowns, N)
        Where border and border meet.
    """

    nodal: Array
    contacts: Array
    entries: Array
    right: Array
    corner: Array


def _over(a: int, b: int, columns: Array) -> Array:
    """Coefficients of the 28 entries of `UPPER` in entry a, b of ``columns^T H columns``."""
    row = np.zeros(len(UPPER))
    for n, (i, j) in enumerate(UPPER):
        row[n] = columns[i, a] * columns[j, b] + (i != j) * columns[j, a] * columns[i, b]
    return row


# dx, dy, theta_i, theta_j, F_x, F_y, xi by dx, dy, m, h, and by element (6) and contact (3)
_BENT = np.zeros((7, 4))
_BENT[[0, 1, 2, 2, 3, 3], [0, 1, 2, 3, 2, 3]] = 1, 1, 1, 1, 1, -1
_MOVED = np.zeros((7, 9))
_MOVED[[0, 0, 1, 1, 2, 3, 4, 5, 6], [0, 3, 1, 4, 2, 5, 6, 7, 8]] = -1, 1, -1, 1, 1, 1, 1, 1, 1
# minus the Hessian, as in the Lagrangian: of the beam, of element and contact, of the contact
_TANGENT = -np.array(
    [_over(a, b, _BENT) for a, b in beam.PAIRS]
    + [_over(6 + c, a, _MOVED) for c in range(OWN) for a in range(6)]
    + [_over(6 + c, 6 + d, _MOVED) for c in range(OWN) for d in range(OWN)]
)
_FORCE = -np.concatenate([_BENT.T, np.eye(7)[4:]])


def coupling_of(pair: PairModel) -> Coupling:
    """Contact law of a pair for many contacts at a time."""
    assert pair.law.coupling is not None, "batches are of contacts with unknowns"
    return pair.law.coupling


class Equations:
    """Scatter maps of a topology, made once.

    Parameters
    ----------
    model : Model
        Numbering, the same for all structures.
    """

    def __init__(self, model: Model) -> None:
        from scipy.sparse import csr_array

        self.model = model
        elements = len(model.element_nodes)
        element, entry, i = _everything(elements, 4, 6)
        where = (model.dofs[i, element], entry * elements + element)
        self.gather = csr_array((beam.GATHER[i, entry], where), shape=(model.dof_count, 4 * elements))
        self.gather.eliminate_zeros()
        element, entry, i, j = _everything(elements, 10, 6, 6)
        values = beam.SPREAD.reshape(6, 6, 10)[i, j, entry]
        rows, columns = model.element_equations[i, element], model.element_equations[j, element]
        keep = (columns <= rows) & (rows < model.banded) & (values != 0)
        self.last = reach(rows[keep], columns[keep], model.banded)
        length = row_length(model.bandwidth)
        where = ((columns * length + rows - columns)[keep], (entry * elements + element)[keep])
        shape = (model.banded * length, 10 * elements)
        self.spread = csr_array((values[keep], where), shape=shape)

    def linearise(self, constants: BatchConstants, iterate: Configurations) -> BatchLinearisation:
        """Residual and tangent at some configurations."""
        model, count = self.model, iterate.q.shape[-1]
        force, entries = beam.reduced_response(constants.coefficients, iterate.q[model.dofs])
        unknowns = model.contact_unknowns
        contacts = np.zeros((unknowns, count))
        right = np.zeros((1 + unknowns, model.equations + 1, count))
        corner = np.zeros((unknowns, unknowns, count))
        closings = [self._contact(constants, iterate, k) for k in range(len(model.pairs))]
        for which, e, gradient, block in closings:
            force[:, e, which] += gradient[:4]
            entries[:, e, which] += block[:10]
        nodal = self.gather @ force.reshape(-1, count)
        for k, closing in enumerate(closings):
            self._enter(constants, iterate, k, closing, (nodal, contacts, right, corner))
        for k in range(len(closings)):
            for other in range(k):
                self._share(constants, iterate, (other, k), contacts, corner)
        return BatchLinearisation(nodal, contacts, entries, right, corner)

    def _contact(
        self, constants: BatchConstants, iterate: Configurations, k: int
    ) -> tuple[Array, Array, Array, Array]:
        """Structures in which pair k is closed, its owner, gradient (7, m) and tangent (37, m) in reduced variables."""
        which = np.flatnonzero(iterate.closed[k])
        e = iterate.element[k, which]
        p = properties_of(constants, e, which)
        x = iterate.q[self.model.dofs[:, e], which]
        offset = constants.offset[k, which]
        gradient, hessian = coupling_of(self.model.pairs[k]).jet(
            p,
            x,
            iterate.xi[k, which],
            iterate.force[k][:, which],
            constants.side[k, which],
            offset if offset.any() else 0.0,
        )
        gradient, block = _FORCE @ gradient, _TANGENT @ hessian
        gradient[6] /= p.l0
        block[[22, 23, 24, 25, 26, 27, 30, 33, 34, 35, 36]] /= p.l0
        block[36] /= p.l0
        return which, e, gradient, block

    def _enter(
        self,
        constants: BatchConstants,
        iterate: Configurations,
        k: int,
        closing: tuple[Array, Array, Array, Array],
        system: tuple[Array, Array, Array, Array],
    ) -> None:
        """Enter pair k where it is closed; where it is open, its unknowns stand alone."""
        model, pair = self.model, self.model.pairs[k]
        which, e, gradient, block = closing
        nodal, contacts, right, corner = system
        slots = pair.slots
        for n in range(slots.start, slots.stop):
            corner[n, n] = ~iterate.closed[k]
        if not len(e):
            return
        dofs, F = model.dofs[:, e], iterate.force[k][:, which]
        start = constants.coordinates[model.element_nodes[e, 0], :, which].T + iterate.q[dofs[:2], which]
        nodal[dofs[:2], which] -= F
        node = self.node(constants, iterate, k, which)
        contacts[slots, which] = gradient[4:]
        contacts[slots.start : slots.start + 2, which] -= start - node
        columns = block[10:28].reshape(OWN, 6, -1)
        columns[0, 0] -= 1
        columns[1, 1] -= 1
        equations = model.element_equations[:, e]
        for c in range(OWN):
            right[1 + pair.slot + c, equations, which] = columns[c]
        corner[slots, slots, which] = block[28:].reshape(OWN, OWN, -1)
        if pair.node >= 0:
            dof = 3 * pair.node
            nodal[dof : dof + 2, which] += F
            for c in range(2):
                right[1 + pair.slot + c, model.equation[dof + c], which] += 1.0

    def _share(
        self,
        constants: BatchConstants,
        iterate: Configurations,
        pairs: tuple[int, int],
        contacts: Array,
        corner: Array,
    ) -> None:
        """Let two contacts feel each other's dent where they are on one element."""
        together = iterate.closed[list(pairs)].all(axis=0) & (
            iterate.element[pairs[0]] == iterate.element[pairs[1]]
        )
        ordered = iterate.xi[pairs[0]] <= iterate.xi[pairs[1]]
        for (one, two), where in ((pairs, ordered), (pairs[::-1], ~ordered)):
            which = np.flatnonzero(together & where)
            if not len(which):
                continue
            p = properties_of(constants, iterate.element[one, which], which)
            xi = (iterate.xi[one, which], iterate.xi[two, which])
            coupling = coupling_of(self.model.pairs[one])
            gradient, block = coupling.crossing(
                p, xi, iterate.force[one][:, which], iterate.force[two][:, which]
            )
            rows = np.r_[self.model.pairs[one].slots, self.model.pairs[two].slots]
            contacts[rows[:, None], which] += gradient
            corner[rows[:, None, None], rows[:, None], which] += block

    def node(self, constants: BatchConstants, iterate: Configurations, k: int, which: Array) -> Array:
        """Positions of pair k's contacting node in some structures, shape (2, m)."""
        pair = self.model.pairs[k]
        if pair.pin is not None:
            pin: Array = iterate.node[k][:, which]
            return pin
        dof = 3 * pair.node
        position: Array = constants.coordinates[pair.node][:, which] + iterate.q[dof : dof + 2][:, which]
        return position

    def solve(self, system: BatchLinearisation) -> tuple[Array, Array, Array]:
        """Newton's step of the equations and of the contact unknowns, and the sign of the determinant."""
        model, count = self.model, system.nodal.shape[-1]
        band = self.spread @ system.entries.reshape(-1, count)
        right = system.right[:, : model.banded]
        np.negative(system.nodal[model.free], out=right[0])
        band = band.reshape(model.banded, -1, count)
        return eliminate(band, self.last, right, system.corner, -system.contacts)


def _everything(*sizes: int) -> list[Array]:
    """All combinations of numbers below the sizes, flat."""
    return [part.ravel() for part in np.indices(sizes)]


def properties_of(constants: BatchConstants, e: Array, which: Array) -> Properties:
    """Constants of one element in each of the structures `which`."""
    return Properties(*(column[e, which] for column in constants.properties))
