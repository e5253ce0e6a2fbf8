"""Friction in an answer: states of the contacts, the places of stick, Coulomb's law, and dissipation; loaded where a contact has friction."""

from comparisons.referee.friction.history import History
from comparisons.referee.friction.rubbing import dissipated, rubs_wrongly, rubs_wrongly_on_the_way, unlawful

__all__ = ["History", "dissipated", "rubs_wrongly", "rubs_wrongly_on_the_way", "unlawful"]


def __dir__() -> list[str]:
    return sorted(__all__)
