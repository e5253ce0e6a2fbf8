"""2D solid elements with unilateral contact: the finite-element reference for beam contact."""

from typing import TYPE_CHECKING

from fem_reference.path.critical import CriticalPoint
from fem_reference.result.observe import (
    SectionForces,
    axis_line,
    axis_stations,
    energy,
    face_strains,
    fibre_stress,
    nodal_stress,
    section_forces,
)
from fem_reference.result.result import ContactHistory, Result, SolveError, SupportHistory
from fem_reference.solve import solve
from fem_reference.statement.conditions import Joint, Spring, Support
from fem_reference.statement.loads import LineLoad, PointLoad
from fem_reference.statement.material import MATERIALS, PLANES
from fem_reference.statement.problem import Contact, Pin, SolidProblem, default_penalty
from fem_reference.statement.settings import Settings
from fem_reference.statement.status import Status
from fem_reference.statement.strip import ELEMENTS, Strip

__all__ = [
    "ELEMENTS",
    "MATERIALS",
    "PLANES",
    "Contact",
    "ContactHistory",
    "CriticalPoint",
    "Joint",
    "LineLoad",
    "Pin",
    "PointLoad",
    "Result",
    "SectionForces",
    "Settings",
    "SolidProblem",
    "SolveError",
    "Spring",
    "Status",
    "Strip",
    "Support",
    "SupportHistory",
    "axis_line",
    "axis_stations",
    "default_penalty",
    "energy",
    "face_strains",
    "fibre_stress",
    "nodal_stress",
    "section_forces",
    "solve",
]


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


if not TYPE_CHECKING:

    def __getattr__(name: str) -> str:
        """Look the version up where it is asked for; that imports more than the package."""
        if name != "__version__":
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib.metadata import version

        return version("tsm-crossval")
