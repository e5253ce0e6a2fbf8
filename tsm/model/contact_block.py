"""Border of the linear system, which holds the contacts, and the units in which the system is solved."""

from __future__ import annotations

from copy import copy
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from tsm.elements.contact_law import crossing
from tsm.elements.properties import Array
from tsm.model.numbering import Numbering
from tsm.model.pairs import PairModel
from tsm.model.state import Touch


class Bordered(NamedTuple):
    """Tangent, a band with a border."""

    band: Array  # LAPACK band storage, one row per column of the matrix; shape (banded, ldab)
    # right, below: border columns and rows; shapes (equations + 1, border), (border, equations + 1)
    right: Array
    below: Array
    # matrix of the border's rows and columns. An open contact has 1 on its diagonal and zeros elsewhere;
    # shape (border, border)
    corner: Array
    # contribution of the residual inside exact elements after the inner unknowns are eliminated; shape
    # (equations + contact unknowns,), or 0
    condensed_residual: Array | float
    groups: tuple[Any, ...]  # tangents of the element groups
    contacts: ContactBlock


class Units:
    """Units of the equations and unknowns, needed because exact elements put lengths, forces and angles into one matrix.

    ``model``: model whose longest beam and largest ``EI/L^2`` are the units. ``k``: bandwidth.
    """

    def __init__(self, model: Numbering, k: int) -> None:
        self.columns, self.rows = model.units, 1 / model.row_units
        banded, last = model.banded, model.equations
        rows = np.pad(self.rows[:banded], (2 * k, k))
        self.band = self.columns[:banded, None] * sliding_window_view(rows, 3 * k + 1)
        self.right = np.append(self.rows[:last], 0.0)[:, None] * self.columns[banded:]
        self.below = self.rows[banded:, None] * np.append(self.columns[:last], 0.0)
        self.corner = self.rows[banded:, None] * self.columns[banded:]

    def without(self, tangent: Bordered, sides: Array) -> tuple[Bordered, Array]:
        """Tangent and right-hand sides as plain numbers."""
        plain = tangent._replace(
            band=tangent.band * self.band,
            right=tangent.right * self.right,
            below=tangent.below * self.below,
            corner=tangent.corner * self.corner,
        )
        return plain, sides * self.rows[:, None]


class ContactBlock:
    """Unknowns and residuals of the contacts while the element groups enter them.

    ``right, below, corner``: border of the tangent, see `Bordered`.
    ``residual, condensed_residual, by_load`` (contact unknowns,): residuals of the contacts, their contribution
        after the unknowns inside elements are eliminated, and their derivative by loads along the elements.
    ``forces``: force on the beam of every closed pair.
    ``blocks``: touched element of every closed pair, and derivatives over element (6), node (2) and the contact's
        unknowns; of exact elements the rows of the contact, and the columns of element and node.
    ``pushed``: first degrees of freedom of the beam ends that touch, with the reaction (2,) on each.
    ``stiffest``: largest stiffness of a contact whose force follows from the displacements.
    """

    def __init__(self, model: Numbering) -> None:
        self.model = model
        self.right = np.zeros((model.equations + 1, model.border))
        self.below = np.zeros((model.border, model.equations + 1))
        self.corner = np.zeros((model.border, model.border))
        self.residual, self.condensed_residual, self.by_load = np.zeros((3, model.contact_unknowns))
        self.forces: dict[int, tuple[float, float]] = {}
        self.blocks: dict[int, tuple[int, Array]] = {}
        self.pushed: list[tuple[int, Array]] = []
        self.closed: dict[int, list[tuple[PairModel, Touch]]] = {}
        self.stiffest = 0.0

    def copy(self) -> ContactBlock:
        """What the elements enter at a configuration, for their tangents to be added."""
        other = copy(self)
        other.right, other.below, other.corner = self.right.copy(), self.below.copy(), self.corner.copy()
        other.blocks = self.blocks.copy()
        return other

    def leave_open(self, pair: PairModel) -> None:
        """Decouple the unknowns of an open pair: 1 on the diagonal, zeros elsewhere."""
        if pair.slot >= 0:
            slots = self.border_of(pair)
            self.corner[slots, slots] = np.eye(pair.target.kind.contact_unknowns)

    def enter(self, k: int, pair: PairModel, force: tuple[float, float], rows: Any) -> None:
        """Enter force and residuals of a closed pair."""
        self.forces[k] = force
        self.residual[pair.slots] += rows
        if pair.node >= 0:
            self.pushed.append((3 * pair.node, np.array(force)))

    def close(self, k: int, pair: PairModel, touch: Touch, gradient: Array, block: Array) -> None:
        """Enter a closed pair on an element in closed form."""
        model, e = self.model, touch.element
        self.enter(k, pair, (float(gradient[6]), float(gradient[7])), gradient[8:])
        self.blocks[k] = e, block
        others = self.closed.setdefault(e, [])
        if pair.slot < 0:
            self.stiffest = max(self.stiffest, float(np.abs(block[6:8, 6:8]).max()))
        else:
            slots, node = self.border_of(pair), model.equation[3 * pair.node :][:2]
            self.couple(slots, model.element_equations[:, e], block[:6, 8:], block[8:, :6])
            if pair.node >= 0:
                self.couple(slots, node, block[6:8, 8:], block[8:, 6:8])
            self.corner[slots, slots] += block[8:, 8:]
            for other, earlier in others:
                self._share(model.element[e], (other, earlier), (pair, touch))
        others.append((pair, touch))

    def couple(self, slots: slice, equations: Array, columns: Array, rows: Array) -> None:
        """Add columns and rows of the border between equations of the beams and unknowns of contacts."""
        self.right[equations, slots] += columns
        self.below[slots, equations] += rows

    def _share(self, p: Any, first: tuple[PairModel, Touch], second: tuple[PairModel, Touch]) -> None:
        """Couple two contacts on one element: each force deflects the element at the other contact."""
        pairs, (a, b) = (first[0], second[0]), (first[1], second[1])
        gradient, block = crossing(pairs[0].law, p, (a.xi, b.xi), (a.force, b.force))
        parts = (slice(0, 3), slice(3, 6))
        for pair_i, part_i in zip(pairs, parts, strict=True):
            self.residual[pair_i.slots] += gradient[part_i]
            for pair_j, part_j in zip(pairs, parts, strict=True):
                self.corner[self.border_of(pair_i), self.border_of(pair_j)] += block[part_i, part_j]

    def border_of(self, pair: PairModel) -> slice:
        """Rows and columns of a pair's unknowns in the border."""
        start = pair.slot + self.model.border_dofs
        return slice(start, start + pair.target.kind.contact_unknowns)
