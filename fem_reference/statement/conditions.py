"""Conditions of strips' ends: supports, springs and joints. They act on the end's mean displacement and rotation."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_reference.statement.arrays import Floats
from fem_reference.statement.checks import Point, require, require_choice, require_distinct, require_finite

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


def require_known_ends(problem: Any) -> None:
    """Require known ends without clamps, one support and one spring at a joint or end, and joints at one position."""
    positions = {f"{strip.name}.{end}": getattr(strip, end) for strip in problem.strips for end in ENDS}
    clamps = [f"{strip.name}.{end}" for strip in problem.strips for end in strip.clamped]
    for condition in (*problem.supports, *problem.springs):
        require(condition, "strip", condition.node in positions, "must name a strip")
        require(condition, "end", condition.node not in clamps, "must not be a clamped end")
    first = {end: joint.ends[0] for joint in problem.joints for end in joint.ends}
    for joint in problem.joints:
        for end in joint.ends:
            fits = end in positions and end not in clamps and positions[end] == positions[joint.ends[0]]
            rule = "must be an end without a clamp, at the position of the first one"
            require(joint, "ends", fits, rule, end)
    require_distinct(problem, "joints", (end for joint in problem.joints for end in joint.ends))
    for field in ("supports", "springs"):
        nodes = (first.get(item.node, item.node) for item in getattr(problem, field))
        require_distinct(problem, field, nodes)


def require_held(problem: Any, touching: Iterable[tuple[str, Point, Point]]) -> None:
    """Require strips that cannot move without strain; ``touching`` has the strip, position and normal of pins that touch."""
    strips = {strip.name: strip for strip in problem.strips}
    names, length = list(strips), problem.strips[0].length

    def motion(name: str, place: Point) -> Floats:
        """Displacement x, y and turn of a strip at a place by the rigid motions ``(a - c y, b + c x)`` of all strips, ``(3, k)``."""
        rows = np.zeros((3, len(names), 3))
        x, y = np.subtract(place, strips[name].start) / length
        rows[:, names.index(name)] = [[1, 0, -y], [0, 1, x], [0, 0, 1]]
        return rows.reshape(3, -1)

    def at(end: str) -> Floats:
        name, side = end.split(".")
        return motion(name, getattr(strips[name], side))

    given = [(f"{name}.{end}", (0.0, 0.0, 0.0)) for name in names for end in strips[name].clamped]
    given += [(item.node, item.motion) for item in (*problem.supports, *problem.springs)]
    rows = [np.zeros(3 * len(names)), *(normal @ motion(name, place)[:2] for name, place, normal in touching)]
    rows += [at(end)[k] for end, held in given for k in range(3) if held[k] is not None]
    rows += [
        at(end)[k] - at(joint.ends[0])[k]
        for joint in problem.joints
        for end in joint.ends[1:]
        for k in range(2 if joint.stiffness_of(end) == 0.0 else 3)
    ]
    # the null space of the conditions; SciPy's function would import all of its linear algebra
    _, sizes, ways = np.linalg.svd(np.array(rows))
    free = np.abs(ways[np.count_nonzero(sizes > 1e-9 * sizes.max()) :]).max(axis=0, initial=0.0)
    moved = zip(names, free.reshape(-1, 3), strict=True)
    loose = sorted(name for name, moves in moved if max(moves) > 1e-6)
    rule = f"must hold {', '.join(loose)}, with the pins that touch at the start"
    require(problem, "supports", not loose, rule, tuple(held for _, held in given))
