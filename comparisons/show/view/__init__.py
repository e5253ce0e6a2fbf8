"""The motion of a scene: bodies with their axial stress, pins and contact forces, over the load parameters."""

from comparisons.show.view.films import Film, film, show, write
from comparisons.show.view.series import Series, read_series, solved_series

__all__ = ["Film", "Series", "film", "read_series", "show", "solved_series", "write"]


def __dir__() -> list[str]:
    return sorted(__all__)
