"""The deflected centre line of one element without a load on it, with its derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.properties import Array, Properties, chord_rotation, unwind


class Curve:
    """Deflected centre line ``r(xi) = x_i + xi d + w(xi) perp(d)`` of an element, d its chord.

    ``w(xi) = xi (1 - xi) ((1 - xi) tan s_i - xi tan s_j)`` with the end slopes ``s_i, s_j`` of the centre line from
    the chord: the rotations from the chord less the shear strain of the element.

    Parameters
    ----------
    p : Properties
        Constants of the element, plain numbers.
    x : sequence of 6 numbers
        Its displacements.
    """

    def __init__(self, p: Properties, x: Any) -> None:
        self.dx, self.dy = p.dx0 + (x[3] - x[0]), p.dy0 + (x[4] - x[1])
        turn = chord_rotation(p.dx0 * self.dy - p.dy0 * self.dx, p.dx0 * self.dx + p.dy0 * self.dy)
        theta_i, theta_j = unwind(x[2] - turn), unwind(x[5] - turn)
        self.near = (1 + p.Phi / 2) / (1 + p.Phi)
        self.far = -(p.Phi / 2) / (1 + p.Phi)
        self.tan_i = np.tan(self.near * theta_i + self.far * theta_j)
        self.tan_j = np.tan(self.far * theta_i + self.near * theta_j)

    def deflection(self, xi: Any) -> tuple[Any, Array, Array]:
        """Return w with gradient and Hessian in ``(dx, dy, theta_i, theta_j, F_x, F_y, xi)``."""
        eta = 1 - xi
        return self._blend(
            (xi * eta * eta, -xi * xi * eta),
            (eta * (1 - 3 * xi), xi * (3 * xi - 2)),
            (6 * xi - 4, 6 * xi - 2),
        )

    def slope_angle(self, xi: Any) -> tuple[Any, Array, Array]:
        """Angle of the tangent from the x axis, with gradient and Hessian in the same variables."""
        eta = 1 - xi
        slope, gradient, hessian = self._blend(
            (eta * (1 - 3 * xi), xi * (3 * xi - 2)), (6 * xi - 4, 6 * xi - 2), (6.0, 6.0)
        )
        turn_gradient, turn_hessian = self._turn()
        angle = chord_rotation(self.dy + slope * self.dx, self.dx - slope * self.dy)
        scale = 1 / (1 + slope * slope)
        hessian = scale * hessian - 2 * slope * scale * scale * np.outer(gradient, gradient)
        gradient = scale * gradient
        gradient[:2] += turn_gradient
        hessian[:2, :2] += turn_hessian
        return angle, gradient, hessian

    def _turn(self) -> tuple[Array, Array]:
        """Gradient and Hessian of the chord's angle in ``(dx, dy)``."""
        dx, dy = self.dx, self.dy
        l2 = dx * dx + dy * dy
        gx, gy = -dy / l2, dx / l2
        same = -2 * gx * gy
        return np.array([gx, gy]), np.array([[same, gx * gx - gy * gy], [gx * gx - gy * gy, -same]])

    def _blend(self, h: Any, dh: Any, ddh: Any) -> tuple[Any, Array, Array]:
        """Value, gradient and Hessian of ``h_i(xi) tan s_i + h_j(xi) tan s_j``."""
        near, far, a, b = self.near, self.far, self.tan_i, self.tan_j
        both = near + far
        da, db = 1 + a * a, 1 + b * b
        i, j = h[0] * da, h[1] * db
        ii, jj = 2 * a * i, 2 * b * j
        si, sj = dh[0] * da, dh[1] * db
        turn, turn_slide = -both * (i + j), -both * (si + sj)
        with_i, with_j = near * ii + far * jj, far * ii + near * jj
        (gx, gy), turn_hessian = self._turn()
        gradient = np.array(
            [turn * gx, turn * gy, near * i + far * j, far * i + near * j, 0, 0, dh[0] * a + dh[1] * b]
        )
        hessian = np.zeros((7, 7), dtype=gradient.dtype)
        both2 = both * both * (ii + jj)
        hessian[0, :4] = both2 * gx * gx, both2 * gx * gy, -both * with_i * gx, -both * with_j * gx
        hessian[1, :4] = both2 * gx * gy, both2 * gy * gy, -both * with_i * gy, -both * with_j * gy
        hessian[:2, :2] += turn * turn_hessian
        hessian[2:4, :2] = hessian[:2, 2:4].T
        hessian[2, 2] = near * near * ii + far * far * jj
        hessian[3, 3] = far * far * ii + near * near * jj
        hessian[2, 3] = hessian[3, 2] = near * far * (ii + jj)
        slide = (turn_slide * gx, turn_slide * gy, near * si + far * sj, far * si + near * sj)
        hessian[6, :4] = slide
        hessian[:4, 6] = slide
        hessian[6, 6] = ddh[0] * a + ddh[1] * b
        return h[0] * a + h[1] * b, gradient, hessian
