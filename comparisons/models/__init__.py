"""The models: each solves a scene and states its response; the registry has them by name."""

from comparisons.models.base import Model, Style
from comparisons.models.registry import MODELS, Certify, certified, references, solve
from comparisons.models.rod import ELASTICA, ROD
from comparisons.models.solid import SOLID
from comparisons.models.tsm import TSM

__all__ = [
    "ELASTICA",
    "MODELS",
    "ROD",
    "SOLID",
    "TSM",
    "Certify",
    "Model",
    "Style",
    "certified",
    "references",
    "solve",
]
