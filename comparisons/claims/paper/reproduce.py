"""The figures of [P] and the verdicts on its claims, as files."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.claims.paper.cantilever_shapes import Lifts, cantilever_shapes, plot_lifts
from comparisons.claims.paper.claims import Findings, claims_text
from comparisons.claims.paper.critical_area import (
    PRINTED,
    RATIOS,
    SHOWN_TOLERANCE,
    CriticalAreas,
    critical_areas,
)
from comparisons.claims.paper.critical_area_plot import (
    nearest_tolerance,
    plot_curves,
    plot_floors,
    plot_tolerances,
)
from comparisons.claims.paper.double_beam import DoubleBeam, double_beam
from comparisons.claims.paper.double_beam_plot import plot_histories, plot_stages
from comparisons.claims.paper.figures import FIGURES
from comparisons.claims.paper.formulations import FORMULATIONS
from comparisons.claims.paper.ks_shapes import READINGS, Shapes, ks_shapes, plot_readings, rows, shape_rows
from comparisons.claims.paper.reproduce_report import write_reproduced_page
from comparisons.claims.problems.double_beam import EVENTS
from comparisons.files import writable_folder, write_text
from comparisons.output import write_numbers, write_rows

Report = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Reproduced:
    """The files written, and the runs that a figure needs and that did not go through."""

    files: tuple[Path, ...]
    stopped: tuple[str, ...]


def reproduce(name: str, folder: Path, *, quick: bool, report: Report) -> Reproduced:
    """Compute and draw one figure or all of them, and judge the claims that they bear on.

    Parameters
    ----------
    name : str
        A key of `FIGURES`, or "all".
    folder : Path
        Made if it is not there. The verdicts are ``claims.md``, those of a single figure ``claims-NAME.md``; ``report.html`` shows what was
        run last.
    quick : bool
        Whether to take coarse settings.
    report : callable
        Takes lines about the progress.

    Raises
    ------
    OutputError
        If `folder` cannot be written; nothing is computed.
    """
    folder = writable_folder(folder)
    found = Findings(quick=quick)
    files: list[Path] = []
    stopped: list[str] = []
    for number, figure in enumerate(names := list(FIGURES) if name == "all" else [name], 1):
        report(f"[{number}/{len(names)}] {figure}: {FIGURES[figure]}")

        def indented(line: str) -> None:
            report(f"  {line}")

        compute, write = STUDIES[figure]
        study = compute(quick=quick, report=indented)
        files += write(study, folder)
        stopped += [f"{figure}: {one}" for one in getattr(study, "stopped", ())]
        found = replace(found, **{figure: study})
    claims = folder / ("claims.md" if name == "all" else f"claims-{name}.md")
    write_text(claims, claims_text(found))
    page = write_reproduced_page(found, [*files, claims], folder)
    return Reproduced(files=(page, *files, claims), stopped=tuple(stopped))


def _pictures(folder: Path, stem: str) -> list[Path]:
    return [folder / f"{stem}.png", folder / f"{stem}.svg"]


def write_fig7a(found: Lifts, folder: Path) -> list[Path]:
    """Write Fig. 7a: the picture, forces and places against the displacement, and the slip-offs."""
    files = _pictures(folder, "fig7a")
    plot_lifts(found, *files)
    columns = ("displacement", "force", "rod_force", "arc", "rod_arc")
    table = [
        {"start": lift.start, **dict(zip(columns, values, strict=True))}
        for lift in found.lifts
        for values in zip(*(getattr(lift, column) for column in columns), strict=True)
    ]
    numbers = [
        {
            "start": lift.start,
            "slip_off_rod": lift.rod_slip_off,
            "slip_off": lift.slip_off,
            "slip_off_error": {elements: lift.slip_off_error(elements) for elements in lift.slip_off},
            "force_error": lift.force_error,
            "reached_in_contact": lift.reached,
        }
        for lift in found.lifts
    ]
    return [
        *files,
        write_rows(folder / "fig7a.csv", table),
        write_numbers(folder / "fig7a.json", {"starting_positions": numbers, "stopped": found.stopped}),
    ]


def write_fig7b(found: CriticalAreas, folder: Path) -> list[Path]:
    """Write Fig. 7b: curves at one tolerance, critical areas against the tolerance, floors of the unbalanced force."""
    files = [
        picture for stem in ("fig7b", "fig7b-tolerance", "fig7b-floor") for picture in _pictures(folder, stem)
    ]
    plot_curves(found, *files[:2])
    plot_tolerances(found, *files[2:4])
    plot_floors(found, *files[4:])
    shown = nearest_tolerance(found)
    curves = [
        {"element": one.element, "start": one.start, "node": one.node, "displacement": d, "ratio": r}
        for one in found.measured
        if one.tolerance == shown
        for d, r in zip(one.displacement, one.ratio, strict=True)
    ]
    areas = [
        {name: getattr(one, name) for name in ("element", "tolerance", "start", "node", "smallest")}
        for one in found.measured
    ]
    floors = [
        {"element": one.element, "end": one.end, "psi": one.psi, "ratio": ratio, "floor": floor}
        for one in found.floors
        for ratio, floor in zip(RATIOS, one.floor, strict=True)
    ]
    return [
        *files,
        write_rows(folder / "fig7b.csv", curves),
        write_rows(folder / "fig7b-tolerance.csv", areas),
        write_rows(folder / "fig7b-floor.csv", floors),
        write_numbers(folder / "fig7b.json", _fig7b_numbers(found)),
    ]


def _fig7b_numbers(found: CriticalAreas) -> dict[str, Any]:
    def measured(element: str, tolerance: float) -> dict[str, float]:
        areas = found.areas(element, tolerance)
        return {"smallest": areas.min(), "median": np.median(areas), "largest": areas.max()}

    return {
        "tolerance_of_the_curves": nearest_tolerance(found),
        "wanted_tolerance_of_the_curves": SHOWN_TOLERANCE,
        "critical_area": {
            one.element: {
                f"{tolerance:.0e}": measured(one.element, tolerance) for tolerance in found.tolerances
            }
            for one in FORMULATIONS
        },
        "printed": PRINTED,
        "tolerance_for_the_printed": {
            element: found.tolerance_for(element, float(np.sqrt(low * high)))
            for element, (low, high) in PRINTED.items()
        },
        "slopes_of_the_floor": {
            element: found.slopes(element) for element in dict.fromkeys(one.element for one in found.floors)
        },
    }


def write_fig8(found: Shapes, folder: Path) -> list[Path]:
    """Write Fig. 8: pictures of the readings, errors of all runs, points of the drawn axes."""
    table = rows(found)
    return [
        *plot_readings(found, folder),
        write_rows(folder / "fig8.csv", table),
        write_rows(folder / "fig8-shapes.csv", shape_rows(found)),
        write_numbers(folder / "fig8.json", {"readings": READINGS, "runs": table, "stopped": found.stopped}),
    ]


def write_fig9(found: DoubleBeam, folder: Path) -> list[Path]:
    """Write Fig. 9: stages, forces against depth, events, and the check against the exact rods."""
    stages, histories = _pictures(folder, "fig9"), _pictures(folder, "fig9-forces")
    plot_histories(found, *histories)
    files = histories
    if found.stages:
        plot_stages(found, *stages)
        files = stages + histories
    table = [
        {
            "depth": depth,
            **{
                f"{pair} {quantity}": getattr(history, quantity)[k]
                for pair, history in found.histories.items()
                for quantity in ("force", "arc", "exact_force", "exact_arc")
            },
        }
        for k, depth in enumerate(found.depth)
    ]
    names = (
        "events",
        "checks",
        "stages",
        "iterations",
        "seconds",
        "attempts",
        "stopped",
    )
    return [
        *files,
        write_rows(folder / "fig9.csv", table),
        write_numbers(
            folder / "fig9.json", {"exact_events": EVENTS, **{name: getattr(found, name) for name in names}}
        ),
    ]


STUDIES: dict[str, tuple[Callable[..., Any], Callable[[Any, Path], list[Path]]]] = {
    "fig7a": (cantilever_shapes, write_fig7a),
    "fig7b": (critical_areas, write_fig7b),
    "fig8": (ks_shapes, write_fig8),
    "fig9": (double_beam, write_fig9),
}
"""How each figure of `FIGURES` is computed and written."""
