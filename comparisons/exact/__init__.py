"""Exact solutions under one pin: the elastica in closed form, and the Reissner rod without and with friction."""

from comparisons.exact.elastica import elastica_under_pin
from comparisons.exact.path import Event, Outcome, RodPath
from comparisons.exact.rod import rod_under_pin

__all__ = ["Event", "Outcome", "RodPath", "elastica_under_pin", "rod_under_pin"]


def __dir__() -> list[str]:
    return sorted(__all__)
