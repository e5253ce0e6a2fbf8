"""Run the matrix, judge every cell, write the maps: one table for each axis, models down, values across."""

import math
from collections import Counter
from collections.abc import Sequence
from html import escape
from pathlib import Path
from shutil import rmtree

import numpy as np

from comparisons.output import Row, write_numbers, write_rows
from comparisons.report.pages import Section, write_page
from comparisons.suite.case import Case
from comparisons.suite.run import Progress
from comparisons.suite.run import run as run_cases
from comparisons.suite.workers import Workers
from comparisons.suites.extremes.axes import AXES, matrix
from comparisons.suites.extremes.cell import Judgement, Verdict, judged

MARKS = {Verdict.RIGHT: "", Verdict.STOPPED: "■ ", Verdict.WITHDRAWN: "□ ", Verdict.WRONG: "✗ "}
"""Marks that distinguish the verdicts without colour."""
STYLE = Path(__file__).with_name("maps.css")
LEGEND = """A cell shows the largest error of force, arc position, moment and tip over all load parameters reached: of the comparisons that
must hold, the one that comes nearest to what is allowed. A cell that stopped shows the name of the reason, one that is withdrawn by its own
checks the error that it would have had. Hover over it to see what it
is compared with, what is allowed and why."""
POWERS = (-14.0, -10.0, -6.0, -3.0, 0.0)
SHADES = ((8, 33, 107, 189, 255), (48, 113, 174, 215, 247), (107, 181, 214, 231, 188))
"""Red, green and blue by the error's decimal logarithm: blue for small errors to pale yellow, safe for the colour-blind."""


def sections(judgements: Sequence[Judgement]) -> list[Section]:
    """Return the key and one map for each axis that has cells."""
    style = STYLE.read_text(encoding="utf-8")
    parts = [Section(title="How to read the maps", html=f"<style>{style}</style><p>{LEGEND}</p>{_key()}")]
    for name, axis in AXES.items():
        own = [item for item in judgements if item.cell.axis == name]
        if not own:
            continue
        at = {(item.cell.row, item.cell.column): item for item in own}
        rows, columns = (list(dict.fromkeys(names)) for names in zip(*at, strict=True))
        head = "".join(f'<th scope="col">{escape(column)}</th>' for column in ("", *columns))
        body = "\n".join(
            f'<tr><th scope="row">{escape(row)}</th>{"".join(_cell(at.get((row, column))) for column in columns)}</tr>'
            for row in rows
        )
        table = f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>"
        html = f'<p>{escape(axis.scene)}. {counted(own)}.</p><div class="map">{table}</div>'
        parts.append(Section(title=axis.title, html=html))
    return parts


def counted(judgements: Sequence[Judgement]) -> str:
    """Return the number of cells, their number by verdict, and the number of withdrawn cells that are right."""
    number = Counter(item.verdict for item in judgements)
    needless = sum(item.needless for item in judgements)
    counts = {verdict: f"{number[verdict]} {verdict}" for verdict in Verdict}
    counts[Verdict.WITHDRAWN] += f" ({needless} needlessly)" if needless else ""
    return f"{len(judgements)} cells: " + ", ".join(counts.values())


def _key() -> str:
    shades = "".join(_shaded(10.0**power) for power in (-14, -10, -6, -3, -1))
    words = {
        Verdict.STOPPED: "stopped by name", Verdict.WITHDRAWN: "withdrawn by its own checks", Verdict.WRONG: "wrong",
    }  # fmt: skip
    marks = "".join(f'<td class="{verdict}">{MARKS[verdict]}{text}</td>' for verdict, text in words.items())
    return f'<table class="key"><tr><th>completed and right, error</th>{shades}{marks}</tr></table>'


def _cell(item: Judgement | None) -> str:
    if item is None:
        return '<td class="none">·</td>'
    decisive, about = item.decisive, f' class="{item.verdict}" title="{escape(_details(item))}"'
    if item.verdict is Verdict.RIGHT and decisive:
        return _shaded(decisive.error, about)
    named = item.verdict is Verdict.STOPPED or decisive is None
    shown = item.own.response.status if named or decisive is None else _number(decisive.error)
    return f"<td{about}>{MARKS[item.verdict]}{escape(shown)}</td>"


def _details(item: Judgement) -> str:
    own = item.own.response
    found = (
        f"against {finding.name}: error {_number(finding.error)}, allowed {_number(finding.allowed)} ({finding.why})\n"
        for finding in item.findings
    )
    head = f"{item.cell.case.label}, {item.cell.column}: {item.verdict}\n{own.status}: {own.message}\n"
    tail = f"{own.iterations} iterations, {own.cutbacks} cut-backs"
    return f"{head}reached {item.reached:.4g} of 1\n{''.join(found)}{tail}"


def _number(value: float) -> str:
    if not math.isfinite(value):
        return "∞"
    return f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e+") if value else "0"


def _shaded(error: float, about: str = "") -> str:
    """Return a cell with the colour of an error."""
    power = math.log10(max(error, 1e-300))
    red, green, blue = (round(float(np.interp(power, POWERS, shades))) for shades in SHADES)
    ink = "#fff" if 0.3 * red + 0.59 * green + 0.11 * blue < 130 else "#111"
    return f'<td{about} style="background:rgb({red},{green},{blue});color:{ink}">{_number(error)}</td>'


def extremes(
    folder: Path, workers: Workers, progress: Progress, *, quick: bool = False
) -> tuple[list[Judgement], tuple[Path, ...]]:
    """Run the matrix, or take it up where it was interrupted, and write page, table and numbers."""
    cells, kept = matrix(quick=quick), folder / ".extremes"
    cases = sorted(dict.fromkeys(case for cell in cells for case in cell.cases), key=_cost, reverse=True)
    results = run_cases(cases, kept, workers, repeats=0, progress=progress)
    judgements = [judged(cell, results) for cell in cells]
    html, rows = folder / "extremes.html", [row(item) for item in judgements]
    numbers = {"quick": quick, "verdicts": counts(judgements), "cells": rows}
    tables = (write_rows(folder / "extremes.csv", rows), write_numbers(folder / "extremes.json", numbers))
    part = ", a part of the matrix (quick)" if quick else ""
    lead = f"{counted(judgements)}{part}."
    write_page(folder, "Where it holds, where it stops", lead, sections(judgements), (), tables, html.name)
    rmtree(kept)
    return judgements, (html, *tables)


def _cost(case: Case) -> int:
    """Return steps times elements: the long cases come first, so that no worker ends up alone with one."""
    elements = case.options.elements or 1
    along, across = case.options.mesh or (0, 0)
    return case.scene.load_parameters * (elements + 40 * along * across)


def counts(judgements: Sequence[Judgement]) -> dict[str, dict[str, int]]:
    """Return how many cells of each axis are right, stopped, withdrawn and wrong."""
    number = Counter((item.cell.axis, item.verdict) for item in judgements)
    axes = dict.fromkeys(item.cell.axis for item in judgements)
    return {axis: {str(verdict): number[axis, verdict] for verdict in Verdict} for axis in axes}


def row(item: Judgement) -> Row:
    """Return one line of the table: the cell, its verdict, and the comparison that decides it."""
    own, decisive = item.own.response, item.decisive
    about = {"error": "error", "allowed": "allowed", "against": "name", "why": "why"}
    return {
        "axis": item.cell.axis,
        "model": item.cell.row,
        "value": item.cell.column,
        "label": item.cell.case.label,
        "verdict": str(item.verdict),
        "needless": item.needless,
        "status": own.status,
        "reached": item.reached,
        **{column: decisive and getattr(decisive, name) for column, name in about.items()},
        "iterations": own.iterations,
        "cutbacks": own.cutbacks,
        "seconds": item.own.seconds,
        "message": own.message,
    }
