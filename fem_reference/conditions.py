"""Conditions of strips' ends: supports, springs, dead loads and joints. They act on the end's mean displacement and rotation."""

from dataclasses import dataclass
from math import isfinite

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.checks import Point, require, require_choice, require_distinct, require_point
from fem_reference.strip import Strip

ENDS = ("start", "end")
Motion = tuple[float | None, float | None, float | None]
"""Displacements x and y [m] and rotation [rad]; None where free."""


@dataclass(frozen=True, kw_only=True)
class AtEnd:
    """Base of the conditions of one end of a strip.

    ``strip, end``: name of the strip, and its end, ``"start"`` or ``"end"``. Raises ValueError if the end has
    another name.
    """

    strip: str
    end: str

    def __post_init__(self) -> None:
        require_choice(self.owner, "end", self.end, ENDS)

    @property
    def node(self) -> str:
        """Name of the end, ``"strip.end"``."""
        return f"{self.strip}.{self.end}"

    @property
    def owner(self) -> str:
        """Name of the condition in error messages."""
        return f"{type(self).__name__}({self.node!r})"


@dataclass(frozen=True, kw_only=True)
class Support(AtEnd):
    """A support of a strip's end. The end section may contract and warp.

    Parameters
    ----------
    strip, end
        Name of the strip, and its end, ``"start"`` or ``"end"``.
    motion
        Mean displacement x, y [m] and rotation, anticlockwise [rad], at the load parameter 1, in the global frame; None where
        free. They are proportional to the load parameter.
    onward
        Changes of the three in the stages after the first one, from one whole load parameter to the next; the free ones do not count.

    Raises
    ------
    ValueError
        If nothing is held or a motion is not finite.
    """

    motion: Motion = (0.0, 0.0, 0.0)
    onward: tuple[tuple[float, float, float], ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        owner = self.owner
        moved = all(len(change) == 3 and all(map(isfinite, change)) for change in self.onward)
        require(moved, owner, "onward", self.onward, "must be three finite values for every stage")
        held = [value for value in self.motion if value is not None]
        finite = len(self.motion) == 3 and all(map(isfinite, held))
        require(finite and len(held) > 0, owner, "motion", self.motion, "must be three, at least one finite")


@dataclass(frozen=True, kw_only=True)
class Spring(AtEnd):
    """Linear springs between a strip's end and the ground, without force in the undeformed state.

    Parameters
    ----------
    strip, end
        Name of the strip, and its end, ``"start"`` or ``"end"``.
    stiffness
        Stiffness against the mean displacement x, y [N/m] and the rotation [N m/rad] of the end section.

    Raises
    ------
    ValueError
        If a stiffness is negative or not finite, or all vanish.
    """

    stiffness: tuple[float, float, float]

    def __post_init__(self) -> None:
        super().__post_init__()
        owner = self.owner
        finite = len(self.stiffness) == 3 and all(isfinite(value) and value >= 0 for value in self.stiffness)
        rule = "must be three finite values, none negative, not all zero"
        require(finite and any(self.stiffness), owner, "stiffness", self.stiffness, rule)

    @property
    def motion(self) -> Motion:
        """Zero for the components that the springs resist, None for the others."""
        x, y, rotation = (0.0 if value else None for value in self.stiffness)
        return x, y, rotation


@dataclass(frozen=True, kw_only=True)
class EndLoad(AtEnd):
    """A dead force and a dead moment on an end of a strip.

    The force is distributed evenly over the undeformed section. The tractions of the moment are linear over the
    undeformed section and normal to the mean direction of the deformed one.

    Parameters
    ----------
    strip, end
        Name of the strip, and its end, ``"start"`` or ``"end"``.
    force
        Force at the load parameter 1, in the global frame [N]. It is proportional to the load parameter.
    moment
        Moment at the load parameter 1, anticlockwise [N m]. It is proportional to the load parameter.
    stage
        Number from 0 of the stage during which force and moment are added.

    Raises
    ------
    ValueError
        If a value is not finite, or force and moment vanish.
    """

    end: str = "end"
    force: Point = (0.0, 0.0)
    moment: float = 0.0
    stage: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        owner = self.owner
        require_point(owner, "force", self.force)
        require(self.stage >= 0, owner, "stage", self.stage, "must not be negative")
        require(isfinite(self.moment), owner, "moment", self.moment, "must be finite")
        rule = "must not be zero without a moment"
        require(any((*self.force, self.moment)), owner, "force", self.force, rule)


@dataclass(frozen=True, kw_only=True)
class Joint:
    """A joint: the ends keep a common mean position. All but the hinged ones turn by the same angle. The corner is not meshed.

    Parameters
    ----------
    ends
        Names of at least two ends with the same undeformed position, ``"strip.end"``.
    hinged
        Ends among them that turn against the first end, which is not hinged.
    stiffness
        Stiffnesses of rotational springs between the hinged ends and the first end, in the order of ``hinged``; zero for a hinge without a
        moment. Without a value all are zero [N m/rad].

    Raises
    ------
    ValueError
        If there are fewer than two ends, an end appears twice, a hinged end is none of the others, or a stiffness is negative or not finite.
    """

    ends: tuple[str, ...]
    hinged: tuple[str, ...] = ()
    stiffness: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        owner = f"Joint({self.ends!r})"
        distinct = len(self.ends) == len(set(self.ends)) >= 2
        require(distinct, owner, "ends", self.ends, "must be at least two different ends")
        known = len(self.hinged) == len(set(self.hinged)) and set(self.hinged) <= set(self.ends[1:])
        require(known, owner, "hinged", self.hinged, f"must be different ends among {self.ends[1:]}")
        finite = all(isfinite(value) and value >= 0 for value in self.stiffness)
        counted = len(self.stiffness) in (0, len(self.hinged))
        rule = "must be one finite value for every hinged end, none negative"
        require(finite and counted, owner, "stiffness", self.stiffness, rule)

    def stiffness_of(self, end: str) -> float | None:
        """Stiffness of a hinge [N m/rad]; None for an end without a hinge."""
        if end not in self.hinged:
            return None
        return self.stiffness[self.hinged.index(end)] if self.stiffness else 0.0


Holding = Support | Spring
"""What holds an end section."""


def require_known_ends(
    strips: tuple[Strip, ...],
    holding: tuple[Holding, ...],
    joints: tuple[Joint, ...],
    loads: tuple[EndLoad, ...],
) -> None:
    """Require known ends without clamps, one support and one spring at a joint or end, and joints at one position."""
    positions = {f"{strip.name}.{end}": getattr(strip, end) for strip in strips for end in ENDS}
    clamps = [f"{strip.name}.{end}" for strip in strips for end in strip.clamped]
    for condition in (*holding, *loads):
        owner, node = condition.owner, condition.node
        require(node in positions, owner, "strip", condition.strip, "must name a strip")
        require(node not in clamps, owner, "end", condition.end, "must not be a clamped end")
    for joint in joints:
        owner = f"Joint({joint.ends!r})"
        for end in joint.ends:
            fits = end in positions and end not in clamps and positions[end] == positions[joint.ends[0]]
            require(
                fits, owner, "ends", end, "must be an end without a clamp, at the position of the first one"
            )
    require_distinct("SolidProblem", "joints", (end for joint in joints for end in joint.ends))
    first = {end: joint.ends[0] for joint in joints for end in joint.ends}
    for name, kind in (("supports", Support), ("springs", Spring)):
        nodes = (first.get(item.node, item.node) for item in holding if isinstance(item, kind))
        require_distinct("SolidProblem", name, nodes)


def require_held(
    strips: tuple[Strip, ...],
    holding: tuple[Holding, ...],
    joints: tuple[Joint, ...],
    touching: list[tuple[str, Point, Point]],
) -> None:
    """Require strips that cannot move without strain; ``touching`` has the strip, position and normal of pins that touch."""
    for group in _structures(strips, joints):
        own = [strip for strip in strips if strip.name in group]
        motions, rows = _held(own, holding)
        rows += [(name, position, normal, 0.0) for name, position, normal in touching if name in group]
        rule = f"must hold {', '.join(sorted(group))}, with the pins that touch at the start"
        require(_rigid(own, rows, joints), "SolidProblem", "supports", motions, rule)


Row = tuple[str, Point, Point, float]
"""Strip, position, direction of a displacement there and factor of the rotation of a held component."""


def _held(strips: list[Strip], holding: tuple[Holding, ...]) -> tuple[tuple[Motion, ...], list[Row]]:
    """Motions of the clamps, supports and springs of a group of strips, and the components they hold."""
    own = {strip.name: strip for strip in strips}
    ends: list[tuple[str, str, Motion]] = [
        (strip.name, end, (0.0, 0.0, 0.0)) for strip in strips for end in strip.clamped
    ]
    ends += [(item.strip, item.end, item.motion) for item in holding if item.strip in own]
    rows = [
        (name, getattr(own[name], end), (float(component == 0), float(component == 1)), float(component == 2))
        for name, end, motion in ends
        for component in range(3)
        if motion[component] is not None
    ]
    return tuple(motion for *_, motion in ends), rows


def _structures(strips: tuple[Strip, ...], joints: tuple[Joint, ...]) -> list[set[str]]:
    """Names of the strips, grouped by what is joined."""
    groups = [{strip.name} for strip in strips]
    for joint in joints:
        joined = {end.split(".")[0] for end in joint.ends}
        met = [group for group in groups if group & joined]
        groups = [group for group in groups if not group & joined] + [set().union(*met)]
    return groups


def _rigid(strips: list[Strip], held: list[Row], joints: tuple[Joint, ...]) -> bool:
    """Whether the strips, each with a rigid motion ``(a - c y, b + c x, c)``, cannot move against held components and joints."""
    numbers = {strip.name: number for number, strip in enumerate(strips)}
    origin, size = strips[0].start, max(strip.length for strip in strips)

    def row(name: str, position: Point, direction: Point, rotation: float) -> Floats:
        x, y = (np.array(position) - origin) / size
        found = np.zeros((len(strips), 3))
        nx, ny = direction
        found[numbers[name]] = nx, ny, ny * x - nx * y + rotation
        return found.ravel()

    rows = [row(*item) for item in held]
    for joint in joints:
        (first, *others) = (end.split(".") for end in joint.ends)
        for name, end in others:
            if name in numbers:
                place = getattr(strips[numbers[name]], end)
                components = [((1.0, 0.0), 0.0), ((0.0, 1.0), 0.0)]
                if joint.stiffness_of(f"{name}.{end}") != 0.0:
                    components.append(((0.0, 0.0), 1.0))
                rows += [row(name, place, *item) - row(first[0], place, *item) for item in components]
    unknowns = 3 * len(strips)
    return len(rows) >= unknowns and int(np.linalg.matrix_rank(np.array(rows), tol=1e-9)) == unknowns
