"""A claim of [P], and how it is judged by numbers."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from inspect import getdoc

from comparisons.claims.paper.figure_study import Study


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


Judge = Callable[[Study], Judgement]


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One claim, however often the paper makes it: places with what is said there, and the judge of the study of a figure."""

    figure: str
    stated: tuple[tuple[str, str], ...]
    judge: Judge

    @property
    def source(self) -> str:
        """Every place in [P] where it stands."""
        return "; ".join(place for place, _ in self.stated)

    @property
    def text(self) -> str:
        """What it says, at all of its places."""
        return " ".join(text for _, text in self.stated)


STATED: list[Claim] = []
"""Every claim that a judge is marked with."""


def claim(figure: str, *places: str) -> Callable[[Judge], Judge]:
    """Mark the judge of a claim: its docstring is what the paper says, a paragraph for each place in [P]."""

    def marked(judge: Judge) -> Judge:
        texts = (getdoc(judge) or "").split("\n\n")
        STATED.append(Claim(figure=figure, stated=tuple(zip(places, texts, strict=True)), judge=judge))
        return judge

    return marked


def holds(cases: bool | Sequence[bool | None], number: str, why: str, *, in_size: bool = True) -> Judgement:
    """Judge a claim that the numbers decide: whether it holds, or `cases` of it in every reading of what the paper does not say.

    A case is None where this program ends before the reading does. The claim is reproduced where it holds in all readings, in
    direction only unless `in_size`; not reproduced where it fails in all of them; otherwise it cannot be told.
    """
    given = cases if isinstance(cases, Sequence) else [cases]
    readings = [None if case is None else bool(case) for case in given]  # bool of numpy, too
    if not readings:
        raise ValueError("cases = (): a claim without a reading cannot be judged")
    if all(readings):
        verdict = Verdict.REPRODUCED if in_size else Verdict.IN_DIRECTION
    elif all(case is False for case in readings):
        verdict = Verdict.NOT_REPRODUCED
    else:
        verdict = Verdict.CANNOT_BE_TOLD
    return Judgement(verdict=verdict, number=number, why=why)


def percent(value: float) -> str:
    """Return a ratio in percent, with three digits."""
    return f"{100.0 * value:.3g} %" if value >= 1e-6 else f"{100.0 * value:.0e} %"
