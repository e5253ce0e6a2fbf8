"""A beam as a rod: its undeformed axis, its stiffnesses along the axis, and the resultant of the dead load on it.

The undeformed axis is a straight line, or an arc that turns left by `turn`. At the arc position s it has the angle ``beta(s) = kappa0 s -
turn/2`` from the chord, ``kappa0 = turn/length``. The rotation theta of a section is measured from its undeformed direction, so that the
curvature is ``kappa0 + theta'`` and the moment ``EI theta'``. A dead load q per undeformed length gives the force ``n(s) = c - W(s)``,
with ``W' = q``, ``W(0) = 0`` and c constant between stations.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyint, polyval
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Flexibility(NamedTuple):
    """EI, 1/EA and 1/GA at arc positions, or one of their derivatives."""

    EI: Any
    stretch: Any
    shear: Any


@dataclass(frozen=True, kw_only=True, eq=False)
class Rod:
    """A beam in the units of `comparisons.referee.layout.Layout`.

    Attributes
    ----------
    length, turn : float
        Undeformed length, and the angle by which the axis turns left.
    axes : ndarray, shape (2, 2)
        Unit vectors along the chord and to its left, as columns.
    stiffness : tuple of ndarray
        Coefficients of EI, EA and GA as polynomials in the arc position, ascending.
    greatest : Flexibility
        The flexibilities, of a taper the largest 1/EA and 1/GA and the smallest EI.
    load : ndarray, shape (pieces, k, 2)
        Coefficients of W on every piece, in the frame of the chord.
    breaks : ndarray, shape (pieces + 1,)
        Arc positions between which a piece reaches; inner ones are ends of loads and places of forces inside the beam.
    """

    length: float
    turn: float
    axes: Array
    stiffness: tuple[Array, Array, Array]
    greatest: Flexibility
    load: Array
    breaks: Array

    @cached_property
    def tapers(self) -> bool:
        """Whether the section changes along the beam."""
        return any(len(item) > 1 for item in self.stiffness)

    @cached_property
    def loaded(self) -> bool:
        """Whether a load acts along the beam."""
        return bool(np.any(self.load))

    @cached_property
    def uniform(self) -> bool:
        """Whether the beam is straight, of one section, and without a load along it."""
        return self.turn == 0.0 and not self.tapers and not self.loaded

    @cached_property
    def curvature(self) -> float:
        """Curvature kappa0 of the undeformed axis."""
        return self.turn / self.length

    def angle(self, s: Any) -> Any:
        """Angle beta of the undeformed axis from the chord."""
        return self.curvature * s - self.turn / 2.0

    def flexibility(self, s: Any) -> Flexibility:
        """Return EI, 1/EA and 1/GA at arc positions, real or complex."""
        if not self.tapers:
            return self.greatest
        EI, EA, GA = (polyval(s, item) for item in self.stiffness)
        return Flexibility(EI, 1.0 / EA, 1.0 / GA)

    def softening(self, s: float) -> Array:
        """Return the derivatives of 1/EA and 1/GA by the arc position."""
        return np.array([-polyval(s, polyder(item)) / polyval(s, item) ** 2 for item in self.stiffness[1:]])

    def between(self, a: float, b: float) -> Array:
        """Way of the undeformed axis from one arc position to another, in the frame of the chord."""
        if self.turn == 0.0:
            return np.array([b - a, 0.0])
        half, angle = self.curvature * (b - a) / 2.0, (self.angle(a) + self.angle(b)) / 2.0
        chord = (b - a) * float(np.sinc(half / math.pi))
        return np.array([chord * math.cos(angle), chord * math.sin(angle)])

    def direction(self, s: float) -> Array:
        """Unit tangent of the undeformed axis in the frame of the chord."""
        angle = self.angle(s)
        return np.array([math.cos(angle), math.sin(angle)])

    def frame(self, s: Any) -> Any:
        """Unit vectors along the undeformed axis and to its left in the axes of the scene, as columns; real or complex s."""
        if self.turn == 0.0:
            return self.axes
        c, d = np.cos(self.angle(s)), np.sin(self.angle(s))
        return self.axes @ np.array([[c, -d], [d, c]])

    def resultant(self, piece: int, s: Any) -> Any:
        """Resultant W (..., 2) of the load from the start to arc positions on a piece."""
        return np.stack([polyval(s, self.load[piece, :, k]) for k in range(2)], axis=-1)

    def turned(self, vector: Any, s: Any, *, back: bool = False) -> Any:
        """Return vectors (..., 2) from the frame of the chord in the frame of the undeformed tangent at arc positions, or `back`."""
        if self.turn == 0.0:
            return vector
        a, b = np.cos(self.angle(s)), np.sin(self.angle(s)) * (-1.0 if back else 1.0)
        x, y = vector[..., 0], vector[..., 1]
        return np.stack([a * x + b * y, a * y - b * x], axis=-1)

    def steepness(self, piece: int, n: Any, s: Any) -> Any:
        """Return the derivative of `local`, n, by the arc position: ``kappa0 (n_y, -n_x) - q`` in the frame of the undeformed tangent."""
        turning = self.curvature * np.stack([n[..., 1], -n[..., 0]], axis=-1)
        return turning - self.turned(polyval(s, polyder(self.load[piece])), s)

    def local(self, piece: int, c: Any, s: Any) -> Any:
        """Force ``c - W`` in the frame of the undeformed tangent at arc positions, (..., 2); real or complex."""
        if self.uniform:
            return c
        return self.turned(c - self.resultant(piece, s) if self.loaded else c, s)


def resultants(
    length: float, spans: list[tuple[float, float, Array]], breaks: set[float]
) -> tuple[Array, Array]:
    """Return the arc positions between which a load is one polynomial, and the coefficients of W there.

    `spans` are loads from one arc position to another, each with the coefficients (k, 2) of q; `breaks` are further arc positions.
    """
    if not spans:
        places = np.array(sorted({0.0, length, *breaks}))
        return places, np.zeros((len(places) - 1, 1, 2))
    places = np.array(sorted({0.0, length, *breaks, *(s for a, b, _ in spans for s in (a, b))}))
    size = max([1, *(len(q) for _, _, q in spans)])
    table, before = np.zeros((len(places) - 1, size + 1, 2)), np.zeros(2)
    for W, a, b in zip(table, places[:-1], places[1:], strict=True):
        q = np.zeros((size, 2))
        for first, last, density in spans:
            if first <= a and b <= last:
                q[: len(density)] += density
        W[:] = polyint(q, lbnd=a)
        W[0] += before
        before = polyval(b, W)
    return places, table
