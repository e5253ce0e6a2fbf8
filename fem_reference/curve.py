"""The smooth curve that represents a strip in contact, and the closest point on it.

A cubic spline passes through the section means or the face nodes ``X_k`` over their undeformed axial coordinates. The
curve is a moving average of this spline, ``r(zeta) = sum_q w_q sum_k B_k(zeta + d_q) X_k``. It is twice continuously
differentiable, whereas the edges of the elements have kinks. Without the average, the local indentation and the shear kink
of the axis rotate the normal by up to ``F / (G A_e)``, depending on the position of the contact within an element.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import csr_matrix

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.mesh import Discretisation
from fem_reference.problem import Contact
from fem_reference.strip import Strip

_PROJECTION_STEPS = 40
_HALF_BAND, _WINDOW = 45, 256
"""Half bandwidth and window size of `band_slopes`, in stations."""


_HERMITE = np.array(
    [
        [[1, 0, -3, 2], [0, 0, 3, -2], [0, 1, -2, 1], [0, 0, -1, 1]],
        [[0, -6, 6, 0], [0, 6, -6, 0], [1, -4, 3, 0], [0, -2, 3, 0]],
        [[-6, 12, 0, 0], [6, -12, 0, 0], [-4, 6, 0, 0], [-2, 6, 0, 0]],
    ],
    dtype=float,
).reshape(12, 4)
"""Coefficients of the powers of z in Hermite's cubic polynomials of [0, 1] and their first two derivatives."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactCurve:
    """A twice continuously differentiable curve through points that move with the nodes."""

    stations: Floats  # undeformed axial coordinates of the points, increasing, ``(m,)`` [m]
    # slopes of the cardinal splines at the stations in band storage ``(m, 2 b + 1)``, see `band_slopes`
    # [1/m]
    slopes: Floats
    rows: csr_matrix  # weights ``(m, n)`` of the nodes in the points
    # offsets, kernel: offsets ``(q,)`` [m] and weights ``(q,)`` of the points in the moving average
    offsets: Floats
    kernel: Floats

    def basis(self, zeta: Any) -> Array:  # a float, or complex for a complex step
        """Averaged cardinal splines and their first two derivatives at ``zeta``, ``(3, m)``."""
        s = self.stations
        k, weighted = self.pieces(zeta + self.offsets)
        first, count = int(k.min()), int(np.ptp(k)) + 2
        ones = np.eye(count)
        left, right = ones[k - first], ones[k - first + 1]
        values, slopes = (weighted[:, n] @ left + weighted[:, n + 1] @ right for n in (0, 2))
        bandwidth = self.slopes.shape[1]
        half = bandwidth // 2
        shifted = np.zeros((count, count + bandwidth))
        shifted[:, :bandwidth] = self.slopes[first : first + count]
        # In this view of the padded array each row begins one column further to the right.
        rows = shifted.ravel()[:-count].reshape(count, count + bandwidth - 1)
        padded = np.zeros((3, s.size + 2 * half), dtype=weighted.dtype)
        padded[:, first : first + count + bandwidth - 1] = slopes @ rows
        padded[:, half + first : half + first + count] += values
        return padded[:, half : half + s.size]

    @cached_property
    def spline(self) -> csr_matrix:
        """Matrix ``(m, m)`` from the points to the slopes of their spline at the stations [1/m]."""
        m, half = self.stations.size, self.slopes.shape[1] // 2
        row = np.repeat(np.arange(m), self.slopes.shape[1]).reshape(self.slopes.shape)
        column = row + np.arange(self.slopes.shape[1]) - half
        inside = (column >= 0) & (column < m)
        return csr_matrix((self.slopes[inside], (row[inside], column[inside])), shape=(m, m))

    def pieces(self, zeta: Array) -> tuple[Ints, Array]:
        """Spline intervals that contain the points ``zeta`` ``(q,)``, and Hermite's polynomials there, times the kernel, ``(3, 4, q)``.

        Rows: value, first and second derivative. Columns: factors of ``X_k``, ``X_k+1`` and the slopes at k and k + 1. Beyond
        the ends the spline is continued along its tangents.
        """
        s, inner = self.stations, zeta
        leaves = bool(zeta[0].real < s[0] or zeta[-1].real > s[-1])  # the offsets increase
        if leaves:
            inner = np.where(zeta.real < s[0], s[0], np.where(zeta.real > s[-1], s[-1], zeta))
        k = np.minimum(np.maximum(np.searchsorted(s, inner.real) - 1, 0), s.size - 2)
        h = s[k + 1] - s[k]
        z = (inner - s[k]) / h
        powers = np.empty((4, z.size), dtype=z.dtype)
        powers[0], powers[1] = self.kernel, self.kernel * z
        powers[2] = powers[1] * z
        powers[3] = powers[2] * z
        hermite = (_HERMITE @ powers).reshape(3, 4, -1)
        hermite[:, 2:] *= h
        hermite[1:] /= h
        hermite[2] /= h
        if leaves:
            beyond = zeta - inner
            hermite[0] += beyond * hermite[1]
            hermite[2] *= beyond == 0
        return k, hermite


def band_slopes(stations: Floats) -> Floats:
    """Slopes of the cardinal not-a-knot splines at the stations, in band storage ``(m, 2 b + 1)`` with b <= 45.

    A cardinal spline is one at one station and zero at all others. Row k holds the slopes at station k of the splines of
    the stations ``k - b`` to ``k + b``. From station to station the slopes decrease by the factor 0.27, at worst 0.5, so that
    those outside the band vanish. They are computed in windows of stations; work and memory are proportional to m.
    """
    m = stations.size
    half = min(_HALF_BAND, m - 1)
    band = np.zeros((m, 2 * half + 1))
    for first in range(0, m, _WINDOW):
        last = min(first + _WINDOW, m)
        low, high = max(0, first - 2 * _HALF_BAND), min(m, last + 2 * _HALF_BAND)
        near = stations[low:high]
        full = np.zeros((last - first, high - low + 2 * half))
        full[:, half : half + near.size] = CubicSpline(near, np.eye(near.size), bc_type="not-a-knot")(
            stations[first:last], 1
        )
        rows = np.arange(last - first)
        band[first:last] = full[rows[:, None], (first - low + rows)[:, None] + np.arange(2 * half + 1)]
    return band


def contact_curve(strip: Strip, mesh: Discretisation, contact: Contact) -> ContactCurve:
    """Build the curve through the section means ("axis") or the nodes of the touched face ("face")."""
    stations, rows = mesh.stations, mesh.sections
    if contact.surface == "face":
        face = mesh.edges[contact.side]
        stations = mesh.places[face, 0]
        rows = csr_matrix(
            (np.ones(face.size), (np.arange(face.size), face)), shape=(face.size, len(mesh.nodes))
        )
    # SciPy's equations for a spline of few stations are ill-conditioned if lengths are far from 1.
    slopes = band_slopes(stations / strip.length) / strip.length
    offsets, kernel = averaging(contact_spread(strip, contact), float(np.diff(stations).min()))
    return ContactCurve(stations=stations, slopes=slopes, rows=rows, offsets=offsets, kernel=kernel)


def contact_spread(strip: Strip, contact: Contact) -> float:
    """Half the length of contact averaging [m]: ``contact.spread``, or 1.5 heights and at most a tenth of the length."""
    return min(1.5 * strip.largest_height, strip.length / 10) if contact.spread is None else contact.spread


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

    zeta: Any  # undeformed axial coordinate of the closest point [m]
    inside: bool  # whether the closest point lies on the strip and not on the continuation beyond an end
    stationary: bool  # whether the iteration reached ``(r - x_c) . r' = 0`` at ``zeta``
    distance: Any  # signed distance ``n . (x_c - r)``, positive on the left [m]
    end_distance: Any  # distance of the point from the end of the curve nearer to ``zeta`` [m]
    basis: Array  # spline values and derivatives at ``zeta``, ``(3, m)``
    tangent: Array  # tangent, normal: unit tangent and left normal of the curve, ``(2,)``
    normal: Array
    stretch: Any  # stretch, bend, stretch_slope: ``rho = |r'|`` [-], ``n . r''`` and ``t . r''`` [1/m]
    bend: Any
    stretch_slope: Any


def project(curve: ContactCurve, X: Array, point: Array) -> Projection:
    """Project a point on the curve whose points have the positions ``X`` ``(m, 2)``."""
    s, from_point = curve.stations, CurveFrom(curve=curve, points=X - point)
    zeta, stationary = closest(from_point)
    r, r1, r2 = from_point.at(zeta)
    stretch = np.sqrt(r1 @ r1)
    tangent = r1 / stretch
    normal = np.array([-tangent[1], tangent[0]])
    end = from_point.points[0 if 2 * np.real(zeta) < s[0] + s[-1] else -1]
    slack = 1e-12 * (s[-1] - s[0])  # round-off must not place a point at an end beyond it
    return Projection(
        zeta=zeta,
        inside=bool(s[0] - slack <= np.real(zeta) <= s[-1] + slack),
        stationary=stationary,
        distance=-normal @ r,
        end_distance=np.sqrt(end @ end),
        basis=curve.basis(zeta),
        tangent=tangent,
        normal=normal,
        stretch=stretch,
        bend=normal @ r2,
        stretch_slope=tangent @ r2,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveFrom:
    """The curve relative to a point, which loses no digits near the point."""

    curve: ContactCurve  # the contact curve
    points: Array  # its points less the point ``(m, 2)`` [m]

    @cached_property
    def _slopes(self) -> Array:
        """Slopes ``(m, 2)`` of the spline through the points at the stations."""
        slopes: Array = self.curve.spline @ self.points
        return slopes

    def at(self, zeta: Any) -> Array:
        """Position and first two derivatives ``(3, 2)`` at ``zeta``."""
        k, factors = self.curve.pieces(zeta + self.curve.offsets)
        X, D = self.points, self._slopes
        return np.asarray(factors.reshape(3, -1) @ np.concatenate([X[k], X[k + 1], D[k], D[k + 1]]))

    def orthogonality(self, zeta: Any) -> tuple[Any, Any, Any]:
        """Return ``r . r'``, its slope ``r' . r' + r . r''`` and ``r' . r'``."""
        r, r1, r2 = self.at(zeta)
        size = r1 @ r1
        return r @ r1, size + r @ r2, size


def closest(curve: CurveFrom) -> tuple[Any, bool]:
    """Coordinate of the closest point by Newton's method from the closest station, and whether it is stationary.

    The curve is continued by one spacing beyond its ends, so that a point beyond an end still has a projection. Near a
    centre of curvature the root is searched between the neighbouring stations.
    """
    s, X = curve.curve.stations, curve.points
    low, high = 2 * s[0] - s[1], 2 * s[-1] - s[-2]
    k = int(np.argmin((X.real**2).sum(axis=1)))
    zeta, bracket_tried = s[k] + 0 * X[0, 0], False
    for _ in range(_PROJECTION_STEPS):
        value, slope, size = curve.orthogonality(zeta)
        # Near and beyond the centre of curvature: a bracketed root, otherwise a Gauss-Newton step.
        if slope.real <= 0.1 * size.real:
            if not bracket_tried:
                bracket_tried, root = True, _bracketed_root(curve, k)
                if root is not None:
                    return root, True
            slope = size
        step = -value / slope
        last, zeta = zeta, zeta + step if np.iscomplexobj(X) else min(max(zeta + step, low), high)
        if abs(step) <= 1e-14 * (s[-1] - s[0]):
            return zeta, True
        if zeta == last:
            break
    return zeta, False


def _bracketed_root(curve: CurveFrom, k: int) -> Any | None:
    """Closest point between the neighbours of station k by bracketed Newton iteration; None without a sign change."""
    stations = curve.curve.stations
    s = np.concatenate([[2 * stations[0] - stations[1]], stations])
    s = np.append(s, 2 * s[-1] - s[-2])
    low, high = float(s[k]), float(s[k + 2])
    if curve.orthogonality(low)[0].real > 0 or curve.orthogonality(high)[0].real < 0:
        return None
    zeta = float(s[k + 1])
    for _ in range(_PROJECTION_STEPS):
        value, slope, size = (term.real for term in curve.orthogonality(zeta))
        low, high = (low, zeta) if value > 0 else (zeta, high)
        following = zeta - value / slope if slope > 0 else np.inf
        if not low < following < high:
            following = (low + high) / 2
        done = abs(value) <= 1e-14 * size * (s[-1] - s[0]) or following == zeta
        zeta = following
        if done:
            break
    # One complex Newton step carries the derivative of a complex-step check.
    value, slope, _ = curve.orthogonality(zeta + 0 * curve.points[0, 0])
    return zeta - value / slope if np.iscomplexobj(curve.points) else zeta
