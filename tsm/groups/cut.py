"""A contact that cuts an exact element: what it sees of the rod there, and the derivatives of its rows.

The tangent vector of the rod jumps at a contact with its force F. The contact sees the mean of both sides, which is the tangent vector under
the force ``n - F/2``, and the mean turn, which is that under the moment ``m - C/2`` with the couple C of the friction on a face.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.contact_law import Here
from tsm.elements.properties import Array, cosine, sine
from tsm.elements.rod import Course
from tsm.elements.varied import derivatives, varied
from tsm.pairs import PairModel
from tsm.state import Touch


class Section(NamedTuple):
    """Flexibilities 1/EA, 1/GA, 1/EI of one section, the natural curvature there, and what varies."""

    stretch: Any
    shear: Any
    bend: Any
    curvature: Any
    course: Course | None  # of shape (1, 1)


class Cut(NamedTuple):
    """A contact at the end of a segment."""

    s: int  # number of the segment
    pair: PairModel
    touch: Touch
    section: Section
    # angle of the section, force before (x, y), contact force (x, y), arc position, moment before, load parameter
    at: tuple[Any, ...]
    here: Here
    couple: Any  # on the axis, by which the moment falls

    def derivatives(self, unit: float, selectors: Array) -> Array:
        """Derivatives (5, n) of the point of the surface (2), the last row, the couple and the angles of `slip`.

        ``unit``: unit of the row of a stick. ``selectors`` (8, n): derivatives of what is `at` the contact.
        The last two are without friction left out.
        """
        moved = varied(self.at)
        pair, here, couple = self.pair, *seen(self.pair, self.section, moved, self.at)
        rows = [*pair.rows(self.touch.grip, moved[3:5], here, unit)]
        if self.touch.grip is not None:
            rows += [couple, pair.lever * here.shear + pair.roll * here.direction]
        stacked = np.zeros((len(rows), len(selectors) + 1), dtype=complex)
        for row, values in zip(stacked, rows, strict=True):
            row[:] = values
        by: Array = derivatives(stacked) @ selectors
        return by


def seen(pair: PairModel, section: Section, at: Any, held: tuple[Any, ...]) -> tuple[Here, Any]:
    """What a contact sees, and the couple; ``held``: where the section is known, from which it varies."""
    angle, nx, ny, Fx, Fy, arc, moment, load = at
    stretch, shear, bend, turn, course = section
    nx, ny = nx - Fx / 2, ny - Fy / 2
    if course is not None:
        on, later = arc - held[5], load - held[7]
        stretch, shear, bend = (
            value + slope[0, 0] * on for value, slope in zip(section[:3], course.slope, strict=True)
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
