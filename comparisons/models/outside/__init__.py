"""Programs of others as models: they answer in JSON, from a child process or from functions in this one.

An adapter in Python takes what it needs from here, see ``docs/how-to/program.md``.
"""

from comparisons.models.outside.adapters.exchange import (
    Histories,
    RefusedError,
    StoppedError,
    points_along,
    refined,
    serve,
)
from comparisons.models.outside.adapters.frame import frame
from comparisons.models.outside.programs import Functions

__all__ = [
    "Functions",
    "Histories",
    "RefusedError",
    "StoppedError",
    "frame",
    "points_along",
    "refined",
    "serve",
]


def __dir__() -> list[str]:
    return sorted(__all__)
