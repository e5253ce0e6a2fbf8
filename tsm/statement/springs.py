"""Hinges between beams and their joints, and linear springs: their statement, and their forces, stiffness and energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tsm.elements.properties import Array
from tsm.statement.beam import END, ENDS, LARGEST, End, checks, finite

_EPS = float(np.finfo(float).eps)


def _check(item: Hinge | Spring, *stiffnesses: str) -> None:
    check = checks(f"{type(item).__name__}({item.beam}.{item.end})", item)
    check("end", item.end in ENDS, END)
    for field in stiffnesses:
        value = getattr(item, field)
        check(field, finite(value) and value >= 0, f"must lie between 0 and {LARGEST:g}")


@dataclass(frozen=True, kw_only=True)
class Hinge:
    """A hinge between a beam's end and its joint. Supports, springs and loads that name the end act on the joint.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"}
        Which end.
    stiffness : float
        Stiffness of a rotational spring between the joint and the end [force length/rad].
    """

    beam: str
    end: End
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        _check(self, "stiffness")


@dataclass(frozen=True, kw_only=True)
class Spring:
    """Linear springs between a beam's end, or the joint there, and the ground; without force in the undeformed state.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"}
        Which end.
    x, y : float
        Stiffnesses against displacement [force/length].
    rotation : float
        Stiffness against rotation [force length/rad].
    """

    beam: str
    end: End
    x: float = 0.0
    y: float = 0.0
    rotation: float = 0.0

    def __post_init__(self) -> None:
        _check(self, "x", "y", "rotation")


class Springs:
    """Forces, stiffness and energy of the springs of a structure: ``k q`` to the ground, ``k (q_b - q_a)`` between two rotations.

    ``ground``: degrees of freedom and stiffnesses of the springs to the ground. ``between``: pairs of
    rotations and stiffnesses of the springs in hinges.

    ``dofs`` (1, g), (2, h): degrees of freedom of the two kinds.
    ``values`` (g + 4 h,): stiffness matrices of the two kinds, row by row.
    """

    def __init__(
        self, ground: Sequence[tuple[int, float]], between: Sequence[tuple[int, int, float]]
    ) -> None:
        self.ground = np.array([dof for dof, _ in ground], dtype=int)
        self.ground_stiffness = np.array([stiffness for _, stiffness in ground])
        self.first, self.second = np.array([item[:2] for item in between], dtype=int).reshape(-1, 2).T
        self.stiffness = np.array([item[2] for item in between])
        self.dofs = [self.ground[None], np.stack([self.first, self.second])]
        signs = np.array([1.0, -1.0, -1.0, 1.0])
        self.values = np.concatenate([self.ground_stiffness, np.outer(signs, self.stiffness).ravel()])

    def forces(self, q: Array) -> Array:
        """Return the residual over all degrees of freedom from their displacements `q`, or its rate from the rates of these."""
        nodal = np.zeros_like(q)
        np.add.at(nodal, self.ground, self.ground_stiffness * q[self.ground])
        moment = self.stiffness * (q[self.second] - q[self.first])
        np.add.at(nodal, self.first, -moment)
        np.add.at(nodal, self.second, moment)
        return nodal

    def energy(self, q: Array) -> float:
        """Energy of the springs."""
        turned = q[self.second] - q[self.first]
        return float(self.ground_stiffness @ q[self.ground] ** 2 + self.stiffness @ turned**2) / 2

    def noise(self, extent: float, force: float) -> float:
        """Round-off of the residual in parts of `force`, for displacements up to `extent` and rotations up to 1."""
        units = np.where(self.ground % 3 == 2, 1.0 / extent, extent)
        largest = (self.ground_stiffness * units).max(initial=0.0)
        return 4 * _EPS * float(max(largest, self.stiffness.max(initial=0.0) / extent)) / force
