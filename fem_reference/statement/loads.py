"""Dead loads on a strip: forces and moments on its sections, and forces per length such as a weight.

A force acts on its section as a uniform traction over the height, a moment as tractions that are linear over the height and normal to
the mean direction of the deformed section, a force per length as a force per volume that is uniform over the height.

In a stage, quantities change in proportion to the load parameter, from one whole number to the next.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_reference.statement.arrays import Floats
from fem_reference.statement.checks import Point, require, require_finite
from fem_reference.statement.strip import Strip


@dataclass(frozen=True, kw_only=True)
class PointLoad:
    """A dead force and a dead moment on a section of a strip: the force evenly over its height, the moment linearly.

    Parameters
    ----------
    strip
        Name of the strip.
    at
        Position of the section over the length: 0 at the start, 1 at the end.
    force
        Force at the load parameter 1, in the global frame [N]. It is proportional to the load parameter.
    moment
        Moment at the load parameter 1, anticlockwise [N m]. It is proportional to the load parameter.
    stage
        Number from 0 of the stage during which force and moment are added.

    Raises
    ------
    ValueError
        If a value is out of range or not finite, or force and moment vanish.
    """

    strip: str
    at: float = 1.0
    force: Point = (0.0, 0.0)
    moment: float = 0.0
    stage: int = 0

    def __post_init__(self) -> None:
        require(self, "stage", self.stage >= 0, "must not be negative")
        require(self, "at", 0 <= self.at <= 1, "must lie between 0 and 1")
        require_finite(self, "force", self.force, 2)
        require_finite(self, "moment", (self.moment,))
        require(self, "force", any((*self.force, self.moment)), "must not be zero without a moment")

    @property
    def node(self) -> str:
        """Name of the section, ``"strip.start"``, ``"strip.end"`` or ``"strip at 0.5"``."""
        end = {0.0: "start", 1.0: "end"}.get(self.at)
        return f"{self.strip} at {self.at!r}" if end is None else f"{self.strip}.{end}"

    def on_sections(self, strip: Strip, stations: Floats) -> Floats:
        """Forces ``(m, 2)`` on the mean displacements of the sections at ``stations`` ``(m,)``, in the global frame [N]."""
        return np.outer(_shares(strip, stations, np.array([self.at * strip.length])), self.force)


@dataclass(frozen=True, kw_only=True)
class LineLoad:
    """A dead force per undeformed length of a strip's axis, distributed evenly over the height.

    Parameters
    ----------
    strip
        Name of the strip.
    force
        Coefficients ``c_k`` of the force per length ``sum c_k f^k`` at the load parameter 1, f the position over the length, in the global
        frame [N/m]. It is proportional to the load parameter.
    part
        Positions over the length between which the force acts.
    stage
        Number from 0 of the stage during which the force is added.

    Raises
    ------
    ValueError
        If a value is not finite, all coefficients vanish, or the part is empty or beyond the strip.
    """

    strip: str
    force: tuple[Point, ...]
    part: tuple[float, float] = (0.0, 1.0)
    stage: int = 0
    moment = 0.0  # of a load that has none; no field

    def __post_init__(self) -> None:
        low, high = self.part
        require(self, "stage", self.stage >= 0, "must not be negative")
        for coefficient in self.force:
            require_finite(self, "force", coefficient, 2)
        require(self, "force", any(map(any, self.force)), "must not be zero")
        require(self, "part", 0 <= low < high <= 1, "must be two increasing numbers between 0 and 1")

    def on_sections(self, strip: Strip, stations: Floats) -> Floats:
        """Forces ``(m, 2)`` on the mean displacements of the sections at ``stations`` ``(m,)``, in the global frame [N]."""
        x, w = np.polynomial.legendre.leggauss(4)
        low, high = (part * strip.length for part in self.part)
        ends = np.clip(stations[:: _order(strip)], low, high)
        half = np.diff(ends)[:, None] / 2
        points, weights = (ends[:-1, None] + half * (1 + x)).ravel(), (half * w).ravel()
        per_length = np.polynomial.polynomial.polyval(points / strip.length, np.array(self.force))
        return _shares(strip, stations, points) @ (per_length * weights).T


Load = PointLoad | LineLoad


def _order(strip: Strip) -> int:
    """Number of stations from one element of a structured mesh to the next; the mean displacement is a polynomial between."""
    return 1 if strip.element == "Q1" or strip.mesh_file is not None else 2


def _shares(strip: Strip, stations: Floats, points: Floats) -> Floats:
    """Shares ``(m, p)`` of the sections in the mean displacement at the ``points`` ``(p,)``, by Lagrange's polynomials."""
    order, shares = _order(strip), np.zeros((stations.size, points.size))
    elements = np.clip(np.searchsorted(stations[::order], points) - 1, 0, (stations.size - 1) // order - 1)
    for element in np.unique(elements):
        part, here = slice(order * element, order * (element + 1) + 1), elements == element
        s, x = ((at - stations[part.start]) / np.ptp(stations[part]) for at in (stations[part], points[here]))
        shares[part, here] = np.linalg.solve(np.vander(s).T, np.vander(x, s.size).T)
    return shares


def stage_of(t: float, stages: int) -> int:
    """Number from 0 of the stage at the load parameter ``t``; at a boundary, the one that ends."""
    return min(max(math.ceil(t) - 1, 0), stages - 1)


def amount(increments: Any, t: float) -> Any:
    """Quantity at ``t`` that changes by ``increments[k]`` in the stage k."""
    stage = stage_of(t, len(increments))
    return (t - stage) * increments[stage] + sum(increments[:stage])


def increment(increments: Any, before: float, after: float) -> Any:
    """Change per load parameter between two load parameters of one stage."""
    return increments[stage_of((before + after) / 2, len(increments))]
