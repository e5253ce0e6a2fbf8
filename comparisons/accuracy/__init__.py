"""An accuracy instead of a mesh: which model a scene requires, how fine, and what error is left."""

from comparisons.accuracy.answer import Answer
from comparisons.accuracy.choose import solve_to
from comparisons.quantities import QUANTITIES

__all__ = ["QUANTITIES", "Answer", "solve_to"]
