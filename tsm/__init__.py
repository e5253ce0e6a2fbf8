"""Planar beams by the tangent stiffness method with node-element contact, frictionless or with Coulomb friction."""

from tsm.arc_length import trace
from tsm.batch import BatchResult, solve_batch
from tsm.elements import ELEMENTS
from tsm.events import Event, EventKind
from tsm.result import ContactHistory, FrictionHistory, Result, SupportHistory
from tsm.settings import Settings
from tsm.solve import SolveError, march, solve
from tsm.status import Status
from tsm.structure import Beam, ContactPair, LineLoad, Load, Pin, Section, Structure, Support

__all__ = [
    "ELEMENTS",
    "BatchResult",
    "Beam",
    "ContactHistory",
    "ContactPair",
    "Event",
    "EventKind",
    "FrictionHistory",
    "LineLoad",
    "Load",
    "Pin",
    "Result",
    "Section",
    "Settings",
    "SolveError",
    "Status",
    "Structure",
    "Support",
    "SupportHistory",
    "march",
    "solve",
    "solve_batch",
    "trace",
]
