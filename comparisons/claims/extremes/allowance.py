"""The allowed error of a model in a cell, fixed before any run."""

from comparisons.cases.case import Case
from comparisons.claims.claim import Allowance
from comparisons.models import MODELS
from comparisons.models.theory import Bending

LARGEST = 0.2
"""Largest allowed error for any model; an answer with a larger error should have stopped."""


def allowance(case: Case, bent: Bending) -> Allowance:
    """Return the error allowed to `case` against the Reissner rod that bends as `bent` says, `LARGEST` at most.

    A model of another rod, as the elastica, is allowed a larger error, because it does not approximate this rod.
    """
    model = MODELS[case.model]
    parts = model.error_parts(case.scene, case.options, bent)
    largest = max(parts, key=lambda why: parts[why])
    error = sum(parts.values())
    if model.rod and not error <= LARGEST:
        return Allowance(error=LARGEST, why=f"more is wrong, although theory allows it: {largest}")
    return Allowance(error=error, why=largest)
