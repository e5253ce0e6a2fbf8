"""Solution to a requested accuracy: the choice of model and mesh, and the estimate of the remaining error."""

from comparisons.accuracy.answer import Answer
from comparisons.accuracy.choose import solve_to
from comparisons.quantities import QUANTITIES

__all__ = ["QUANTITIES", "Answer", "solve_to"]


def __dir__() -> list[str]:
    return sorted(__all__)
