"""Problem data: strips, rigid pins on paths, contacts, and the conditions of the strips' ends."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference.statement.arrays import Array, Floats
from fem_reference.statement.checks import (
    Point,
    require,
    require_choice,
    require_distinct,
    require_finite,
    require_positive,
)
from fem_reference.statement.conditions import Joint, Spring, Support, require_held, require_known_ends
from fem_reference.statement.loads import Load, PointLoad, stage_of
from fem_reference.statement.strip import Strip

TURN = 0.5
"""Largest angle [rad] by which the path of a pin may turn within one load step."""


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A rigid circular pin that moves along a polyline at constant speed.

    Parameters
    ----------
    name
        Name of the pin, which contacts refer to.
    path
        Positions of the centre [m], one where the pin rests. The load parameter t in [0, 1] is the fraction of the path's length.
    radius
        Radius [m]; zero for a sharp pin.
    onward
        Points that the pin moves to in every stage after the first one, from one whole load parameter to the next; none where it rests.

    Raises
    ------
    ValueError
        If there is no point, a point is not finite, several points have no distance or the radius is negative.
    """

    name: str
    path: tuple[Point, ...]
    radius: float = 0.0
    onward: tuple[tuple[Point, ...], ...] = ()

    def __post_init__(self) -> None:
        onward = [point for points in self.onward for point in points]
        for field, points in (("path", self.path), ("onward", onward)):
            for point in points:
                require_finite(self, field, point, 2)
        whole = (*self.path, *onward)
        require(self, "path", len(self.path) > 0, "must have at least one point")
        require(self, "path", len(whole) == 1 or len(set(whole)) > 1, "must have a positive length")
        require_finite(self, "radius", (self.radius,), least=0.0)

    def position(self, t: float) -> Floats:
        """Return the position ``(2,)`` of the pin's centre at the load parameter ``t``."""
        stage = stage_of(t, len(self._ways))
        place = np.interp(t - stage, *self._ways[stage])
        return np.array([place.real, place.imag])

    @cached_property
    def _ways(self) -> tuple[tuple[Floats, Array], ...]:
        """Fractions of the length, and places in the complex plane, of the path's points in every stage, each ``(k,)``."""
        ways, last = [], self.path[:1]
        for points in (self.path[1:], *self.onward):
            way = np.array((*last, *points)) @ (1, 1j)
            reached = np.append(0.0, np.abs(np.diff(way)).cumsum())
            ways.append((reached / (reached[-1] or 1.0), way))
            last = (points or last)[-1:]
        return tuple(ways)

    @property
    def turns(self) -> tuple[float, ...]:
        """Load parameters of path points. Between two consecutive ones the path turns by at least `TURN`.

        >>> Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))).turns
        (0.5,)
        """
        load_parameters = []
        for stage, (fractions, way) in enumerate(self._ways):
            legs, turned = np.diff(way), 0.0
            bends = np.abs(np.angle(legs[1:] * legs[:-1].conj()))
            for t, bend in zip(fractions[1:-1].tolist(), bends.tolist(), strict=True):
                turned += bend
                if turned >= TURN:
                    load_parameters.append(stage + t)
                    turned = 0.0
        return tuple(load_parameters)


@dataclass(frozen=True, kw_only=True)
class Contact:
    """Unilateral contact of a pin, or of another strip's end, with a strip.

    Parameters
    ----------
    node
        Name of a pin, or an end of another strip such as ``"upper.end"``. The position of an end is the mean position of
        its edge.
    strip
        Name of the touched strip.
    side
        Side of the strip from which the node approaches, seen from start to end: ``"right"`` or ``"left"``.
    surface
        ``"axis"``: the curve of section-mean positions; ``"face"``: the face on the node's side.
    penalty
        Contact stiffness eps in the energy ``eps g^2 / 2`` [N/m]; None for `default_penalty`.
    penetration
        Largest penetration that augmented Lagrangian steps leave, relative to the strip's length. None for the penalty
        method without such steps.
    spread
        Half the length [m] of the strip over which the contact force is distributed and the position averaged. Zero for
        a sharp contact; None for 1.5 heights, at most a tenth of the length.
    keep
        Whether the solution ends with `Status.LOST_CONTACT` when the closed contact slips off an end of the strip.
        Otherwise the solution continues without this contact.
    friction
        Coefficient mu of Coulomb friction, see `fem_reference.contact.friction`. A pin does not turn.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    node: str
    strip: str
    side: str = "right"
    surface: str = "axis"
    penalty: float | None = None
    penetration: float | None = None
    spread: float | None = None
    keep: bool = True
    friction: float = 0.0

    def __post_init__(self) -> None:
        require_choice(self, "side", ("right", "left"))
        require_choice(self, "surface", ("axis", "face"))
        require_positive(self, "penalty")
        fits = self.penetration is None or 1e-13 <= self.penetration <= 1
        require(self, "penetration", fits, "must lie between 1e-13 and 1")
        require_finite(self, "spread", (self.spread or 0.0,), least=0.0)
        require_finite(self, "friction", (self.friction,), least=0.0)

    @property
    def name(self) -> str:
        """Name of the pair, ``"node->strip"``."""
        return f"{self.node}->{self.strip}"

    @property
    def sign(self) -> float:
        """Sign s in the gap ``g = s n . (x_c - r) - radius`` with the left normal n: +1 on the left, -1 on the right."""
        return 1.0 if self.side == "left" else -1.0


@dataclass(frozen=True, kw_only=True)
class SolidProblem:
    """Strips, pins and their contacts, supports, springs and joints of ends, and loads.

    Raises
    ------
    ValueError
        If a name appears twice, a contact, support, joint or load refers to an unknown name, an end has two supports, a
        joint's ends are apart, strips can move without strain and are not touched by a pin, or a node starts on the wrong side of a strip.
    """

    strips: tuple[Strip, ...]
    pins: tuple[Pin, ...] = ()
    contacts: tuple[Contact, ...] = ()
    supports: tuple[Support, ...] = ()
    joints: tuple[Joint, ...] = ()
    loads: tuple[Load, ...] = ()
    springs: tuple[Spring, ...] = ()

    def __post_init__(self) -> None:
        require(self, "strips", len(self.strips) > 0, "must hold at least one strip")
        for field in ("strips", "pins", "contacts"):
            require_distinct(self, field, [item.name for item in getattr(self, field)])
        names = [strip.name for strip in self.strips]
        for contact in self.contacts:
            nodes = [pin.name for pin in self.pins]
            nodes += [f"{name}.{end}" for name in names if name != contact.strip for end in ("start", "end")]
            require(contact, "strip", contact.strip in names, f"must name a strip: {names}")
            rule = f"must name a pin or another strip's end: {nodes}"
            require(contact, "node", contact.node in nodes, rule)
        for load in self.loads:
            require(load, "strip", load.strip in names, "must name a strip")
            clamps = {f"{load.strip}.{end}" for end in self.strip(load.strip).clamped}
            free = not isinstance(load, PointLoad) or load.node not in clamps
            require(load, "at", free, "must not be a clamped end")
        require_known_ends(self)
        require_held(self, self._touching())

    def strip(self, name: str) -> Strip:
        """Return the strip called ``name``."""
        return next(strip for strip in self.strips if strip.name == name)

    def pin(self, name: str) -> Pin | None:
        """Return the pin called ``name``; None for a strip's end."""
        return next((pin for pin in self.pins if pin.name == name), None)

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Load parameters at which a load step must end because a stage ends or the path of a pin turns, see `Pin.turns`."""
        ends = map(float, range(1, self.stages))
        return tuple(sorted({*ends, *(turn for pin in self.pins for turn in pin.turns)}))

    @cached_property
    def stages(self) -> int:
        """Number of stages. The load parameter of the last state is at most this number."""
        moved = [len(pin.onward) for pin in self.pins] + [len(item.onward) for item in self.supports]
        return 1 + max([0, *(load.stage for load in self.loads), *moved])

    def penalty(self, contact: Contact) -> float:
        """Contact stiffness eps of a contact [N/m]."""
        return contact.penalty or default_penalty(self.strip(contact.strip))

    def _touching(self) -> Iterator[tuple[str, Point, Point]]:
        """Strip, position and normal of every pin that touches at the start. No node may start beyond the touched surface."""
        for contact in self.contacts:
            strip, pin = self.strip(contact.strip), self.pin(contact.node)
            owner: Pin | Contact = pin or contact
            if pin:
                field, start, room = "path[0]", pin.path[0], pin.radius
            else:
                name, end = contact.node.split(".")
                field, start, room = "node", getattr(self.strip(name), end), 0.0
            axial, transverse = strip.place(start)
            if contact.surface == "face":
                room += strip.height_at(min(max(axial, 0.0), strip.length)) / 2
            gap, slack = contact.sign * transverse - room, 1e-9 * strip.length
            rule = f"must not start beyond the {contact.side} {contact.surface} of the strip (gap {gap:.3g})"
            require(owner, field, gap >= -slack or not 0 < axial < strip.length, rule, start)
            if pin and gap <= slack and 0 <= axial <= strip.length:
                x, y = strip.directions(axial)[1].tolist()
                yield strip.name, pin.path[0], (x, y)


def default_penalty(strip: Strip) -> float:
    """Contact stiffness ``25 E b`` [N/m] with which penetration is small compared with the local indentation.

    The local indentation under a line load scales with ``F / (E b)``. The bending stiffness ``3 E I / L^3``, which is
    ``E b (h / L)^3 / 4``, is smaller than ``E b`` in every slender strip.
    """
    return 25 * strip.youngs_modulus * strip.width
