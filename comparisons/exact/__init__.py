"""Exact solutions: the elastica in closed form and the Reissner rod under a pin."""

from comparisons.exact.elastica import ElasticaState, elastica_under_pin
from comparisons.exact.outcome import Outcome
from comparisons.exact.rod import RodPath, rod_under_pin

__all__ = ["ElasticaState", "Outcome", "RodPath", "elastica_under_pin", "rod_under_pin"]
