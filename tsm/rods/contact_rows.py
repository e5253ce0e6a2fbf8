"""Rows of a contact that cuts an exact element: the node lies on the surface, and the force is normal to it.

The surface lies at the offset from the axis, across the mean of the tangent vectors before and after the contact; the force is normal to
that mean: ``r + offset - x_c = 0``, ``F . (r'_- + r'_+) = 0``.

Where the offset o changes along the beam, the surface is the envelope of circles with the radius o about the points of the axis. With the
sum T of the tangent vectors, its direction t and right normal n, and ``S = 2 o'/|T|``, ``C = sqrt(1 - S^2)``, its normal is ``nu = C n - S t``
and its direction ``f = C t + S n``: ``r + o nu - x_c = 0``, ``|T| F . f = 0``. The force goes through the point of the axis.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.properties import Array

Point = tuple[Any, Any]
Tangents = tuple[rod.Tangent, rod.Tangent]


class Explicit(NamedTuple):
    """Derivatives at a contact by what passes neither through the section's angle nor through the forces."""

    vector: Array  # derivatives of the sum of the tangent vectors; shape (2, n)
    turn: Array  # derivatives of the mean of the angle's derivative in the arc position; shape (n,)


class Leaning(NamedTuple):
    """Normal and direction (2,) of a surface whose offset changes along the beam, with ``|T|``, t, n and S over C."""

    normal: Array
    along: Array
    size: Any
    axis: Array
    across: Array
    steep: Any


def leaning(tangents: Tangents, steep: float) -> Leaning:
    """Surface at a contact; `steep` is the derivative of the offset by the arc position."""
    axis = np.array(_sum(tangents))
    size = (axis[0] ** 2 + axis[1] ** 2) ** 0.5
    t = axis / size
    n = np.array([t[1], -t[0]])
    S = 2 * steep / size
    C = (1 - S * S) ** 0.5
    return Leaning(C * n - S * t, C * t + S * n, size, t, n, S / C)


def turned(surface: Leaning, axis: Array) -> Array:
    """Change (n,) of the angle of the surface with the sum of the tangent vectors (2, n)."""
    turn: Array = (surface.steep * (surface.axis @ axis) - surface.across @ axis) / surface.size
    return turn


def by_selectors(tangents: Tangents, selectors: Array, explicit: Explicit | None) -> Array:
    """Derivatives (2, n) of the sum of the tangent vectors, from the derivatives of angle, force before and contact force (5, n)."""
    before, after = tangents
    (xx, xy, yy), (ax, ay, aa) = before.compliance, after.compliance
    by = [
        [before.turned[0] + after.turned[0], xx + ax, xy + ay, -ax, -ay],
        [before.turned[1] + after.turned[1], xy + ay, yy + aa, -ay, -aa],
    ]
    vector: Array = np.array(by) @ selectors
    return vector if explicit is None else vector + explicit.vector


def residual(apart: Point, force: Point, tangents: Tangents, reach: float, steep: float = 0.0) -> list[Any]:
    """Residual of position (2) and direction.

    ``apart``: vector from the contacting node to the axis. ``force``: force on the beam. ``tangents``:
    tangent vectors before and after the contact. ``reach, steep``: offset of the surface, positive to the
    right, and its derivative by the arc position.
    """
    if steep:
        surface = leaning(tangents, steep)
        x, y = np.array(apart) + reach * surface.normal
        return [x, y, surface.size * (surface.along @ np.array(force))]
    (x, y), (tx, ty) = apart, _sum(tangents)
    if reach:
        part = reach / (tx * tx + ty * ty) ** 0.5
        x, y = x + part * ty, y - part * tx
    return [x, y, force[0] * tx + force[1] * ty]


def differentiate(
    rows: Array,
    force: Point,
    tangents: Tangents,
    face: tuple[float, float],
    selectors: Array,
    explicit: Explicit | None = None,
) -> None:
    """Add to the rows (3, n) of position and direction the derivatives through the tangent vectors.

    ``rows`` (3, n): derivatives by the unknowns; the derivatives of the axis' position are entered already.
    ``face``: offset of the surface, positive to the right, and its derivative by the arc position.
    ``selectors`` (6, n): derivatives of the section's angle, the internal force before, the contact force,
    and the arc position. ``explicit``: further derivatives of the tangent vectors.
    """
    reach, steep = face
    arc, selectors = selectors[5], selectors[:5]
    if steep:
        surface, axis = leaning(tangents, steep), by_selectors(tangents, selectors, explicit)
        turn, F = turned(surface, axis), np.array(force)
        rows[:2] += np.outer(surface.along, reach * turn) + np.outer(surface.normal, steep * arc)
        rows[2] = (surface.along @ F) * (surface.axis @ axis) - surface.size * (surface.normal @ F) * turn
        rows[2] += surface.size * (surface.along @ selectors[3:5])
        return
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
