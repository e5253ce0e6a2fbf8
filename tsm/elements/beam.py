"""The beam element without contact, with the basic system simply supported on the chord.

The element has three deformations: the elongation ``e = l - l0`` of the chord, the mean m of the end rotations from the chord, which
goes with a shear force, and half their difference h, which goes with a constant curvature. The rotations are ``theta_i = m + h`` and
``theta_j = m - h``. The strain energy is ::

    U = (e + em m^2 + eh h^2)^2 / (2 (c0 + cm m^2 + ch h^2)) + (km m^2 + kh h^2)/2 + r4 m^4 + r2 m^2 h^2

    c0 = l0/EA,  km = 12 EI/(l0 (1 + Phi)),  kh = 4 EI/l0

The paper's element has only the three coefficients c0, km and kh. The six others represent the strains of the Reissner rod, axial
``(1 + u') cos theta + w' sin theta - 1`` and shear ``w' cos theta - (1 + u') sin theta``::

    em = l0 (1 - 5 Phi^2)/(10 (1 + Phi)^2) + 12 EI Phi/(l0 EA (1 + Phi)^2),    eh = l0/6
    cm = D l0 (1 + 5 Phi^2)/(5 (1 + Phi)^2),    ch = D l0/3,    D = 1/GA - 1/EA
    r4 = v sm/6 + v^2 cm/2,    r2 = v sh/6 + v^2 ch/2,    v = -12 EI/(l0^2 (1 + Phi))
    sm = l0 (1 + B/2 + B^2/10 + B^3/140),    sh = l0 (1 + B/10),    B = -6/(1 + Phi)

- ``em, eh`` represent the bow: bending shortens the chord by ``integral (w'^2 - gamma^2)/2``, with the shear strain gamma. The second
  term of em is the stretch by the shear force v m, which has an axial component in the turned sections.
- ``cm, ch`` represent the component of the axial force that shears the turned sections.
- ``r4, r2`` represent a finite gamma.

For rotations of the size d the error of the energy is of the order d^6 if e is of the order d^2, and of the order d^4 if e is of the
order d. Without the six coefficients the element converges with second order only. With the bow alone it converges to a limit with a
relative error of the order gamma^2.

In the terms of the tangent stiffness method ([P] (1)-(2)), the returned tangent is ``K_O + K_G``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array, Properties, chord_rotation, unwind

# (dx, dy, m, h) from the element's displacements
_REDUCE = np.zeros((4, 6))
_REDUCE[0, [0, 3]] = _REDUCE[1, [1, 4]] = -1, 1
_REDUCE[2, [2, 5]] = 0.5
_REDUCE[3, [2, 5]] = 0.5, -0.5
_GATHER = _REDUCE.T.copy()
# the ten distinct entries of the tangent over those four, spread over the displacements
_PAIRS = [(0, 0), (0, 1), (1, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)]
_PRODUCTS = np.einsum("ai,bj->abij", _REDUCE, _REDUCE).reshape(4, 4, 36)
_SPREAD = np.array([_PRODUCTS[a, b] + (a != b) * _PRODUCTS[b, a] for a, b in _PAIRS]).T.copy()


class Coefficients(NamedTuple):
    """Coefficients of the energy, see the module's text."""

    chord: Array  # undeformed chord; shape (2, n)
    l0: Array  # undeformed length; shape (n,)
    # constant, of_mm, of_hh: coefficients of the polynomial in ``m^2`` and ``h^2`` that gives lengthening,
    # flexibility and, without the axial force, the stiffnesses against m and h; shape (4, n)
    constant: Array
    of_mm: Array
    of_hh: Array
    e: Array  # e, c: ``2 em, 2 eh`` and ``cm, ch``; shape (2, n)
    c: Array
    r4: Array  # r4, r2: ``8 r4`` and ``4 r2``; shape (n,)
    r2: Array


def linear_coefficients(p: Properties) -> Coefficients:
    """Coefficients of the paper's element: elongation of the chord, linear bending and shear."""
    none = np.zeros_like(p.l0)
    return _coefficients(p, np.array([none, none]), np.array([none, none]), none, none)


def bowed_coefficients(p: Properties) -> Coefficients:
    """Coefficients with the strain measures of the Reissner rod to fourth order.

    They follow from ``N (l0 + e) - integral (N_s + N_s^2/2EA + Q_s^2/2GA - EI theta'^2/2)`` at Timoshenko's solution, which has the
    shear force ``v m`` and the rotation ``m + h - 2 h xi + B m xi (1 - xi)`` from the chord.
    """
    l0, EA, EI, Phi = p.l0, p.EA, p.EI, p.Phi
    shear_strain = -Phi / (1 + Phi)
    shear_force = -12 * EI / (l0 * l0 * (1 + Phi))
    parabola = -6 / (1 + Phi)
    # integrals over the element: theta^2 = tm m^2 + th h^2, theta^3 = m (sm m^2 + sh h^2)
    tm = l0 * (1 + 5 * Phi * Phi) / (5 * (1 + Phi) ** 2)
    th = l0 / 3
    sm = l0 * (1 + parabola / 2 + parabola**2 / 10 + parabola**3 / 140)
    sh = l0 * (1 + parabola / 10)
    excess = Phi * l0 * l0 / (12 * EI) - 1 / EA
    lengthening = l0 * (1 - 5 * Phi * Phi) / (10 * (1 + Phi) ** 2) + shear_force * shear_strain * l0 / EA
    return _coefficients(
        p,
        np.array([lengthening, l0 / 6]),
        excess * np.array([tm, th]),
        shear_force * sm / 6 + shear_force**2 * excess * tm / 2,
        shear_force * sh / 6 + shear_force**2 * excess * th / 2,
    )


def _coefficients(p: Properties, e: Array, c: Array, r4: Array, r2: Array) -> Coefficients:
    none = np.zeros_like(p.l0)
    return Coefficients(
        chord=np.array([p.dx0, p.dy0]),
        l0=p.l0,
        constant=np.array([none, p.l0 / p.EA, 12 * p.EI / (p.l0 * (1 + p.Phi)), 4 * p.EI / p.l0]),
        of_mm=np.array([e[0], c[0], 4 * r4, 2 * r2]),
        of_hh=np.array([e[1], c[1], 2 * r2, none]),
        e=2 * e,
        c=c,
        r4=8 * r4,
        r2=4 * r2,
    )


def _deformed(a: Coefficients, x: Array) -> tuple[Array, Array, Array, Array]:
    """Chord (2, n), its length and its elongation (n,), and the rotations m and h (2, n)."""
    shift = x[3:5] - x[:2]
    chord = a.chord + shift
    (x0, y0), (dx, dy) = a.chord, chord
    squared = chord * chord
    length = np.sqrt(squared[0] + squared[1])
    # l - l0 without the cancellation of two lengths
    stretched = (a.chord + chord) * shift
    e = (stretched[0] + stretched[1]) / (length + a.l0)
    turn = chord_rotation(x0 * dy - y0 * dx, x0 * dx + y0 * dy)
    bend = np.empty_like(shift)
    bend[0] = unwind((x[2] + x[5]) / 2 - turn)
    bend[1] = (x[2] - x[5]) / 2
    return chord, length, e, bend


def response(a: Coefficients, x: Array) -> tuple[Array, Array]:
    """Nodal forces and exact tangent of beam elements.

    ``x`` (6, n): element displacements, component first. Returns ``force`` (6, n), gradient of the energy;
    ``tangent`` (36, n), its derivative, row by row, symmetric.
    """
    chord, length, e, bend = _deformed(a, x)
    t = chord / length
    tx, ty = t

    mm, hh = bend * bend
    polynomial = a.constant + a.of_mm * mm + a.of_hh * hh
    flexibility = polynomial[1]
    N = (e + polynomial[0]) / flexibility
    softer = N * a.c
    gain = a.e - softer
    stiffness = polynomial[2:] + N * gain
    slope = bend * (gain - softer)
    coupling = slope / flexibility

    moments = bend * stiffness
    shear = moments[0] / length
    reduced = np.empty((4, *x.shape[1:]), dtype=x.dtype)
    reduced[0] = N * tx + shear * ty
    reduced[1] = N * ty - shear * tx
    reduced[2:] = moments

    entries = np.empty((10, *x.shape[1:]), dtype=x.dtype)
    bending = slope * coupling + stiffness
    entries[7] = bending[0] + a.r4 * mm
    entries[8] = slope[0] * coupling[1] + a.r2 * bend[0] * bend[1]
    entries[9] = bending[1]
    # of the chord vector, in the chord's own axes: tt, tn, nn, and across with m and h
    across = entries[7:9] / length
    tn = (shear - coupling[0]) / length
    nn = (N + across[0]) / length
    tt = 1 / flexibility
    xx, yy = t * t
    xy = tx * ty
    turned = (tn + tn) * xy
    entries[0] = tt * xx + nn * yy - turned
    entries[1] = (tt - nn) * xy + tn * (xx - yy)
    entries[2] = tt * yy + nn * xx + turned
    entries[3:5] = tx * coupling + ty * across
    entries[5:7] = ty * coupling - tx * across
    return _GATHER @ reduced, _SPREAD @ entries


def energy(a: Coefficients, x: Array) -> Array:
    """Strain energy of beam elements, shape (n,); arguments as for `response`."""
    _, _, e, bend = _deformed(a, x)
    mm, hh = bend * bend
    polynomial = a.constant + a.of_mm * mm + a.of_hh * hh
    stretch = (e + polynomial[0]) ** 2 / polynomial[1]
    bending = a.constant[2] * mm + a.constant[3] * hh
    return (stretch + bending + a.r4 * mm * mm / 4 + a.r2 * mm * hh / 2) / 2
