"""The manual as Markdown, as nested numbers and as JUnit checks."""

from collections.abc import Iterator, Sequence
from typing import Any

from comparisons.claims.claim import Judgement
from comparisons.claims.junit import JUnitCase
from comparisons.claims.manual.problem import Case
from comparisons.version import versions

HEAD = """# Verification manual

{cases} problems with exact answers, put to every model that can state them: {passed} of {runs} answers within their tolerances.
An error is that of the worst quantity, relative to its exact value, or to the length where it is a position. `crossval run manual` writes
this page, its pictures and `manual.json`; it took {seconds:.0f} s with {versions}.

"""
SECTION = """<a id="{problem.name}"></a>

## {problem.title}

{problem.statement}

Purpose: {problem.purpose}

Exact value: {problem.source}.

![{problem.title}]({picture})

"""
COLUMNS = (
    "case",
    "model",
    "quantity of the largest error",
    "exact",
    "computed",
    "error",
    "tolerance",
    "verdict",
)
STATED = ("name", "title", "purpose", "statement", "source", "uncertainty", "quantities")


def markdown(cases: Sequence[Case]) -> str:
    """Return the manual as Markdown: a table of all answers, then a section for each case."""
    judgements = [item for case in cases for item in case.judgements]
    head = HEAD.format(
        cases=len(cases),
        passed=sum(item.passed for item in judgements),
        runs=len(judgements),
        seconds=sum(item.seconds for item in judgements),
        versions=", ".join(f"{name} {number}" for name, number in versions().items()),
    )
    answers = [_answer(case, item) for case in cases for item in case.judgements]
    return head + table([COLUMNS, *answers]) + "\n" + "\n".join(map(_section, cases))


def table(rows: Sequence[Sequence[str]]) -> str:
    """Return rows, the header first, as a table in Markdown."""
    lines = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in rows]
    return "".join([lines[0], "|" + "---|" * len(rows[0]) + "\n", *lines[1:]])


def _answer(case: Case, item: Judgement) -> list[str]:
    """The answer of a model: its quantity of the largest error."""
    k = item.worst
    quantity = case.problem.quantities[k]
    return [
        f"[{case.problem.title}](#{case.problem.name})",
        item.claim.name,
        quantity.name,
        f"{quantity.exact:.9g}",
        item.stopped or f"{item.values[k]:.9g}",
        f"{item.findings[k].error:.1e}",
        f"{item.claim.allowance.error:.2g}",
        _verdict(item),
    ]


def _verdict(item: Judgement) -> str:
    return "passed" if item.passed else "**FAILED**"


def _section(case: Case) -> str:
    problem, items = case.problem, case.judgements
    rows = [["quantity", "exact", *(item.claim.name for item in items)]]
    for k, quantity in enumerate(problem.quantities):
        computed = (f"{item.values[k]:.9g} ({item.findings[k].error:.1e})" for item in items)
        rows.append([quantity.name, f"{quantity.exact:.12g}", *computed])
    rows += [
        ["tolerance", "", *(f"{item.claim.allowance.error:.2g}" for item in items)],
        ["verdict", "", *map(_verdict, items)],
        ["seconds", "", *(f"{item.seconds:.2f}" for item in items)],
    ]
    reasons = (
        f"- {item.claim.name}: {item.claim.allowance.why}.{f' Stopped: {item.stopped}.' * bool(item.stopped)}\n"
        for item in items
    )
    return SECTION.format(problem=problem, picture=case.picture) + table(rows) + "\n" + "".join(reasons)


def numbers(cases: Sequence[Case]) -> dict[str, Any]:
    """Return everything but the pictures as nested numbers."""
    return {"passed": all(case.passed for case in cases), "cases": [_case(case) for case in cases]}


def _case(case: Case) -> dict[str, Any]:
    runs = [
        {
            "model": trial.model,
            "setting": trial.setting,
            "tolerance": trial.allowance.error,
            "reason": trial.allowance.why,
            "values": item.values,
            "errors": [finding.error for finding in item.findings],
            "seconds": item.seconds,
            "stopped": item.stopped,
            "passed": item.passed,
        }
        for trial, item in zip(case.problem.trials, case.judgements, strict=True)
    ]
    stated = {name: getattr(case.problem, name) for name in STATED}
    found = {name: getattr(case, name) for name in ("picture", "passed", "seconds")}
    return {**stated, "runs": runs, **found}


def junit_cases(cases: Sequence[Case]) -> Iterator[JUnitCase]:
    """Yield a check for every case and model."""
    for case in cases:
        yield from (item.junit(f"manual.{case.problem.name}") for item in case.judgements)
