"""The smooth curve that represents a strip in contact, and the closest point on it.

A cubic spline passes through the section means or the face nodes ``X_k`` over their undeformed axial coordinates. The
curve is a moving average of this spline, ``r(zeta) = sum_q w_q sum_k B_k(zeta + d_q) X_k``, with the cardinal splines B_k and
weights w_q at the offsets d_q. It is twice continuously differentiable, whereas the edges of the elements have kinks.

A contact force F indents the solid, and gives the axis a kink of shear. Without the average these would rotate the normal by up to
``F / (G A_e)``, which depends on the place of the contact within an element.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, identity

from fem_reference.solid.mesh import Discretisation
from fem_reference.statement.arrays import Floats, Ints
from fem_reference.statement.problem import Contact
from fem_reference.statement.strip import Strip

_PROJECTION_STEPS = 40
_REACH, _WINDOW = 90, 256
"""Number of stations over which a cardinal spline decays to round-off, and number of those whose slopes are computed at once."""

_HERMITE = np.array(
    [
        [[1, 0, -3, 2], [0, 0, 3, -2], [0, 1, -2, 1], [0, 0, -1, 1]],
        [[0, -6, 6, 0], [0, 6, -6, 0], [1, -4, 3, 0], [0, -2, 3, 0]],
        [[-6, 12, 0, 0], [6, -12, 0, 0], [-4, 6, 0, 0], [-2, 6, 0, 0]],
    ],
    dtype=float,
).reshape(12, 4)
"""Coefficients of the powers of z in Hermite's cubic polynomials over [0, 1], and in their first two derivatives."""
_POWERS = np.arange(4.0)[:, None]


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactCurve:
    """A twice continuously differentiable curve through points that move with the nodes."""

    stations: Floats  # undeformed axial coordinates of the points, increasing, ``(m,)`` [m]
    slopes: csr_matrix  # from the points to the slopes of their spline at the stations, ``(m, m)`` [1/m]
    transposed: csr_matrix  # transposed `slopes`
    offsets: Floats  # offsets ``(q,)`` of the points in the moving average [m]
    kernel: Floats  # weights ``(q,)`` of these points

    def basis(self, zeta: float) -> Floats:
        """Averaged cardinal splines and their derivatives at ``zeta``, ``(2, m)``."""
        k, factors = self.pieces(zeta)
        both = np.zeros((self.stations.size, 2, 2))  # factors of points and of slopes, by derivative
        np.add.at(both, k, factors[:2, ::2].T)
        np.add.at(both, k + 1, factors[:2, 1::2].T)
        return (both[:, 0] + self.transposed @ both[:, 1]).T

    def at(self, zeta: float, X: Floats, D: Floats) -> Floats:
        """Position and first two derivatives ``(3, 2)`` of the curve with points X and slopes D at the stations."""
        k, factors = self.pieces(zeta)
        return factors.reshape(3, -1) @ np.concatenate([X[k], X[k + 1], D[k], D[k + 1]])

    def pieces(self, zeta: float) -> tuple[Ints, Floats]:
        """Intervals k ``(q,)`` of the averaged places, and factors ``(3, 4, q)`` of points and slopes in the curve and its derivatives."""
        # the kernel times Hermite's polynomials, by derivative: of X_k, X_k+1 and the slopes at k and k + 1
        s, places = self.stations, zeta + self.offsets
        inner = places
        outside = bool(places[0] < s[0] or places[-1] > s[-1])  # the offsets increase
        if outside:
            inner = np.clip(places, s[0], s[-1])
        k = np.minimum(np.maximum(np.searchsorted(s, inner) - 1, 0), s.size - 2)
        h = s[k + 1] - s[k]
        z = (inner - s[k]) / h
        hermite = (_HERMITE @ (self.kernel * z**_POWERS)).reshape(3, 4, -1)
        hermite[:, 2:] *= h
        hermite[1:] /= h
        hermite[2] /= h
        if outside:  # beyond the ends the spline goes on along its tangents
            beyond = places - inner
            hermite[0] += beyond * hermite[1]
            hermite[2] *= beyond == 0
        return k, hermite


def cardinal_slopes(stations: Floats) -> csr_matrix:
    """Matrix ``(m, m)`` from values at the stations to the slopes of their not-a-knot spline there.

    A column has the slopes of a cardinal spline, which is one at its own station and zero at the others.
    """
    from scipy.interpolate import CubicSpline  # its import takes longer than that of the package

    m, entries = stations.size, list[tuple[Ints, Ints, Floats]]()
    for first in range(0, m, _WINDOW):
        low, last = max(0, first - _REACH), min(m, first + _WINDOW)
        near = stations[low : last + _REACH]
        slopes = CubicSpline(near, np.eye(near.size), bc_type="not-a-knot")(stations[first:last], 1)
        row, column = np.nonzero(np.abs(slopes) > 1e-17 * np.abs(slopes).max())
        entries.append((row + first, column + low, slopes[row, column]))
    rows, columns, values = map(np.concatenate, zip(*entries, strict=True))
    return csr_matrix((values, (rows, columns)), shape=(m, m))


def contact_curve(strip: Strip, mesh: Discretisation, contact: Contact) -> tuple[ContactCurve, csr_matrix]:
    """Curve through the section means ("axis") or the nodes of the touched face ("face"), and the nodes' weights ``(m, n)`` in its points."""
    stations, rows = mesh.stations, mesh.sections
    if contact.surface == "face":
        face = mesh.edges[contact.side]
        stations, rows = mesh.places[face, 0], identity(len(mesh.nodes), format="csr")[face]
    spread = min(1.5 * strip.largest_height, strip.length / 10) if contact.spread is None else contact.spread
    offsets, kernel = averaging(spread, float(np.diff(stations).min()))
    # SciPy's equations for a spline of few stations are ill-conditioned if lengths are far from 1.
    slopes = cardinal_slopes(stations / strip.length) / strip.length
    transposed = csr_matrix(slopes.T)
    curve = ContactCurve(
        stations=stations, slopes=slopes, transposed=transposed, offsets=offsets, kernel=kernel
    )
    return curve, rows


def averaging(spread: float, spacing: float) -> tuple[Floats, Floats]:
    """Offsets and weights of an average over ``[-spread, spread]`` that is exact for cubic polynomials.

    Gauss points, at least two in each ``spacing`` of the stations, weighted by the kernel ``15 (3 - 10 x^2 + 7 x^4) / 32``
    (Gasser, Mueller, Mammitzsch, J. R. Statist. Soc. B 47 (1985), 238-252, table 1).
    """
    if spread == 0:
        return np.zeros(1), np.ones(1)
    x, w = np.polynomial.legendre.leggauss(max(12, int(np.ceil(4 * spread / spacing))))
    kernel = w * (3 - 10 * x**2 + 7 * x**4)
    return spread * x, kernel / kernel.sum()


@dataclass(frozen=True, kw_only=True, eq=False)
class Projection:
    """Projection of a point on the curve."""

    zeta: float  # undeformed axial coordinate of the closest point [m]
    inside: bool  # whether the closest point lies on the strip and not on the continuation beyond an end
    stationary: bool  # whether it satisfies the condition of the closest point, ``(r - x_c) . r' = 0``
    distance: float  # signed distance ``-d = n . (x_c - r)``, positive on the left [m]
    end_distance: float  # distance of the point from the end of the curve nearer to ``zeta`` [m]
    tangent: Floats  # unit tangent of the curve, ``(2,)``
    normal: Floats  # its left normal
    stretch: float  # ``rho = |r'|``
    bend: float  # ``n . r''`` [1/m]
    stretch_slope: float  # ``t . r''`` [1/m]


def project(curve: ContactCurve, X: Floats, point: Floats) -> Projection:
    """Project a point on the curve whose points have the positions ``X`` ``(m, 2)``."""
    s, Y = curve.stations, X - point  # relative to the point, which loses no digits near it
    D = curve.slopes @ Y
    zeta, stationary, (r, r1, r2) = closest(curve, Y, D)
    stretch = float(np.sqrt(r1 @ r1))
    tangent = r1 / stretch
    normal = np.array([-tangent[1], tangent[0]])
    slack = 1e-12 * (s[-1] - s[0])  # round-off must not place a point at an end beyond it
    return Projection(
        zeta=zeta,
        inside=bool(s[0] - slack <= zeta <= s[-1] + slack),
        stationary=stationary,
        distance=float(-normal @ r),
        end_distance=float(np.sqrt((Y[0 if 2 * zeta < s[0] + s[-1] else -1] ** 2).sum())),
        tangent=tangent,
        normal=normal,
        stretch=stretch,
        bend=float(normal @ r2),
        stretch_slope=float(tangent @ r2),
    )


def closest(curve: ContactCurve, Y: Floats, D: Floats) -> tuple[float, bool, Floats]:
    """Coordinate of the point closest to the origin by Newton's method from the closest station, whether it is stationary, and `at` it."""
    s = curve.stations
    # the curve goes on by one spacing beyond its ends, so that a point beyond an end still has a projection
    low, high = 2 * s[0] - s[1], 2 * s[-1] - s[-2]
    k = int(np.argmin((Y**2).sum(axis=1)))
    around = (s[k - 1] if k else low, s[k + 1] if k + 1 < s.size else high)
    zeta, size = float(s[k]), s[-1] - s[0]

    def slope(zeta: float) -> float:
        r, r1, _ = curve.at(zeta, Y, D)
        return float(r @ r1)

    for _ in range(_PROJECTION_STEPS):
        r, r1, r2 = at = curve.at(zeta, Y, D)
        squared = r1 @ r1
        curvature = squared + r @ r2
        # near the centre of curvature and beyond it: the root between the neighbouring stations, or else a Gauss-Newton step
        if curvature <= 0.1 * squared:
            if slope(around[0]) < 0 < slope(around[1]):
                from scipy.optimize import brentq  # rare, and its import takes as long as that of the package

                zeta = float(brentq(slope, *around, xtol=1e-15 * size))
                return zeta, True, curve.at(zeta, Y, D)
            curvature = squared
        step = float(-(r @ r1) / curvature)
        if abs(step) <= 1e-14 * size:
            return zeta, True, at
        last, zeta = zeta, min(max(zeta + step, low), high)
        if zeta == last:
            break
    return zeta, False, curve.at(zeta, Y, D)
