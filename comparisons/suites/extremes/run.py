"""Run the matrix, judge every cell, draw the maps: one table for each axis, models down, values across."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from comparisons.output import Row
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, rendered
from comparisons.suite import Case
from comparisons.suite.progress import Runner
from comparisons.suites.extremes.axes import AXES, matrix
from comparisons.suites.extremes.cell import VERDICTS, Judgement, judged
from comparisons.suites.found import Found

MARKS = dict(zip(VERDICTS, ("", "■ ", "□ ", "✗ "), strict=True))
"""Marks that distinguish the verdicts without colour."""
POWERS = (-14.0, -10.0, -6.0, -3.0, 0.0)
SHADES = ((8, 33, 107, 189, 255), (48, 113, 174, 215, 247), (107, 181, 214, 231, 188))
"""Red, green and blue by the error's decimal logarithm: blue for small errors to pale yellow, safe for the colour-blind."""
MOST = 2
"""Wrong cells that a brief names."""
ABSENT = ("·", {"class": "none"})
"""Text and attributes of a cell of the map without a cell of the matrix."""


def extremes(run: Runner, *, quick: bool = False) -> Found:
    """Run the matrix and judge it."""
    cells = matrix(quick=quick)
    cases = dict.fromkeys(case for cell in cells for case in cell.cases)
    results = run(sorted(cases, key=_cost, reverse=True))
    judgements = [judged(cell, results) for cell in cells]
    rows = [item.row for item in judgements]
    number = Counter((row["axis"], row["verdict"]) for row in rows)
    axes = dict.fromkeys(row["axis"] for row in rows)
    counts = {axis: {verdict: number[axis, verdict] for verdict in VERDICTS} for axis in axes}
    wrong = [item.sentence for item in judgements if item.row["verdict"] == "wrong"]
    answer = [{"axis": axis, **of} for axis, of in counts.items()]
    about = f"The cells of each axis{', a part of them (quick)' * quick}:"
    return Found(
        title="Where it holds, where it stops",
        brief=Brief(_sentence(rows), [*wrong[:MOST], *_reasons(rows)], answer, about),
        files={"extremes.csv": rows, "extremes.json": {"quick": quick, "verdicts": counts, "cells": rows}},
        sections=lambda _: _sections(judgements),
        wrong=wrong,
        page="extremes.html",
    )


def _sentence(rows: Sequence[Row]) -> str:
    """Return how many cells have each verdict."""
    number = Counter(row["verdict"] for row in rows)
    withdrawn = f", {number['withdrawn']} are withdrawn by their own checks" if number["withdrawn"] else ""
    wrong = f"{number['wrong'] or 'none'} {'are' if number['wrong'] > 1 else 'is'} wrong"
    return f"{number['right']} of {len(rows)} cells are right, {number['stopped']} stop by name{withdrawn}, {wrong}."


def _reasons(rows: Sequence[Row]) -> Iterator[str]:
    """Yield why cells stop and are withdrawn."""
    for verdict in ("stopped", "withdrawn"):
        why = Counter(row["status"] for row in rows if row["verdict"] == verdict)
        if why:
            yield f"{verdict.capitalize()}: {', '.join(f'{n} {name}' for name, n in why.most_common())}."
    if needless := sum(row["needless"] for row in rows):
        yield f"{needless} of the withdrawn cells needlessly: their errors are within what is allowed."


def _cost(case: Case) -> int:
    """Return steps times elements: the long cases come first, so that no worker ends up alone with one."""
    along, across = case.options.mesh or (0, 0)
    return case.scene.load_parameters * ((case.options.elements or 1) + 40 * along * across)


def _sections(judgements: Sequence[Judgement]) -> list[Section]:
    """Return one map for each axis that has cells, and the key after the first."""
    shaded = {_number(error): {"style": _shade(error)} for error in (1e-14, 1e-10, 1e-6, 1e-3, 0.1)}
    parts = [Section("How to read the maps", rendered("maps", marks=MARKS, shaded=shaded))]
    for name, axis in AXES.items():
        own = [item for item in judgements if item.row["axis"] == name]
        if own:
            at = {(item.row["model"], item.row["value"]): _cell(item) for item in own}
            rows, columns = (list(dict.fromkeys(names)) for names in zip(*at, strict=True))
            grid = {row: [at.get((row, column), ABSENT) for column in columns] for row in rows}
            drawn = rendered("map", about=f"{axis['scene']}.", columns=columns, grid=grid)
            parts.append(Section(axis["title"], drawn))
    return [*parts[1:2], parts[0], *parts[2:]]


def _cell(item: Judgement) -> tuple[str, dict[str, Any]]:
    """Return the text and the attributes of a cell of the map."""
    findings, row = item
    head = "{label}, {value}: {verdict}\n{status}: {message}\nreached {reached:.4g} of 1".format_map(row)
    held = [
        f"against {one.name}: error {_number(one.error)}, allowed {_number(one.allowed)} ({one.why})"
        for one in findings
    ]
    lines = (head, *held, f"{row['iterations']} iterations, {row['cutbacks']} cut-backs")
    verdict = row["verdict"]
    text = row["status"] if verdict == "stopped" or not findings else _number(row["error"])
    shade = _shade(row["error"]) if verdict == "right" and findings else None
    return MARKS[verdict] + text, {"class": verdict, "title": "\n".join(lines), "style": shade}


def _number(value: float) -> str:
    if not math.isfinite(value):
        return "∞"
    return f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e+") if value else "0"


def _shade(error: float) -> str:
    """Return the colour of an error, and of the words on it."""
    power = math.log10(max(error, 1e-300))
    red, green, blue = (round(float(np.interp(power, POWERS, shades))) for shades in SHADES)
    ink = "#fff" if 0.3 * red + 0.59 * green + 0.11 * blue < 130 else "#111"
    return f"background:rgb({red},{green},{blue});color:{ink}"
