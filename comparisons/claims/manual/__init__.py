"""The verification manual: problems with exact answers, put to every model that can state them."""

from comparisons.claims.manual.problem import (
    Case,
    Judgement,
    Problem,
    Quantity,
    Trial,
    problems,
    read_problem,
)
from comparisons.claims.manual.write import Manual, judged, write_manual

__all__ = [
    "Case",
    "Judgement",
    "Manual",
    "Problem",
    "Quantity",
    "Trial",
    "judged",
    "problems",
    "read_problem",
    "write_manual",
]


def __dir__() -> list[str]:
    return sorted(__all__)
