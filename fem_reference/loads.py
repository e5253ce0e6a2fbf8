"""Dead loads inside a strip: forces at points of the axis, and forces per length such as a weight.

They act on the sections of the strip:

- a force as a uniform traction over the height of its section;
- a moment as tractions that are linear over the height, normal to the mean direction of the deformed section;
- a force per length as a force per volume that is uniform over the height of every section. A weight is such a force.
"""

from dataclasses import dataclass
from math import isfinite

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.checks import Point, require, require_point
from fem_reference.strip import Strip


@dataclass(frozen=True, kw_only=True)
class PointLoad:
    """A dead force and a dead moment on the section inside a strip: the force evenly over its height, the moment linearly.

    Parameters
    ----------
    strip
        Name of the strip.
    at
        Position of the section over the length, between 0 and 1.
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
    at: float
    force: Point = (0.0, 0.0)
    moment: float = 0.0
    stage: int = 0

    def __post_init__(self) -> None:
        owner = f"PointLoad({self.strip!r})"
        require(self.stage >= 0, owner, "stage", self.stage, "must not be negative")
        require(0 < self.at < 1, owner, "at", self.at, "must lie between 0 and 1")
        require_point(owner, "force", self.force)
        require(isfinite(self.moment), owner, "moment", self.moment, "must be finite")
        rule = "must not be zero without a moment"
        require(any((*self.force, self.moment)), owner, "force", self.force, rule)

    @property
    def node(self) -> str:
        """Name of the section, ``"strip at 0.5"``."""
        return f"{self.strip} at {self.at!r}"

    def on_sections(self, strip: Strip, stations: Floats) -> Floats:
        """Forces ``(m, 2)`` on the mean displacements of the sections at ``stations`` ``(m,)``, in the global frame [N]."""
        at, forces = self.at * strip.length, np.zeros((stations.size, 2))
        for piece in _pieces(strip, stations):
            s = stations[piece]
            if s[0] <= at <= s[-1]:
                forces[piece] = np.outer(_shapes(s, np.array([at]))[:, 0], self.force)
                break
        return forces


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

    def __post_init__(self) -> None:
        owner = f"LineLoad({self.strip!r})"
        require(self.stage >= 0, owner, "stage", self.stage, "must not be negative")
        for coefficient in self.force:
            require_point(owner, "force", coefficient)
        require(any(map(any, self.force)), owner, "force", self.force, "must not be zero")
        low, high = self.part
        ordered = isfinite(low) and isfinite(high) and 0 <= low < high <= 1
        require(ordered, owner, "part", self.part, "must be two increasing numbers between 0 and 1")

    def per_length(self, fraction: Floats) -> Floats:
        """Force per length ``(p, 2)`` at positions over the length ``(p,)`` [N/m]."""
        powers = fraction[:, None] ** np.arange(len(self.force))
        return np.asarray(powers @ np.array(self.force))

    def on_sections(self, strip: Strip, stations: Floats) -> Floats:
        """Forces ``(m, 2)`` on the mean displacements of the sections at ``stations`` ``(m,)``, in the global frame [N]."""
        x, w = np.polynomial.legendre.leggauss(4)
        low, high = (part * strip.length for part in self.part)
        forces = np.zeros((stations.size, 2))
        for piece in _pieces(strip, stations):
            s = stations[piece]
            a, b = max(low, s[0]), min(high, s[-1])
            if a < b:
                points = (a + b) / 2 + (b - a) / 2 * x
                values = self.per_length(points / strip.length) * (w * (b - a) / 2)[:, None]
                forces[piece] += _shapes(s, points) @ values
        return forces


def _pieces(strip: Strip, stations: Floats) -> list[slice]:
    """Ranges of stations between which the mean displacement of the sections is interpolated: the elements of a structured mesh."""
    order = 1 if strip.element == "Q1" or strip.mesh_file is not None else 2
    return [slice(k, k + order + 1) for k in range(0, stations.size - 1, order)]


def _shapes(stations: Floats, points: Floats) -> Floats:
    """Lagrange's polynomials ``(k, p)`` of the stations ``(k,)`` at the points ``(p,)``."""
    rows = []
    for number, own in enumerate(stations):
        others = np.delete(stations, number)
        rows.append(np.prod((points[:, None] - others) / (own - others), axis=1))
    return np.array(rows)
