"""Run the matrix, judge every cell, write the maps."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from shutil import rmtree
from typing import NamedTuple

from comparisons.cases.case import Case
from comparisons.cases.run import Progress
from comparisons.cases.run import run as run_cases
from comparisons.cases.workers import Workers
from comparisons.claims.claim import Verdict
from comparisons.claims.extremes.axes import AXES, matrix
from comparisons.claims.extremes.cell import Judgement, judged
from comparisons.claims.extremes.maps import counted, sections
from comparisons.files import write_text
from comparisons.output import Row, write_numbers, write_rows
from comparisons.show.pages import page, provenance


class Extremes(NamedTuple):
    """What became of every cell of the matrix, and the files that were written."""

    judgements: tuple[Judgement, ...]
    files: tuple[Path, ...]

    @property
    def wrong(self) -> tuple[Judgement, ...]:
        """The cells that are wrong."""
        return tuple(item for item in self.judgements if item.verdict is Verdict.WRONG)


def extremes(folder: Path, workers: Workers, progress: Progress, *, quick: bool = False) -> Extremes:
    """Run the matrix and write ``extremes.html``, ``.csv`` and ``.json`` into `folder`.

    A run that was interrupted is taken up where it was; one that ended starts anew.

    Raises
    ------
    OutputError, WorkersError
        If a file cannot be written, or the workers are gone.
    """
    cells, kept = matrix(quick=quick), folder / ".extremes"
    cases = sorted(dict.fromkeys(case for cell in cells for case in cell.cases), key=_cost, reverse=True)
    results = run_cases(cases, kept, workers, repeats=0, progress=progress)
    judgements = tuple(judged(cell, results) for cell in cells)
    files = write(folder, judgements, quick=quick)
    rmtree(kept)
    return Extremes(judgements=judgements, files=files)


def _cost(case: Case) -> int:
    """Return steps times elements: the long cases come first, so that no worker ends up alone with one."""
    elements = case.options.elements or 1
    along, across = case.options.mesh or (0, 0)
    return case.scene.load_parameters * (elements + 40 * along * across)


def write(folder: Path, judgements: Sequence[Judgement], *, quick: bool) -> tuple[Path, ...]:
    """Write the three files and return their names."""
    html, rows = folder / "extremes.html", [row(item) for item in judgements]
    numbers = {"quick": quick, "verdicts": counts(judgements), "cells": rows}
    tables = (write_rows(folder / "extremes.csv", rows), write_numbers(folder / "extremes.json", numbers))
    part = ", a part of the matrix (quick)" if quick else ""
    whole = [*sections(AXES, judgements), *provenance((), tables, folder)[1:]]
    write_text(html, page("Where it holds, where it stops", f"{counted(judgements)}{part}.", whole))
    return html, *tables


def counts(judgements: Sequence[Judgement]) -> dict[str, dict[str, int]]:
    """Return how many cells of each axis are right, stopped, withdrawn and wrong."""
    return {
        axis.name: {str(verdict): number[verdict] for verdict in Verdict}
        for axis in AXES
        if (number := Counter(item.verdict for item in judgements if item.cell.axis == axis.name))
    }


def row(item: Judgement) -> Row:
    """Return one line of the table: the cell, its verdict, and the comparison that decides it."""
    own, decisive = item.own.response, item.decisive
    about = ("error", "allowed", "against", "why")
    found = (decisive.error, decisive.allowed, decisive.name, decisive.why) if decisive else (None,) * 4
    return {
        "axis": item.cell.axis,
        "model": item.cell.row,
        "value": item.cell.column,
        "label": item.cell.case.label,
        "verdict": str(item.verdict),
        "needless": item.needless,
        "status": own.status,
        "reached": item.reached,
        **dict(zip(about, found, strict=True)),
        "iterations": own.iterations,
        "cutbacks": own.cutbacks,
        "seconds": item.own.seconds,
        "message": own.message,
    }
