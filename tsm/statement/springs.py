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
    """Forces, stiffness and energy of the springs of a structure, ``k (q_b - q_a)``.

    ``items``: degrees of freedom a and b, and stiffness of every spring; b is -1 for the ground.

    ``dofs`` (2, n): degrees of freedom. ``values`` (4 n,): stiffness matrices, row by row.
    """

    def __init__(self, items: Sequence[tuple[int, int, float]]) -> None:
        self.dofs, self.stiffness = np.array([item[:2] for item in items]).T, np.array([k for *_, k in items])
        self.values = np.outer((1.0, -1.0, -1.0, 1.0), self.stiffness).ravel()

    def stretch(self, q: Array) -> Array:
        """Changes ``q_b - q_a`` (n, ...) of values over the degrees of freedom, none of the ground."""
        first, second = np.concatenate([q, 0 * q[:1]])[self.dofs]
        return second - first

    def forces(self, q: Array) -> Array:
        """Return the residual over all degrees of freedom from their displacements `q`, or its rate from the rates of these."""
        nodal, pull = np.zeros(len(q) + 1), self.stiffness * self.stretch(q)
        np.add.at(nodal, self.dofs, [-pull, pull])
        return nodal[:-1]

    def energy(self, q: Array) -> float:
        """Energy of the springs."""
        return float(self.stiffness @ self.stretch(q) ** 2) / 2

    def noise(self, extent: float, force: float) -> float:
        """Round-off of the residual in parts of `force`, for displacements up to `extent` and rotations up to 1."""
        units = np.where(self.dofs[0] % 3 == 2, 1.0 / extent, extent)
        return 4 * _EPS * float((self.stiffness * units).max()) / force
