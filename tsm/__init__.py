"""Planar beams by the tangent stiffness method with node-element contact, frictionless or with Coulomb friction."""

from tsm.arc_length import trace
from tsm.batch import BatchResult, solve_batch
from tsm.elements import ELEMENTS
from tsm.events import Event, EventKind
from tsm.result import ContactHistory, FrictionHistory, Result, SupportHistory
from tsm.settings import Settings
from tsm.solve import SolveError, march, solve
from tsm.status import Status
from tsm.structure import (
    Beam,
    ContactPair,
    Hinge,
    LineLoad,
    Load,
    Pin,
    Section,
    Spring,
    Structure,
    Support,
)

__all__ = [
    "ELEMENTS",
    "BatchResult",
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
    "solve_batch",
    "trace",
]
