"""The element formulations that the studies compare, each with one colour in every figure."""

from dataclasses import dataclass
from typing import Any

from comparisons.show import palette
from tsm.elements import EULER_BERNOULLI_CANTILEVER, EULER_BERNOULLI_SIMPLE, MIXED, TIMOSHENKO


@dataclass(frozen=True, kw_only=True)
class Formulation:
    """An element type of `tsm`, how [P] calls it and how it is drawn."""

    element: str
    label: str
    marker: str
    linestyle: Any = "-"

    @property
    def color(self) -> str:
        """The model's colour."""
        return palette.colour(f"TSM {self.element}")

    @property
    def line(self) -> dict[str, Any]:
        """Keywords of a matplotlib line."""
        return {"color": self.color, "marker": self.marker, "linestyle": self.linestyle}


FORMULATIONS = (
    Formulation(element=EULER_BERNOULLI_SIMPLE.name, label="Euler-Bernoulli, simple", marker="o"),
    Formulation(
        element=EULER_BERNOULLI_CANTILEVER.name,
        label="Euler-Bernoulli, cantilever",
        marker="s",
        linestyle=(0, (5, 2)),
    ),
    Formulation(element=TIMOSHENKO.name, label="Timoshenko", marker="^"),
    Formulation(element=MIXED.name, label=MIXED.name, marker="D", linestyle=(0, (1, 1))),
)
"""The paper's three, then the one whose contact force is an unknown."""
