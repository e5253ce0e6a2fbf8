"""What a model states about a scene, as a record and as JSON."""

from comparisons.answer.record import (
    CONTACT_STATES,
    OPEN,
    SLIPS,
    Array,
    ContactEvent,
    ContactHistory,
    CriticalPoint,
    Deformation,
    FrictionHistory,
    Grid,
    Ints,
    Sections,
    SupportHistory,
)
from comparisons.answer.response import Response

__all__ = [
    "CONTACT_STATES",
    "OPEN",
    "SLIPS",
    "Array",
    "ContactEvent",
    "ContactHistory",
    "CriticalPoint",
    "Deformation",
    "FrictionHistory",
    "Grid",
    "Ints",
    "Response",
    "Sections",
    "SupportHistory",
]


def __dir__() -> list[str]:
    return sorted(__all__)
