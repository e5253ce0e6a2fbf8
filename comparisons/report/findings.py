"""The findings of a comparison: a sentence, points and the answer in units, each made from the data."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from math import inf, isfinite, log, nan

import numpy as np

from comparisons.answer import Response
from comparisons.answer.quantities import table_columns
from comparisons.referee import Verdict
from comparisons.report.brief import Brief, at_largest, in_units
from comparisons.suite import Row
from comparisons.suite.budget import TIMES, Budget

BUDGET = "error budget"
"""Key of the error budget among what is left out."""
AGREES = 1e-9
"""Error below which two answers agree."""
ASKED = 0.01
"""The error for which it is said which model is enough."""
MEANINGS = {
    "TSM mesh": "the beam's elements",
    "TSM theory": "the beam's theory",
    "solid beside the rod": "a body dents, warps and contracts, a rod does not",
    "material law": "the solid's stress is not linear in the rod's strain",
    "solid mesh": "the solid's elements",
    "penalty": "the solid's penetration at contacts",
    "load steps": "the number of load parameters",
}
"""What the parts of the error budget are, in a few words."""
LEAST_PART = 0.05
"""Part of the difference of beams and solid, over the largest part, below which it is not named."""
STATES = {
    "-": "Stability is not stated by {}.",
    "in part": "Stability is stated at a part of the load parameters by {}.",
    "no": "Unstable equilibria are on the path of {}.",
}
"""What is said of the runs by their `stable`."""


def findings(
    rows: Sequence[Row],
    reference: str,
    bodies: Row | None,
    budget: Budget | None,
    left_out: Mapping[str, str],
) -> Brief:
    """Return what a comparison found.

    `bodies` is the row of beams with their errors against the solid, if both answered. `left_out` has reasons by the family of a run, or
    by `BUDGET`.
    """
    others = [row for row in rows if isfinite(_worst(row)[0])]
    sentence = _sentence(others, reference, bodies, budget)
    points = [
        _enough(others, reference),
        "" if budget is None else _parts(budget, sentence),
        _causes(others, explained=budget is not None),
        " ".join([*_stopped(rows), *_apart(others, reference), *_left_out(left_out)]),
        " ".join([_certified(rows), *_stability(rows)]),
    ]
    exact = next(row for row in rows if row.label == reference)
    answer, about = list[dict[str, str]](), ""
    if len(exact.response.load_parameter):
        t = float(exact.response.load_parameter[at_largest(exact.response)])
        finest = [bodies] if bodies else [row for row in others if row.case.found.meshed]
        shown = {"beam": finest[-1].response} if finest else {}
        shown |= {row.family: row.response for row in others if row.response.continuum}
        answer = in_units(exact.case.scene, {**shown, reference: exact.response}, t)
        other = [*shown, reference][-1 if len(shown) < 2 else 1]
        beam = f" (beam: {finest[-1].label}; apart: {other} less beam)" if finest else ""
        about = f"The answer at load parameter {t:.4g}, where the force is largest{beam}:"
    return Brief(sentence, list(filter(None, points)), answer, about)


def _sentence(others: Sequence[Row], reference: str, bodies: Row | None, budget: Budget | None) -> str:
    """Return how far beams and solid are apart, why, and what is enough for `ASKED`."""
    near = (row for row in _near(others) if not row.response.continuum)
    beams = [row for row in near if row.case.found.meshed]
    least = min(beams, key=lambda row: row.response.unknowns, default=None)
    enough = f"for {_size(ASKED)} of the {reference} no beam here is enough"
    if least is not None:
        enough = f"for {_size(ASKED)} a beam is enough: {least.label} ({_size(_worst(least)[0])} off the {reference})"
    if bodies is None or not isfinite(_worst(bodies)[0]):
        return f"{enough[0].upper()}{enough[1:]}."
    apart, quantity = _worst(bodies)
    compared = next(one for one in table_columns().values() if one.called(bodies.case.scene) == quantity)
    over = "its largest value" if compared.over == "largest" else compared.relative_to
    said = f"Beam and solid differ in the {quantity} by {_size(apart)} of {over}"
    if budget is not None and apart > AGREES:
        measured, _, parts = _largest(budget)
        most = next(iter(parts))
        # the parts are those of the quantity that differs most in the budget, which may be another one
        same = _named(measured).startswith(quantity)
        if same and 2.0 * abs(parts[most]) > sum(map(abs, parts.values())):
            said += f", most of it by the {most} ({MEANINGS[most]})"
    return f"{said}; {enough if apart <= ASKED else f'for {_size(ASKED)} of the solid a beam is not enough'}."


def _near(rows: Iterable[Row]) -> list[Row]:
    """Return the completed runs with errors up to `ASKED`."""
    return [row for row in rows if row.response.completed and _worst(row)[0] <= ASKED]


def _enough(others: Sequence[Row], reference: str) -> str:
    """Return which runs are within `ASKED` of the reference, of each family the coarsest, and which families are not."""
    good, beyond = list[str](), list[str]()
    for family, own in groupby(others, key=lambda row: row.family):
        rows = sorted(own, key=lambda row: row.resolution)
        if within := _near(rows):
            count = within[0].resolution
            elements = f" with {count:.0f} element{'' if count == 1 else 's'}" if isfinite(count) else ""
            good.append(f"{family}{elements} ({_size(_worst(within[0])[0])})")
        else:
            beyond.append(f"{family} ({_size(_worst(rows[-1])[0])})")
    said = f"Within {_size(ASKED)} of the {reference}: {', '.join(good) or 'none'}."
    return f"{said} Beyond: {', '.join(beyond)}." if beyond else said


def _apart(others: Sequence[Row], reference: str) -> Iterator[str]:
    open_here = [row.label for row in others if inf in (row.errors or {})["path"].values()]
    if open_here:
        yield f"{_listed(open_here)} and the {reference} disagree on whether a contact is closed."


def _causes(others: Sequence[Row], *, explained: bool) -> str:
    """Return why the families are off, and how fast their errors fall; of a continuum it is `explained` elsewhere."""
    said = []
    for family, own in groupby(others, key=lambda row: row.family):
        rows = list(own)
        if max(_worst(row)[0] for row in rows) < AGREES:
            continue
        cause = "" if explained and rows[0].response.continuum else rows[0].cause
        falls = _falling(rows)
        if cause or falls:
            said.append(f"{family}, {cause or 'discretisation'} {falls}".rstrip())
    return f"Why models are off: {'; '.join(said)}." if said else ""


def _worst(row: Row) -> tuple[float, str]:
    """Return the largest finite error over the path, and its quantity; nan without one."""
    compared = {
        name: one.called(row.case.scene) for name, one in table_columns().items() if name != "friction"
    }
    found = ((row.error("path", name), words) for name, words in compared.items())
    return max((one for one in found if isfinite(one[0])), default=(nan, ""))


def _falling(rows: list[Row]) -> str:
    """Return the measured order of runs with several resolutions."""
    first, last = (choose(rows, key=lambda row: row.resolution) for choose in (min, max))
    coarse, fine = _worst(first)[0], _worst(last)[0]
    if not last.resolution > first.resolution or fine < AGREES or coarse <= fine:
        return ""
    order = log(coarse / fine) / log(last.resolution / first.resolution)
    return f"(falls with the power {order:.1f} of the length of the elements)"


def _largest(budget: Budget) -> tuple[str, int, dict[str, float]]:
    """Return the quantity and the number of the load parameter of the largest difference, and its parts, the largest first."""
    sizes = np.nan_to_num([np.abs(total) for total in budget.total.values()])
    number, k = map(int, np.unravel_index(np.argmax(sizes), sizes.shape))
    quantity = list(budget.total)[number]
    parts = ((name, float(values[k])) for name, values in budget.parts[quantity].items())
    return quantity, k, dict(sorted(parts, key=lambda one: -abs(one[1])))


def _parts(budget: Budget, sentence: str) -> str:
    """Return what makes the largest difference between beams and solid, and what the parts are that the `sentence` does not explain."""
    quantity, k, parts = _largest(budget)
    total = float(budget.total[quantity][k])
    if not abs(total) >= AGREES:
        return f"In the error budget, beams and solid agree to {_size(abs(total))}."
    greatest = max(map(abs, parts.values()))
    meanings = {name: f" ({words})" for name, words in MEANINGS.items() if words not in sentence}
    shown = (name for name, part in parts.items() if abs(part) > LEAST_PART * greatest)
    words = _listed(f"{_size(parts[name])} {name}{meanings.get(name, '')}" for name in shown)
    return f"In the error budget, beams and solid differ most in the {_named(quantity)}, at load parameter {TIMES[k]:g}: by {_size(total)} of its value there, made of {words}."


def _named(quantity: str) -> str:
    """Return a quantity of the budget in the words of a page."""
    kind, _, where = quantity.partition(" ")
    return f"{kind.replace('_', ' ').replace('clamp', 'support')} {where}".strip()


def _stopped(rows: Sequence[Row]) -> Iterator[str]:
    stopped = [row for row in rows if not row.response.completed]
    # the message of the first run of a family stands for those that differ from it in numbers only
    for label, response in _together(stopped, lambda row: re.sub(r"[\d.]+", "", row.response.message)):
        reached = float(response.load_parameter.max(initial=0.0))
        told = f"; errors are those up to load parameter {reached:.4g}" if reached else ""
        yield f"{label} did not complete ({response.ended}){told}."


def _together(rows: Iterable[Row], key: Callable[[Row], str]) -> Iterator[tuple[str, Response]]:
    """Yield neighbours of one family with the same key as one label, and the first response."""
    for _, same in groupby(rows, key=lambda row: (row.family, row.response.status, key(row))):
        first, *more = same
        yield f"{first.family} ({len(more) + 1} runs)" if more else first.label, first.response


def _left_out(left_out: Mapping[str, str]) -> Iterator[str]:
    for reason in dict.fromkeys(reason for name, reason in left_out.items() if name != BUDGET):
        yield f"Not stated by {_listed(name for name in left_out if left_out[name] == reason)}: {reason}."
    if BUDGET in left_out:
        yield f"There is no error budget: {left_out[BUDGET]}."


def _stability(rows: Sequence[Row]) -> Iterator[str]:
    """Yield what is not stable; a family that states an index in one run is not silent."""
    said = {row.family: "" for row in rows}
    for state in ("-", "yes", "in part", "no"):
        said |= {row.family: state for row in rows if row.stable == state}
    for state, words in STATES.items():
        if families := [family for family in said if said[family] == state]:
            yield words.format(_listed(families))


def _certified(rows: Sequence[Row]) -> str:
    doubtful = [row for row in rows if _judged(row.response)]
    together = _together(doubtful, lambda row: _judged(row.response))
    rest = [f"; {label} was {_judged(one)}" for label, one in together]
    count = f"{len(rows) - len(doubtful)} of {len(rows)} answers" if doubtful else "every answer"
    return f"The referee, an independent solver, certified {count}{''.join(rest)}."


def _judged(response: Response) -> str:
    """Return what the referee said of an answer that it did not certify; empty for one that it did."""
    found = response.certificate
    if found is None:
        return "not judged"
    judged = "not judged" if found.verdict is Verdict.NOT_JUDGED else "refused"
    return "" if found.certified else f"{judged} ({found.reason})"


def _size(value: float) -> str:
    """Return a relative error in percent, by one digit where it is small.

    >>> _size(0.0041), _size(-3e-12)
    ('0.41 %', '-3e-10 %')
    """
    return f"{100.0 * value:{'.2g' if abs(value) >= 1e-6 else '.0e'}} %"


def _listed(names: Iterable[str]) -> str:
    """Return names as a list in a sentence.

    >>> _listed(["a", "b", "c"])
    'a, b and c'
    """
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
