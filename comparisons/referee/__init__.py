"""The referee: the exact equilibrium of a scene's rods next to any answer, independent of every model."""

from comparisons.referee.equilibrium import Found
from comparisons.referee.start import Given, given_by
from comparisons.referee.state import Contact, Equilibrium, Shape, equilibrium

__all__ = ["Contact", "Equilibrium", "Found", "Given", "Shape", "equilibrium", "given_by"]
