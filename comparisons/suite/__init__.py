"""Suites: cases, the rows that they become, where they run, files of results, and studies as files."""

from comparisons.suite.case import Case, case
from comparisons.suite.measure import Row, measure
from comparisons.suite.settings import changed

__all__ = ["Case", "Row", "case", "changed", "measure"]


def __dir__() -> list[str]:
    return sorted(__all__)
