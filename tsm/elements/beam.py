"""The beam element between contacts: basic system simply supported on the chord.

With the elongation ``e = l - l0`` of the chord and the end rotations from it, taken together as
``u = theta_i + theta_j`` (shear bends it so) and ``d = theta_i - theta_j`` (constant curvature), the energy is ::

    U = (e + eu u^2 + ed d^2)^2 / (2 (c0 + cu u^2 + cd d^2)) + (ku u^2 + kd d^2)/2 + r4 u^4 + r2 u^2 d^2

    c0 = l0/EA,  ku = 3 EI/(l0 (1 + Phi)),  kd = EI/l0

The paper's element has these three coefficients only. The others carry the Reissner rod's strain measures
``(1 + u') cos theta + w' sin theta - 1`` and ``w' cos theta - (1 + u') sin theta`` to fourth order in rotation and
strain: ``eu, ed`` are the length taken up by bending, ``integral (w'^2 - gamma^2)/2`` ("bow"); ``cu, cd`` the normal force's
share in shear; the rest what a finite shear strain gamma adds. Without them the element converges with second
order only, or, with the bow alone, to a limit that is off by gamma^2.

In the terms of the tangent stiffness method ([P] (1)-(2)) the returned tangent is ``K_O + K_G``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array, Properties, chord_rotation, unwind

# the tangent's ten distinct entries over (dx, dy, theta_i, theta_j), spread over the element's displacements
_REDUCE = np.zeros((4, 6))
_REDUCE[0, [0, 3]] = _REDUCE[1, [1, 4]] = -1, 1
_REDUCE[2, 2] = _REDUCE[3, 5] = 1
_PAIRS = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 2), (2, 3), (3, 3)]
_SPREAD = np.array(
    [
        (np.outer(_REDUCE[a], _REDUCE[b]) + (a != b) * np.outer(_REDUCE[b], _REDUCE[a])).ravel()
        for a, b in _PAIRS
    ]
)


class Coefficients(NamedTuple):
    """Coefficients of the energy, see the module's text; arrays of shape (n,)."""

    c0: Array
    ku: Array
    kd: Array
    eu: Array
    ed: Array
    cu: Array
    cd: Array
    r4: Array
    r2: Array


def linear_coefficients(p: Properties) -> Coefficients:
    """Coefficients of the paper's element: elongation of the chord, linear bending and shear."""
    zero = np.zeros_like(p.l0)
    ku = 3 * p.EI / (p.l0 * (1 + p.Phi))
    return Coefficients(p.l0 / p.EA, ku, p.EI / p.l0, zero, zero, zero, zero, zero, zero)


def bowed_coefficients(p: Properties) -> Coefficients:
    """Coefficients with the strain measures of the Reissner rod to fourth order.

    Perturbation of ``integral N_s^2/2EA + Q_s^2/2GA + EI theta'^2/2`` about Timoshenko's solution, whose rotation
    from the chord is linear plus ``P xi (1 - xi)``, with ``integral theta = -gamma l0``, ``P = p u``.
    """
    l0, EA, EI, Phi = p.l0, p.EA, p.EI, p.Phi
    linear = linear_coefficients(p)
    shear_strain = -Phi / (2 * (1 + Phi))
    shear_force = -6 * EI / (l0 * l0 * (1 + Phi))
    shear_compliance = Phi * l0 * l0 / (12 * EI)
    parabola = -3 / (1 + Phi)
    # integrals over the element: theta^2 = tu u^2 + td d^2, theta^3 = u (su u^2 + sd d^2)
    tu = l0 * (1 + 5 * Phi * Phi) / (20 * (1 + Phi) ** 2)
    td = l0 / 12
    su = l0 * (1 / 8 + parabola / 8 + parabola**2 / 20 + parabola**3 / 140)
    sd = l0 * (1 / 8 + parabola / 40)
    excess = shear_compliance - 1 / EA
    return linear._replace(
        eu=l0 * (1 - 5 * Phi * Phi) / (40 * (1 + Phi) ** 2) + shear_force * shear_strain * l0 / EA,
        ed=l0 / 24,
        cu=excess * tu,
        cd=excess * td,
        r4=shear_force * su / 6 + shear_force**2 * excess * tu / 2,
        r2=shear_force * sd / 6 + shear_force**2 * excess * td / 2,
    )


def response(p: Properties, c: Coefficients, x: Array) -> tuple[Array, Array]:
    """Nodal forces and exact tangent of beam elements.

    Parameters
    ----------
    p : Properties
        Constants, arrays of shape (n,).
    c : Coefficients
        Of the energy.
    x : ndarray, shape (n, 6)
        Element displacements.

    Returns
    -------
    force : ndarray, shape (n, 6)
        Gradient of the energy.
    tangent : ndarray, shape (n, 6, 6)
        Its derivative, symmetric.
    """
    du, dv = x[:, 3] - x[:, 0], x[:, 4] - x[:, 1]
    dx, dy = p.dx0 + du, p.dy0 + dv
    length = np.sqrt(dx * dx + dy * dy)
    tx, ty = dx / length, dy / length
    e = (2 * (p.dx0 * du + p.dy0 * dv) + du * du + dv * dv) / (length + p.l0)
    turn = chord_rotation(p.dx0 * dy - p.dy0 * dx, p.dx0 * dx + p.dy0 * dy)
    theta_i, theta_j = unwind(x[:, 2] - turn), unwind(x[:, 5] - turn)
    u, d = theta_i + theta_j, theta_i - theta_j

    uu, dd = u * u, d * d
    compliance = c.c0 + c.cu * uu + c.cd * dd
    N = (e + c.eu * uu + c.ed * dd) / compliance
    by_u, by_d = 2 * N * (c.eu - N * c.cu / 2), 2 * N * (c.ed - N * c.cd / 2)
    G = u * (by_u + c.ku + 4 * c.r4 * uu + 2 * c.r2 * dd)
    D = d * (by_d + c.kd + 2 * c.r2 * uu)
    fu, fd = 2 * u * (c.eu - N * c.cu), 2 * d * (c.ed - N * c.cd)

    shear = 2 * G / length
    force = np.empty(x.shape, dtype=x.dtype)
    force[:, 3] = N * tx + shear * ty
    force[:, 4] = N * ty - shear * tx
    force[:, :2] = -force[:, 3:5]
    force[:, 2] = G + D
    force[:, 5] = G - D

    ee = 1 / compliance
    eu, ed = fu * ee, fd * ee
    Huu = fu * eu + by_u + c.ku + 12 * c.r4 * uu + 2 * c.r2 * dd
    Hud = fu * ed + 4 * c.r2 * u * d
    Hdd = fd * ed + by_d + c.kd + 2 * c.r2 * uu
    # of the chord vector, in the chord's own axes: tt, tn, nn
    tn = (shear - 2 * eu) / length
    nn = (N + 4 * Huu / length) / length
    ti, tj = eu + ed, eu - ed
    ni, nj = -2 * (Huu + Hud) / length, -2 * (Huu - Hud) / length
    xx, xy, yy = tx * tx, tx * ty, ty * ty
    entries = np.stack(
        [
            ee * xx - 2 * tn * xy + nn * yy,
            (ee - nn) * xy + tn * (xx - yy),
            ee * yy + 2 * tn * xy + nn * xx,
            ti * tx - ni * ty,
            ti * ty + ni * tx,
            tj * tx - nj * ty,
            tj * ty + nj * tx,
            Huu + 2 * Hud + Hdd,
            Huu - Hdd,
            Huu - 2 * Hud + Hdd,
        ],
        axis=1,
    )
    return force, (entries @ _SPREAD).reshape(-1, 6, 6)
