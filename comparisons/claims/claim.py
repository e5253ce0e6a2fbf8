"""A claim: values that a case measures, their reference values and the error that is allowed; and the one judge of claims."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from time import perf_counter

from comparisons.claims.junit import JUnitCase


class StoppedError(RuntimeError):
    """A solution that stopped before it had an answer: its status and sentence."""


class Verdict(StrEnum):
    """Verdict on a claim."""

    RIGHT = "right"
    STOPPED = "stopped"
    WITHDRAWN = "withdrawn"
    """The checks of the response refuse the answer. It counts neither as right nor as stopped."""
    WRONG = "wrong"


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A number with its reference value.

    The name has the unit, unless the quantity is dimensionless. The scale divides the error; by default it is the magnitude of the
    reference value.
    """

    name: str
    exact: float
    scale: float | None = None

    def error(self, value: float) -> float:
        """Return ``|value - exact| / scale``."""
        return abs(value - self.exact) / (abs(self.exact) if self.scale is None else self.scale)


@dataclass(frozen=True, kw_only=True)
class Allowance:
    """The largest error allowed, and its reason: the largest part of it in words."""

    error: float
    why: str


@dataclass(frozen=True, kw_only=True)
class Finding:
    """The relative error of a quantity, or against an answer, with its bound and the reason of the bound.

    The error is infinite where one of the two has no answer.
    """

    name: str
    error: float
    allowed: float
    why: str = "asked for"

    @property
    def holds(self) -> bool:
        """Whether the error is within what is allowed; nan is not."""
        return self.error <= self.allowed

    @property
    def share(self) -> float:
        """The error over the allowed error, infinite if the error is nan."""
        share = self.error / self.allowed
        return share if math.isfinite(share) else math.inf

    def beyond(self, value: float, exact: float) -> str:
        """Return the sentence for a bound that a value breaks."""
        return f"{self.name}: {value:.10g}, exact {exact:.10g}, error {self.error:.2g} > {self.allowed:.2g}"

    @property
    def measured(self) -> str:
        """The error and its bound in one line."""
        return f"{self.name}: error {self.error:.2g}, allowed {self.allowed:g}"


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A statement about the answer to a case."""

    name: str  # name of the model with its resolution
    quantities: tuple[Quantity, ...]  # what is compared, with the reference values
    allowance: Allowance  # allowed error of every quantity
    # returns a value for every quantity; raises `StoppedError` where there is no answer
    measure: Callable[[], Sequence[float]]


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """A claim, its verdict, and for every quantity the value, nan where the solution stopped, and the error.

    `seconds` is the wall time of everything, and `stopped` says why there is no answer, if there is none.
    """

    claim: Claim
    verdict: Verdict
    values: tuple[float, ...]
    findings: tuple[Finding, ...]
    seconds: float
    stopped: str = ""

    @property
    def passed(self) -> bool:
        """Whether every error is within what is allowed."""
        return self.verdict is Verdict.RIGHT

    @property
    def worst(self) -> int:
        """Number of the quantity with the largest error, of the first that is not a number if one is not."""
        return max(range(len(self.findings)), key=lambda k: self.findings[k].share)

    @property
    def failure(self) -> str | None:
        """Why the claim fails, with its numbers; None if it is right."""
        if self.passed or self.stopped:
            return self.stopped or None
        k = self.worst
        return self.findings[k].beyond(self.values[k], self.claim.quantities[k].exact)

    def junit(self, classname: str) -> JUnitCase:
        """Return the judgement as a JUnit test case."""
        return JUnitCase(
            classname=classname,
            name=self.claim.name,
            seconds=self.seconds,
            failure=self.failure,
            output="\n".join(one.measured for one in self.findings),
        )


def judge(claim: Claim) -> Judgement:
    """Measure what a claim is about and judge it; a claim without a value for every quantity is a `ValueError`."""
    began, stopped = perf_counter(), ""
    try:
        values = tuple(claim.measure())
    except StoppedError as error:
        stopped, values = str(error), (math.nan,) * len(claim.quantities)
    seconds, allowed = perf_counter() - began, claim.allowance
    findings = tuple(
        Finding(
            name=quantity.name,
            error=math.inf if stopped else quantity.error(value),
            allowed=allowed.error,
            why=allowed.why,
        )
        for quantity, value in zip(claim.quantities, values, strict=True)
    )
    verdict = Verdict.STOPPED if stopped else decided(findings)
    return Judgement(
        claim=claim, verdict=verdict, values=values, findings=findings, seconds=seconds, stopped=stopped
    )


def decided(findings: Sequence[Finding], *, completed: bool = True) -> Verdict:
    """Return the verdict on the findings. One error above its allowance is wrong, also if the solution stopped later."""
    if not all(finding.holds for finding in findings):
        return Verdict.WRONG
    return Verdict.RIGHT if completed else Verdict.STOPPED
