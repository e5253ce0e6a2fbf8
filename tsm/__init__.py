"""Planar beams by the tangent stiffness method with node-element contact, frictionless or with Coulomb friction."""

from typing import TYPE_CHECKING

from tsm.arc_length import trace
from tsm.contact.events import Event, EventKind
from tsm.elements import ELEMENTS
from tsm.result.result import ContactHistory, FrictionHistory, Result, SupportHistory
from tsm.solve import SolveError, march, solve
from tsm.statement.beam import Beam, LineLoad, Section
from tsm.statement.pin import Pin
from tsm.statement.settings import Settings
from tsm.statement.springs import Hinge, Spring
from tsm.statement.status import Status
from tsm.statement.structure import ContactPair, Load, Structure, Support

__all__ = [
    "ELEMENTS",
    "Beam",
    "ContactHistory",
    "ContactPair",
    "Event",
    "EventKind",
    "FrictionHistory",
    "Hinge",
    "LineLoad",
    "Load",
    "Pin",
    "Result",
    "Section",
    "Settings",
    "SolveError",
    "Spring",
    "Status",
    "Structure",
    "Support",
    "SupportHistory",
    "march",
    "solve",
    "trace",
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
