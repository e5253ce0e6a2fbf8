"""Rows of a contact that cuts an exact element: the node lies on the surface, and the force is normal to it.

The surface lies at the offset from the axis, across the mean of the tangent vectors before and after the contact; the force is normal to
that mean: ``r + offset - x_c = 0``, ``F . (r'_- + r'_+) = 0``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.properties import Array

Point = tuple[Any, Any]
Tangents = tuple[rod.Tangent, rod.Tangent]


class Explicit(NamedTuple):
    """Derivatives at a contact by the unknowns that pass neither through the section's angle nor through the forces.

    Attributes
    ----------
    vector : ndarray, shape (2, n)
        Of the sum of the tangent vectors.
    turn : ndarray, shape (n,)
        Of the mean derivative of the angle in the arc position.
    """

    vector: Array
    turn: Array


def residual(apart: Point, force: Point, tangents: Tangents, reach: float) -> list[Any]:
    """Residual of position (2) and direction.

    Parameters
    ----------
    apart : tuple of 2 numbers
        Vector from the contacting node to the axis.
    force : tuple of 2 numbers
        Force on the beam.
    tangents : tuple of rod.Tangent
        Tangent vectors before and after the contact.
    reach : float
        Offset of the surface, positive to the right.
    """
    (x, y), (tx, ty) = apart, _sum(tangents)
    if reach:
        part = reach / (tx * tx + ty * ty) ** 0.5
        x, y = x + part * ty, y - part * tx
    return [x, y, force[0] * tx + force[1] * ty]


def differentiate(
    rows: Array,
    force: Point,
    tangents: Tangents,
    reach: float,
    selectors: Array,
    explicit: Explicit | None = None,
) -> None:
    """Add to the rows (3, n) of position and direction the derivatives through the tangent vectors.

    Parameters
    ----------
    rows : ndarray, shape (3, n)
        Derivatives by the unknowns; the derivatives of the axis' position are entered already.
    force, tangents, reach
        As for `residual`.
    selectors : ndarray, shape (5, n)
        Derivatives of the section's angle, the internal force before, and the contact force.
    explicit : Explicit, optional
        Further derivatives of the tangent vectors.
    """
    before, after = tangents
    (Fx, Fy), (tx, ty) = force, _sum(tangents)
    ux, uy = before.turned[0] + after.turned[0], before.turned[1] + after.turned[1]
    (xx, xy, yy), (ax, ay, aa) = before.compliance, after.compliance
    sx, sy, ss = xx + ax, xy + ay, yy + aa
    by_direction = [
        Fx * ux + Fy * uy,
        Fx * sx + Fy * sy,
        Fx * sy + Fy * ss,
        tx - Fx * ax - Fy * ay,
        ty - Fx * ay - Fy * aa,
    ]
    rows[2] = np.array(by_direction) @ selectors
    if explicit is not None:
        rows[2] += Fx * explicit.vector[0] + Fy * explicit.vector[1]
    if reach:
        turned_x, turned_y = np.array([[ux, sx, sy, -ax, -ay], [uy, sy, ss, -ay, -aa]]) @ selectors
        if explicit is not None:
            turned_x, turned_y = turned_x + explicit.vector[0], turned_y + explicit.vector[1]
        across = (tx * turned_y - ty * turned_x) * (reach / (tx * tx + ty * ty) ** 1.5)
        rows[0] += tx * across
        rows[1] += ty * across


def _sum(tangents: Tangents) -> Point:
    before, after = tangents
    return before.vector[0] + after.vector[0], before.vector[1] + after.vector[1]
