"""Statement of a problem: supports, loads, pins, contact pairs, and the structure with its beams.

Everything here is immutable, holds plain numbers and checks itself; nothing is computed yet.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from tsm.statement.beam import (
    END,
    ENDS,
    FINITE,
    MOST,
    MOST_STAGES,
    POINT,
    STAGE,
    Beam,
    End,
    LineLoad,
    Point,
    check,
    checks,
    finite,
    is_point,
)  # fmt: skip
from tsm.statement.pin import Pin
from tsm.statement.springs import Hinge, Spring

Side = Literal["left", "right"]


MOST_FRICTION = 100.0
"""Largest coefficient of friction; the force then leans 89.4 degrees."""


@dataclass(frozen=True, kw_only=True)
class Support:
    """Prescribed displacement of a beam end; ``None`` leaves the component free.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"}
        Which end.
    ux, uy : float or None
        Prescribed displacement at load parameter 1 [length].
    rotation : float or None
        Prescribed rotation at load parameter 1, anticlockwise [rad].
    onward : sequence of tuple of float
        Displacement x, y and rotation by which the end moves on in each of the stages after the first one; zero where free.
    """

    beam: str
    end: End
    ux: float | None = 0.0
    uy: float | None = 0.0
    rotation: float | None = 0.0
    onward: tuple[tuple[float, float, float], ...] = ()

    def __post_init__(self) -> None:
        owner = f"Support({self.beam}.{self.end})"
        of_field = checks(owner, self)
        held = [value is not None for value in (self.ux, self.uy, self.rotation)]
        for motion in self.onward:
            check(finite(*motion), owner, "onward", motion, f"must be {FINITE}")
            still = all(has or not value for value, has in zip(motion, held, strict=True))
            check(still, owner, "onward", motion, "must be zero where the component is free")
        of_field("end", self.end in ENDS, END)
        for field in ("ux", "uy", "rotation"):
            value = getattr(self, field)
            of_field(field, value is None or finite(value), f"must be None or {FINITE}")


@dataclass(frozen=True, kw_only=True)
class Load:
    """Dead force and moment on a node of a beam, applied in one stage; both keep their direction and stay after the stage.

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
    stage : int
        Number of the stage, from 0, in which the load grows with the load parameter.
    """

    beam: str
    end: End | None = None
    arc: float | None = None
    force: Point = (0.0, 0.0)
    moment: float = 0.0
    stage: int = 0

    def __post_init__(self) -> None:
        check = checks(f"Load({self.beam}.{self.arc if self.end is None else self.end})", self)
        if self.arc is None:
            check("end", self.end in ENDS, END)
        else:
            check("arc", self.end is None, "is given instead of end, not besides")
        check("force", is_point(self.force), POINT)
        check("moment", finite(self.moment), f"must be {FINITE}")
        check("stage", 0 <= self.stage <= MOST_STAGES, STAGE)


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
    end_offset : float or None
        Distance at the end of the beam where it differs from `offset`, which then holds at the start; it is linear between them. The
        contact surface is the envelope of circles with these radii about the points of the axis. Without friction only.
    """

    node: str
    beam: str
    side: Side = "right"
    offset: float = 0.0
    keep: bool = False
    friction: float = 0.0
    radius: float = 0.0
    end_offset: float | None = None

    def __post_init__(self) -> None:
        check = checks(self.name, self)
        check("side", self.side in {"left", "right"}, 'must be "left" or "right"')
        check("offset", finite(self.offset) and self.offset >= 0, "must not be negative")
        rubs = 0 <= self.friction <= MOST_FRICTION
        check("friction", rubs, f"must lie between 0 and {MOST_FRICTION:g}")
        check("radius", 0 <= self.radius <= self.offset, "must lie between 0 and the offset")
        if self.end_offset is not None:
            positive = min(self.offset, self.end_offset) > 0 and finite(self.end_offset)
            check("end_offset", positive, "must be positive, and offset too")
            check("friction", not self.friction, "must be 0 on a surface with an end_offset")

    @property
    def name(self) -> str:
        """Name of the pair, ``node->beam``."""
        return f"{self.node}->{self.beam}"


@dataclass(frozen=True, kw_only=True)
class Structure:
    """Beams with their supports and loads, the pins that push them and the contacts that may close.

    Beams whose ends have the same coordinates are rigidly joined there, unless a hinge is between an end and the joint.

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
    hinges: tuple[Hinge, ...] = ()
    springs: tuple[Spring, ...] = ()

    def __post_init__(self) -> None:
        check(len(self.beams) > 0, "Structure", "beams", self.beams, "must not be empty")
        elements = sum(beam.elements for beam in self.beams)
        check(elements <= MOST, "Structure", "elements", elements, f"must be at most {MOST} in all")
        names = [beam.name for beam in self.beams] + [pin.name for pin in self.pins]
        _unique(names, "a beam or pin")
        _unique([pair.name for pair in self.contacts], "a contact")
        joined: list[Support | Hinge | Spring] = [*self.supports, *self.hinges, *self.springs]
        for kind in (Support, Hinge, Spring):
            ends = (f"{item.beam}.{item.end}" for item in joined if isinstance(item, kind))
            _unique(ends, f"a {kind.__name__.lower()}")
        beams = {beam.name for beam in self.beams}
        nodes = {pin.name for pin in self.pins} | {f"{beam}.{end}" for beam in beams for end in ENDS}
        for item in (*joined, *self.loads, *self.line_loads):
            check(item.beam in beams, type(item).__name__, "beam", item.beam, "names no beam")
        for load in self.loads:
            if load.arc is not None:
                at_node = self.beam(load.beam).node(load.arc) is not None
                check(at_node, f"Load({load.beam})", "arc", load.arc, "must be a node, see Beam.divided")
        for line_load in self.line_loads:
            line_load.check(self.beam(line_load.beam))
        for pair in self.contacts:
            of_pair = checks(pair.name, pair)
            of_pair("beam", pair.beam in beams, "names no beam")
            of_pair("node", pair.node in nodes, "names no pin and no beam end")
            of_pair("node", pair.node.rpartition(".")[0] != pair.beam, "a beam does not touch itself")
            if pair.end_offset is not None:
                flat = abs(pair.end_offset - pair.offset) < self.beam(pair.beam).length
                of_pair("end_offset", flat, "must differ from offset by less than the length")

    @property
    def stages(self) -> int:
        """Number of stages; the load parameter goes from 0 to this number."""
        onward = (len(item.onward) for items in (self.pins, self.supports) for item in items)
        loads = [*(load.stage for load in self.loads), *(load.stage for load in self.line_loads)]
        return 1 + max([*onward, *loads], default=0)

    def beam(self, name: str) -> Beam:
        """Beam of that name."""
        return next(beam for beam in self.beams if beam.name == name)


def _unique(names: Iterable[str], what: str) -> None:
    seen: set[str] = set()
    for name in names:
        check(name not in seen, "Structure", "names", name, f"names more than one of {what}")
        seen.add(name)
