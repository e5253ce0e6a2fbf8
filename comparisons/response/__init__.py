"""What a model states about a scene, as a record and as JSON."""

from comparisons.response.record import (
    Array,
    ContactEvent,
    ContactHistory,
    CriticalPoint,
    Deformation,
    FrictionHistory,
    Grid,
    Response,
    SupportHistory,
)

__all__ = [
    "Array",
    "ContactEvent",
    "ContactHistory",
    "CriticalPoint",
    "Deformation",
    "FrictionHistory",
    "Grid",
    "Response",
    "SupportHistory",
]
