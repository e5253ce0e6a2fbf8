"""The verification manual: problems with exact answers, put to every model that can state them."""

from comparisons.suites.manual.problem import Case, Problem, Trial, problems, read_problem
from comparisons.suites.manual.write import judged, write_manual

__all__ = ["Case", "Problem", "Trial", "judged", "problems", "read_problem", "write_manual"]


def __dir__() -> list[str]:
    return sorted(__all__)
