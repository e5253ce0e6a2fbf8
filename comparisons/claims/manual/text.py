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
RULE = "|---|---|---|---|---|---|---|---|"


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
    return head + "\n".join([*_overview(cases), *(line for case in cases for line in _section(case)), ""])


def _overview(cases: Sequence[Case]) -> Iterator[str]:
    yield "| case | model | quantity of the largest error | exact | computed | error | tolerance | verdict |"
    yield RULE
    for case in cases:
        for item in case.judgements:
            k = item.worst
            quantity = case.problem.quantities[k]
            cells = [
                f"[{case.problem.title}](#{case.problem.name})",
                item.claim.name,
                quantity.name,
                f"{quantity.exact:.9g}",
                item.stopped or f"{item.values[k]:.9g}",
                f"{item.findings[k].error:.1e}",
                f"{item.claim.allowance.error:.2g}",
                _verdict(item),
            ]
            yield _row(cells)
    yield ""


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _verdict(item: Judgement) -> str:
    return "passed" if item.passed else "**FAILED**"


def _section(case: Case) -> Iterator[str]:
    problem, items = case.problem, case.judgements
    yield f'<a id="{problem.name}"></a>'
    yield ""
    yield f"## {problem.title}"
    yield ""
    yield problem.statement
    yield ""
    yield f"Purpose: {problem.purpose}"
    yield ""
    yield f"Exact value: {problem.source}."
    yield ""
    yield f"![{problem.title}]({case.picture})"
    yield ""
    yield _row(["quantity", "exact", *(item.claim.name for item in items)])
    yield "|" + "---|" * (2 + len(items))
    for k, quantity in enumerate(problem.quantities):
        computed = (f"{item.values[k]:.9g} ({item.findings[k].error:.1e})" for item in items)
        yield _row([quantity.name, f"{quantity.exact:.12g}", *computed])
    yield _row(["tolerance", "", *(f"{item.claim.allowance.error:.2g}" for item in items)])
    yield _row(["verdict", "", *(_verdict(item) for item in items)])
    yield _row(["seconds", "", *(f"{item.seconds:.2f}" for item in items)])
    yield ""
    for item in items:
        stopped = f" Stopped: {item.stopped}." if item.stopped else ""
        yield f"- {item.claim.name}: {item.claim.allowance.why}.{stopped}"
    yield ""


def numbers(cases: Sequence[Case]) -> dict[str, Any]:
    """Return everything but the pictures as nested numbers."""
    return {"passed": all(case.passed for case in cases), "cases": [_case(case) for case in cases]}


def _case(case: Case) -> dict[str, Any]:
    problem = case.problem
    return {
        **{
            name: getattr(problem, name)
            for name in ("name", "title", "purpose", "statement", "source", "uncertainty", "quantities")
        },
        "runs": [
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
            for trial, item in zip(problem.trials, case.judgements, strict=True)
        ],
        "picture": case.picture,
        "passed": case.passed,
        "seconds": case.seconds,
    }


def junit_cases(cases: Sequence[Case]) -> Iterator[JUnitCase]:
    """Yield a check for every case and model."""
    for case in cases:
        yield from (item.junit(f"manual.{case.problem.name}") for item in case.judgements)
