"""The findings of a comparison in sentences, each made from the data."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from math import inf, isfinite, log, nan

import numpy as np

from comparisons.answer.quantities import table_columns
from comparisons.models import find
from comparisons.referee import Verdict
from comparisons.scene import Scene
from comparisons.suite import Row
from comparisons.suite.budget import TIMES, Budget

BUDGET = "error budget"
"""Key of the error budget among what is left out."""
AGREES = 1e-9
"""Error below which two answers agree."""
LEAST_PART = 0.05
"""Part of the difference of beams and solid, over the largest part, below which it is not named."""
STATES = {
    "-": "Stability is not stated by {}.",
    "in part": "Stability is stated at a part of the load parameters by {}.",
    "no": "Unstable equilibria are on the path of {}.",
}
"""What is said of the runs by their `stable`."""


def findings(
    scene: Scene,
    rows: Sequence[Row],
    reference: str,
    budget: Budget | None,
    left_out: Mapping[str, str],
) -> list[str]:
    """Return what a comparison found; `left_out` has reasons by the family of a run, or by `BUDGET`."""
    others = [row for row in rows if row.label != reference]
    found = [_compared(scene, rows, others, reference)]
    for family, own in groupby(others, key=lambda row: row.family):
        found += _off(family, list(own), scene, budget, reference)
    return [*found, *_stopped(rows), *_left_out(left_out), *_stability(rows), _certified(rows)]


def _compared(scene: Scene, rows: Sequence[Row], others: Sequence[Row], reference: str) -> str:
    models = dict.fromkeys(find(row.response.model).label for row in others)
    last = max(float(row.response.load_parameter.max(initial=0.0)) for row in rows)
    runs = "1 run of {} is" if len(others) == 1 else f"{len(others)} runs of {{}} are"
    return (
        f"{runs.format(_listed(models))} compared with the {reference} on {scene.name} at "
        f"{len(scene.times)} load parameters, up to {last:.4g}. Errors of forces and moments are relative to the largest value, "
        "errors of positions to the length."
    )


def _off(family: str, rows: list[Row], scene: Scene, budget: Budget | None, reference: str) -> Iterator[str]:
    """Yield how far the runs of a family are off, and why."""
    known = [row for row in rows if isfinite(_worst(row, scene)[0])]
    if not known:
        return
    name = f"The {family}" if family[0].islower() else family
    explained = budget is not None and find(known[0].response.model).continuum
    if max(_worst(row, scene)[0] for row in known) < AGREES:
        yield f"{name} agrees with the {reference} to {_stated(known, scene)}."
    else:
        cause = "" if explained else next((row.cause for row in known if row.cause), "")
        because = f". Theory expects most of it from this cause: {cause}" if cause else ""
        yield f"{name} is off by at most {_stated(known, scene)}{_falling(known, scene)}{because}."
    if explained and budget is not None:
        yield _parts(budget)
    for row in known:
        if inf in (row.errors or {})["path"].values():
            yield f"{row.label} and the {reference} disagree on whether a contact is closed."


def _stated(rows: Sequence[Row], scene: Scene) -> str:
    """Return the errors of runs that differ in resolution; a quantity is named where it changes."""
    words, before = [], ""
    for row in rows:
        error, quantity = _worst(row, scene)
        named = "" if quantity == before else f" ({quantity})"
        elements = f" with {row.resolution:.0f} element{'' if row.resolution == 1 else 's'}"
        words.append(f"{_size(error)}{named}{elements if isfinite(row.resolution) else ''}")
        before = quantity
    return _listed(words)


def _worst(row: Row, scene: Scene) -> tuple[float, str]:
    """Return the largest finite error over the path, and its quantity; nan without one."""
    names = {name: one.called(scene) for name, one in table_columns().items() if name != "friction"}
    path = {} if row.errors is None else row.errors["path"]
    found = [(path[name], words) for name, words in names.items() if isfinite(path.get(name, inf))]
    return max(found, default=(nan, ""))


def _falling(rows: list[Row], scene: Scene) -> str:
    """Return the measured order of runs with several resolutions."""
    first, last = (choose(rows, key=lambda row: row.resolution) for choose in (min, max))
    coarse, fine = _worst(first, scene)[0], _worst(last, scene)[0]
    if not last.resolution > first.resolution or fine < AGREES or coarse <= fine:
        return ""
    order = log(coarse / fine) / log(last.resolution / first.resolution)
    return f"; the error falls with the power {order:.1f} of the length of the elements"


def _parts(budget: Budget) -> str:
    """Return what makes the largest difference between beams and solid, of a force where there is one."""
    names = [name for name in budget.total if "force" in name] or list(budget.total)
    sizes = np.nan_to_num([np.abs(budget.total[name]) for name in names])
    number, k = np.unravel_index(np.argmax(sizes), sizes.shape)
    quantity = names[number]
    if sizes.max() < AGREES:
        return f"In the error budget, beams and solid agree to {_size(float(sizes.max()))}."
    parts = {name: float(values[k]) for name, values in budget.parts[quantity].items()}
    greatest = max(map(abs, parts.values()))
    shown = sorted((n for n in parts if abs(parts[n]) > LEAST_PART * greatest), key=lambda n: -abs(parts[n]))
    words = _listed(f"{_size(parts[name])} {name}" for name in shown)
    kind, _, column = quantity.partition(" ")
    name = f"{kind.replace('_', ' ')} {column}".strip()
    return (
        f"In the error budget, beams and solid differ most in the {name} at load parameter {TIMES[k]:g}: by "
        f"{_size(float(budget.total[quantity][k]))}, made of {words}."
    )


def _stopped(rows: Sequence[Row]) -> Iterator[str]:
    for response, label in ((row.response, row.label) for row in rows):
        if not response.completed:
            reached = float(response.load_parameter.max(initial=0.0))
            why = f"{response.status}: {response.message}"
            yield f"{label} did not complete ({why}); its errors are those up to load parameter {reached:.4g}."


def _left_out(left_out: Mapping[str, str]) -> Iterator[str]:
    for reason in dict.fromkeys(reason for name, reason in left_out.items() if name != BUDGET):
        yield f"Not stated by {_listed(name for name in left_out if left_out[name] == reason)}: {reason}."
    if BUDGET in left_out:
        yield f"There is no error budget: {left_out[BUDGET]}."


def _stability(rows: Sequence[Row]) -> Iterator[str]:
    """Yield what is not stable; a family that states an index in one run is not silent."""
    states = {
        state: dict.fromkeys(row.family for row in rows if row.stable == state) for state in (*STATES, "yes")
    }
    spoken = {*states["in part"], *states["no"], *states["yes"]}
    left = {"-": spoken, "in part": {*states["no"]}, "no": set[str]()}
    for state, words in STATES.items():
        families = [family for family in states[state] if family not in left[state]]
        if families:
            yield words.format(_listed(families))


def _certified(rows: Sequence[Row]) -> str:
    rest = []
    for row in rows:
        found = row.response.certificate
        if found is None:
            rest.append(f"{row.label} was not judged")
        elif not found.certified:
            said = "not judged" if found.verdict is Verdict.NOT_JUDGED else "refused"
            rest.append(f"{row.label} was {said} ({found.reason})")
    if not rest:
        return "The referee certified every answer."
    return f"The referee certified {len(rows) - len(rest)} of {len(rows)} answers; {'; '.join(rest)}."


def _size(value: float) -> str:
    """Return a relative error in percent, or as a power of ten where it is small.

    >>> _size(0.0041), _size(-3e-12)
    ('0.41 %', '-3e-12')
    """
    return f"{100.0 * value:.2g} %" if abs(value) >= 1e-6 else f"{value:.0e}"


def _listed(names: Iterable[str]) -> str:
    """Return names as a list in a sentence.

    >>> _listed(["a", "b", "c"])
    'a, b and c'
    """
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
