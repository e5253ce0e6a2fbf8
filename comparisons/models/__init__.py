"""The models, by name in a registry. Each model solves a scene and returns its response."""

from comparisons.models.model import Model, Style
from comparisons.models.registry import MODELS, certified, find, restored, solve
from comparisons.models.rod import ELASTICA, ROD
from comparisons.models.solid import SOLID
from comparisons.models.tsm import TSM

__all__ = [
    "ELASTICA",
    "MODELS",
    "ROD",
    "SOLID",
    "TSM",
    "Model",
    "Style",
    "certified",
    "find",
    "restored",
    "solve",
]


def __dir__() -> list[str]:
    return sorted(__all__)
