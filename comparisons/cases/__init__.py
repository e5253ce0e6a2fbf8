"""Sweeps: cases, what one of them measures, where many run, the file of their results, and studies as files."""

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, measure

__all__ = ["Case", "Measurement", "measure"]


def __dir__() -> list[str]:
    return sorted(__all__)
