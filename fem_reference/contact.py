r"""Penalty contact of a sharp pin with a smooth curve carried by the solid.

The curve is the cubic spline through section positions ``X_k`` over their undeformed axial coordinates,
``r(zeta) = sum_k B_k(zeta) X_k``. At the closest point, ``(r - x_c) . r' = 0``, the gap is ``g = s n . (x_c - r)`` with the
curve's left normal n and side s. A penalty ``eps g^2 / 2 = eps |x_c - r|^2 / 2`` is, with the contact force
``lam = -eps g`` kept as a variable,

    Pi = -lam g - lam^2 / (2 eps).

With ``W = dr/du``, unit tangent t, ``rho = |r'|``, ``d = n . (r - x_c)``, ``k = n . r''`` and ``h = rho^2 + d k``, elimination of
zeta by its own stationarity gives both derivatives of the gap, hence force and symmetric tangent:

    dg/du   = -s W^T n
    d2g/du2 = -s (k W^T t t^T W - rho (W^T t n^T W' + W'^T n t^T W) - d W'^T n n^T W') / h.

The second holds at ``d = 0`` too: nothing is divided by the gap. Eliminating lam as well leaves the tangent
``eps (W^T W - c c^T / (r' . r' + (r - x_c) . r''))`` of the penalty alone, ``c = W^T r' + W'^T (r - x_c)``; keeping lam spares
Newton's method the force ``eps g`` of an iterate that is not yet in place, and the round-off of a stiff eps.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.mesh import Discretisation
from fem_reference.problem import Contact

_PROJECTION_STEPS = 40


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """A twice continuously differentiable curve through section positions.

    Parameters
    ----------
    stations
        Undeformed axial coordinates of the sections, ``(m,)`` [m].
    slopes
        Slopes of the cardinal splines at the stations, ``(m, m)``: ``dr/dzeta = slopes @ X`` there [1/m].
    nodes, weights
        Nodes ``(m, r)`` of each section and their weights ``(r,)`` in the section position ``X_k``.
    """

    stations: Floats
    slopes: Floats
    nodes: Ints
    weights: Floats

    def points(self, x: Array) -> Array:
        """Section positions ``(m, 2)`` from nodal positions ``x`` ``(n, 2)``."""
        return np.asarray(self.weights @ x[self.nodes])

    def basis(self, zeta: Any) -> Array:  # a float, or complex for a complex step
        """Values and first two derivatives of the cardinal splines at ``zeta``, ``(3, m)``."""
        s = self.stations
        k = min(max(int(np.searchsorted(s, np.real(zeta))) - 1, 0), s.size - 2)
        h = s[k + 1] - s[k]
        z = (zeta - s[k]) / h
        # Hermite polynomials: rows value, first, second derivative; columns X_k, X_k+1, slope k, slope k+1.
        hermite = np.array(
            [
                [(1 + 2 * z) * (1 - z) ** 2, z**2 * (3 - 2 * z), h * z * (1 - z) ** 2, h * z**2 * (z - 1)],
                [6 * z * (z - 1) / h, 6 * z * (1 - z) / h, (1 - z) * (1 - 3 * z), z * (3 * z - 2)],
                [(12 * z - 6) / h**2, (6 - 12 * z) / h**2, (6 * z - 4) / h, (6 * z - 2) / h],
            ]
        )
        B = hermite[:, 2:] @ self.slopes[k : k + 2]
        B[:, k : k + 2] += hermite[:, :2]
        return B


def contact_curve(mesh: Discretisation, contact: Contact) -> Curve:
    """Build the curve a contact acts on: section means ("axis") or the nodes of the touched face ("face")."""
    stations = mesh.stations
    if contact.surface == "axis":
        nodes, weights = mesh.columns, mesh.section_weights
    else:
        nodes, weights = mesh.columns[:, :1] if contact.side == "right" else mesh.columns[:, -1:], np.ones(1)
    slopes = CubicSpline(stations, np.eye(stations.size), bc_type="not-a-knot")(stations, 1)
    return Curve(stations=stations, slopes=slopes, nodes=nodes, weights=weights)


@dataclass(frozen=True, kw_only=True, eq=False)
class Projection:
    """The pin seen from the curve.

    Parameters
    ----------
    zeta
        Undeformed axial coordinate of the closest point [m].
    inside
        Whether the closest point lies on the strip, rather than beyond an end.
    stationary
        Whether ``(r - x_c) . r' = 0`` was reached at ``zeta``.
    gap
        Signed distance on the pin's side, negative in penetration [m].
    end_distance
        Distance to the nearer end of the curve [m]: how far off a pin is whose closest point is not inside.
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
    gap: Any
    end_distance: Any
    basis: Array
    tangent: Array
    normal: Array
    stretch: Any
    bend: Any


def project(curve: Curve, x: Array, pin: Floats, sign: float) -> Projection:
    """Project the pin on the curve carried by nodal positions ``x`` ``(n, 2)``; ``sign`` is s of the gap."""
    s, X = curve.stations, curve.points(x)
    zeta, stationary = closest(curve, X, pin)
    B = curve.basis(zeta)
    r, r1, r2 = B @ X
    stretch = np.sqrt(r1 @ r1)
    tangent = r1 / stretch
    normal = np.array([-tangent[1], tangent[0]])
    end = X[0] if 2 * np.real(zeta) < s[0] + s[-1] else X[-1]
    slack = 1e-12 * (s[-1] - s[0])  # a pin within round-off of an end is on the strip
    return Projection(
        zeta=zeta,
        inside=bool(s[0] - slack <= np.real(zeta) <= s[-1] + slack),
        stationary=stationary,
        gap=sign * normal @ (pin - r),
        end_distance=np.sqrt((end - pin) @ (end - pin)),
        basis=B,
        tangent=tangent,
        normal=normal,
        stretch=stretch,
        bend=normal @ r2,
    )


def closest(curve: Curve, X: Array, pin: Floats) -> tuple[Any, bool]:
    """Coordinate of the closest point, by Newton's method from the closest section, and whether it is stationary.

    The curve's end pieces are continued by one section spacing, so that a pin within round-off of an end, or
    beyond it during an iteration, still has a projection.
    """
    s = curve.stations
    low, high = 2 * s[0] - s[1], 2 * s[-1] - s[-2]
    zeta = s[np.argmin(((X - pin).real ** 2).sum(axis=1))] + 0 * X[0, 0]
    for _ in range(_PROJECTION_STEPS):
        r, r1, r2 = curve.basis(zeta) @ X
        slope = r1 @ r1 + (r - pin) @ r2
        # Beyond the centre of curvature, Gauss-Newton instead.
        if slope.real <= 0.1 * (r1 @ r1).real:
            slope = r1 @ r1
        step = -((r - pin) @ r1) / slope
        last, zeta = zeta, zeta + step if np.iscomplexobj(X) else min(max(zeta + step, low), high)
        if abs(step) <= 1e-14 * (s[-1] - s[0]):
            return zeta, True
        if zeta == last:
            break
    return zeta, False


def gap_derivatives(curve: Curve, at: Projection, nodes: int, sign: float) -> tuple[Array, Array]:
    """First and second derivative of the gap with respect to the nodal displacements.

    Parameters
    ----------
    curve, at
        The curve and the pin's projection on it.
    nodes
        Number of nodes n.
    sign
        Side s of the gap.

    Returns
    -------
    U : (2 n, 3)
        Columns ``dg/du``, ``W^T t`` and ``W'^T n``.
    H : (3, 3)
        ``d2g/du2 = U H U^T`` [1/m]; the first row and column vanish.
    """
    d = -sign * at.gap
    pairs = ((at.basis[0], -sign * at.normal), (at.basis[0], at.tangent), (at.basis[1], at.normal))
    U = np.zeros((nodes, 2, 3), dtype=np.result_type(*at.normal))
    for column, (row, vector) in enumerate(pairs):
        U[curve.nodes, :, column] = (row[:, None] * curve.weights)[:, :, None] * vector
    H = np.array([[0.0, 0.0, 0.0], [0.0, at.bend, -at.stretch], [0.0, -at.stretch, -d]])
    return U.reshape(-1, 3), -sign * H / (at.stretch**2 + d * at.bend)
