"""Conditions of strips' ends: supports, dead loads and rigid joints. They act on the end's mean displacement and rotation."""

from dataclasses import dataclass
from math import isfinite

import numpy as np

from fem_reference.checks import Point, require, require_choice, require_distinct, require_point
from fem_reference.strip import Strip

ENDS = ("start", "end")
Motion = tuple[float | None, float | None, float | None]
"""Displacements x and y [m] and rotation [rad]; None where free."""


@dataclass(frozen=True, kw_only=True)
class Support:
    """A support of a strip's end. The end section may contract and warp.

    Parameters
    ----------
    strip, end
        Name of the strip, and its end, ``"start"`` or ``"end"``.
    motion
        Mean displacement x, y [m] and rotation, anticlockwise [rad], at the load parameter 1, in the global frame; None where
        free. They are proportional to the load parameter.

    Raises
    ------
    ValueError
        If nothing is held or a motion is not finite.
    """

    strip: str
    end: str
    motion: Motion = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        owner = f"Support({self.node!r})"
        require_choice(owner, "end", self.end, ENDS)
        held = [value for value in self.motion if value is not None]
        finite = len(self.motion) == 3 and all(map(isfinite, held))
        require(finite and len(held) > 0, owner, "motion", self.motion, "must be three, at least one finite")

    @property
    def node(self) -> str:
        """Name of the end, ``"strip.end"``."""
        return f"{self.strip}.{self.end}"


@dataclass(frozen=True, kw_only=True)
class EndLoad:
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

    Raises
    ------
    ValueError
        If a value is not finite, or force and moment vanish.
    """

    strip: str
    force: Point = (0.0, 0.0)
    moment: float = 0.0
    end: str = "end"

    def __post_init__(self) -> None:
        owner = f"EndLoad({self.node!r})"
        require_choice(owner, "end", self.end, ENDS)
        require_point(owner, "force", self.force)
        require(isfinite(self.moment), owner, "moment", self.moment, "must be finite")
        rule = "must not be zero without a moment"
        require(any((*self.force, self.moment)), owner, "force", self.force, rule)

    @property
    def node(self) -> str:
        """Name of the end, ``"strip.end"``."""
        return f"{self.strip}.{self.end}"


@dataclass(frozen=True, kw_only=True)
class Joint:
    """A rigid joint: the ends keep a common mean position, and turn by the same angle. The corner itself is not meshed.

    Parameters
    ----------
    ends
        Names of at least two ends with the same undeformed position, ``"strip.end"``.

    Raises
    ------
    ValueError
        If there are fewer than two ends, or an end appears twice.
    """

    ends: tuple[str, ...]

    def __post_init__(self) -> None:
        distinct = len(self.ends) == len(set(self.ends)) >= 2
        require(distinct, f"Joint({self.ends!r})", "ends", self.ends, "must be at least two different ends")


def require_known_ends(
    strips: tuple[Strip, ...],
    supports: tuple[Support, ...],
    joints: tuple[Joint, ...],
    loads: tuple[EndLoad, ...],
) -> None:
    """Require known ends without clamps, one support at a joint or end, and joints at one position."""
    positions = {f"{strip.name}.{end}": getattr(strip, end) for strip in strips for end in ENDS}
    clamps = [f"{strip.name}.{end}" for strip in strips for end in strip.clamped]
    conditions: list[Support | EndLoad] = [*supports, *loads]
    for condition in conditions:
        owner = f"{type(condition).__name__}({condition.node!r})"
        require(condition.node in positions, owner, "strip", condition.strip, "must name a strip")
        require(condition.node not in clamps, owner, "end", condition.end, "must not be a clamped end")
    for joint in joints:
        owner = f"Joint({joint.ends!r})"
        for end in joint.ends:
            fits = end in positions and end not in clamps and positions[end] == positions[joint.ends[0]]
            require(
                fits, owner, "ends", end, "must be an end without a clamp, at the position of the first one"
            )
    require_distinct("SolidProblem", "joints", (end for joint in joints for end in joint.ends))
    first = {end: joint.ends[0] for joint in joints for end in joint.ends}
    require_distinct("SolidProblem", "supports", (first.get(item.node, item.node) for item in supports))


def require_held(
    strips: tuple[Strip, ...],
    supports: tuple[Support, ...],
    joints: tuple[Joint, ...],
    touching: list[tuple[str, Point, Point]],
) -> None:
    """Require strips that cannot move without strain; ``touching`` has the strip, position and normal of pins that touch."""
    for group in _structures(strips, joints):
        rows = [
            (position, (float(component == 0), float(component == 1)), float(component == 2))
            for position, motion in _held(strips, supports, group)
            for component in range(3)
            if motion[component] is not None
        ]
        rows += [(position, normal, 0.0) for name, position, normal in touching if name in group]
        rule = f"must hold {', '.join(sorted(group))}, with the pins that touch at the start"
        motions = tuple(motion for _, motion in _held(strips, supports, group))
        require(_rigid(rows), "SolidProblem", "supports", motions, rule)


def _held(
    strips: tuple[Strip, ...], supports: tuple[Support, ...], group: set[str]
) -> list[tuple[Point, Motion]]:
    """Positions and motions of the clamps and supports of a group of strips."""
    own = {strip.name: strip for strip in strips if strip.name in group}
    held: list[tuple[Point, Motion]] = [
        (strip.start if end == "start" else strip.end, (0.0, 0.0, 0.0))
        for strip in own.values()
        for end in strip.clamped
    ]
    ends = [(own[item.strip], item) for item in supports if item.strip in own]
    held += [(strip.start if item.end == "start" else strip.end, item.motion) for strip, item in ends]
    return held


def _structures(strips: tuple[Strip, ...], joints: tuple[Joint, ...]) -> list[set[str]]:
    """Names of the strips, grouped by what is joined."""
    groups = [{strip.name} for strip in strips]
    for joint in joints:
        joined = {end.split(".")[0] for end in joint.ends}
        met = [group for group in groups if group & joined]
        groups = [group for group in groups if not group & joined] + [set().union(*met)]
    return groups


def _rigid(held: list[tuple[Point, Point, float]]) -> bool:
    """Whether no rigid motion ``(a - c y, b + c x, c)`` is left; held are positions, directions there, and rotations."""
    rows = []
    for position, (nx, ny), rotation in held:
        x, y = np.subtract(position, held[0][0])
        rows.append((nx, ny, ny * x - nx * y + rotation))
    scale = np.array([1.0, 1.0, 1 / max([1e-300, *(abs(row[2]) for row in rows)])])
    return len(rows) > 0 and int(np.linalg.matrix_rank(np.array(rows) * scale, tol=1e-9)) == 3
