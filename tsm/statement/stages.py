"""Stages of the load: the load parameter goes from k to k + 1 in the stage k, and all changes are in proportion to it."""

from __future__ import annotations

import math

import numpy as np

from tsm.elements.properties import Array


def stage_of(load_parameter: float, stages: int) -> int:
    """Number, from 0, of the stage at a load parameter; at a boundary, the stage that ends there.

    >>> [stage_of(t, 2) for t in (0.0, 0.5, 1.0, 1.5, 2.0)]
    [0, 0, 0, 1, 1]
    """
    return 0 if stages == 1 else min(max(math.ceil(load_parameter) - 1, 0), stages - 1)


class Increments:
    """Quantities that rise from zero by an increment in every stage.

    ``rows`` (stages, ...): increments of the quantities; each stays after its stage.
    """

    def __init__(self, rows: Array) -> None:
        self.rows = rows
        self.before = np.cumsum(rows, axis=0) - rows

    def at(self, load_parameter: float) -> Array:
        """Quantities at a load parameter."""
        stage = stage_of(load_parameter, len(self.rows))
        return self.before[stage] + (load_parameter - stage) * self.rows[stage]

    def rate(self, load_parameter: float) -> Array:
        """Derivatives in the load parameter; where a stage ends, during that stage."""
        return self.rows[stage_of(load_parameter, len(self.rows))]

    def change(self, begin: float, end: float) -> Array:
        """Changes between two load parameters."""
        return self.at(end) - self.at(begin)

    def dot(self, load_parameter: float, values: Array) -> float:
        """Scalar product of n quantities at a load parameter with other values (n,)."""
        return float(self.at(load_parameter) @ values)
