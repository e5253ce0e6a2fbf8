"""A configuration: displacements and closed contacts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from tsm.elements.properties import Array

Cuts = tuple[tuple[int, tuple[int, ...]], ...]
"""Exact elements in contact: the number among the exact elements, and the contact pairs in order of arc position."""


class Place(NamedTuple):
    """Where a contact with friction lies on its beam, as far as that decides how far it has slipped."""

    arc: float  # arc position on the beam
    shear: float  # angle psi from the section's normal to the mean tangent
    direction: float  # angle phi of the mean tangent
    # length A of the face for a unit of arc: that of the mean tangent, and the mean curvature times the
    # face's distance
    stretch: float


class Traction(NamedTuple):
    """Contact with friction at a configuration."""

    # tangential, normal: force on the beam along its mean tangent, and across it away from the node
    tangential: float
    normal: float
    place: Place  # where the contact lies

    @property
    def way(self) -> int:
        """Sign of the slip that the force goes with."""
        return 1 if self.tangential >= 0 else -1


class Grip(NamedTuple):
    """State of a closed contact with friction."""

    slip: int  # sign of the slip rate, 0 in stick
    held: Place | None  # place at which the row of stick is zero, see `tsm.path.energy`; None in slip


UNDECIDED = Grip(slip=0, held=None)
"""State of a contact that has just closed; its force is normal to the surface until its state is known."""


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A closed contact."""

    element: int  # global number of the element that owns the contacting node
    xi: float  # position on the element, 0 to 1 from end i to end j
    force: tuple[float, float]  # force on the beam (x, y)
    angle: float = 0.0  # angle of the section from the x axis, used by exact elements only
    grip: Grip | None = None  # slip or stick, None without friction


@dataclass(frozen=True, kw_only=True)
class Profile:
    """Angles inside the exact elements."""

    cuts: Cuts  # contacts that cut the elements
    # angles of the sections from the x axis at the p Gauss nodes of the s segments; shape (s, p)
    angle: Array


@dataclass(frozen=True, kw_only=True)
class State:
    """A configuration at one load parameter."""

    load_parameter: float
    # displacements ``(u, v, theta)`` of the nodes, then internal force (x, y) and moment at the start of the
    # exact elements; shape (dofs,)
    q: Array
    touches: tuple[Touch | None, ...]  # by contact pair, None where it is open
    armed: tuple[
        bool, ...
    ]  # by contact pair: whether an open one may close, its node being on the stated side
    profile: Profile | None = None  # angles inside the exact elements, None without such elements


def profile_of(state: State) -> Profile:
    """Angles inside the exact elements of a model that has some."""
    assert state.profile is not None, "a model with exact elements has their profile"
    return state.profile


def touch_of(state: State, k: int) -> Touch:
    """Closed contact of pair k."""
    touch = state.touches[k]
    assert touch is not None, "a cut is a closed contact"
    return touch
