"""Numerical settings of a solution."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

BRANCHES = ("stop", "stable", "primary")
"""Ways to go on at a critical point."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Numerical settings of a solution.

    Parameters
    ----------
    tolerance : float
        Bound on the scaled residual, see `Newton`.
    integration_tolerance : float
        Bound on the estimated integration error inside exact elements: the largest error of positions over
        the longest beam, of angles, and of forces over ``EI/L^2``.
    branch : {"stop", "stable", "primary"}
        Continuation at a critical point. With ``stop`` the path ends there, with the kind of the point as
        status. With ``stable`` it turns to the stable branch of least energy. With ``primary`` it goes on
        along the unstable branch, if there is one.
    """

    tolerance: float = 1e-10
    integration_tolerance: float = 1e-9
    branch: Literal["stop", "stable", "primary"] = "stop"

    def __post_init__(self) -> None:
        for field, least in (("tolerance", 0.0), ("integration_tolerance", 1e-14)):
            value = getattr(self, field)
            if not (math.isfinite(value) and least < value < 1):
                raise ValueError(f"Settings.{field} = {value!r}: must lie between {least:g} and 1")
        if self.branch not in BRANCHES:
            raise ValueError(f"Settings.branch = {self.branch!r}: must be one of {', '.join(BRANCHES)}")
