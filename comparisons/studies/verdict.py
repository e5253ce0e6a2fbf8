"""A claim of [P], and how it is judged by numbers."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Verdict(StrEnum):
    """What becomes of a claim."""

    REPRODUCED = "reproduced"
    NOT_REPRODUCED = "not reproduced"
    CANNOT_BE_TOLD = "cannot be told"


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """A verdict, the number behind it and the reason."""

    verdict: Verdict
    number: str
    why: str


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One claim.

    Attributes
    ----------
    source : str
        Where it stands in [P].
    text : str
        What it says.
    figure : str
        The figure whose study decides it.
    judge : callable
        From that study to the judgement.
    """

    source: str
    text: str
    figure: str
    judge: Callable[[Any], Judgement]


def holds(condition: bool, number: str, why: str) -> Judgement:
    """Judge a claim that the numbers decide."""
    verdict = Verdict.REPRODUCED if condition else Verdict.NOT_REPRODUCED
    return Judgement(verdict=verdict, number=number, why=why)


def percent(value: float) -> str:
    """Return a ratio in percent, with three digits."""
    return f"{100.0 * value:.3g} %" if value >= 1e-6 else f"{100.0 * value:.0e} %"
