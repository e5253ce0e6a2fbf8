"""The options of one run, and the error for a scene or option that a model cannot take."""

from dataclasses import dataclass
from typing import Literal, get_args

Branch = Literal["stop", "stable", "primary"]
BRANCHES: tuple[str, ...] = get_args(Branch)
"""Ways to go on at a critical point."""


class ModelError(ValueError):
    """A model cannot state a scene, or an option does not fit the model: one line."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of one run. None keeps the value of the scene, or the default of the model."""

    elements: int | None = None
    """TSM elements of every beam."""
    element: str | None = None
    """Type of the TSM elements; without one, `mixed` where the options or the scene give a number of elements, else `exact`."""
    integration_tolerance: float | None = None
    """Bound on the error of the integration inside exact TSM elements."""
    mesh: tuple[int, int] | None = None
    """Elements of the solid along and across."""
    branch: Branch | None = None
    """At a critical point the path ends by name, turns to the stable branch of least energy, or goes on unstable."""
