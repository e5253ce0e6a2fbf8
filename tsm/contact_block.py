"""Border of the linear system, which holds the contacts, and the units in which the system is solved."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.rods.layout import CUT, OWN
from tsm.rods.records import CutElement
from tsm.state import Touch

if TYPE_CHECKING:
    from tsm.model import Model
    from tsm.pairs import PairModel


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


class Units:
    """Units of the equations and unknowns, needed because exact elements put lengths, forces and angles into one matrix.

    ``model``: model whose longest beam and largest ``EI/L^2`` are the units. ``k``: bandwidth.
    """

    def __init__(self, model: Model, k: int) -> None:
        self.columns, self.rows = model.units, 1 / model.row_units
        banded, last = model.banded, model.equations
        column, entry = np.indices((banded, 3 * k + 1))
        row = column + entry - 2 * k
        inside = (row >= 0) & (row < banded)
        self.band = np.where(inside, self.columns[column] * self.rows[np.where(inside, row, 0)], 0.0)
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
    ``residual, condensed_residual`` (contact unknowns,): residuals of the contacts, and their contribution
        after the unknowns inside elements are eliminated.
    ``forces``: force on the beam of every closed pair.
    ``pushed``: first degrees of freedom of the beam ends that touch, with the reaction (2,) on each.
    ``stiffest``: largest stiffness of a contact whose force follows from the displacements.
    ``crowded``: whether two nodes touch one element whose matrix knows a single contact.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.right = np.zeros((model.equations + 1, model.border))
        self.below = np.zeros((model.border, model.equations + 1))
        self.corner = np.zeros((model.border, model.border))
        self.residual = np.zeros(model.contact_unknowns)
        self.condensed_residual = np.zeros(model.contact_unknowns)
        self.forces: dict[int, tuple[float, float]] = {}
        self.pushed: list[tuple[int, Array]] = []
        self.coupled: list[tuple[PairModel, int, Array]] = []
        self.closed: dict[int, list[tuple[PairModel, Touch]]] = {}
        self.stiffest = 0.0
        self.crowded = False

    def leave_open(self, pair: PairModel) -> None:
        """Decouple the unknowns of an open pair: 1 on the diagonal, zeros elsewhere."""
        if pair.slot >= 0:
            slots = self._slots(pair)
            self.corner[slots, slots] = np.eye(pair.element_type.contact_unknowns)

    def close(self, k: int, pair: PairModel, touch: Touch, gradient: Array, block: Array) -> None:
        """Enter a closed pair."""
        model, e = self.model, touch.element
        self.forces[k] = (float(gradient[6]), float(gradient[7]))
        if pair.node >= 0:
            self.pushed.append((3 * pair.node, gradient[6:8]))
        others = self.closed.setdefault(e, [])
        if pair.slot < 0:
            self.stiffest = max(self.stiffest, float(np.abs(block[6:8, 6:8]).max()))
            self.crowded |= len(others) > 0
            if pair.node >= 0:
                self.coupled.append((pair, e, block))
        else:
            slots, eq = self._slots(pair), model.element_equations[:, e]
            self.right[eq, slots], self.below[slots, eq] = block[:6, 8:], block[8:, :6]
            if pair.node >= 0:
                eq = model.equation[3 * pair.node : 3 * pair.node + 2]
                self.right[eq, slots], self.below[slots, eq] = block[6:8, 8:], block[8:, 6:8]
            self.corner[slots, slots] += block[8:, 8:]
            self.residual[pair.slots] += gradient[8:]
            for other, earlier in others:
                self._share(model.element[e], (other, earlier), (pair, touch))
        others.append((pair, touch))

    def cut(self, contacts: dict[int, list[Any]], touches: tuple[Touch | None, ...]) -> None:
        """Enter the residuals and forces of contacts that cut their elements."""
        for k, rows in contacts.items():
            pair, touch = self.model.pairs[k], touches[k]
            assert touch is not None, "a cut is a closed contact"
            self.residual[pair.slots] = rows
            self.forces[k] = touch.force
            if pair.node >= 0:
                self.pushed.append((3 * pair.node, np.array(touch.force)))

    def cut_element(self, part: CutElement, dofs: Array) -> None:
        """Enter the tangent of the contacts that cut an element with given degrees of freedom."""
        model, tangent = self.model, part.tangent
        eq = model.equation[dofs]
        own = [(model.pairs[k], slice(OWN + CUT * n, OWN + CUT * (n + 1))) for n, k in enumerate(part.pairs)]
        for pair, rows in own:
            slots = self._slots(pair)
            self.right[eq, slots], self.below[slots, eq] = tangent[:OWN, rows], tangent[rows, :OWN]
            self.condensed_residual[pair.slots] = tangent[rows, -1]
            for other, columns in own:
                self.corner[slots, self._slots(other)] = tangent[rows, columns]
            if pair.node >= 0:
                for i in range(2):
                    equation = model.equation[3 * pair.node + i]
                    self.right[equation, slots.start + i] += 1
                    self.below[slots.start + i, equation] -= 1

    def _share(self, p: Any, first: tuple[PairModel, Touch], second: tuple[PairModel, Touch]) -> None:
        """Couple two contacts on one element: each force deflects the element at the other contact."""
        (one, a), (two, b) = first, second
        coupling = one.law.coupling
        assert coupling is not None, "both have unknowns"
        if coupling.friction is not None and (a.grip is not None or b.grip is not None):
            rubs = (one.rub(a), two.rub(b))
            gradient, block = coupling.friction.crossing(p, (a.xi, b.xi), a.force, b.force, rubs)
        else:
            gradient, block = coupling.crossing(p, (a.xi, b.xi), a.force, b.force)
        rows = (one.slots, two.slots)
        parts = (slice(0, 3), slice(3, 6))
        for own, part in zip(rows, parts, strict=True):
            self.residual[own] += gradient[part]
        for pair_i, part_i in zip((one, two), parts, strict=True):
            for pair_j, part_j in zip((one, two), parts, strict=True):
                self.corner[self._slots(pair_i), self._slots(pair_j)] += block[part_i, part_j]

    def _slots(self, pair: PairModel) -> slice:
        start = pair.slot + self.model.border_dofs
        return slice(start, start + pair.element_type.contact_unknowns)
