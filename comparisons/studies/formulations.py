"""The element formulations that the studies compare, each with one colour in every figure."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Formulation:
    """An element type of `tsm`, how [P] calls it and how it is drawn."""

    element: str
    label: str
    color: str
    marker: str
    linestyle: Any = "-"

    @property
    def line(self) -> dict[str, Any]:
        """Keywords of a matplotlib line."""
        return {"color": self.color, "marker": self.marker, "linestyle": self.linestyle}


# Okabe and Ito's palette: told apart with every common colour blindness; markers and dashes tell them apart in grey.
FORMULATIONS = (
    Formulation(
        element="euler-bernoulli-simple", label="Euler-Bernoulli, simple", color="#D55E00", marker="o"
    ),
    Formulation(
        element="euler-bernoulli-cantilever",
        label="Euler-Bernoulli, cantilever",
        color="#E69F00",
        marker="s",
        linestyle=(0, (5, 2)),
    ),
    Formulation(element="timoshenko", label="Timoshenko", color="#0072B2", marker="^"),
    Formulation(element="mixed", label="mixed", color="#009E73", marker="D", linestyle=(0, (1, 1))),
)
"""The paper's three, then the one whose contact force is an unknown."""
