"""A control node: a point on a prescribed path through all stages of the load."""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from tsm.statement.beam import LARGEST, Point, check, is_point

TURN = 0.5
"""Angle in radians that the path of a pin may turn by within a load step."""


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
        apart = all(a != b for a, b in pairwise(self.points))
        check(apart, owner, "path", self.points, "must not repeat a point at once")

    @property
    def points(self) -> tuple[Point, ...]:
        """Corners of the path through all stages."""
        return (*self.path, *(point for points in self.onward for point in points))

    @cached_property
    def _reached(self) -> tuple[list[float], list[Point]]:
        """Load parameters and places of the corners; where the pin rests in a stage, its place at both ends of the stage."""
        times, places = [0.0], [self.path[0]]
        for stage, points in enumerate((self.path[1:], *self.onward)):
            legs = [math.dist(a, b) for a, b in pairwise((places[-1], *points))] or [1.0]
            length = math.fsum(legs)
            times += [stage + math.fsum(legs[:done]) / length for done in range(1, len(legs) + 1)]
            places += points or places[-1:]
        return times, places

    def _leg(self, load_parameter: float) -> tuple[float, Point, float, Point]:
        """Load parameter and place at both ends of the leg at a load parameter; at a corner, of the leg before it."""
        times, places = self._reached
        k = min(max(bisect_left(times, load_parameter), 1), len(times) - 1)
        return times[k - 1], places[k - 1], times[k], places[k]

    def position(self, load_parameter: float) -> Point:
        """Position at a load parameter.

        >>> Pin(name="pin", path=((0.0, 0.0), (2.0, 0.0), (2.0, 2.0))).position(0.75)
        (2.0, 1.0)
        """
        begin, a, end, b = self._leg(load_parameter)
        part = (load_parameter - begin) / (end - begin)
        return (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))

    def velocity(self, begin: float, end: float) -> Point:
        """Mean derivative of the position between two load parameters; the derivative if these are equal, at a corner on the leg before it.

        >>> Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))).velocity(0.0, 1.0)
        (1.0, 1.0)
        """
        first, a, last, b = self._leg(end)
        if begin != end and min(begin, end) < first:
            first, a, last, b = begin, self.position(begin), end, self.position(end)
        return ((b[0] - a[0]) / (last - first), (b[1] - a[1]) / (last - first))

    @property
    def corners(self) -> tuple[float, ...]:
        """Load parameters of the inner points of the path in every stage."""
        return tuple(t for t in self._reached[0] if not t.is_integer())

    @property
    def turns(self) -> tuple[float, ...]:
        """Load parameters of the corners inside a stage at which the path has turned by `TURN` since the last of them.

        >>> Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))).turns
        (0.5,)
        """
        (times, places), found, turned = self._reached, [], 0.0
        for t, a, b, c in zip(times[1:], places, places[1:], places[2:], strict=False):
            one, other = (math.atan2(q[1] - p[1], q[0] - p[0]) for p, q in ((a, b), (b, c)))
            turned += abs(math.remainder(other - one, math.tau))
            if t.is_integer():
                turned = 0.0
            elif turned >= TURN:
                found.append(t)
                turned = 0.0
        return tuple(found)
