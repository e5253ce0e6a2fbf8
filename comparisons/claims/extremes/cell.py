"""One cell of the matrix, and its verdict."""

from dataclasses import dataclass, replace

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement
from comparisons.cases.run import COMPLETED, UNSETTLED
from comparisons.claims.claim import Finding, Verdict, decided
from comparisons.claims.extremes.checks import Check, Results
from comparisons.models.verify import CHECK_FAILED


@dataclass(frozen=True, kw_only=True)
class Cell:
    """A case at one position of the matrix, the varied quantity, the model and the value, with its checks, which all must hold."""

    axis: str = ""
    row: str
    column: str
    case: Case
    checks: tuple[Check, ...]

    @property
    def cases(self) -> tuple[Case, ...]:
        """The case, and those that its checks need."""
        return (self.case, *(case for check in self.checks for case in check.needs))

    def also(self, *checks: Check) -> "Cell":
        """Return the cell with further checks."""
        return replace(self, checks=(*self.checks, *checks))


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The verdict on a cell by its own measurement and the findings of its checks over the load parameters that were reached.

    Wrong: an error is above its allowance at a load parameter that was reached, or the case raised or lost its worker. Withdrawn: the
    answer fails the checks of a response; it counts neither as right nor as stopped.
    """

    cell: Cell
    own: Measurement
    findings: tuple[Finding, ...]
    verdict: Verdict

    @property
    def reached(self) -> float:
        """The last load parameter reached, zero if none was."""
        return float(max(self.own.response.load_parameter, default=0.0))

    @property
    def needless(self) -> bool:
        """Whether the answer is withdrawn although all its errors are within their allowances."""
        decisive = self.decisive
        return self.verdict is Verdict.WITHDRAWN and decisive is not None and bool(decisive.holds)

    @property
    def decisive(self) -> Finding | None:
        """The finding with the largest error over its allowance."""
        return max(self.findings, key=lambda finding: finding.share, default=None)

    @property
    def sentence(self) -> str:
        """What is wrong, in one line."""
        found, own = self.decisive, self.own.response
        place = f"{self.cell.axis} {self.cell.column}, {self.cell.case.label}: {self.verdict}: {own.status}"
        if found is None:
            return f"{place}: {own.message}"
        return f"{place}, error {found.error:.2g} against {found.name}, allowed {found.allowed:.2g} ({found.why})"


def judged(cell: Cell, results: Results) -> Judgement:
    """Return the verdict on `cell` by the `results` of its `cases`."""
    measured = results[cell.case]
    own = measured.response
    checks = cell.checks if len(own.load_parameter) else ()
    found = (check.finding(cell.case, own, results) for check in checks)
    findings = tuple(finding for finding in found if finding is not None)
    if own.status == CHECK_FAILED:
        verdict = Verdict.WITHDRAWN
    elif own.status in UNSETTLED:
        verdict = Verdict.WRONG
    else:
        verdict = decided(findings, completed=own.status == COMPLETED)
    return Judgement(cell=cell, own=measured, findings=findings, verdict=verdict)
