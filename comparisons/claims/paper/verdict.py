"""A claim of [P], and how it is judged by numbers."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Verdict(StrEnum):
    """What becomes of a claim."""

    REPRODUCED = "reproduced"
    IN_DIRECTION = "reproduced in direction, not in size"
    NOT_REPRODUCED = "not reproduced"
    CANNOT_BE_TOLD = "cannot be told"
    PROVISIONAL = "provisional"
    """Coarse settings decide nothing: a full run may decide otherwise."""


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """A verdict, the number behind it and the reason."""

    verdict: Verdict
    number: str
    why: str


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One claim, however often the paper makes it.

    Attributes
    ----------
    stated : tuple of (str, str)
        Where it stands in [P], and what it says there.
    figure : str
        The figure whose study decides it.
    judge : callable
        From that study to the judgement.
    """

    stated: tuple[tuple[str, str], ...]
    figure: str
    judge: Callable[[Any], Judgement]

    @property
    def source(self) -> str:
        """Every place in [P] where it stands."""
        return "; ".join(place for place, _ in self.stated)

    @property
    def text(self) -> str:
        """What it says, at all of its places."""
        return " ".join(text for _, text in self.stated)


def claim(figure: str, judge: Callable[[Any], Judgement], *stated: tuple[str, str]) -> Claim:
    """Return the claim that the study of `figure` decides by `judge`."""
    return Claim(stated=stated, figure=figure, judge=judge)


def holds(condition: bool, number: str, why: str) -> Judgement:
    """Judge a claim that the numbers decide."""
    verdict = Verdict.REPRODUCED if condition else Verdict.NOT_REPRODUCED
    return Judgement(verdict=verdict, number=number, why=why)


def over_readings(cases: Sequence[bool | None], number: str, why: str) -> Judgement:
    """Judge a claim that depends on what the paper does not say.

    Parameters
    ----------
    cases : sequence of bool or None
        Whether it holds in every reading; None where this program ends before the reading does.
    number, why : str
        Measured numbers and reason of the judgement.

    Returns
    -------
    Judgement
        Reproduced where it holds in all readings, not reproduced where it fails in all of them; otherwise it cannot be told.
    """
    if not cases:
        raise ValueError("cases = (): a claim without a reading cannot be judged")
    if all(cases):
        verdict = Verdict.REPRODUCED
    elif all(case is False for case in cases):
        verdict = Verdict.NOT_REPRODUCED
    else:
        verdict = Verdict.CANNOT_BE_TOLD
    return Judgement(verdict=verdict, number=number, why=why)


def in_size(*, direction: bool, size: bool, number: str, why: str) -> Judgement:
    """Judge a claim of which the paper prints a size: whether its direction is right, and whether its size is reached."""
    if not direction:
        verdict = Verdict.NOT_REPRODUCED
    else:
        verdict = Verdict.REPRODUCED if size else Verdict.IN_DIRECTION
    return Judgement(verdict=verdict, number=number, why=why)


def percent(value: float) -> str:
    """Return a ratio in percent, with three digits."""
    return f"{100.0 * value:.3g} %" if value >= 1e-6 else f"{100.0 * value:.0e} %"
