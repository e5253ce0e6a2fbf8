"""A problem put to its models: a claim for each of them."""

from collections.abc import Sequence

from comparisons.claims.claim import Claim, judge
from comparisons.claims.manual.record import Case, Curve, Problem, Trial


def answered(problem: Problem, picture: str) -> tuple[Case, tuple[Curve, ...]]:
    """Put a problem to all its models.

    Parameters
    ----------
    problem : Problem
        What is solved.
    picture : str
        Name of the picture's file.

    Returns
    -------
    case : Case
        With a judgement for every trial, in order.
    curves : tuple of Curve
        What the models add to the picture.
    """
    curves: list[Curve] = []
    judgements = tuple(judge(_claim(problem, trial, curves)) for trial in problem.trials)
    return Case(problem=problem, judgements=judgements, picture=picture), tuple(curves)


def _claim(problem: Problem, trial: Trial, curves: list[Curve]) -> Claim:
    """Return the claim that a model answers a problem; measuring it appends to the curves."""

    def measure() -> Sequence[float]:
        measured = trial.measure(problem.scene)
        curves.extend(measured.curves)
        return measured.values

    return Claim(
        name=trial.label,
        statement=problem.statement,
        source=problem.source,
        quantities=problem.quantities,
        allowance=trial.allowance,
        measure=measure,
    )
