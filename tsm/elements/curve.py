"""The deflected centre line of one element without a load on it, with its derivatives."""

from __future__ import annotations

from typing import Any

from tsm.elements.contact_law import Vector
from tsm.elements.properties import Properties, chord_rotation, from_chord, tangent_of


def _weights(xi: Any) -> tuple[Vector, Vector, Vector]:
    """Deflections of an element by the tangents of both end slopes, and their first two derivatives."""
    eta, turns = 1 - xi, 6 * xi
    return (xi * eta * eta, -xi * xi * eta), (eta * (1 - 3 * xi), xi * (3 * xi - 2)), (turns - 4, turns - 2)


class Curve:
    """Deflected centre line ``r(xi) = x_i + xi d + w(xi) perp(d)`` of an element, d its chord.

    ``w(xi) = xi (1 - xi) ((1 - xi) tan s_i - xi tan s_j)`` with the end slopes ``s_i, s_j`` of the centre
    line from the chord: the rotations from the chord plus the shear strain of the element, ``w' = theta +
    gamma``.
    """

    def __init__(self, p: Properties, x: Any) -> None:
        self.dx, self.dy, theta_i, theta_j = from_chord(p, x)
        square = self.dx * self.dx + self.dy * self.dy
        # derivatives of the chord's angle
        self.turn_x, self.turn_y = -self.dy / square, self.dx / square
        self.near = (1 + p.Phi / 2) / (1 + p.Phi)
        self.far = -(p.Phi / 2) / (1 + p.Phi)
        self.tan_i = tangent_of(self.near * theta_i + self.far * theta_j)
        self.tan_j = tangent_of(self.far * theta_i + self.near * theta_j)

    def deflection(self, xi: Any) -> tuple[Any, Any, Any]:
        """Return w and its first two derivatives in xi."""
        w, slope, bend = (i * self.tan_i + j * self.tan_j for i, j in _weights(xi))
        return w, slope, bend

    def deflection_slope(self, xi: Any) -> tuple[Any, tuple[Any, ...]]:
        """Return w and its derivatives in ``(dx, dy, theta_i, theta_j, xi)``."""
        w, turn, *by = self._blend(*_weights(xi)[:2])
        return w, (turn * self.turn_x, turn * self.turn_y, *by)

    def deflection_bend(self, xi: Any) -> tuple[Any, ...]:
        """Second derivatives of w: the fifteen of the upper triangle, row by row."""
        near, far, a, b = self.near, self.far, self.tan_i, self.tan_j
        both, da, db = near + far, 1 + a * a, 1 + b * b
        (i, j), (si, sj) = ((i * da, j * db) for i, j in _weights(xi)[:2])
        ii, jj = 2 * a * i, 2 * b * j
        turn, slid = -both * (i + j), -both * (si + sj)
        with_i, with_j = -both * (near * ii + far * jj), -both * (far * ii + near * jj)
        twice = both * both * (ii + jj)
        gx, gy = self.turn_x, self.turn_y
        gxx, gxy = -2 * gx * gy, gx * gx - gy * gy
        return (
            twice * gx * gx + turn * gxx, twice * gx * gy + turn * gxy, with_i * gx, with_j * gx, slid * gx,
            twice * gy * gy - turn * gxx, with_i * gy, with_j * gy, slid * gy,
            near * near * ii + far * far * jj, near * far * (ii + jj), near * si + far * sj,
            far * far * ii + near * near * jj, far * si + near * sj,
            (6 * xi - 4) * a + (6 * xi - 2) * b,
        )  # fmt: skip

    def slope_angle(self, xi: Any) -> tuple[Any, tuple[Any, ...]]:
        """Angle of the tangent from the x axis, and its derivatives in ``(dx, dy, theta_i, theta_j, xi)``."""
        slope, turn, *by = self._blend(*_weights(xi)[1:])
        angle = chord_rotation(self.dy + slope * self.dx, self.dx - slope * self.dy)
        scale = 1 / (1 + slope * slope)
        turn = 1 + scale * turn
        return angle, (turn * self.turn_x, turn * self.turn_y, *(scale * part for part in by))

    def _blend(self, h: Vector, dh: Vector) -> tuple[Any, Any, Any, Any, Any]:
        """``h_i(xi) tan s_i + h_j(xi) tan s_j`` and its derivatives by the chord's angle, both rotations, and xi."""
        near, far, a, b = self.near, self.far, self.tan_i, self.tan_j
        i, j = h[0] * (1 + a * a), h[1] * (1 + b * b)
        turn = -(near + far) * (i + j)
        return h[0] * a + h[1] * b, turn, near * i + far * j, far * i + near * j, dh[0] * a + dh[1] * b
