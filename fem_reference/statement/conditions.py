"""Conditions of strips' ends: supports, springs and joints. They act on the end's mean displacement and rotation."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from fem_reference.statement.arrays import Floats
from fem_reference.statement.checks import Point, require, require_choice, require_distinct, require_finite
from fem_reference.statement.strip import Strip

ENDS = ("start", "end")
Motion = tuple[float | None, float | None, float | None]
"""Displacements x and y [m] and rotation [rad]; None where free."""


@dataclass(frozen=True, kw_only=True)
class AtEnd:
    """Base of the conditions of one end of a strip."""

    strip: str
    end: str

    def __post_init__(self) -> None:
        require_choice(self, "end", ENDS)

    @property
    def node(self) -> str:
        """Name of the end, ``"strip.end"``."""
        return f"{self.strip}.{self.end}"


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
        If the end has another name, nothing is held or a motion is not finite.
    """

    motion: Motion = (0.0, 0.0, 0.0)
    onward: tuple[tuple[float, float, float], ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        for change in self.onward:
            require_finite(self, "onward", change, 3)
        require_finite(self, "motion", [value or 0.0 for value in self.motion], 3)
        require(self, "motion", any(value is not None for value in self.motion), "must hold one")


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
        If the end has another name, a stiffness is negative or not finite, or all vanish.
    """

    stiffness: tuple[float, float, float]

    def __post_init__(self) -> None:
        super().__post_init__()
        require_finite(self, "stiffness", self.stiffness, 3, least=0.0)
        require(self, "stiffness", any(self.stiffness), "must not be zero")

    @property
    def motion(self) -> Motion:
        """Zero for the components that the springs resist, None for the others."""
        x, y, rotation = (0.0 if value else None for value in self.stiffness)
        return x, y, rotation


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
        distinct = len(self.ends) == len(set(self.ends)) >= 2
        require(self, "ends", distinct, "must be at least two different ends")
        known = len(self.hinged) == len(set(self.hinged)) and set(self.hinged) <= set(self.ends[1:])
        require(self, "hinged", known, f"must be different ends among {self.ends[1:]}")
        counted = len(self.stiffness) in (0, len(self.hinged))
        require(self, "stiffness", counted, "must be one value for every hinged end")
        for value in self.stiffness:
            require_finite(self, "stiffness", (value,), least=0.0)

    def stiffness_of(self, end: str) -> float | None:
        """Stiffness of a hinge [N m/rad]; None for an end without a hinge."""
        if end not in self.hinged:
            return None
        return self.stiffness[self.hinged.index(end)] if self.stiffness else 0.0


Holding = tuple[Support | Spring, ...]
"""What holds end sections."""


def require_known_ends(
    problem: object, strips: tuple[Strip, ...], holding: Holding, joints: tuple[Joint, ...]
) -> None:
    """Require known ends without clamps, one support and one spring at a joint or end, and joints at one position."""
    positions = {f"{strip.name}.{end}": getattr(strip, end) for strip in strips for end in ENDS}
    clamps = [f"{strip.name}.{end}" for strip in strips for end in strip.clamped]
    for condition in holding:
        require(condition, "strip", condition.node in positions, "must name a strip")
        require(condition, "end", condition.node not in clamps, "must not be a clamped end")
    for joint in joints:
        for end in joint.ends:
            fits = end in positions and end not in clamps and positions[end] == positions[joint.ends[0]]
            rule = "must be an end without a clamp, at the position of the first one"
            require(joint, "ends", fits, rule, end)
    require_distinct(problem, "joints", (end for joint in joints for end in joint.ends))
    first = {end: joint.ends[0] for joint in joints for end in joint.ends}
    for name, kind in (("supports", Support), ("springs", Spring)):
        nodes = (first.get(item.node, item.node) for item in holding if isinstance(item, kind))
        require_distinct(problem, name, nodes)


def require_held(
    problem: object,
    strips: tuple[Strip, ...],
    holding: Holding,
    joints: tuple[Joint, ...],
    touching: list[tuple[str, Point, Point]],
) -> None:
    """Require strips that cannot move without strain; ``touching`` has the strip, position and normal of pins that touch."""
    numbers = {strip.name: number for number, strip in enumerate(strips)}
    axes: list[tuple[Point, float]] = [((1.0, 0.0), 0.0), ((0.0, 1.0), 0.0), ((0.0, 0.0), 1.0)]

    def row(name: str, place: Point, direction: Point, turn: float = 0.0) -> Floats:
        """Displacement in a ``direction`` and turn of a strip with the rigid motion ``(a - c y, b + c x)``, from its start."""
        strip, found = strips[numbers[name]], np.zeros((len(strips), 3))
        (x, y), (nx, ny) = np.subtract(place, strip.start), direction
        found[numbers[name]] = nx, ny, (ny * x - nx * y + turn * strips[0].length) / strip.length
        return found.ravel()

    def motion(end: str, component: int) -> Floats:
        name, side = end.split(".")
        return row(name, getattr(strips[numbers[name]], side), *axes[component])

    held = [(f"{strip.name}.{end}", (0.0, 0.0, 0.0)) for strip in strips for end in strip.clamped]
    motions: list[tuple[str, Motion]] = [*held, *((item.node, item.motion) for item in holding)]
    rows = [row(*touch) for touch in touching]
    rows += [motion(end, k) for end, given in motions for k in range(3) if given[k] is not None]
    rows += [
        motion(end, k) - motion(joint.ends[0], k)
        for joint in joints
        for end in joint.ends[1:]
        for k in range(2 if joint.stiffness_of(end) == 0.0 else 3)
    ]
    free = null_space(np.array([np.zeros(3 * len(strips)), *rows]), rcond=1e-9).reshape(len(strips), -1)
    moves = np.abs(free).max(axis=1, initial=0.0) > 1e-6
    loose = ", ".join(sorted(strip.name for strip, loose in zip(strips, moves, strict=True) if loose))
    rule = f"must hold {loose}, with the pins that touch at the start"
    require(problem, "supports", not loose, rule, tuple(given for _, given in motions))
