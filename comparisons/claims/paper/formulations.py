"""The element formulations of the studies: the paper's three, then the one whose contact force is an unknown."""

from typing import Any

from comparisons.show import palette
from tsm.elements import EULER_BERNOULLI_CANTILEVER, EULER_BERNOULLI_SIMPLE
from tsm.elements import MIXED as MIXED_ELEMENT
from tsm.elements import TIMOSHENKO as TIMOSHENKO_ELEMENT

SIMPLE, CANTILEVER = EULER_BERNOULLI_SIMPLE.name, EULER_BERNOULLI_CANTILEVER.name
TIMOSHENKO, MIXED = TIMOSHENKO_ELEMENT.name, MIXED_ELEMENT.name
LABELS = {
    SIMPLE: "Euler-Bernoulli, simple",
    CANTILEVER: "Euler-Bernoulli, cantilever",
    TIMOSHENKO: "Timoshenko",
    MIXED: MIXED,
}
"""What they are called, in the order of drawing."""
_DASHES = {CANTILEVER: (0, (5, 2)), MIXED: (0, (1, 1))}


def line(element: str) -> dict[str, Any]:
    """Return the keywords of a formulation's line in matplotlib."""
    style = palette.style(f"TSM {element}")
    return {"color": style.colour, "marker": style.marker, "linestyle": _DASHES.get(element, "-")}
