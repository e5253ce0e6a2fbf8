"""Pins and contact pairs."""

import math
from bisect import bisect_left
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

from comparisons.scene import rules
from comparisons.scene.record import Record, Unjudged, key, one_of, optional
from comparisons.scene.rules import Point
from comparisons.scene.stages import PinMove, stage_of

STRAIGHT = "A straight path [length]; a displacement of zero leaves the pin at rest, an obstacle."


class Path:
    """A polyline at constant speed from load parameter 0 to 1; its points are equal where nothing moves [length]."""

    def __init__(self, points: tuple[Point, ...]) -> None:
        self.points = points

    @cached_property
    def _reached(self) -> tuple[float, ...]:
        """Distance along the path at every point, each rounded once."""
        lengths = [math.dist(a, b) for a, b in pairwise(self.points)]
        return tuple(math.fsum(lengths[:k]) for k in range(len(self.points)))

    @property
    def corners(self) -> tuple[float, ...]:
        """The load parameters of the inner points."""
        return tuple(reached / self._reached[-1] for reached in self._reached[1:-1])

    def position(self, load_parameter: float) -> Point:
        """Return the point at the fraction `load_parameter` of the length."""
        ahead = load_parameter * self._reached[-1]
        k = bisect_left(self._reached, ahead, 1, len(self.points) - 1)
        start, end = self.points[k - 1 : k + 1]
        if start == end:
            return start
        u = (ahead - self._reached[k - 1]) / math.dist(start, end)
        return (1.0 - u) * start[0] + u * end[0], (1.0 - u) * start[1] + u * end[1]


class PinSpec(Record):
    """A point, or a round pin that does not turn, on a prescribed path, traversed at constant speed by the load parameter."""

    name: str = key(rules.name, "Letters, digits, ``-`` and ``_``.")
    start: Point | None = optional(rules.point, STRAIGHT)
    displacement: Point | None = optional(rules.point, STRAIGHT)
    path: tuple[Point, ...] | None = optional(
        rules.polyline(2), "A polyline [length], instead of `start` and `displacement`."
    )
    radius: float | None = optional(
        rules.positive,
        "Radius of a round pin, whose centre is on the path [length]; else the pin is a point.",
    )
    moves: ClassVar[tuple[PinMove | None, ...] | None] = ()
    """Motions in the stages after the first one, which the scene states; one is None where the pin rests, all are where one is wrong."""

    obeys = (one_of(("start", "displacement"), ("path",)),)

    @cached_property
    def _paths(self) -> tuple[Path, ...]:
        """The path of every stage."""
        if self.moves is None:
            raise Unjudged("moves")
        if self.start is None or self.displacement is None:
            paths = [Path(self.path or ())]
        else:
            paths = [Path((self.start, _moved(self.start, self.displacement)))]
        for move in self.moves:
            here = paths[-1].points[-1]
            onward = (move and move.path) or (_moved(here, (move and move.displacement) or (0.0, 0.0)),)
            paths.append(Path((here, *onward)))
        return tuple(paths)

    @cached_property
    def stage_points(self) -> tuple[tuple[Point, ...], ...]:
        """The points of the path in every stage, from where the stage begins; one point where the pin rests."""
        return tuple(path.points[:1] if len(set(path.points)) == 1 else path.points for path in self._paths)

    @cached_property
    def points(self) -> tuple[Point, ...]:
        """The points of the path through all stages."""
        ways = (pair for path in self._paths for pair in pairwise(path.points))
        return (self._paths[0].points[0], *(b for a, b in ways if a != b))

    @property
    def moving(self) -> bool:
        """Whether the pin moves in any stage; otherwise it is an obstacle at rest."""
        return len(self.points) > 1

    @cached_property
    def corners(self) -> tuple[float, ...]:
        """The load parameters of the path's inner points, and the ones at which a stage ends and another follows."""
        stages = ((k, path.corners) for k, path in enumerate(self._paths))
        return tuple(k + t for k, inner in stages for t in ((0.0, *inner) if k else inner))

    def position(self, load_parameter: float) -> Point:
        """Return the point at the fraction of the length of its stage's path that `load_parameter` states."""
        stage = stage_of(load_parameter, len(self._paths))
        return self._paths[stage].position(load_parameter - stage)


def _moved(point: Point, displacement: Point) -> Point:
    return point[0] + displacement[0], point[1] + displacement[1]


class ContactSpec(Record):
    """A contact of a node with a beam."""

    node: str = key(rules.text, "A pin's name, or a beam's end as ``upper.end``.")
    beam: str = key(rules.name, "The beam touched.")
    side: str = key(rules.choice("right", "left"), "Side of the beam's direction from which the node comes.")
    surface: str = optional(
        rules.choice("axis", "face"), "The beam's axis, or its face at half the height.", "axis"
    )
    penalty: float | None = optional(
        rules.positive, "Penalty stiffness of the solid model [force/length]; automatic if not given."
    )
    penetration: float | None = optional(
        rules.positive,
        "Penetration of the solid over the length, by augmented Lagrangian steps; else the penalty bounds it.",
    )
    keep: bool = optional(
        rules.truth, "Whether a release or a slip-off of the closed contact ends the solution.", False
    )
    friction: float = optional(
        rules.friction,
        "Coulomb's coefficient of friction, which acts on the beam's `surface`.",
        0.0,
    )

    @property
    def pair(self) -> str:
        """Name of the pair, ``node->beam``."""
        return f"{self.node}->{self.beam}"
