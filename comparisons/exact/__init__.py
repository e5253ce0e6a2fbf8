"""Exact solution of the Reissner rod under one pin, without and with friction; without stretch and shear it is the elastica."""

from comparisons.exact.path import Event, Outcome, RodPath
from comparisons.exact.rod import rod_under_pin

__all__ = ["Event", "Outcome", "RodPath", "rod_under_pin"]


def __dir__() -> list[str]:
    return sorted(__all__)
