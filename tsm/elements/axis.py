"""The deflected axis inside closed-form elements, at equal lengths of arc: for shapes, not for equilibrium."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tsm.elements.properties import Array, Properties, from_chord

_PIECES, _ROUNDS = 8, 3
"""Pieces with a linear curvature each, and rounds of the iteration, each of which gains two powers of the length."""


def deflected_axes(
    p: Properties,
    x: Array,
    force: Array,
    contacts: Sequence[tuple[int, float, tuple[float, float]]],
    xi: Array,
) -> Array:
    """Positions along the axes of elements from their ends i: the rod's equations between their end states.

    The element gives the internal force n; sections turn by phi, t and n_ are their directions::

        phi' = l0 (M + a + b xi)/EI,  M' = -(r' x n),  r' = l0 ((1 + n.t/EA) t + (n.n_/GA) n_)

    They are solved by Picard's iteration from the chord. The element satisfies equilibrium inside only approximately. Three small
    corrections therefore close the axis: a and b fit the rotation of end j and the direction of the chord, and a factor close to one
    fits the length of the chord.

    ``x, force`` (6, elements): displacements of the elements and nodal forces on them. ``contacts``: number of
    the element, place xi and force on it. ``xi`` (m,): positions along the elements, as parts of the length. Returns
    (elements, m, 2).
    """
    dx, dy, first, last = (value[:, None] for value in from_chord(p, x))
    chord = dx + 1j * dy
    stations = np.unique(
        np.concatenate([np.linspace(0, 1, _PIECES + 1), xi, [place for _, place, _ in contacts]])
    )
    n = np.repeat(-(force[0] + 1j * force[1])[:, None], len(stations) - 1, axis=1)
    for element, place, (Fx, Fy) in contacts:
        n[element, stations[:-1] >= place] -= complex(Fx, Fy)
    n *= np.abs(chord) / chord
    inverse = p.l0[:, None] / p.EI[:, None]
    r, b = stations * np.abs(chord) + 0j, np.zeros_like(first)
    for _ in range(_ROUNDS):
        bend = inverse * _sums(-(np.conj(np.diff(r)) * n).imag)
        turned = _sums(np.diff(stations) * (bend[:, 1:] + bend[:, :-1]) / 2)
        a = last - first - turned[:, -1:] - b / 2
        r = _positions(
            p, first + turned + a * stations + b * stations**2 / 2, bend + a + b * stations, n, stations
        )
        b += 12 * r[:, -1:].imag / r[:, -1:].real
    points = (r * chord / r[:, -1:])[:, np.searchsorted(stations, xi)]
    return np.stack([points.real, points.imag], axis=-1)


def _sums(values: Array) -> Array:
    """Sums up to every station, from zero."""
    sums = np.zeros((len(values), values.shape[1] + 1), values.dtype)
    np.cumsum(values, axis=1, out=sums[:, 1:])
    return sums


def _positions(p: Properties, angle: Array, bend: Array, n: Array, stations: Array) -> Array:
    """Integrals of r' by Simpson's rule in every piece, where the curvature is linear."""
    step, stretch, shear = np.diff(stations), 1 / p.EA[:, None], (p.Phi * p.l0**2 / (12 * p.EI))[:, None]
    middle = angle[:, :-1] + step * (3 * bend[:, :-1] + bend[:, 1:]) / 8
    total = np.zeros(n.shape, complex)
    t_ends = np.exp(1j * angle)
    for weight, t in ((1, t_ends[:, :-1]), (4, np.exp(1j * middle)), (1, t_ends[:, 1:])):
        along = np.conj(t) * n
        total += weight / 6 * t * (1 + along.real * stretch + 1j * along.imag * shear)
    return _sums(p.l0[:, None] * step * total)
