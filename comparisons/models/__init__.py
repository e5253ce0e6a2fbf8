"""The models: each solves a scene and states its response; the registry has them by name."""

from comparisons.models.registry import MODELS, Certify, certified, solve

__all__ = ["MODELS", "Certify", "certified", "solve"]
