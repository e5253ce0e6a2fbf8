"""The referee: it computes the exact equilibrium of a scene's rods near an answer and certifies the answer, whatever the model."""

from comparisons.referee.certificate import Certificate, Judgement, Verdict
from comparisons.referee.certify import certify, default_allowance
from comparisons.referee.distance import Distance
from comparisons.referee.guess import AnswerState, answer_state
from comparisons.referee.newton import equilibrium
from comparisons.referee.state import Contact, Equilibrium, SearchStatus, Shape

__all__ = [
    "AnswerState",
    "Certificate",
    "Contact",
    "Distance",
    "Equilibrium",
    "Judgement",
    "SearchStatus",
    "Shape",
    "Verdict",
    "answer_state",
    "certify",
    "default_allowance",
    "equilibrium",
]


def __dir__() -> list[str]:
    return sorted(__all__)
