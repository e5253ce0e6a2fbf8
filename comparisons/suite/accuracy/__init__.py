"""Solution to a requested accuracy: the choice of model and mesh, and the estimate of the remaining error."""

from comparisons.suite.accuracy.answer import Answer, solve_to

__all__ = ["Answer", "solve_to"]


def __dir__() -> list[str]:
    return sorted(__all__)
