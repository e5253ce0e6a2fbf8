"""The verification manual: problems with exact answers, put to every model that can state them."""

from comparisons.claims.manual.record import Case, Manual, Problem, Quantity, Run, Trial
from comparisons.claims.manual.write import write_manual

__all__ = ["Case", "Manual", "Problem", "Quantity", "Run", "Trial", "write_manual"]
