"""A problem put to its models, and their answers judged."""

from time import perf_counter

import numpy as np

from comparisons.claims.manual.record import Answer, Case, Curve, Problem, Run, StoppedError, Trial


def judge(problem: Problem, picture: str) -> tuple[Case, tuple[Curve, ...]]:
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
        With a run for every trial, in order.
    curves : tuple of Curve
        What the models add to the picture.
    """
    runs: list[Run] = []
    curves: list[Curve] = []
    for trial in problem.trials:
        run, answer = _run(problem, trial)
        runs.append(run)
        curves += answer.curves
    case = Case(
        name=problem.name,
        title=problem.title,
        statement=problem.statement,
        source=problem.source,
        quantities=problem.quantities,
        runs=tuple(runs),
        picture=picture,
    )
    return case, tuple(curves)


def _run(problem: Problem, trial: Trial) -> tuple[Run, Answer]:
    stopped, began = "", perf_counter()
    try:
        answer = trial.measure()
    except StoppedError as error:
        stopped, answer = str(error), Answer(values=(np.nan,) * len(problem.quantities))
    seconds = perf_counter() - began
    errors = tuple(q.error(value) for q, value in zip(problem.quantities, answer.values, strict=True))
    run = Run(
        model=trial.model,
        setting=trial.setting,
        tolerance=trial.tolerance,
        reason=trial.reason,
        values=answer.values,
        errors=errors,
        seconds=seconds,
        stopped=stopped,
    )
    return run, answer


def failure(case: Case, run: Run) -> str | None:
    """Return why a run failed, with its numbers; None if it passed."""
    if run.passed:
        return None
    if run.stopped:
        return run.stopped
    quantity, k = case.quantities[run.worst], run.worst
    return f"{quantity.name}: {run.values[k]:.10g}, exact {quantity.exact:.10g}, error {run.errors[k]:.2g} > {run.tolerance:.2g}"
