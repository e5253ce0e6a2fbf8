"""What a running solution tells: how far it is, after how many iterations, and where contacts are."""

from collections.abc import Callable
from typing import NamedTuple

WIDTH = 30
REDRAW = 0.1
"""Seconds between two pictures of a bar."""


class Reached(NamedTuple):
    """An accepted step of a solution.

    Attributes
    ----------
    load_parameter : float
        Where it is.
    iterations : int
        Newton iterations since the step before.
    contacts : tuple of str
        Closed contacts, as ``pin->cantilever on element 8 of 20``.
    """

    load_parameter: float
    iterations: int
    contacts: tuple[str, ...]


Watch = Callable[[Reached], None]


def unwatched(_: Reached) -> None:
    """Tell nobody."""


def bar(part: float) -> str:
    """Return a bar that is filled to `part`.

    Examples
    --------
    >>> bar(0.5)
    '[###############...............]'
    """
    filled = int(WIDTH * min(max(part, 0.0), 1.0))
    return f"[{'#' * filled}{'.' * (WIDTH - filled)}]"
