"""The verification manual: problems with exact answers, put to every model that can state them."""

from comparisons.suites.manual.problem import Problem, Trial, problems, read_problem
from comparisons.suites.manual.write import Judgement, judged, manual

__all__ = ["Judgement", "Problem", "Trial", "judged", "manual", "problems", "read_problem"]


def __dir__() -> list[str]:
    return sorted(__all__)
