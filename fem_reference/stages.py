"""Stages: quantities that change in proportion to the load parameter, from one whole number to the next."""

import math
from typing import Any


def stage_of(t: float, stages: int) -> int:
    """Number from 0 of the stage at the load parameter ``t``; at a boundary, the one that ends."""
    return min(max(math.ceil(t) - 1, 0), stages - 1)


def amount(increments: Any, t: float) -> Any:
    """Quantity at ``t`` that changes by ``increments[k]`` in the stage k."""
    stage = stage_of(t, len(increments))
    total = (t - stage) * increments[stage]
    return total if stage == 0 else total + sum(increments[1:stage], start=increments[0])


def increment(increments: Any, before: float, after: float) -> Any:
    """Change per load parameter between two load parameters of one stage."""
    return increments[stage_of((before + after) / 2, len(increments))]
