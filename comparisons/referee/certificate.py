"""Certificates: verdicts on an answer by comparison with the exact equilibrium near it."""

import math
from dataclasses import field
from enum import Enum
from typing import Any

from comparisons.frozen import Frozen
from comparisons.referee.distance import Distance
from comparisons.referee.state import Equilibrium


class Verdict(Enum):
    """Verdict on an answer, the most serious last; the value is its meaning."""

    CERTIFIED = "within its allowance of a stable, admissible equilibrium"
    NOT_JUDGED = "not judged"
    UNSTABLE = "near an unstable equilibrium, or not on the branch from the undeformed state"
    INADMISSIBLE = "near an equilibrium that violates unilateral contact or Coulomb's law"
    NOT_AN_EQUILIBRIUM = "not near an equilibrium"


class Judgement(Frozen):
    """The verdict on an answer at one load parameter."""

    load_parameter: float  #: Load parameter of the answer.
    verdict: Verdict  #: The verdict.
    reason: str  #: Reason of the verdict in one line.
    distance: Distance | None = None  #: Differences from the exact equilibrium; None without one.
    exact: Equilibrium | None = field(default=None, repr=False)  #: The exact equilibrium.

    @property
    def index(self) -> int:
        """Index of the exact equilibrium; -1 without one, and with friction, which has no potential."""
        return -1 if self.exact is None else self.exact.index

    @property
    def residual(self) -> float:
        """Estimated relative error of the exact equilibrium itself."""
        return math.nan if self.exact is None else self.exact.error


class Certificate(Frozen):
    """The verdict on an answer along its path."""

    verdict: Verdict  #: The most serious verdict.
    reason: str  #: Reason of the verdict in one line.
    allowance: float  #: Largest difference allowed.
    judged: tuple[Judgement, ...]  #: The judged load parameters, in order.
    path: tuple[str, ...]  #: Violations between the load parameters, one sentence each.
    seconds: float  #: Wall time [s].

    @property
    def certified(self) -> bool:
        """Whether the verdict is `Verdict.CERTIFIED`."""
        return self.verdict is Verdict.CERTIFIED

    def line(self) -> str:
        """Return the certificate in one line."""
        within = f" within {100.0 * self.allowance:.3g} %" if self.certified else ""
        return f"{self.verdict.name}{within}: {self.reason}"

    def as_dict(self) -> dict[str, Any]:
        """Return the certificate by the names of the JSON file."""
        judged = [_as_dict(item) for item in self.judged]
        return {**vars(self), "verdict": self.verdict.name, "judged": judged, "path": list(self.path)}


def _as_dict(item: Judgement) -> dict[str, Any]:
    """Return a judgement by the names of the JSON file."""
    values = {
        **vars(item),
        "verdict": item.verdict.name,
        "distance": item.distance and {**item.distance.sizes},
    }
    exact: Equilibrium | None = values.pop("exact")
    values |= {"index": item.index, "residual": item.residual}
    if exact is not None:
        values["exact"] = {
            "contacts": {
                pair: {"force": here.force.tolist(), "arc_position": here.arc_position}
                for pair, here in exact.contacts.items()
            },
            "reactions": {end: held.tolist() for end, held in exact.reactions.items()},
            "ends": {end: place.tolist() for end, place in exact.ends.items()},
            "strain_energy": exact.strain_energy,
        }
    return values
