"""Sweeps: cases as records, and what one of them measures."""

from comparisons.sweep.case import Case
from comparisons.sweep.measure import Measurement, measure

__all__ = ["Case", "Measurement", "measure"]
