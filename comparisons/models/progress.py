"""Progress of a running solution: load parameter, iterations, and the elements in contact."""

from collections.abc import Callable
from typing import NamedTuple

WIDTH = 30
REDRAW = 0.1
"""Seconds between two drawings of a progress bar."""


class Reached(NamedTuple):
    """An accepted step: its load parameter, the iterations since the step before, and closed contacts, as ``pin->beam on element 8 of 20``."""

    load_parameter: float
    iterations: int
    contacts: tuple[str, ...]


Watch = Callable[[Reached], None]
Count = Callable[[int, int], None]
"""Receives how many parts of a work are done, and how many there are."""


def unwatched(_: Reached) -> None:
    """Ignore the progress."""


def uncounted(_done: int, _parts: int) -> None:
    """Ignore the progress."""


def bar(part: float) -> str:
    """Return a progress bar that is filled to `part`.

    Examples
    --------
    >>> bar(0.5)
    '[###############...............]'
    """
    filled = int(WIDTH * min(max(part, 0.0), 1.0))
    return f"[{'#' * filled}{'.' * (WIDTH - filled)}]"
