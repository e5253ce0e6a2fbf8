"""Beam elements and their contact, in one registry."""

from tsm.elements.registry import ELEMENTS, ElementType

__all__ = ["ELEMENTS", "ElementType"]
