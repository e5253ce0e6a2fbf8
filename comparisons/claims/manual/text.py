"""The manual as Markdown, as nested numbers and as JUnit checks."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from comparisons.claims.junit import JUnitCase
from comparisons.claims.manual.judge import failure
from comparisons.claims.manual.record import Case, Run
from comparisons.version import versions

HEAD = """# Verification manual

{cases} problems with exact answers, put to every model that can state them: {passed} of {runs} answers within their tolerances.
An error is that of the worst quantity, relative to its exact value, or to the length where it is a position. `crossval manual` writes
this page, its pictures and `manual.json`; it took {seconds:.0f} s with {versions}.

"""
RULE = "|---|---|---|---|---|---|---|---|"


def markdown(cases: Sequence[Case]) -> str:
    """Return the manual as Markdown: a table of all answers, then a section for each case."""
    runs = [run for case in cases for run in case.runs]
    head = HEAD.format(
        cases=len(cases),
        passed=sum(run.passed for run in runs),
        runs=len(runs),
        seconds=sum(run.seconds for run in runs),
        versions=", ".join(f"{name} {number}" for name, number in versions().items()),
    )
    return head + "\n".join([*_overview(cases), *(line for case in cases for line in _section(case)), ""])


def _overview(cases: Sequence[Case]) -> Iterator[str]:
    yield "| case | model | quantity of the largest error | exact | ours | error | tolerance | verdict |"
    yield RULE
    for case in cases:
        for run in case.runs:
            k = run.worst
            cells = [
                f"[{case.title}](#{case.name})",
                run.label,
                case.quantities[k].name,
                f"{case.quantities[k].exact:.9g}",
                run.stopped or f"{run.values[k]:.9g}",
                f"{run.errors[k]:.1e}",
                f"{run.tolerance:.2g}",
                _verdict(run),
            ]
            yield _row(cells)
    yield ""


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _verdict(run: Run) -> str:
    return "passed" if run.passed else "**FAILED**"


def _section(case: Case) -> Iterator[str]:
    yield f'<a id="{case.name}"></a>'
    yield ""
    yield f"## {case.title}"
    yield ""
    yield case.statement
    yield ""
    yield f"Exact value: {case.source}."
    yield ""
    yield f"![{case.title}]({case.picture})"
    yield ""
    yield _row(["quantity", "exact", *(run.label for run in case.runs)])
    yield "|" + "---|" * (2 + len(case.runs))
    for k, quantity in enumerate(case.quantities):
        ours = (f"{run.values[k]:.9g} ({run.errors[k]:.1e})" for run in case.runs)
        yield _row([quantity.name, f"{quantity.exact:.12g}", *ours])
    yield _row(["tolerance", "", *(f"{run.tolerance:.2g}" for run in case.runs)])
    yield _row(["verdict", "", *(_verdict(run) for run in case.runs)])
    yield _row(["seconds", "", *(f"{run.seconds:.2f}" for run in case.runs)])
    yield ""
    for run in case.runs:
        yield f"- {run.label}: {run.reason}." + (f" Stopped: {run.stopped}." if run.stopped else "")
    yield ""


def numbers(cases: Sequence[Case]) -> dict[str, Any]:
    """Return everything but the pictures as nested numbers."""
    return {
        "passed": all(case.passed for case in cases),
        "cases": [
            {
                **asdict(case),
                "passed": case.passed,
                "seconds": case.seconds,
                "runs": [{**asdict(run), "passed": run.passed} for run in case.runs],
            }
            for case in cases
        ],
    }


def junit_cases(cases: Sequence[Case]) -> Iterator[JUnitCase]:
    """Yield a check for every case and model."""
    for case in cases:
        for run in case.runs:
            yield JUnitCase(
                classname=f"manual.{case.name}",
                name=run.label,
                seconds=run.seconds,
                failure=failure(case, run),
            )
