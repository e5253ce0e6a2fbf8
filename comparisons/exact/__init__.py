"""Exact solutions under one pin: the elastica in closed form, and the Reissner rod without and with friction."""

from comparisons.exact.elastica import ElasticaState, elastica_under_pin
from comparisons.exact.friction_result import FrictionEvent, FrictionPath, FrictionState
from comparisons.exact.friction_rod import Surface, rod_with_friction
from comparisons.exact.outcome import Outcome
from comparisons.exact.rod import RodPath, rod_under_pin

__all__ = [
    "ElasticaState",
    "FrictionEvent",
    "FrictionPath",
    "FrictionState",
    "Outcome",
    "RodPath",
    "Surface",
    "elastica_under_pin",
    "rod_under_pin",
    "rod_with_friction",
]


def __dir__() -> list[str]:
    return sorted(__all__)
