"""A control node: a point on a prescribed path through all stages of the load."""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise

from tsm.statement.beam import LARGEST, Point, check, is_point
from tsm.statement.stages import stage_of

TURN = 0.5
"""Angle in radians that the path of a pin may turn by within a load step."""


@dataclass(frozen=True)
class Polyline:
    """A polyline at constant speed, from parameter 0 to 1; a single point is at rest."""

    points: tuple[Point, ...]  # its corners [length]

    @cached_property
    def _reached(self) -> list[float]:
        """Distance along the path at every corner, each rounded once."""
        legs = [math.dist(a, b) for a, b in pairwise(self.points)]
        if not math.isfinite(sum(legs)):
            return list(accumulate(legs, initial=0.0))
        return [math.fsum(legs[:corner]) for corner in range(len(legs) + 1)]

    @property
    def length(self) -> float:
        """Length of the polyline."""
        return self._reached[-1]

    def _leg(self, t: float) -> int:
        """Number of the leg at a parameter; at a corner, the leg before it."""
        at = bisect_left(self._reached, t * self.length)
        return min(max(at, 1), len(self.points) - 1) - 1

    def velocity(self, begin: float, end: float) -> Point:
        """Mean derivative of the position between two parameters; the derivative if these are equal, at a corner on the leg before it."""
        if len(self.points) == 1:
            return (0.0, 0.0)
        k = self._leg(end)
        if begin != end and self._reached[k] > min(begin, end) * self.length:
            return _mean(self.position(begin), self.position(end), end - begin)
        a, b = self.points[k : k + 2]
        return _mean(a, b, math.dist(a, b) / self.length)

    @property
    def corners(self) -> tuple[float, ...]:
        """Parameters of the inner points."""
        return tuple(done / self.length for done in self._reached[1:-1])

    @property
    def turns(self) -> tuple[float, ...]:
        """Parameters of the corners at which the path has turned by `TURN` since the last of them."""
        found, turned = [], 0.0
        legs = pairwise(self.points)
        for done, ((a, b), (_, c)) in zip(self._reached[1:], pairwise(legs), strict=False):
            one, other = (math.atan2(q[1] - p[1], q[0] - p[0]) for p, q in ((a, b), (b, c)))
            turned += abs(math.remainder(other - one, math.tau))
            if turned >= TURN:
                found.append(done / self.length)
                turned = 0.0
        return tuple(found)

    def position(self, t: float) -> Point:
        """Position at a parameter in [0, 1]."""
        if len(self.points) == 1:
            return self.points[0]
        k = self._leg(t)
        a, b = self.points[k : k + 2]
        part = (t * self.length - self._reached[k]) / math.dist(a, b)
        return (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A control node: a point that follows a prescribed path and does not turn.

    Parameters
    ----------
    name : str
        Unique name.
    path : sequence of tuple of float
        Corners of a polyline [length], traversed at constant speed while the load parameter goes from 0 to 1; one point where the
        pin rests.
    onward : sequence of sequence of tuple of float
        Points that the pin moves to in each of the stages after the first one; none where it rests.
    """

    name: str
    path: tuple[Point, ...]
    onward: tuple[tuple[Point, ...], ...] = ()

    def __post_init__(self) -> None:
        owner = f"Pin({self.name})"
        check(len(self.path) > 0, owner, "path", self.path, "must have at least one point")
        for field, points in (("path", self.path), *(("onward", points) for points in self.onward)):
            pairs = all(map(is_point, points))
            check(pairs, owner, field, points, f"must hold pairs of finite numbers, of at most {LARGEST:g}")
        for polyline in self.polylines:
            apart = all(a != b for a, b in pairwise(polyline.points))
            check(apart, owner, "path", polyline.points, "must not repeat a point at once")

    @cached_property
    def polylines(self) -> tuple[Polyline, ...]:
        """The path in every stage."""
        parts = [Polyline(self.path)]
        for points in self.onward:
            parts.append(Polyline((parts[-1].points[-1], *points)))
        return tuple(parts)

    @property
    def points(self) -> tuple[Point, ...]:
        """Corners of the path through all stages."""
        return (*self.path, *(point for points in self.onward for point in points))

    def velocity(self, begin: float, end: float) -> Point:
        """Mean derivative of the position between two load parameters; the derivative if these are equal, at a corner on the leg before it.

        >>> Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))).velocity(0.0, 1.0)
        (1.0, 1.0)
        """
        line, stage = self._at(end)
        if begin < stage:
            return _mean(self.position(begin), self.position(end), end - begin)
        return line.velocity(begin - stage, end - stage)

    def _at(self, load_parameter: float) -> tuple[Polyline, int]:
        """Path at a load parameter, and its stage."""
        stage = stage_of(load_parameter, len(self.polylines)) if self.onward else 0
        return self.polylines[stage], stage

    @property
    def corners(self) -> tuple[float, ...]:
        """Load parameters of the inner points of the path in every stage."""
        return tuple(k + t for k, part in enumerate(self.polylines) for t in part.corners)

    @property
    def turns(self) -> tuple[float, ...]:
        """Load parameters of the corners inside a stage at which the path has turned by `TURN` since the last of them.

        >>> Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))).turns
        (0.5,)
        """
        return tuple(k + t for k, part in enumerate(self.polylines) for t in part.turns)

    def position(self, load_parameter: float) -> Point:
        """Position at a load parameter.

        >>> Pin(name="pin", path=((0.0, 0.0), (2.0, 0.0), (2.0, 2.0))).position(0.75)
        (2.0, 1.0)
        """
        line, stage = self._at(load_parameter)
        return line.position(load_parameter - stage)


def _mean(a: Point, b: Point, span: float) -> Point:
    return ((b[0] - a[0]) / span, (b[1] - a[1]) / span)
