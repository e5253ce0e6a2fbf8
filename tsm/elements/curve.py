"""The deflected centre line of one element without a load on it, with its derivatives."""

from __future__ import annotations

from typing import Any, NamedTuple

from tsm.elements.properties import Properties, chord_rotation, tangent_of, unwind


class Jet(NamedTuple):
    """A value with first and second derivatives in ``(dx, dy, theta_i, theta_j, xi)``.

    `gradient` has those five entries, `hessian` the fifteen of the upper triangle, row by row.
    """

    value: Any
    gradient: tuple[Any, ...]
    hessian: tuple[Any, ...]


class Curve:
    """Deflected centre line ``r(xi) = x_i + xi d + w(xi) perp(d)`` of an element, d its chord.

    ``w(xi) = xi (1 - xi) ((1 - xi) tan s_i - xi tan s_j)`` with the end slopes ``s_i, s_j`` of the centre line from
    the chord: the rotations from the chord plus the shear strain of the element, ``w' = theta + gamma``.
    """

    def __init__(self, p: Properties, x: Any) -> None:
        self.dx, self.dy = p.dx0 + (x[3] - x[0]), p.dy0 + (x[4] - x[1])
        turn = chord_rotation(p.dx0 * self.dy - p.dy0 * self.dx, p.dx0 * self.dx + p.dy0 * self.dy)
        theta_i, theta_j = unwind(x[2] - turn), unwind(x[5] - turn)
        self.near = (1 + p.Phi / 2) / (1 + p.Phi)
        self.far = -(p.Phi / 2) / (1 + p.Phi)
        self.shear_strain = self.far * (theta_i + theta_j)
        self.tan_i = tangent_of(self.near * theta_i + self.far * theta_j)
        self.tan_j = tangent_of(self.far * theta_i + self.near * theta_j)

    def deflection(self, xi: Any) -> tuple[Any, Any, Any]:
        """Return w and its first two derivatives in xi."""
        a, b, eta = self.tan_i, self.tan_j, 1 - xi
        return (
            xi * eta * (eta * a - xi * b),
            eta * (1 - 3 * xi) * a + xi * (3 * xi - 2) * b,
            (6 * xi - 4) * a + (6 * xi - 2) * b,
        )

    def approach(self, xi: Any, rx: Any, ry: Any) -> tuple[Any, tuple[Any, Any], tuple[Any, Any]]:
        """Newton step from xi towards the point of the curve that is closest to a node.

        ``rx, ry``: vector from the node to the element's end i. Returns what
        to take from xi, the vector from the node to the curve at xi, and the tangent there.
        """
        (w, dw, ddw), dx, dy = self.deflection(xi), self.dx, self.dy
        px, py = rx + xi * dx - w * dy, ry + xi * dy + w * dx
        tx, ty = dx - dw * dy, dy + dw * dx
        step = (px * tx + py * ty) / (tx * tx + ty * ty + ddw * (py * dx - px * dy))
        return step, (px, py), (tx, ty)

    def deflection_jet(self, xi: Any) -> Jet:
        """Return w with its derivatives."""
        eta = 1 - xi
        return self._blend(
            (xi * eta * eta, -xi * xi * eta),
            (eta * (1 - 3 * xi), xi * (3 * xi - 2)),
            (6 * xi - 4, 6 * xi - 2),
        )

    def slope_angle_jet(self, xi: Any) -> Jet:
        """Angle of the tangent from the x axis with its derivatives."""
        eta = 1 - xi
        slope, g, h = self._blend(
            (eta * (1 - 3 * xi), xi * (3 * xi - 2)), (6 * xi - 4, 6 * xi - 2), (6.0, 6.0)
        )
        turn_x, turn_y, turn_xx, turn_xy = self._turn()
        angle = chord_rotation(self.dy + slope * self.dx, self.dx - slope * self.dy)
        scale = 1 / (1 + slope * slope)
        bend = 2 * slope * scale * scale
        pairs = [(i, j) for i in range(5) for j in range(i, 5)]
        hessian = [scale * value - bend * g[i] * g[j] for value, (i, j) in zip(h, pairs, strict=True)]
        hessian[0] += turn_xx
        hessian[1] += turn_xy
        hessian[5] -= turn_xx
        gradient = (scale * g[0] + turn_x, scale * g[1] + turn_y, scale * g[2], scale * g[3], scale * g[4])
        return Jet(angle, gradient, tuple(hessian))

    def shear_strain_jet(self) -> Jet:
        """Shear strain of the element with its derivatives."""
        far, (gx, gy, gxx, gxy) = self.far, self._turn()
        hessian = [0.0] * 15
        hessian[0], hessian[1], hessian[5] = -2 * far * gxx, -2 * far * gxy, 2 * far * gxx
        return Jet(self.shear_strain, (-2 * far * gx, -2 * far * gy, far, far, 0.0), tuple(hessian))

    def _turn(self) -> tuple[Any, Any, Any, Any]:
        """Derivatives of the chord's angle: x, y, xx = -yy, xy."""
        dx, dy = self.dx, self.dy
        l2 = dx * dx + dy * dy
        gx, gy = -dy / l2, dx / l2
        return gx, gy, -2 * gx * gy, gx * gx - gy * gy

    def _blend(self, h: Any, dh: Any, ddh: Any) -> Jet:
        """Jet of ``h_i(xi) tan s_i + h_j(xi) tan s_j``."""
        near, far, a, b = self.near, self.far, self.tan_i, self.tan_j
        both = near + far
        da, db = 1 + a * a, 1 + b * b
        i, j = h[0] * da, h[1] * db
        ii, jj = 2 * a * i, 2 * b * j
        si, sj = dh[0] * da, dh[1] * db
        turn, slid = -both * (i + j), -both * (si + sj)
        with_i, with_j = -both * (near * ii + far * jj), -both * (far * ii + near * jj)
        twice = both * both * (ii + jj)
        gx, gy, gxx, gxy = self._turn()
        return Jet(
            h[0] * a + h[1] * b,
            (turn * gx, turn * gy, near * i + far * j, far * i + near * j, dh[0] * a + dh[1] * b),
            (
                twice * gx * gx + turn * gxx, twice * gx * gy + turn * gxy, with_i * gx, with_j * gx, slid * gx,
                twice * gy * gy - turn * gxx, with_i * gy, with_j * gy, slid * gy,
                near * near * ii + far * far * jj, near * far * (ii + jj), near * si + far * sj,
                far * far * ii + near * near * jj, far * si + near * sj,
                ddh[0] * a + ddh[1] * b,
            ),
        )  # fmt: skip
