"""A contact that cuts an exact element: what it sees of the rod there, and the derivatives of its rows.

The tangent vector of the rod jumps at a contact with its force F. The contact sees the mean of both sides,
which is the tangent vector under the force ``n - F/2``, and the mean turn, which is that under the moment ``m
- C/2`` with the couple C of the friction on a face.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.properties import Array, cosine, sine
from tsm.elements.rod import Course
from tsm.elements.varied import derivatives, varied
from tsm.model.contact_block import ContactBlock
from tsm.model.groups.base import ElementGroup
from tsm.model.groups.layout import CUT, OWN, chain
from tsm.model.pairs import Here, PairModel
from tsm.model.state import Touch

_NODAL = [0, 1, 2, 6, 7, 8]
"""Unknowns of an element that are its nodes'."""
_BLOCK = np.zeros((8 + CUT, 8))
_BLOCK[[8, 9], [6, 7]] = -1
_NONE = [0.0] * 8


class Section(NamedTuple):
    """Flexibilities 1/EA, 1/GA, 1/EI of one section, the natural curvature there, and what varies."""

    stretch: Any
    shear: Any
    bend: Any
    curvature: Any
    course: Course | None  # of shape (1, 1)


@dataclass(eq=False)
class Cut:
    """A contact at the end of a segment."""

    pair: PairModel
    touch: Touch
    section: Section
    # angle of the section, force before (x, y), contact force (x, y), arc position, moment before, load parameter
    at: tuple[Any, ...]
    here: Here
    couple: Any  # on the axis, by which the moment falls
    unit: float  # unit of the row of a stick

    @cached_property
    def derivatives(self) -> Array:
        """Derivatives (5, 8) of the point of the surface (2), the last row, the couple and the angles of `slip` by what is `at` the contact.

        The last two are without friction left out.
        """
        if not self.pair.pair.offset and not self.pair.rubs and self.section.course is None:
            return np.array([_NONE, _NONE, self._by_hand()])
        moved = varied(self.at)
        pair, here, couple = self.pair, *seen(self.pair, self.section, moved, self.at)
        rows = [*pair.rows(self.touch.grip, moved[3:5], here, self.unit)]
        if self.touch.grip is not None:
            rows += [couple, pair.lever * here.shear + pair.roll * here.direction]
        stacked = np.zeros((len(rows), len(self.at) + 1), dtype=complex)
        for row, values in zip(stacked, rows, strict=True):
            row[:] = values
        return derivatives(stacked)

    def _by_hand(self) -> list[float]:
        """Derivatives of ``F . T`` by what is `at` a sharp pin on a uniform rod, for speed."""
        (stretch, shear, *_), (angle, nx, ny, Fx, Fy, *_), (Tx, Ty) = self.section, self.at, self.here.tangent
        c, s, g, mx, my = math.cos(angle), math.sin(angle), stretch - shear, nx - Fx / 2, ny - Fy / 2
        turn, gq, along = 1 + g * (mx * c + my * s), g * (mx * s - my * c), g * (Fx * c + Fy * s)
        bx, by = shear * Fx + along * c, shear * Fy + along * s
        turned = Fy * (turn * c - gq * s) - Fx * (gq * c + turn * s)
        return [turned, bx, by, Tx - bx / 2, Ty - by / 2, 0.0, 0.0, 0.0]


class CutElement(NamedTuple):
    """Tangent of an element over n columns: its own and its contacts' unknowns, load parameter, inner residual."""

    element: int  # counted over the exact elements
    pairs: tuple[int, ...]  # its contact pairs in order of arc position
    slots: list[int]  # positions of their unknowns among those of all contacts
    tangent: Array  # shape (9 + 4 k, n)
    inputs: Array  # inputs of the segments by the same columns; shape (k + 1, 7 or 9, n)
    slip: dict[int, Array]  # by pair with friction: its slip rate as a linear form; shape (n,)


def seen(pair: PairModel, section: Section, at: Any, held: tuple[Any, ...]) -> tuple[Here, Any]:
    """What a contact sees, and the couple; ``held``: where the section is known, from which it varies."""
    angle, nx, ny, Fx, Fy, arc, moment, load = at
    stretch, shear, bend, turn, course = section
    nx, ny = nx - Fx / 2, ny - Fy / 2
    if course is not None:
        on, later = arc - held[5], load - held[7]
        stretch, shear, bend = (
            value + slope * on for value, slope in zip(section[:3], course.slope[:, 0, 0], strict=True)
        )
        nx, ny = (
            n - (P + q * on + rate * later)
            for n, P, q, rate in zip((nx, ny), *(part[:, 0, 0] for part in course[2:]), strict=True)
        )
    T = rod.tangent(stretch, shear, (nx, ny), angle)
    if not pair.rubs:
        return Here(arc, T, 0.0, 0.0, 0.0), 0.0
    c, s = cosine(angle), sine(angle)
    slant = np.arctan((c * T[1] - s * T[0]) / (c * T[0] + s * T[1]))
    couple = pair.lever * (Fx * T[0] + Fy * T[1]) / (T[0] * T[0] + T[1] * T[1]) ** 0.5
    return Here(arc, T, slant, angle + slant, turn + bend * (moment - couple / 2)), couple


def cut_element(element: int, cuts: dict[int, Cut], transfer: Array) -> CutElement:
    """Tangent of an element from its contacts by pair, and from the transfer (k + 1, 4, 7 or 9) of its segments."""
    count = len(cuts)
    inputs, tangent, selectors = (part.copy() for part in chain(count))
    inputs = inputs[:, : transfer.shape[2]]
    moved, slip = tangent[3:5].copy(), {}
    for n, (k, cut) in enumerate(cuts.items()):
        row = OWN + CUT * n
        out = transfer[n] @ inputs[n]
        moved += out[2:]
        inputs[n + 1, 1] = selectors[n, 6] = out[1]
        by = cut.derivatives @ selectors[n]
        tangent[row : row + 2], tangent[row + 2], tangent[row + 3] = moved + by[:2], by[2], out[0]
        if cut.touch.grip is not None:
            inputs[n + 1, 1] -= by[3]
            slip[k] = cut.pair.place(cut.here).stretch * selectors[n, 5] + by[4]
    out = transfer[count] @ inputs[count]
    tangent[3:5] = moved + out[2:]
    tangent[3, 6] = tangent[4, 7] = -1
    tangent[5], tangent[8] = out[0], out[1]
    slots = [cut.pair.slot + i for cut in cuts.values() for i in range(CUT)]
    return CutElement(element, tuple(cuts), slots, tangent, inputs, slip)


def enter(part: CutElement, group: ElementGroup, contacts: ContactBlock) -> None:
    """Enter the tangent of the contacts that cut an element."""
    model, dofs, tangent = group.model, group.dofs[:, part.element], part.tangent
    eq = model.equation[dofs]
    own = [(model.pairs[k], slice(OWN + CUT * n, OWN + CUT * (n + 1))) for n, k in enumerate(part.pairs)]
    contacts.by_load[part.slots], contacts.condensed_residual[part.slots] = tangent[OWN:, -2:].T
    for k, (pair, rows) in zip(part.pairs, own, strict=True):
        slots, block = contacts.border_of(pair), _BLOCK.copy()
        contacts.couple(slots, eq, tangent[:OWN, rows], tangent[rows, :OWN])
        for other, columns in own:
            contacts.corner[slots, contacts.border_of(other)] = tangent[rows, columns]
        block[8:, :6] = tangent[rows, _NODAL]
        contacts.blocks[k] = int(group.elements[part.element]), block
        if pair.node >= 0:
            node = model.equation[3 * pair.node :][:2]
            contacts.couple(slice(slots.start, slots.start + 2), node, np.eye(2), -np.eye(2))
