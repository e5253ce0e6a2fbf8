"""A configuration: displacements and the contacts that are closed in it."""

from __future__ import annotations

from dataclasses import dataclass

from tsm.elements.properties import Array


@dataclass(frozen=True, kw_only=True)
class Touch:
    """A closed contact.

    Attributes
    ----------
    element : int
        Global number of the element that owns the contacting node.
    xi : float
        Position on it, 0 to 1 from end i to end j.
    force : tuple of float
        Force on the beam (x, y).
    """

    element: int
    xi: float
    force: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class State:
    """A configuration at one load parameter.

    Attributes
    ----------
    load_parameter : float
        Load parameter.
    q : ndarray, shape (3 nodes,)
        Displacements ``(u, v, theta)`` of the nodes.
    touches : tuple of Touch or None
        One entry per contact pair, None where it is open.
    armed : tuple of bool
        One entry per contact pair: whether an open one may close, its node being on the stated side.
    """

    load_parameter: float
    q: Array
    touches: tuple[Touch | None, ...]
    armed: tuple[bool, ...]
