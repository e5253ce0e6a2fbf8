"""Translation of a scene into the problem of each solver; the modelling assumptions stand here side by side."""

from comparisons.models.translate.to_rod import RodScene, to_rod
from comparisons.models.translate.to_solid import to_solid
from comparisons.models.translate.to_structure import beams_refusal, to_structure

__all__ = ["RodScene", "beams_refusal", "to_rod", "to_solid", "to_structure"]


def __dir__() -> list[str]:
    return sorted(__all__)
