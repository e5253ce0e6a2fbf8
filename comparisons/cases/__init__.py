"""Suites: cases, what one of them measures, where many run, the file of their results, their rows, and studies as files."""

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, measure
from comparisons.cases.rows import Row

__all__ = ["Case", "Measurement", "Row", "measure"]


def __dir__() -> list[str]:
    return sorted(__all__)
