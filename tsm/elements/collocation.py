"""Gauss collocation on the unit interval: nodes, weights, integrals of the interpolating polynomial."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from tsm.elements.properties import Array


class Collocation(NamedTuple):
    """Tables of one order, all constant.

    Attributes
    ----------
    c, w : ndarray, shape (p,)
        Gauss nodes and weights.
    once : ndarray, shape (p, p)
        ``once @ f``: integral of the polynomial through f, from 0 to every node.
    ends : ndarray, shape (p, 2)
        ``f @ ends``: integral over the interval, and its integral: ``int f`` and ``int (1 - x) f``.
    twice : ndarray, shape (p, p)
        ``once @ once``, less half of what makes it vanish at the far end: see `rod`.
    legendre : ndarray, shape (p, p)
        ``legendre @ f``: coefficients of the polynomial over the Legendre polynomials.
    """

    c: Array
    w: Array
    once: Array
    ends: Array
    twice: Array
    legendre: Array


@lru_cache(maxsize=64)
def collocation(order: int) -> Collocation:
    """Tables with `order` Gauss nodes.

    >>> t = collocation(3)
    >>> [round(float(x), 12) for x in (t.c**3 @ t.ends)]
    [0.25, 0.05]
    """
    x, weights = legendre.leggauss(order)
    w = weights / 2
    degrees = np.arange(order)
    to_legendre = legendre.legvander(x, order - 1).T * w * (2 * degrees + 1)[:, None]
    c = (x + 1) / 2
    once = integrals(c, order) @ to_legendre
    far = w * (1 - c)
    return Collocation(
        c=c,
        w=w,
        once=once,
        ends=np.stack([w, far], axis=1),
        twice=once @ once - np.outer(c, far) / 2,
        legendre=to_legendre,
    )


def integrals(x: Array, order: int) -> Array:
    """Integrals of the first `order` Legendre polynomials on the unit interval, from 0 to x; shape (m, order)."""
    P = legendre.legvander(2 * np.asarray(x) - 1, order)
    found = np.empty((len(P), order))
    found[:, 0] = x
    for k in range(1, order):
        found[:, k] = (P[:, k + 1] - P[:, k - 1]) / (4 * k + 2)
    return found
