"""The element that integrates the Reissner rod."""

from tsm.elements.element_type import Integrated

EXACT = Integrated(
    name="exact",
    source="the Reissner rod's own equations, integrated from load to load",
    colour="#CC79A7",
    marker="*",
)

ELEMENTS = (EXACT,)
