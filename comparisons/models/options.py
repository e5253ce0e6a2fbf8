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
    """Options of one run. None keeps the value of the scene, or the default of the model.

    Parameters
    ----------
    elements : int, optional
        TSM elements of every beam.
    element : str, optional
        Type of the TSM elements.
    integration_tolerance : float, optional
        Bound on the error of the integration inside exact TSM elements.
    mesh : (int, int), optional
        Elements of the solid along and across.
    branch : {"stop", "stable", "primary"}, optional
        What happens at a critical point: the path ends there by name, turns to the stable branch of least energy, or goes on unstable.
    """

    elements: int | None = None
    element: str | None = None
    integration_tolerance: float | None = None
    mesh: tuple[int, int] | None = None
    branch: Branch | None = None
