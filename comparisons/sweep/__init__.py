"""Sweeps: cases, what one of them measures, where many run, the file of their results, and studies as files."""

from comparisons.sweep.case import Case
from comparisons.sweep.measure import Measurement, measure

__all__ = ["Case", "Measurement", "measure"]
