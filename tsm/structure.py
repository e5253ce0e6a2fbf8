"""Statement of a problem: supports, loads, pins, contact pairs, and the structure with its beams.

Everything here is immutable, holds plain numbers and checks itself; nothing is computed yet.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Literal

from tsm.beam import LARGEST, MOST, Beam, LineLoad, Point, Section
from tsm.beam import check as _check
from tsm.beam import finite as _finite

End = Literal["start", "end"]
Side = Literal["left", "right"]


__all__ = [
    "Beam",
    "ContactPair",
    "End",
    "LineLoad",
    "Load",
    "Pin",
    "Point",
    "Section",
    "Side",
    "Structure",
    "Support",
]


def _between(a: Point, b: Point, part: float) -> Point:
    return (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))


def _direction(a: Point, b: Point) -> float:
    return math.atan2(b[1] - a[1], b[0] - a[0])


MOST_FRICTION = 100.0
"""Largest coefficient of friction; the force then leans 89.4 degrees."""


@dataclass(frozen=True, kw_only=True)
class Support:
    """Prescribed displacement of a beam end at load parameter 1; ``None`` leaves the component free.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"}
        Which end.
    ux, uy : float or None
        Prescribed displacement [length].
    rotation : float or None
        Prescribed rotation, anticlockwise [rad].
    """

    beam: str
    end: End
    ux: float | None = 0.0
    uy: float | None = 0.0
    rotation: float | None = 0.0

    def __post_init__(self) -> None:
        owner = f"Support({self.beam}.{self.end})"
        _check(self.end in {"start", "end"}, owner, "end", self.end, 'must be "start" or "end"')
        for field in ("ux", "uy", "rotation"):
            value = getattr(self, field)
            _check(
                value is None or _finite(value),
                owner,
                field,
                value,
                f"must be None or finite, of at most {LARGEST:g}",
            )


@dataclass(frozen=True, kw_only=True)
class Load:
    """Dead force and moment on a node of a beam at load parameter 1; both keep their direction.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"} or None
        Which end, None for a node inside the beam.
    arc : float or None
        Arc position of the node inside the beam [length], instead of `end`.
    force : tuple of float
        Force (x, y).
    moment : float
        Moment, anticlockwise.
    """

    beam: str
    end: End | None = None
    arc: float | None = None
    force: Point = (0.0, 0.0)
    moment: float = 0.0

    def __post_init__(self) -> None:
        owner = f"Load({self.beam}.{self.arc if self.end is None else self.end})"
        if self.arc is None:
            _check(self.end in {"start", "end"}, owner, "end", self.end, 'must be "start" or "end"')
        else:
            _check(self.end is None, owner, "arc", self.arc, "is given instead of end, not besides")
        _check(
            len(self.force) == 2 and _finite(*self.force),
            owner,
            "force",
            self.force,
            f"must be two finite numbers, of at most {LARGEST:g}",
        )
        _check(_finite(self.moment), owner, "moment", self.moment, f"must be finite, of at most {LARGEST:g}")


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
        Corners of a polyline [length], traversed at constant speed while the load parameter goes from 0 to 1.
    """

    name: str
    path: tuple[Point, ...]

    def __post_init__(self) -> None:
        owner = f"Pin({self.name})"
        _check(len(self.path) >= 2, owner, "path", self.path, "must have at least two points")
        _check(
            all(len(point) == 2 and _finite(*point) for point in self.path),
            owner, "path", self.path, f"must hold pairs of finite numbers, of at most {LARGEST:g}",
        )  # fmt: skip
        _check(
            all(a != b for a, b in zip(self.path, self.path[1:], strict=False)),
            owner, "path", self.path, "must not repeat a point at once",
        )  # fmt: skip

    @cached_property
    def _reached(self) -> list[float]:
        """Distance along the path at every corner, each rounded once."""
        legs = [math.dist(a, b) for a, b in pairwise(self.path)]
        if not math.isfinite(sum(legs)):
            return list(accumulate(legs, initial=0.0))
        return [float(reached) for reached in accumulate(map(Fraction, legs), initial=Fraction(0))]

    @property
    def length(self) -> float:
        """Length of the path."""
        return self._reached[-1]

    def _leg(self, load_parameter: float) -> int:
        """Number of the leg at a load parameter; at a corner, the leg before it."""
        at = bisect_left(self._reached, load_parameter * self.length)
        return min(max(at, 1), len(self.path) - 1) - 1

    def velocity(self, begin: float, end: float) -> Point:
        """Mean derivative of the position between two load parameters; at one of them the derivative, at a corner of the leg before.

        >>> Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))).velocity(0.0, 1.0)
        (1.0, 1.0)
        """
        k = self._leg(end)
        if begin != end and self._reached[k] > min(begin, end) * self.length:
            (x0, y0), (x1, y1) = self.position(begin), self.position(end)
            return ((x1 - x0) / (end - begin), (y1 - y0) / (end - begin))
        a, b = self.path[k : k + 2]
        speed = self.length / math.dist(a, b)
        return (speed * (b[0] - a[0]), speed * (b[1] - a[1]))

    @property
    def corners(self) -> tuple[float, ...]:
        """Load parameters of the path's inner points."""
        return tuple(done / self.length for done in self._reached[1:-1])

    @property
    def turns(self) -> tuple[float, ...]:
        """Load parameters of the corners at which the path has turned by `TURN` since the last of them.

        >>> Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))).turns
        (0.5,)
        """
        found, turned = [], 0.0
        legs = pairwise(self.path)
        for done, ((a, b), (_, c)) in zip(self._reached[1:], pairwise(legs), strict=False):
            turned += abs(math.remainder(_direction(b, c) - _direction(a, b), math.tau))
            if turned >= TURN:
                found.append(done / self.length)
                turned = 0.0
        return tuple(found)

    def position(self, load_parameter: float) -> Point:
        """Position at a load parameter in [0, 1].

        >>> Pin(name="pin", path=((0.0, 0.0), (2.0, 0.0), (2.0, 2.0))).position(0.75)
        (2.0, 1.0)
        """
        k = self._leg(load_parameter)
        a, b = self.path[k : k + 2]
        left = load_parameter * self.length - self._reached[k]
        return _between(a, b, left / math.dist(a, b))


@dataclass(frozen=True, kw_only=True)
class ContactPair:
    """A node that may touch a beam from one side only.

    Parameters
    ----------
    node : str
        Name of a pin, or ``"beam.start"`` / ``"beam.end"`` for a beam's end.
    beam : str
        Name of the beam that is touched.
    side : {"left", "right"}
        Side of the beam's direction from which the node comes.
    offset : float
        Distance from the axis to the contact surface [length], 0 for contact on the axis.
    keep : bool
        Whether the contact, once closed, must persist: a release or a slip-off then ends the solution by name.
    friction : float
        Coulomb's coefficient mu: the tangential force is at most mu times the normal force, and equal to it in slip.
    radius : float
        Radius of a round pin that does not turn, the part of `offset` that is not the beam's [length]. It matters with friction only.
    """

    node: str
    beam: str
    side: Side = "right"
    offset: float = 0.0
    keep: bool = False
    friction: float = 0.0
    radius: float = 0.0

    def __post_init__(self) -> None:
        _check(self.side in {"left", "right"}, self.name, "side", self.side, 'must be "left" or "right"')
        _check(
            _finite(self.offset) and self.offset >= 0,
            self.name,
            "offset",
            self.offset,
            "must not be negative",
        )
        _check(
            0 <= self.friction <= MOST_FRICTION,
            self.name, "friction", self.friction, f"must lie between 0 and {MOST_FRICTION:g}",
        )  # fmt: skip
        _check(
            0 <= self.radius <= self.offset,
            self.name, "radius", self.radius, "must lie between 0 and the offset",
        )  # fmt: skip

    @property
    def name(self) -> str:
        """Name of the pair, ``node->beam``."""
        return f"{self.node}->{self.beam}"


@dataclass(frozen=True, kw_only=True)
class Structure:
    """Beams with their supports and loads, the pins that push them and the contacts that may close.

    Beams whose ends have the same coordinates are rigidly joined there.

    Raises
    ------
    ValueError
        Naming the field, its value and the rule, for names that are not unique or not known, a beam that would
        touch itself, or a structure without beams.
    """

    beams: tuple[Beam, ...]
    supports: tuple[Support, ...] = ()
    pins: tuple[Pin, ...] = ()
    contacts: tuple[ContactPair, ...] = ()
    loads: tuple[Load, ...] = ()
    line_loads: tuple[LineLoad, ...] = ()

    def __post_init__(self) -> None:
        _check(len(self.beams) > 0, "Structure", "beams", self.beams, "must not be empty")
        elements = sum(beam.elements for beam in self.beams)
        _check(elements <= MOST, "Structure", "elements", elements, f"must be at most {MOST} in all")
        names = [beam.name for beam in self.beams] + [pin.name for pin in self.pins]
        _unique(names, "a beam or pin")
        _unique([pair.name for pair in self.contacts], "a contact")
        _unique([f"{support.beam}.{support.end}" for support in self.supports], "a support")
        beams = {beam.name for beam in self.beams}
        ends = {f"{beam}.{end}" for beam in beams for end in ("start", "end")}
        nodes = {pin.name for pin in self.pins} | ends
        for support in self.supports:
            _check(support.beam in beams, "Support", "beam", support.beam, "names no beam")
        for load in self.loads:
            _check(load.beam in beams, "Load", "beam", load.beam, "names no beam")
            if load.arc is not None:
                at_node = self.beam(load.beam).node(load.arc) is not None
                _check(at_node, f"Load({load.beam})", "arc", load.arc, "must be a node, see Beam.divided")
        for line_load in self.line_loads:
            _check(line_load.beam in beams, "LineLoad", "beam", line_load.beam, "names no beam")
            line_load.check(self.beam(line_load.beam))
        for pair in self.contacts:
            _check(pair.beam in beams, pair.name, "beam", pair.beam, "names no beam")
            _check(pair.node in nodes, pair.name, "node", pair.node, "names no pin and no beam end")
            own = pair.node.rpartition(".")[0] == pair.beam
            _check(not own, pair.name, "node", pair.node, "a beam does not touch itself")

    def beam(self, name: str) -> Beam:
        """Beam of that name."""
        return next(beam for beam in self.beams if beam.name == name)


def _unique(names: Iterable[str], what: str) -> None:
    seen: set[str] = set()
    for name in names:
        _check(name not in seen, "Structure", "names", name, f"names more than one of {what}")
        seen.add(name)
