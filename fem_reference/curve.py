"""The curve that a contact acts on, and the closest point on it.

The curve is an average along the cubic spline through section or face positions ``X_k`` over their undeformed axial
coordinates, ``r(zeta) = sum_q w_q sum_k B_k(zeta + d_q) X_k``: twice continuously differentiable, unlike the elements' edges.
Without the average the contact's own dent, and the kink of the axis by shear, turn the normal by up to
``F / (G A_e)`` according to where in an element the contact sits.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import csr_matrix

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.mesh import Discretisation
from fem_reference.problem import Contact
from fem_reference.strip import Strip

_PROJECTION_STEPS = 40


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """A twice continuously differentiable curve along points carried by nodes.

    Parameters
    ----------
    stations
        Undeformed axial coordinates of the points, increasing, ``(m,)`` [m].
    slopes
        Slopes of the cardinal splines at the stations as a band, `band_slopes`, ``(m, 2 b + 1)`` [1/m].
    rows
        Weights of the nodes in the points, ``(m, n)``.
    offsets, kernel
        Distances ``(q,)`` [m] and weights ``(q,)`` of the points that are averaged.
    """

    stations: Floats
    slopes: Floats
    rows: csr_matrix
    offsets: Floats
    kernel: Floats

    def basis(self, zeta: Any) -> Array:  # a float, or complex for a complex step
        """Values and first two derivatives of the averaged cardinal splines at ``zeta``, ``(3, m)``."""
        s, points = self.stations, zeta + self.offsets
        k, hermite = self._pieces(points)
        weighted = hermite * self.kernel
        first, count = int(k.min()), int(np.ptp(k)) + 2
        ones = np.eye(count)
        left, right = ones[k - first], ones[k - first + 1]
        values, slopes = (weighted[:, n] @ left + weighted[:, n + 1] @ right for n in (0, 2))
        reach = self.slopes.shape[1]
        half = reach // 2
        shifted = np.zeros((count, count + reach))
        shifted[:, :reach] = self.slopes[first : first + count]
        # Every row begins one place further to the right than the one before.
        rows = shifted.ravel()[:-count].reshape(count, count + reach - 1)
        padded = np.zeros((3, s.size + 2 * half), dtype=hermite.dtype)
        padded[:, first : first + count + reach - 1] = slopes @ rows
        padded[:, half + first : half + first + count] += values
        return padded[:, half : half + s.size]

    def _pieces(self, zeta: Array) -> tuple[Ints, Array]:
        """Pieces of the spline that hold the points ``zeta`` ``(q,)``, and Hermite's polynomials there, ``(3, 4, q)``.

        Rows value, first, second derivative; columns X_k, X_k+1, slope k, slope k+1. Beyond the ends they go on along their
        tangents.
        """
        s = self.stations
        inner = np.where(zeta.real < s[0], s[0], np.where(zeta.real > s[-1], s[-1], zeta))
        k = np.clip(np.searchsorted(s, inner.real) - 1, 0, s.size - 2)
        h = s[k + 1] - s[k]
        z = (inner - s[k]) / h
        hermite = np.array(
            [
                [(1 + 2 * z) * (1 - z) ** 2, z**2 * (3 - 2 * z), h * z * (1 - z) ** 2, h * z**2 * (z - 1)],
                [6 * z * (z - 1) / h, 6 * z * (1 - z) / h, (1 - z) * (1 - 3 * z), z * (3 * z - 2)],
                [(12 * z - 6) / h**2, (6 - 12 * z) / h**2, (6 * z - 4) / h, (6 * z - 2) / h],
            ]
        )
        beyond = zeta - inner
        hermite[0] += beyond * hermite[1]
        hermite[2] *= beyond == 0
        return k, hermite


def band_slopes(stations: Floats) -> Floats:
    """Slopes at the stations of the not-a-knot splines that are one at one station and zero at the others.

    Those of the stations ``k - b`` to ``k + b`` at the station k, ``(m, 2 b + 1)``, b = 45 or ``m - 1``: with every station further off they
    fall to .27, at worst to a half. They are found window by window, so that work and memory grow with m only.
    """
    m = stations.size
    half = min(_REACH, m - 1)
    band = np.zeros((m, 2 * half + 1))
    for first in range(0, m, _WINDOW):
        last = min(first + _WINDOW, m)
        low, high = max(0, first - 2 * _REACH), min(m, last + 2 * _REACH)
        near = stations[low:high]
        full = np.zeros((last - first, high - low + 2 * half))
        full[:, half : half + near.size] = CubicSpline(near, np.eye(near.size), bc_type="not-a-knot")(
            stations[first:last], 1
        )
        rows = np.arange(last - first)
        band[first:last] = full[rows[:, None], (first - low + rows)[:, None] + np.arange(2 * half + 1)]
    return band


_REACH, _WINDOW = 45, 256


def contact_curve(strip: Strip, mesh: Discretisation, contact: Contact) -> Curve:
    """Build the curve a contact acts on: section means ("axis") or the nodes of the touched face ("face")."""
    stations, rows = mesh.stations, mesh.sections
    if contact.surface == "face":
        face = mesh.edges[contact.side]
        stations = mesh.nodes[face, 0]
        rows = csr_matrix(
            (np.ones(face.size), (np.arange(face.size), face)), shape=(face.size, len(mesh.nodes))
        )
    parts = (
        stations / strip.length
    )  # of a few stations a spline solves equations that lengths far from 1 make ill-conditioned
    slopes = band_slopes(parts) / strip.length
    offsets, kernel = averaging(contact_spread(strip, contact), float(np.diff(stations).min()))
    return Curve(stations=stations, slopes=slopes, rows=rows, offsets=offsets, kernel=kernel)


def contact_spread(strip: Strip, contact: Contact) -> float:
    """Half of the length that a contact is spread over [m]: as given, or 1.5 heights, at most a tenth of the length."""
    return min(1.5 * strip.height, strip.length / 10) if contact.spread is None else contact.spread


def averaging(spread: float, spacing: float) -> tuple[Floats, Floats]:
    """Points and weights of an average over ``[-spread, spread]`` that leaves cubic curves as they are.

    Gauss points, at least two to a ``spacing`` of the curve's points, of the kernel ``15 (3 - 10 x^2 + 7 x^4) / 32``
    (Gasser, Mueller, Mammitzsch, J. R. Statist. Soc. B 47 (1985), 238-252, table 1).
    """
    if spread == 0:
        return np.zeros(1), np.ones(1)
    x, w = np.polynomial.legendre.leggauss(max(12, int(np.ceil(4 * spread / spacing))))
    kernel = w * (3 - 10 * x**2 + 7 * x**4)
    return spread * x, kernel / kernel.sum()


@dataclass(frozen=True, kw_only=True, eq=False)
class Projection:
    """A point seen from the curve.

    Parameters
    ----------
    zeta
        Undeformed axial coordinate of the closest point [m].
    inside
        Whether the closest point lies on the strip, rather than beyond an end.
    stationary
        Whether ``(r - x_c) . r' = 0`` was reached at ``zeta``.
    distance
        ``n . (x_c - r)``, positive on the left [m].
    end_distance
        Distance to the nearer end of the curve [m]: how far off a point is whose closest point is not inside.
    basis
        Spline values and derivatives at ``zeta``, ``(3, m)``.
    tangent, normal
        Unit tangent and left normal of the curve, ``(2,)``.
    stretch, bend
        ``rho = |r'|`` [-] and ``k = n . r''`` [1/m].
    """

    zeta: Any
    inside: bool
    stationary: bool
    distance: Any
    end_distance: Any
    basis: Array
    tangent: Array
    normal: Array
    stretch: Any
    bend: Any


def project(curve: Curve, X: Array, point: Array) -> Projection:
    """Project a point on the curve through the positions ``X`` ``(m, 2)``."""
    s = curve.stations
    zeta, stationary = closest(curve, X, point)
    B = curve.basis(zeta)
    r, r1, r2 = B @ X
    stretch = np.sqrt(r1 @ r1)
    tangent = r1 / stretch
    normal = np.array([-tangent[1], tangent[0]])
    end = X[0] if 2 * np.real(zeta) < s[0] + s[-1] else X[-1]
    slack = 1e-12 * (s[-1] - s[0])  # a point within round-off of an end is on the strip
    return Projection(
        zeta=zeta,
        inside=bool(s[0] - slack <= np.real(zeta) <= s[-1] + slack),
        stationary=stationary,
        distance=normal @ (point - r),
        end_distance=np.sqrt((end - point) @ (end - point)),
        basis=B,
        tangent=tangent,
        normal=normal,
        stretch=stretch,
        bend=normal @ r2,
    )


def closest(curve: Curve, X: Array, point: Array) -> tuple[Any, bool]:
    """Coordinate of the closest point, by Newton's method from the closest station, and whether it is stationary.

    The curve's end pieces are continued by one spacing, so that a point within round-off of an end, or beyond it
    during an iteration, still has a projection. Near a centre of curvature the root is kept between the neighbouring stations.
    """
    s = curve.stations
    low, high = 2 * s[0] - s[1], 2 * s[-1] - s[-2]
    k = int(np.argmin(((X - point).real ** 2).sum(axis=1)))
    zeta, flat = s[k] + 0 * X[0, 0], False
    for _ in range(_PROJECTION_STEPS):
        fall, slope, size = _fall(curve, X, point, zeta)
        # Beyond the centre of curvature, Gauss-Newton instead.
        if slope.real <= 0.1 * size.real:
            if not flat:
                flat, found = True, _bracketed(curve, X, point, k)
                if found is not None:
                    return found, True
            slope = size
        step = -fall / slope
        last, zeta = zeta, zeta + step if np.iscomplexobj(X) else min(max(zeta + step, low), high)
        if abs(step) <= 1e-14 * (s[-1] - s[0]):
            return zeta, True
        if zeta == last:
            break
    return zeta, False


def _fall(curve: Curve, X: Array, point: Array, zeta: Any) -> tuple[Any, Any, Any]:
    """``(r - x_c) . r'``, its slope ``r' . r' + (r - x_c) . r''`` and ``r' . r'``."""
    r, r1, r2 = curve.basis(zeta) @ X
    size = r1 @ r1
    return (r - point) @ r1, size + (r - point) @ r2, size


def _bracketed(curve: Curve, X: Array, point: Array, k: int) -> Any | None:
    """Closest point between the neighbours of station k, by Newton's method kept in a bracket; None if there is none."""
    s = np.concatenate([[2 * curve.stations[0] - curve.stations[1]], curve.stations])
    s = np.append(s, 2 * s[-1] - s[-2])
    low, high = float(s[k]), float(s[k + 2])
    if _fall(curve, X, point, low)[0].real > 0 or _fall(curve, X, point, high)[0].real < 0:
        return None
    zeta = float(s[k + 1])
    for _ in range(_PROJECTION_STEPS):
        fall, slope, size = (term.real for term in _fall(curve, X, point, zeta))
        low, high = (low, zeta) if fall > 0 else (zeta, high)
        after = zeta - fall / slope if slope > 0 else np.inf
        if not low < after < high:
            after = (low + high) / 2
        done = abs(fall) <= 1e-14 * size * (s[-1] - s[0]) or after == zeta
        zeta = after
        if done:
            break
    fall, slope, _ = _fall(curve, X, point, zeta + 0 * X[0, 0])
    return zeta - fall / slope if np.iscomplexobj(X) else zeta
