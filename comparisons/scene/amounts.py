"""Quantities that change in proportion to the load parameter in every stage."""

import math
from collections.abc import Sequence


def stage_of(load_parameter: float, stages: int) -> int:
    """Return the number from 0 of the stage at `load_parameter`; at a boundary, the one that ends."""
    return min(max(math.ceil(load_parameter) - 1, 0), stages - 1)


def amount(increments: Sequence[tuple[float, ...]], load_parameter: float) -> tuple[float, ...]:
    """Return quantities that rise from zero by `increments[k]` in the stage k, in proportion to the load parameter."""
    stage = stage_of(load_parameter, len(increments))
    if stage == 0:
        return tuple(load_parameter * value for value in increments[0])
    before = (math.fsum(values) for values in zip(*increments[:stage], strict=True))
    part = load_parameter - stage
    return tuple(a + part * b for a, b in zip(before, increments[stage], strict=True))
