"""One cell of the matrix: what must hold of its answer, against other answers or by a law in closed form, and its verdict."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from comparisons.answer import Response
from comparisons.answer.errors import difference
from comparisons.frozen import Value
from comparisons.models import TSM
from comparisons.models.shared import kept
from comparisons.models.theory import FLOOR, Bending, bending, chord_term, element_lengths, ordinal
from comparisons.models.verify import CHECK_FAILED
from comparisons.output import Row as TableRow
from comparisons.scene import BeamSpec
from comparisons.suite import Case
from comparisons.suite.run import UNSETTLED, Results
from comparisons.suites.finding import Finding
from tsm.elements import ClosedForm

COMPARED = ("force", "arc", "moment", "tip")
"""Quantities whose largest relative difference is the error."""
INVARIANT = 1e-12
NEXT_TERM = 1.05
"""Error of a roll-up over its first neglected term, with all further terms."""
LARGEST = 0.2
"""Largest allowed error for any model; an answer with a larger error should have stopped."""
Check = Callable[[Case, Response, Results], Finding | None]
"""What must hold of a case's response; None where there is nothing to hold it against."""


class Allowance(NamedTuple):
    """The largest error allowed, and its reason: the largest part of it in words."""

    error: float
    why: str


def allowance(case: Case, bent: Bending) -> Allowance:
    """Return the error allowed to `case` against Reissner's rod, bent so; of a rod at most `LARGEST`."""
    parts = case.found.error_parts(case.scene, case.options, bent)
    error, largest = sum(parts.values()), max(parts, key=parts.__getitem__)
    if case.found.rod and not error <= LARGEST:
        return Allowance(LARGEST, f"more is wrong, although theory allows it: {largest}")
    return Allowance(error, largest)


def in_units_of(other: BeamSpec, beam: BeamSpec, response: Response) -> Response:
    """Return the response of `beam` in the units of `other`, which differs in units only."""
    length = other.length / beam.length
    force = other.EI / beam.EI / length**2

    def scaled(one: Any, **factors: float) -> Any:
        return replace(one, **{key: factor * getattr(one, key) for key, factor in factors.items()})

    contacts, supports = response.contacts.items(), response.supports.items()
    return replace(
        response,
        contacts={pair: scaled(one, force=force, arc_position=length) for pair, one in contacts},
        supports={node: scaled(one, force=force, moment=force * length) for node, one in supports},
        tips={name: length * values for name, values in response.tips.items()},
    )


class Against(Value):
    """The check against the answer of another case in any units; by default theory says what is allowed."""

    case: Case
    name: str = "exact rod"
    allowed: Allowance | None = None

    def __call__(self, case: Case, own: Response, results: Results) -> Finding | None:
        """Return the error of `own` at the load parameters of both; None where the other is no reference."""
        # a model of another rod, as the elastica, may go further than its reference, or be too soft for one
        other, beam, rod = results[self.case].response, self.case.scene.beams[0], case.found.rod
        allowed, why = self.allowed or allowance(case, bending(beam, other))
        if not rod and (allowed > LARGEST or not len(other.load_parameter)):
            return None
        if rod and len(own.load_parameter) > len(other.load_parameter):
            why, error = f"it went on where the {self.name} stopped: {other.ended}", np.inf
        else:
            answer = in_units_of(beam, case.scene.beams[0], own)
            found = [difference(answer, other, self.case.scene, quantity) for quantity in COMPARED]
            error = float(np.fmax.reduce(found, initial=0.0))
        return Finding(name=self.name, error=error, allowed=allowed, why=why)


def energy(case: Case, own: Response, _: Results) -> Finding:
    """Energy integral of a rod under a pin on its axis: its largest violation over ``2 EI sin b``."""
    # with the force F (-sin b, cos b) at (x, y), c = 1/EA - 1/GA and S = (F/GA)/(1 + sqrt(1 - F^2 c/GA)):
    #     F (x cos b + y sin b)^2 = 2 EI (sin b - S) (1 - F c (sin b + S)/2);  S = c = 0 for the elastica
    beam, pin, rod = case.scene.beams[0], case.scene.pins[0], case.found.rod
    force = -own.supports[f"{beam.name}.start"].force
    F = np.hypot(*force.T)
    closed = F > 0.0
    x, y = np.array([pin.position(float(t)) for t in own.load_parameter[closed]]).reshape(-1, 2).T
    F, sine, cosine = F[closed], -force[closed, 0] / F[closed], force[closed, 1] / F[closed]
    shear, stretch = (1 / beam.GA, 1 / beam.EA) if rod else (0.0, 0.0)
    c = stretch - shear
    S = F * shear / (1 + np.sqrt(1 - F**2 * c * shear))
    left = F * (x * cosine + y * sine) ** 2
    right = 2 * beam.EI * (sine - S) * (1 - F * c * (sine + S) / 2)
    error = float((np.abs(left - right) / (2 * beam.EI * sine)).max(initial=0.0))
    what = "its energy integral" if rod else "2 EI sin tc of the elastica"
    return Finding(name=what, error=error, allowed=INVARIANT, why="an identity, to round-off")


def circle(case: Case, own: Response, _: Results) -> Finding:
    """A beam rolled up to an arc by a moment: the largest error of the tip's position over the length."""
    # the first term that the strains neglect makes an element's chord, and so the whole circle, too large
    beam, load, kind = case.scene.beams[0], case.scene.loads[0], TSM.element(case.options)
    angle = load.moment * beam.length / beam.EI * own.load_parameter
    half = angle / (2.0 * np.pi)
    exact = np.stack([np.sinc(2.0 * half), np.sin(angle / 2.0) * np.sinc(half)], axis=1)
    error = float(np.hypot(*(own.tips[beam.name] / beam.length - exact).T).max(initial=0.0))
    allowed, why = FLOOR, "accuracy of the integration"
    if isinstance(kind, ClosedForm):
        turns = angle * element_lengths(case.scene.beams[0], case.options.elements)[0]
        term = float((chord_term(turns, kind.order) * np.hypot(*exact.T)).max(initial=0.0))
        allowed, why = FLOOR + NEXT_TERM * term, f"{ordinal(kind.order)} order of the element"
    return Finding(name="circle", error=error, allowed=allowed, why=why)


class Cell(Value):
    """A case at one position of the matrix, the varied quantity, the model and the value, with what must hold of it."""

    axis: str = ""
    row: str
    column: str
    case: Case
    checks: tuple[Check, ...]

    @property
    def cases(self) -> tuple[Case, ...]:
        """The case, and those that it is compared with."""
        return (self.case, *(one.case for one in self.checks if isinstance(one, Against)))

    def also(self, check: Check) -> "Cell":
        """Return the cell with one more check."""
        return replace(self, checks=(*self.checks, check))


class Judgement(NamedTuple):
    """What was found of a cell over the load parameters that were reached, and the line of the table about it."""

    findings: tuple[Finding, ...]
    row: TableRow

    @property
    def sentence(self) -> str:
        """What is wrong, in one line."""
        row = self.row
        place = f"{row['axis']} {row['value']}, {row['label']}: {row['verdict']}: {row['status']}"
        if not self.findings:
            return f"{place}: {row['message']}"
        return f"{place}, error {row['error']:.2g} against {row['against']}, allowed {row['allowed']:.2g} ({row['why']})"


VERDICTS = ("right", "stopped", "withdrawn", "wrong")
"""Verdicts on a cell. The checks of the response refuse an answer that is withdrawn; it counts neither as right nor as stopped."""


def judged(cell: Cell, results: Results) -> Judgement:
    """Return the judgement on `cell` by the `results` of its `cases`; the finding with the largest error over its allowance decides.

    A cell is wrong where an error is above its allowance, also if the solution stopped later, and where the case raised or lost its
    worker. It is withdrawn needlessly where all its errors are within their allowances.
    """
    measured = results[cell.case]
    own = measured.response
    checks = cell.checks if len(own.load_parameter) else ()
    found = [one for check in checks if (one := check(cell.case, own, results)) is not None]
    decisive, holds = max(found, key=lambda one: one.share, default=None), all(one.holds for one in found)
    verdict = "right" if own.completed else "stopped"
    if own.status == CHECK_FAILED:
        verdict = "withdrawn"
    elif own.status in UNSETTLED or not holds:
        verdict = "wrong"
    about = {"error": "error", "allowed": "allowed", "against": "name", "why": "why"}
    row = {
        "axis": cell.axis,
        "model": cell.row,
        "value": cell.column,
        "label": cell.case.label,
        "verdict": verdict,
        "needless": verdict == "withdrawn" and bool(found) and holds,
        "status": own.status,
        "reached": float(max(own.load_parameter, default=0.0)),
        **{column: decisive and getattr(decisive, name) for column, name in about.items()},
        **kept(own, "iterations cutbacks"),
        "seconds": measured.seconds,
        "message": own.message,
    }
    return Judgement(tuple(found), row)
