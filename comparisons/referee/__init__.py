"""The referee: the exact equilibrium of a scene's rods next to any answer, independent of every model, and certificates by it."""

from comparisons.referee.certificate import Certificate, Judgement, Verdict
from comparisons.referee.certify import certify, default_allowance
from comparisons.referee.distance import Distance
from comparisons.referee.equilibrium import Found
from comparisons.referee.start import Given, given_by
from comparisons.referee.state import Contact, Equilibrium, Shape, equilibrium

__all__ = [
    "Certificate",
    "Contact",
    "Distance",
    "Equilibrium",
    "Found",
    "Given",
    "Judgement",
    "Shape",
    "Verdict",
    "certify",
    "default_allowance",
    "equilibrium",
    "given_by",
]
