"""Certificates: what an answer is worth, judged by the exact equilibrium next to it."""

import math
from dataclasses import asdict, dataclass, field
from enum import Enum
from typing import Any

from comparisons.referee.distance import Distance
from comparisons.referee.equilibrium import Found
from comparisons.referee.state import Equilibrium


class Verdict(Enum):
    """What an answer is."""

    CERTIFIED = "within its allowance of a stable, admissible equilibrium"
    UNSTABLE = "next to an equilibrium that is unstable, or on another branch than it began"
    INADMISSIBLE = "next to an equilibrium that unilateral contact does not admit"
    NOT_AN_EQUILIBRIUM = "not next to an equilibrium"
    NOT_JUDGED = "not judged"


@dataclass(frozen=True, kw_only=True, eq=False)
class Judgement:
    """The verdict on an answer at one load parameter.

    Attributes
    ----------
    load_parameter : float
        Where.
    verdict : Verdict
        What the answer is.
    reason : str
        In one line.
    distance : Distance or None
        From the exact equilibrium, None if none was found.
    index : int
        Of the exact equilibrium, -1 if none was found.
    residual : float
        Relative error of the exact equilibrium itself.
    friction : float
        Sum of the tangential contact forces that the answer's reactions at a clamp show by the balance of material force, over the
        largest contact force; nan where it does not hold.
    exact : Equilibrium or None
        The equilibrium.
    """

    load_parameter: float
    verdict: Verdict
    reason: str
    distance: Distance | None = None
    index: int = -1
    residual: float = math.nan
    friction: float = math.nan
    exact: Equilibrium | None = field(default=None, repr=False)


@dataclass(frozen=True, kw_only=True, eq=False)
class Certificate:
    """What an answer is worth along its path.

    Attributes
    ----------
    verdict : Verdict
        The gravest of all.
    reason : str
        Of the verdict, in one line.
    allowance : float
        Largest distance allowed.
    judged : tuple of Judgement
        The load parameters that were judged, in order.
    path : tuple of str
        What is wrong between the load parameters, a sentence each.
    seconds : float
        Spent.
    """

    verdict: Verdict
    reason: str
    allowance: float
    judged: tuple[Judgement, ...]
    path: tuple[str, ...]
    seconds: float

    @property
    def certified(self) -> bool:
        """Whether the verdict is `Verdict.CERTIFIED`."""
        return self.verdict is Verdict.CERTIFIED

    def line(self) -> str:
        """Return the certificate in one line."""
        return f"{self.verdict.name}: {self.reason}"

    def as_dict(self) -> dict[str, Any]:
        """Return the certificate by the names of the JSON file."""
        return {
            "verdict": self.verdict.name,
            "reason": self.reason,
            "allowance": self.allowance,
            "judged": [_stated(item) for item in self.judged],
            "path": list(self.path),
            "seconds": self.seconds,
        }


def _stated(item: Judgement) -> dict[str, Any]:
    exact = item.exact
    values: dict[str, Any] = {
        "load_parameter": item.load_parameter,
        "verdict": item.verdict.name,
        "reason": item.reason,
        "distance": None if item.distance is None else asdict(item.distance),
        "index": item.index,
        "residual": item.residual,
        "friction": item.friction,
    }
    if exact is not None and exact.found is Found.FOUND:
        values["exact"] = {
            "contacts": {
                pair: {"force": list(map(float, here.force)), "arc_position": here.arc_position}
                for pair, here in exact.contacts.items()
            },
            "reactions": {end: list(map(float, held)) for end, held in exact.reactions.items()},
            "ends": {end: list(map(float, place)) for end, place in exact.ends.items()},
            "strain_energy": exact.strain_energy,
        }
    return values
