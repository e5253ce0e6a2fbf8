"""Rows: cases with their answers, their costs, and their errors against a reference."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import nan

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement
from comparisons.errors import Errors, error_histories, largest
from comparisons.response import Response
from comparisons.scene import Scene


@dataclass(frozen=True, kw_only=True, eq=False)
class Row:
    """A case with its answer, its cost and its errors by scope and quantity.

    `errors` are against the reference, which itself has none; `own_errors` are against what the model converges to, where that is known.
    `name` is the label of the run, by default that of the case. `cause` is the largest part of the error that theory allows the model,
    empty where theory has no estimate for the scene.
    """

    case: Case
    measured: Measurement
    errors: Errors | None = None
    own_errors: Errors | None = None
    name: str = ""
    cause: str = ""

    @property
    def response(self) -> Response:
        """The answer."""
        return self.measured.response

    @property
    def label(self) -> str:
        """Label of the run."""
        return self.name or self.case.label

    @property
    def family(self) -> str:
        """What the runs that differ in resolution only share."""
        return self.case.family

    @property
    def resolution(self) -> float:
        """Number of elements along a beam; nan without a mesh, or where the scene gives the number."""
        return self.case.resolution

    @property
    def outcome(self) -> str:
        """``certified``, ``wrong`` for a refused answer that the program reported as a success, or the status of a stop."""
        if self.measured.wrong:
            return "wrong"
        if not self.response.completed:
            return self.response.status
        return self.measured.verdict.lower().replace("_", " ") or "no verdict"

    def error(self, scope: str, quantity: str, *, own: bool = False) -> float:
        """Return an error against the reference, or against what the model converges to; nan where it is not known."""
        errors = self.own_errors if own else self.errors
        return nan if errors is None else errors[scope][quantity]

    def spent(self, cost: str) -> float:
        """Return the ``seconds``, the ``iterations`` or the ``unknowns``."""
        return float(getattr(self.measured if cost == "seconds" else self.response, cost))

    def cost(self) -> dict[str, float]:
        """Return the columns of all costs."""
        own = {name: getattr(self.response, name) for name in ("iterations", "cutbacks", "unknowns")}
        return own | {name: getattr(self.measured, name) for name in ("seconds", "repeats", "peak_memory")}


def reached_errors(
    response: Response, reference: Response, scene: Scene, quantities: Iterable[str]
) -> Errors:
    """Return the errors as far as both responses came; those at the reference's end are nan for a response that does not reach it."""
    shared, found = error_histories(response, reference, scene, quantities=quantities)
    at_end = shared == reference.load_parameter[-1:]
    return {
        "end": {name: largest(values[at_end]) for name, values in found.items()},
        "path": {name: largest(values) for name, values in found.items()},
    }
