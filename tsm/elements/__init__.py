"""Beam elements and their contact, in one registry."""

from tsm.elements.contact_law import ContactLaw
from tsm.elements.element_type import ClosedForm, ElementType, Integrated
from tsm.elements.kinds.exact import EXACT
from tsm.elements.kinds.mixed import MIXED, MIXED_NO_BOW
from tsm.elements.kinds.paper import EULER_BERNOULLI_CANTILEVER, EULER_BERNOULLI_SIMPLE, PAPER, TIMOSHENKO
from tsm.elements.registry import CLOSED_FORM, ELEMENTS

__all__ = [
    "CLOSED_FORM",
    "ELEMENTS",
    "EULER_BERNOULLI_CANTILEVER",
    "EULER_BERNOULLI_SIMPLE",
    "EXACT",
    "MIXED",
    "MIXED_NO_BOW",
    "PAPER",
    "TIMOSHENKO",
    "ClosedForm",
    "ContactLaw",
    "ElementType",
    "Integrated",
]


def __dir__() -> list[str]:
    return sorted(__all__)
