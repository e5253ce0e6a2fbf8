"""The verification manual: problems with exact answers, put to every model that can state them."""

from comparisons.claims.manual.record import Case, Manual, Problem, Trial
from comparisons.claims.manual.write import write_manual

__all__ = ["Case", "Manual", "Problem", "Trial", "write_manual"]


def __dir__() -> list[str]:
    return sorted(__all__)
