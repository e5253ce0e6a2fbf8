"""The files of the league: a table, a diagram of work and precision, and a page."""

from collections import Counter
from collections.abc import Iterator, Sequence
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.league.entries import Entry, League
from comparisons.models.outside.programs import used
from comparisons.output import Row, write_numbers, write_rows
from comparisons.show import palette
from comparisons.show.pages import Section, folded, picture, provenance, table, write_page
from comparisons.show.plot import WIDTH, figure, save

COLUMNS = 2
"""Panels of the diagram beside each other."""
FLOOR = 1e-14
"""Errors below are drawn here: they are round-off."""


def write_league(league: League, folder: Path) -> list[Path]:
    """Write ``league.csv``, ``league.json``, ``league.svg``, ``league.png`` and ``report.html`` to `folder`; return the files."""
    rows = [entry.row() for entry in league.entries]
    files = [write_rows(folder / "league.csv", rows)] if rows else []
    files.append(
        write_numbers(
            folder / "league.json",
            {"entries": rows, "left_out": league.left_out, "reference_stopped": league.stopped},
        )
    )
    drawn = [folder / "league.svg", folder / "league.png"]
    plot_league(league, *drawn)
    files += drawn
    return [_write_page(league, files, folder), *files]


def plot_league(league: League, *paths: Path) -> None:
    """Draw the error of the force over the processor seconds of the whole process, a panel for each scene and a line for each program.

    A filled marker is a certified answer, a hollow one is a stop by name, and a cross is an answer that the program reported as a
    success and the referee refused.
    """
    rows = ceil(len(league.scenes) / COLUMNS)
    fig = figure(figsize=(WIDTH, 2.4 * rows + 1.4))
    panels = fig.subplots(rows, COLUMNS, squeeze=False, sharex=True, sharey=True).ravel()
    for axes, scene in zip(panels, league.scenes, strict=False):
        for program in league.programs:
            _draw(axes, program, league.of(scene.name, program))
        axes.set(xscale="log", yscale="log")
        axes.set_title(scene.name, fontsize="medium")
        axes.tick_params(labelbottom=True, labelleft=True, labelsize="small")
        axes.grid(visible=True, linewidth=0.3)
    _whole_decades(panels[0])
    for axes in panels[len(league.scenes) :]:
        axes.set_axis_off()
    fig.supxlabel("processor seconds of the whole process")
    fig.supylabel("largest error of the force (reactions without contact)")
    handles: dict[str, Any] = {}
    for axes in panels:
        handles |= dict(zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    fig.legend(
        list(handles.values()),
        list(handles),
        loc="outside upper center",
        ncols=3,
        fontsize="small",
        frameon=False,
    )
    save(fig, *paths)


def _whole_decades(axes: Any) -> None:
    """Widen the range of the seconds to whole decades, which have labels that do not overlap."""
    low, high = np.log10(axes.get_xlim())
    axes.set_xlim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))


def _draw(axes: Any, program: str, entries: Sequence[Entry]) -> None:
    style = palette.style(program)
    seconds = np.array([_seconds(entry) for entry in entries])
    errors = np.array([max(entry.errors["force"], FLOOR) for entry in entries])
    seen = np.isfinite(errors) & np.isfinite(seconds)
    if not seen.any():
        return
    axes.plot(
        seconds[seen], errors[seen], color=style.colour, linewidth=1.2, marker=style.marker, label=program
    )
    for x, y, entry in zip(seconds, errors, entries, strict=True):
        if entry.measured.wrong:
            axes.plot(x, y, color="black", marker="x", markersize=10, linestyle="none", zorder=4)
        elif not entry.measured.response.completed:
            axes.plot(
                x,
                y,
                color=style.colour,
                marker=style.marker,
                markerfacecolor="white",
                linestyle="none",
                zorder=4,
            )


def _seconds(entry: Entry) -> float:
    """Seconds of the whole process; of the solution where the system does not count processes."""
    whole = entry.measured.process_seconds
    return whole if np.isfinite(whole) else entry.measured.seconds


def summary(league: League) -> list[Row]:
    """Return a row for each program: on how many scenes it runs, and how its runs ended."""
    rows: list[Row] = []
    for program in league.programs:
        entries = [entry for entry in league.entries if entry.program == program]
        ends = Counter(entry.outcome for entry in entries)
        rows.append(
            {
                "program": program,
                "scenes": len({entry.case.scene.name for entry in entries}),
                "runs": len(entries),
                "certified": ends["certified"],
                "stopped by name": sum(n for end, n in ends.items() if end.isupper()),
                "said success and was wrong": ends["wrong"],
            }
        )
    return rows


def best_rows(league: League, scene: str) -> Iterator[Row]:
    """Yield the entries of one scene as rows for people."""
    for program in league.programs:
        for entry in league.of(scene, program):
            row = entry.row()
            names = {name: name.removeprefix("error_") for name in row if name.startswith("error_")}
            yield {
                "setting": row["setting"],
                "outcome": row["outcome"],
                **{short: _size(row[name]) for name, short in names.items()},
                "seconds": f"{row['seconds']:.2g}",
                "process": f"{row['process_seconds']:.2g}",
            }


def _size(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.1e}"


def _write_page(league: League, files: Sequence[Path], folder: Path) -> Path:
    sections = [
        Section(title="Programs", html=_table("How the runs of each program ended", summary(league))),
        Section(title="Work and precision", html=picture(folder / "league.svg", DIAGRAM)),
    ]
    for scene in league.scenes:
        reasons = [
            {"program": who, "reason": why} for name, who, why in league.left_out if name == scene.name
        ]
        stopped = league.stopped.get(scene.name)
        parts = [
            f"<p>The exact rods end here: {stopped}. Errors are measured as far as they came.</p>"
            if stopped
            else "",
            folded("all runs", _table(CAPTION, list(best_rows(league, scene.name)))),
            folded("who cannot state it", _table("Reasons", reasons)) if reasons else "",
        ]
        sections.append(Section(title=scene.name, html="\n".join(filter(None, parts))))
    sections += provenance(list(league.scenes), files, folder)
    others = ", ".join(model.label for model in used())
    lead = (
        f"{len(league.entries)} runs of {len(league.programs)} programs on {len(league.scenes)} scenes, each against the exact rods"
        f"{f'; programs of others: {others}' if others else ''}. Seconds belong to the machine named below. There is no single score."
    )
    return write_page(folder, "League", lead, sections)


CAPTION = (
    "Largest errors over the load parameters: forces and moments over their largest, positions over the length. Friction: the tangential "
    "contact forces that the material force at a clamp shows, over the contact forces; infinite where a program does not state it. "
    "Seconds: processor time of the solution, and of a whole process of crossval solve."
)

DIAGRAM = (
    "Largest error of the force over processor seconds of a whole process. Filled: certified. Hollow: stopped by name. Cross: said success "
    "and was wrong."
)


def _table(caption: str, rows: Sequence[Row]) -> str:
    return table(caption, list(rows[0]), (list(row.values()) for row in rows)) if rows else "<p>None.</p>"
