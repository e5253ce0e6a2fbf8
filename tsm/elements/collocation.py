"""Gauss collocation on the unit interval: nodes, weights, integrals of the interpolating polynomial."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from tsm.elements.properties import Array


class Collocation(NamedTuple):
    """Tables of one order, all constant."""

    c: Array  # c, w: Gauss nodes and weights; shape (p,)
    w: Array
    once: Array  # ``once @ f``: integral of the polynomial through f, from 0 to every node; shape (p, p)
    half: Array  # ``once``, less half of what it is at the far end: see `rod`; shape (p, p)
    # ``legendre @ f``: coefficients of the polynomial over the Legendre polynomials; shape (p, p)
    legendre: Array
    # stations, barycentric: 0 and the Gauss nodes, with their barycentric weights
    # (Berrut and Trefethen 2004); shape (p + 1,)
    stations: Array
    barycentric: Array


_TINY = 1e-290
"""Distance to a station whose inverse would overflow."""


@lru_cache(maxsize=64)
def collocation(order: int) -> Collocation:
    """Tables with `order` Gauss nodes.

    >>> t = collocation(3)
    >>> round(float(t.c**3 @ t.w), 12)
    0.25
    """
    x, weights = legendre.leggauss(order)
    w = weights / 2
    degrees = np.arange(order)
    P = legendre.legvander(x, order)
    to_legendre = P[:, :order].T * w * (2 * degrees + 1)[:, None]
    c = (x + 1) / 2
    integrals = np.empty((order, order))
    integrals[:, 0] = c
    integrals[:, 1:] = (P[:, 2:] - P[:, :-2]) / (4 * degrees[1:] + 2)
    once = integrals @ to_legendre
    stations = np.append(0.0, c)
    apart = 4 * (stations[:, None] - stations)
    np.fill_diagonal(apart, 1.0)
    barycentric = 1 / apart.prod(axis=1)
    return Collocation(
        c=c,
        w=w,
        once=once,
        half=once - np.outer(c, w) / 2,
        legendre=to_legendre,
        stations=stations,
        barycentric=barycentric / np.abs(barycentric).max(),
    )


def interpolation(order: int, x: Array) -> Array:
    """Matrix that takes values at the stations to the points x (m,) of the polynomial through them, shape (m, p + 1)."""
    table = collocation(order)
    apart = x[:, None] - table.stations
    hit = np.abs(apart) < _TINY
    if hit.any():
        apart[hit.any(axis=1)] = np.inf
        apart[hit] = 1.0
    weights: Array = table.barycentric / apart
    weights /= weights.sum(axis=1, keepdims=True)
    return weights
