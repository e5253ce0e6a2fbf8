"""Beam elements and their contact, in one registry."""

from tsm.elements.contact_law import ContactLaw, Coupling
from tsm.elements.registry import CLOSED_FORM, ELEMENTS, EXACT, ClosedForm, ElementType

__all__ = ["CLOSED_FORM", "ELEMENTS", "EXACT", "ClosedForm", "ContactLaw", "Coupling", "ElementType"]
