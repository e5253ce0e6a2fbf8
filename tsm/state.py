"""A configuration: displacements and closed contacts."""

from __future__ import annotations

from dataclasses import dataclass

from tsm.elements.properties import Array

Cuts = tuple[tuple[int, tuple[int, ...]], ...]
"""Exact elements in contact: the number among the exact elements, and the contact pairs in order of arc position."""


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A closed contact.

    Attributes
    ----------
    element : int
        Global number of the element that owns the contacting node.
    xi : float
        Position on the element, 0 to 1 from end i to end j.
    force : tuple of float
        Force on the beam (x, y).
    angle : float
        Angle of the section from the x axis, used by exact elements only.
    """

    element: int
    xi: float
    force: tuple[float, float]
    angle: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Profile:
    """Angles inside the exact elements.

    Attributes
    ----------
    cuts : tuple
        Contacts that cut the elements.
    angle : ndarray, shape (s, p)
        Angles of the sections from the x axis at the p Gauss nodes of the s segments.
    """

    cuts: Cuts
    angle: Array


@dataclass(frozen=True, kw_only=True)
class State:
    """A configuration at one load parameter.

    Attributes
    ----------
    load_parameter : float
        Load parameter.
    q : ndarray, shape (dofs,)
        Displacements ``(u, v, theta)`` of the nodes, then internal force (x, y) and moment at the start of the exact elements.
    touches : tuple of Touch or None
        One entry per contact pair, None where it is open.
    armed : tuple of bool
        One entry per contact pair: whether an open one may close, its node being on the stated side.
    profile : Profile or None
        Angles inside the exact elements, None without such elements.
    """

    load_parameter: float
    q: Array
    touches: tuple[Touch | None, ...]
    armed: tuple[bool, ...]
    profile: Profile | None = None
